// Boxes that are tight around thin faces, whichever way these run.
//
// A long thin face that runs askew fills little of the box along the axes around it, so
// that the boxes of many such faces, side by side, all overlap.  Along directions of the
// faces themselves they do not.

#pragma once

#include <array>
#include <span>
#include <vector>

#include "linespace/scene.h"
#include "linespace/space/bvh.h"

namespace sightline::internal {

/// A few sets of three directions, and for each face the one along which its box is
/// small. Set 0 is the axes.  Cost: near-linear in the faces.
class TightBoxes {
 public:
  TightBoxes(const Scene& scene, std::span<const int> faces);

  [[nodiscard]] int count() const { return static_cast<int>(sets_.size()); }
  /// Of the i-th of the faces.
  [[nodiscard]] int set_of(std::size_t i) const { return set_of_[i]; }
  /// Around the face, along the directions of a set: what its points have as products
  /// with them, rounding included.  Faces whose boxes of one set are apart do not meet.
  [[nodiscard]] Box box(int set, int face) const;

 private:
  using Directions = std::array<Point, 3>;
  [[nodiscard]] Directions along(int face) const;
  [[nodiscard]] Box box(const Directions& directions, int face) const;
  [[nodiscard]] double bulk(const Box& box) const;

  const Scene& scene_;
  double least_;  // what a side of a box counts for at least
  std::vector<Directions> sets_;
  std::vector<int> set_of_;
};

}  // namespace sightline::internal
