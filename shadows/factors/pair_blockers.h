// Which blockers may stand between two sides, and whether one of them, or one convex
// solid, hides all by itself.

#pragma once

#include <array>
#include <span>
#include <vector>

#include "linespace/predicates.h"
#include "linespace/scene.h"
#include "linespace/space/bvh.h"
#include "shadows/factors/factor_sides.h"
#include "shadows/hiding/convex_solids.h"

namespace sightline::internal {

/// A side, prepared for many questions.
struct PreparedSide {
  explicit PreparedSide(const FactorSide& side);

  PointList polygon;
  int of;
  int object;  ///< as of FactorSide
  double area;
  Box box;
  PlaneSide plane;
};

/// Each has points before the other's front: exactly.
[[nodiscard]] bool facing(const PreparedSide& a, const PreparedSide& b);
/// All of each lies on or before the other's plane.
[[nodiscard]] bool wholly_facing(const PreparedSide& a, const PreparedSide& b);

/// Immutable; may be shared between threads.
class PairBlockers {
 public:
  PairBlockers(const Scene& scene, const FactorScene& factors);
  [[nodiscard]] const ConvexSolids& solids() const { return solids_; }

  [[nodiscard]] const PointList& polygon(int blocker) const { return blockers_[blocker]; }
  /// All blockers that have a point strictly between the two, and perhaps a few more.
  /// Those in the plane of either, or behind it, are left out, and those of solids that
  /// are hidden from a: null, or for each solid whether it is.  Ascending.
  void between(const PreparedSide& a, const PreparedSide& b,
               const std::vector<char>* hidden, std::vector<int>& found) const;
  /// Without the blockers through which a line from side a can only leave a closed
  /// object: it has come in through another one.  Requires that side a lies in no
  /// material.
  void leave_out_exits(const PreparedSide& a, std::vector<int>& found) const;
  /// One of these blockers, or a convex solid, meets every segment between the two.  True
  /// is a proof.
  [[nodiscard]] bool hidden_by_one(const PreparedSide& a, const PreparedSide& b,
                                   std::span<const int> among) const;
  /// The same of each pair of the parts into which the two are cut, so many times.
  [[nodiscard]] bool hidden_by_parts(const PointList& a, const PointList& b,
                                     std::span<const int> among, int cuts) const;

 private:
  [[nodiscard]] bool hidden_by_solid(const PointList& a, const PointList& b) const;
  [[nodiscard]] bool hides(int blocker, const PointList& a, const PointList& b) const;

  std::vector<PointList> blockers_;
  std::size_t solid_faces_;
  std::vector<PlaneSide> planes_;
  std::vector<int> solid_of_;  // of each blocker; -1: none
  ConvexSolids solids_;
  Bvh tree_;
};

/// The part of a side within a polygon of its plane.
[[nodiscard]] PreparedSide part_of(const PreparedSide& side, PointList polygon);
/// Both halves of a convex polygon, cut across the coordinate axis along which it is
/// longest.  Corners at the cut are rounded.
[[nodiscard]] std::array<PointList, 2> halves(const PointList& polygon);

}  // namespace sightline::internal
