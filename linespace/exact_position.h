// A point of rational coordinates, written so that nothing is lost.

#pragma once

#include <array>
#include <string>

#include "linespace/scene.h"

namespace sightline {

/// A point that may need more digits than a double has.
struct ExactPosition {
  Point nearest;  ///< rounded
  /// "x" or "p/q" in decimal: exactly the coordinates.
  std::array<std::string, 3> exact;
  std::array<bool, 3> is_double;  ///< per axis: `nearest` is exact
};

}  // namespace sightline
