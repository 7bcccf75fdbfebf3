// The double integral of ln r along two segments, in closed form.

#pragma once

#include "linespace/scene.h"

namespace sightline::internal {

struct LogIntegral {
  double value;
  /// Of the terms that make it up: rounding does about 1e-16 times this.  Infinite where
  /// the closed form is of no use: lines nearly, but not quite, parallel.
  double size;
};

/// Integral of ln |x - y| over x from a0 to a1 and y from b0 to b1, both by length.
[[nodiscard]] LogIntegral log_integral(const Point& a0, const Point& a1, const Point& b0,
                                       const Point& b1);

}  // namespace sightline::internal
