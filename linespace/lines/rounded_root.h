// Positions on an edge as doubles: a first enclosure, and where that is too wide, from
// double-double coefficients, a tenth of the cost of exact ones.

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "linespace/lines/transversals.h"
#include "linespace/numbers/exact_numbers.h"

namespace sightline::internal {

/// Encloses x / (x + y) for x and y between bounds that are not negative.  Four roundings
/// at most, so a relative slack of 8 units in the last place of 1 covers them.
[[nodiscard]] inline std::array<double, 2> enclosed_share(double x_low, double x_high,
                                                          double y_low, double y_high) {
  constexpr double slack = 16 * kUnit;
  return {x_low > 0 ? std::max(0.0, x_low / (x_low + y_high) * (1 - slack)) : 0,
          y_low > 0 ? std::min(1.0, x_high / (x_high + y_low) * (1 + slack)) : 1};
}

/// Encloses the zero of at0 (1 - s) + at1 s, whose ends, each known within its error,
/// differ in sign.
[[nodiscard]] inline std::array<double, 2> enclosed_root(double at0, double error0,
                                                         double at1, double error1) {
  const double x = std::abs(at0);
  const double y = std::abs(at1);
  return enclosed_share(std::max(0.0, x - error0), x + error0, std::max(0.0, y - error1),
                        y + error1);
}

/// The zero of at0 (1 - s) + at1 s, off by at most kRangeError; nullopt: not certain.
[[nodiscard]] std::optional<double> rounded_root(const BallNumber& at0,
                                                 const BallNumber& at1);

/// The zero s at which h0 (1 - s)^2 + h1 s (1 - s) + h2 s^2 rises, or falls; likewise.
[[nodiscard]] std::optional<double> rounded_root(const Quadratic<BallNumber>& h,
                                                 bool rises);

/// The range between two rounded positions, in order whatever rounding made of them: they
/// may be nearer to each other than kRangeError, and at precision Double the signs that
/// ordered them may be wrong.
[[nodiscard]] inline std::array<double, 2> rounded_range(double from, double to) {
  return {std::min(from, to), std::max(from, to)};
}

}  // namespace sightline::internal
