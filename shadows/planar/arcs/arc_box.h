// A box around a stretch of an arc.

#pragma once

#include <array>
#include <optional>

#include "shadows/planar/arcs/plane_support.h"

namespace sightline::internal {

/// Homogeneous coordinates of Bezier's control points of the stretch: the last index is
/// the coordinate.  Three points of a conic, two of a line.
[[nodiscard]] std::array<std::array<BallNumber, 3>, 3> control_points(
    const PlaneSupport& support, const BallNumber& from, const BallNumber& to);

/// A point, enclosed.
struct PointRange {
  DoubleRange x, y;
};
/// nullopt where the enclosure of w contains 0.
[[nodiscard]] std::optional<PointRange> point_range(const PlaneSupport& support,
                                                    const BallNumber& s);

/// Contains the stretch.  nullopt where a control point may have no positive weight: of
/// a short enough stretch all have.
[[nodiscard]] std::optional<PointRange> box_of(const PlaneSupport& support,
                                               const DoubleRange& s);

}  // namespace sightline::internal
