#include "aspect/cells/space_bounds.h"

#include <algorithm>

namespace sightline::internal {
namespace {

// The number of a plane across an axis, added if it is not there.
int number_of(std::vector<LightPlane>& planes, const LightPlane& plane, int axis) {
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const auto& p = planes[i].exact;
    bool same = p[3] == plane.exact[3] * p[axis];
    for (int k = 0; k < 3; ++k) same = same && is_zero(p[k]) == (k != axis);
    if (same) return static_cast<int>(i);
  }
  planes.push_back(plane);
  return static_cast<int>(planes.size()) - 1;
}

}  // namespace

std::vector<BoundSide> add_bounds(std::vector<LightPlane>& planes,
                                  const std::array<Point, 2>& box) {
  std::vector<BoundSide> bounds;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, 1}) {
      LightPlane plane;
      for (int i = 0; i < 4; ++i) {
        const double x = i == axis ? 1 : i == 3 ? -box[side][axis] : 0;
        plane.near[i] = {x, 0};
        plane.exact[i] = Ring(x);
      }
      const int number = number_of(planes, plane, axis);
      // One that was there may face the other way.
      const bool same_way = sign_of(planes[number].exact[axis]) == Sign::Positive;
      bounds.push_back({number, same_way == (side == 0)});
    }
  }
  return bounds;
}

bool within(const SignTable& cells, int cell, std::span<const BoundSide> bounds) {
  return std::ranges::all_of(bounds, [&](const BoundSide& b) {
    return cells.positive(cell, b.plane) == b.positive;
  });
}

}  // namespace sightline::internal
