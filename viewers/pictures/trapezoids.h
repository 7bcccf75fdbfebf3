// Polygons with holes, cut into pieces that file formats without holes can hold.

#pragma once

#include <vector>

#include "viewers/pictures/picture_plane.h"

namespace sightline::viewers {

/// The inside of the rings, by the even-odd rule, as triangles and trapezoids whose
/// parallel sides run along x, counter-clockwise.  Sides of rings must not cross, and may
/// touch and coincide.  A piece ends where the sides beside it do (the trapezoidal
/// decomposition of Chazelle and Incerpi 1984), so that n sides give at most 2 n pieces.
/// Cost: n log n, and the sides met by horizontal lines through all corners.
[[nodiscard]] std::vector<std::vector<PlanePoint>> trapezoids(
    const std::vector<std::vector<PlanePoint>>& rings);

}  // namespace sightline::viewers
