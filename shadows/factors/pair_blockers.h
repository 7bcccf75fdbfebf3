// Which blockers may stand between two sides, and whether one of them, or one convex
// solid, hides all by itself.

#pragma once

#include <span>
#include <vector>

#include "linespace/predicates.h"
#include "linespace/scene.h"
#include "linespace/space/bvh.h"
#include "shadows/factors/factor_sides.h"

namespace sightline::internal {

/// A side, prepared for many questions.
struct PreparedSide {
  explicit PreparedSide(const FactorSide& side);

  PointList polygon;
  int of;
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
  /// The first `solid` blockers have the material of a closed object behind them.
  PairBlockers(const Scene& scene, std::vector<PointList> blockers, std::size_t solid);

  [[nodiscard]] const PointList& polygon(int blocker) const { return blockers_[blocker]; }
  /// All blockers that have a point strictly between the two, and perhaps a few more.
  /// Those in the plane of either, or behind it, are left out.  Ascending.
  void between(const PreparedSide& a, const PreparedSide& b,
               std::vector<int>& found) const;
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
  struct Solid {
    Box box;
    std::vector<Eigen::Vector4d> planes;  // unit normals; above 0 outside
  };
  [[nodiscard]] bool hidden_by_solid(const PointList& a, const PointList& b) const;
  [[nodiscard]] bool hides(int blocker, const PointList& a, const PointList& b) const;

  std::vector<PointList> blockers_;
  std::size_t solid_faces_;
  std::vector<PlaneSide> planes_;
  std::vector<Solid> solids_;
  double margin_;  // scene units
  Bvh tree_, solid_tree_;
};

}  // namespace sightline::internal
