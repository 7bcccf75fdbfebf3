// The volume of what of a box lies in a cell of planes.

#pragma once

#include <array>
#include <span>

#include "aspect/cells/inner_point.h"

namespace sightline::internal {

/// Scene units cubed, within some 1e-14 of the box's volume; 0 where they do not meet.
/// Cost: the box is cut by one plane after the other.
[[nodiscard]] double volume_in_box(std::span<const SignedPlane> sides,
                                   const std::array<Point, 2>& box);

}  // namespace sightline::internal
