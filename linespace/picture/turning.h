// The order of what leaves a point of the picture.

#pragma once

#include <span>
#include <vector>

#include "linespace/picture/picture_point.h"

namespace sightline::internal {

/// Positions in the lists, counter-clockwise around the point from the first on.
/// far: for each a point of the picture straight on, less than half a turn away.
/// lines: on which line each runs; one line leaves a point both ways at most.
[[nodiscard]] std::vector<std::size_t> order_around(const PicturePoint& at,
                                                    std::span<const PicturePoint> far,
                                                    std::span<const int> lines);

}  // namespace sightline::internal
