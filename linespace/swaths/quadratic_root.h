// Roots of polynomials of degree one and two with exact coefficients: positions on a
// swath.

#pragma once

#include <array>
#include <vector>

#include "linespace/lines/transversals.h"
#include "linespace/numbers/surd.h"

namespace sightline::internal {

/// (a + b sqrt(d)) / c, c > 0, d >= 0.
struct QuadraticRoot {
  Ring a, b, c, d;

  /// Off by at most kQuotientError of itself.
  [[nodiscard]] double rounded() const { return quotient(Surd{a, b}, Surd{c, 0}, d); }
};

/// The sign of x - y.
[[nodiscard]] Sign compare(const QuadraticRoot& x, const QuadraticRoot& y);

/// A number strictly between x and y, of few bits.  Requires x < y.
[[nodiscard]] Ring number_between(const QuadraticRoot& x, const QuadraticRoot& y);

/// The zero of at0 (1 - s) + at1 s.  Requires at0 != at1.
[[nodiscard]] QuadraticRoot linear_root(const Ring& at0, const Ring& at1);

/// The zero s of h0 (1 - s)^2 + h1 s (1 - s) + h2 s^2 at which it rises, or falls.
/// Requires that there is one, or a double one.
[[nodiscard]] QuadraticRoot root(const Quadratic<Ring>& h, bool rises);

/// All zeros, ascending; none where it is a constant.
[[nodiscard]] std::vector<QuadraticRoot> roots(const Quadratic<Ring>& h);

}  // namespace sightline::internal
