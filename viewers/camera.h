// Where a picture is taken from.

#pragma once

#include <array>

#include "viewers/picture.h"

namespace sightline::viewers {

/// A unit vector towards the eye, `elevation` radians above the horizon; `turn` in [0, 1)
/// goes once around.  Off the axes and diagonals, where aligned scenes look flat.
[[nodiscard]] Point eye_direction(int up_axis, double elevation, double turn);

/// The camera that looks along -towards_eye (a unit vector, not along `up`) and just
/// holds the box; `aspect` is the picture's width by its height.
[[nodiscard]] Camera frame(const std::array<Point, 2>& box, const Point& towards_eye,
                           const Point& up, double aspect);

/// The widest vertical angle of look_from, radians: more distorts.
constexpr double kWidestView = 1.2;

/// The camera at `eye` that looks towards `at`.  Its angle just holds the box, up to
/// kWidestView, which it has where the box is beside or around the eye.  Looking straight
/// along the up axis, the axis two after it (y for z) points up.  Requires eye != at.
[[nodiscard]] Camera look_from(const Point& eye, const Point& at,
                               const std::array<Point, 2>& box, int up_axis,
                               double aspect);

}  // namespace sightline::viewers
