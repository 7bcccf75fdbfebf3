// From where no line can touch a ridge, told at a glance: most pairs of a viewpoint and a
// ridge end here, so it is kept apart from the ridges, small and in the order of their
// tree.

#pragma once

#include <array>

#include "linespace/scene.h"

namespace sightline::internal {

struct Ridge;

class RidgeSides {
 public:
  RidgeSides(const Scene& scene, const Ridge& ridge);

  /// True proves that no line through the point touches the ridge.
  [[nodiscard]] bool never_touched_from(const Point& p) const {
    const int side = common_side(p);
    return side >= 0 && !touched_on_[side];
  }
  /// The same of all points between p and q.
  [[nodiscard]] bool never_touched_from(const Point& p, const Point& q) const {
    const int side = common_side(p);
    return side >= 0 && !touched_on_[side] && common_side(q) == side;
  }

 private:
  /// 0: surely behind both planes of the wedge, 1: in front of both, -1: neither, or too
  /// near to one.
  [[nodiscard]] int common_side(const Point& p) const;

  Point origin_;  // on both planes
  std::array<Point, 2> normals_;
  /// What a normal is off by, in each component, rounding of the products included.
  std::array<double, 2> slack_;
  std::array<bool, 2> touched_on_;
};

inline int RidgeSides::common_side(const Point& p) const {
  const Point d = p - origin_;
  const double reach = d.cwiseAbs().sum();
  const double a = normals_[0].dot(d);
  const double b = normals_[1].dot(d);
  if (a > slack_[0] * reach && b > slack_[1] * reach) return 1;
  return a < -slack_[0] * reach && b < -slack_[1] * reach ? 0 : -1;
}

}  // namespace sightline::internal
