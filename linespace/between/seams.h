// Which of some polygons a segment meets.

#pragma once

#include <array>
#include <span>
#include <vector>

#include "linespace/exact_position.h"
#include "linespace/polygon_visibility.h"

namespace sightline::internal {

/// Numbers of the polygons, convex and planar, that the closed segment meets, ascending.
/// Exact.  Cost: that of a Scene of the polygons whose boxes meet the segment's.
[[nodiscard]] std::vector<int> polygons_met(std::span<const Polygon> polygons,
                                            const std::array<ExactPosition, 2>& segment);

/// Throws InvalidInput unless 0 <= seam and finite.
void check_seam(double seam);

}  // namespace sightline::internal
