// Numbers that say where on a curve a point lies: an element of Q(sqrt D) or a root of a
// polynomial, exactly, and enclosed in doubles.

#pragma once

#include <span>
#include <variant>
#include <vector>

#include "linespace/numbers/exact_numbers.h"
#include "linespace/numbers/polynomials.h"
#include "linespace/numbers/rational.h"
#include "linespace/swaths/quadratic_root.h"

namespace sightline::internal {

/// The only root of f in the open interval from lo to hi; f has different signs there.
struct PolynomialRoot {
  Polynomial1 f;
  Dyadic lo, hi;
};

using ExactParameter = std::variant<QuadraticRoot, PolynomialRoot>;

/// The sign of x - y.
[[nodiscard]] Sign compare(const ExactParameter& x, const ExactParameter& y);
/// The sign of h at x.
[[nodiscard]] Sign sign_at(const Polynomial1& h, const ExactParameter& x);
/// The value of h in Q(sqrt D), times a positive number.
[[nodiscard]] Surd value_at(std::span<const Ring> h, const QuadraticRoot& x);
/// (n.a + n.b sqrt(d)) / (m.a + m.b sqrt(d)).  Requires that it exists.
[[nodiscard]] QuadraticRoot exact_ratio(const Surd& n, const Surd& m, const Ring& d);
/// Halves the interval; or finds the root, which is then the middle.
[[nodiscard]] ExactParameter halved(const PolynomialRoot& x);
/// All roots of f strictly between lo and hi, ascending.  Requires f not zero.
[[nodiscard]] std::vector<PolynomialRoot> roots_between(const Polynomial1& f,
                                                        const Dyadic& lo,
                                                        const Dyadic& hi);
/// A dyadic number strictly between x and y.  Requires x < y.
[[nodiscard]] Dyadic between(const ExactParameter& x, const ExactParameter& y);

// ---- conversions

[[nodiscard]] Dyadic dyadic(double x);
[[nodiscard]] Rational rational(const Dyadic& x);
[[nodiscard]] QuadraticRoot quadratic_root(const Dyadic& x);
[[nodiscard]] QuadraticRoot quadratic_root(const Rational& x);
[[nodiscard]] Ring ring(const Integer& x);
/// The coefficients times a common factor > 0 that makes them integers; without zeros at
/// the end.
[[nodiscard]] Polynomial1 integer_polynomial(std::span<const Ring> coefficients);

// ---- doubles

/// A closed interval.
struct DoubleRange {
  double lo = 0, hi = 0;

  [[nodiscard]] double middle() const { return 0.5 * (lo + hi); }
  [[nodiscard]] double radius() const { return 0.5 * (hi - lo); }
};
[[nodiscard]] inline bool apart(const DoubleRange& x, const DoubleRange& y) {
  return x.hi < y.lo || y.hi < x.lo;
}
[[nodiscard]] DoubleRange range(const BallNumber& x);
[[nodiscard]] BallNumber ball(const DoubleRange& x);
/// nullopt where the divisor may be 0.
[[nodiscard]] std::optional<DoubleRange> range_of_quotient(const BallNumber& x,
                                                           const BallNumber& y);
/// Off by some 2^-96 of itself.
[[nodiscard]] BallNumber ball(const QuadraticRoot& x);
/// At most some units in the last place wide.
[[nodiscard]] DoubleRange range(const ExactParameter& x);
/// Off by some 2^-90 of itself, or 2^-40 of the width of its interval.
[[nodiscard]] BallNumber precise_ball(const ExactParameter& x);
/// Integers times a common power of two, the largest below 1.
[[nodiscard]] std::vector<BallNumber> balls(std::span<const Integer> values);

}  // namespace sightline::internal
