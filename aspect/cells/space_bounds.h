// A box as a part of space that planes cut: some cells lie within it.

#pragma once

#include <array>
#include <span>
#include <vector>

#include "aspect/cells/sign_table.h"
#include "linespace/light/homogeneous.h"

namespace sightline::internal {

/// The side of a plane on which the box lies.
struct BoundSide {
  int plane;
  bool positive;
};

/// Adds the planes of the box's six sides to `planes`, no two of which are the same,
/// unless they are among them; which side of each is the box's.
[[nodiscard]] std::vector<BoundSide> add_bounds(std::vector<LightPlane>& planes,
                                                const std::array<Point, 2>& box);

/// Whether a cell of these planes lies in the box; `cells` is their table, `bounds` what
/// add_bounds() said.
[[nodiscard]] bool within(const SignTable& cells, int cell,
                          std::span<const BoundSide> bounds);

}  // namespace sightline::internal
