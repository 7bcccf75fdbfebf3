// A name for a rational line: the same bytes for the same line, whatever points it is
// told by, other bytes for any other line.

#pragma once

#include <array>
#include <string>

#include "linespace/numbers/rational.h"

namespace sightline::internal {

/// The line's Pluecker coordinates (direction, moment) as integers without a common
/// divisor, the first that is not zero positive.  Empty: no line.
using LineName = std::string;

/// Of the line through two different points.  Cost: some 3 microseconds.
[[nodiscard]] LineName name_of_line(const std::array<ExactPoint, 2>& line);

}  // namespace sightline::internal
