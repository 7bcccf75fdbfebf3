// Positions on an edge as doubles, where the first enclosure is too wide: from
// double-double coefficients, a tenth of the cost of exact ones.

#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "linespace/lines/transversals.h"
#include "linespace/numbers/exact_numbers.h"

namespace sightline::internal {

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
