// The convex closed objects of a scene, each of which hides what lies behind it by
// itself.

#pragma once

#include <span>
#include <vector>

#include "linespace/scene.h"
#include "linespace/space/bvh.h"

namespace sightline::internal {

/// Immutable; may be shared between threads.
class ConvexSolids {
 public:
  explicit ConvexSolids(const Scene& scene);

  [[nodiscard]] std::size_t size() const { return boxes_.size(); }
  [[nodiscard]] const Box& box(int solid) const { return boxes_[solid]; }
  [[nodiscard]] const Bvh& tree() const { return tree_; }
  /// Number of the solid that the object is; -1 for objects that are none.
  [[nodiscard]] int of_object(int object) const { return of_object_[object]; }

  /// The solid's inside meets every segment from a point of one set to a point of the
  /// other, and so from their hulls.  True is a proof: coordinates may be off by 1e-12 of
  /// the scene's.
  [[nodiscard]] bool hides(int solid, std::span<const Point> from,
                           std::span<const Point> to) const;

 private:
  [[nodiscard]] bool meets(int solid, const Point& x, const Point& y) const;

  std::vector<Box> boxes_;
  std::vector<Eigen::Vector4d> planes_;  // unit normals; above 0 outside
  std::vector<std::size_t> first_;       // plane of each solid
  std::vector<int> of_object_;
  double margin_ = 0;  // scene units
  Bvh tree_;
};

}  // namespace sightline::internal
