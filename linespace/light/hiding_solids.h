// Which convex solids, or faces of anything else, certainly hide a point from another.
//
// One that hides both ends of a segment from both ends of another hides all points of
// either from all of the other: in the triangle of a point and a segment it is met on the
// way to either end, and it is convex.

#pragma once

#include <memory>
#include <span>
#include <vector>

#include "linespace/light/light_space.h"

namespace sightline::internal {

/// Immutable; keeps a reference to the space.
class HidingSolids {
 public:
  explicit HidingSolids(const LightSpace& space);

  /// Appends, ascending, the numbers of those whose inside the segment certainly passes.
  void between(const LightPoint& p, const LightPoint& q, std::vector<int>& out) const;

 private:
  struct Plane {
    Point normal;   // outwards
    double offset;  // of the plane moved inwards, beyond all rounding
  };
  // A convex solid by its planes, or a face.
  struct Occluder {
    std::vector<Plane> planes;
    int face = -1;
  };
  [[nodiscard]] bool hides(const Occluder& occluder, const LightPoint& p,
                           const LightPoint& q) const;

  const LightSpace& space_;
  std::vector<Occluder> occluders_;
  std::unique_ptr<Bvh> tree_;
};

/// Leaves in `x` what is also in `y`; both ascending.
void keep_common(std::vector<int>& x, const std::vector<int>& y);

}  // namespace sightline::internal
