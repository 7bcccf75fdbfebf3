// Which faces may be seen: all but those that are certainly hidden.

#pragma once

#include <cstdint>
#include <vector>

#include "linespace/picture/eye_space.h"

namespace sightline::internal {

/// For each face 0 if nearer faces certainly hide all of it, else 1.
[[nodiscard]] std::vector<std::uint8_t> possibly_seen(const EyeSpace& eye);

}  // namespace sightline::internal
