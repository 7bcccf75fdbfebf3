// Which edges of a view lie opposite each other: a line through the viewpoint may meet
// both, one before it and one behind.  In bounded doubles: what is left out is proved to
// be.

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "linespace/scene.h"

namespace sightline::internal {

/// All pairs (i, j), i < j, ascending, of edges that may lie opposite each other.  A tree
/// over their directions is held against its mirror image: time follows what comes near
/// each other.
[[nodiscard]] std::vector<std::pair<std::uint32_t, std::uint32_t>> opposite_edges(
    const Point& viewpoint, std::span<const std::array<Point, 2>> edges);

}  // namespace sightline::internal
