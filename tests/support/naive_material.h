// What lies inside closed objects, for the naive shadows: which faces bound material.

#pragma once

#include <vector>

#include "tests/support/naive_shadow.h"

namespace sightline::testing {

/// A body: faces, with the fronts of the file outside, that wind once around the points
/// of its material and not at all around others.
using Body = std::vector<int>;

/// The bodies of all closed objects: those whose sides are each used as often one way as
/// the other.  A part that hangs together by sides is a shell.  A shell whose fronts are
/// inside is a cavity of its object if the other shells wind around it, and belongs to
/// its body; it is a hollow if the body of another object has it in its material, and
/// belongs to that one's; else it is a room, and belongs to none.
[[nodiscard]] std::vector<Body> bodies_of(const std::vector<NaiveShadowFace>& faces);

}  // namespace sightline::testing
