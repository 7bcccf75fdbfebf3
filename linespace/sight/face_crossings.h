// Where faces of a scene cross each other: there the face on which lines end changes
// although no side of either is met.

#pragma once

#include <array>
#include <functional>
#include <vector>

#include "linespace/numbers/rational.h"
#include "linespace/silhouettes/silhouettes.h"
#include "linespace/space/bvh.h"

namespace sightline::internal {

/// Two faces, f < h, in different planes, whose insides meet in a segment.
struct FaceCrossing {
  int f, h;
  std::array<ExactPoint, 2> segment;
};

/// All of a scene.  Immutable.  Cost: n log n for n faces, and exact arithmetic for pairs
/// each of which has corners on both sides of the other's plane.
class FaceCrossings {
 public:
  /// Faces of one convex solid are not looked at.
  explicit FaceCrossings(const Silhouettes& silhouettes);

  [[nodiscard]] const FaceCrossing& at(std::uint32_t number) const {
    return crossings_[number];
  }
  [[nodiscard]] bool empty() const { return crossings_.empty(); }
  [[nodiscard]] std::size_t count() const { return crossings_.size(); }
  /// Over the segments' boxes; items are numbers.
  [[nodiscard]] const Bvh& tree() const { return tree_; }
  /// In either order.
  [[nodiscard]] bool cross(int f, int h) const;

 private:
  std::vector<FaceCrossing> crossings_;  // by faces, ascending
  Bvh tree_;
};

}  // namespace sightline::internal
