// Polynomials in one and in two variables with integer coefficients, as far as it takes
// to put a point into every cell of an arrangement of plane curves.

#pragma once

#include <boost/multiprecision/gmp.hpp>
#include <vector>

namespace sightline::internal {

using Integer = boost::multiprecision::number<boost::multiprecision::gmp_int,
                                              boost::multiprecision::et_off>;

/// Coefficients from the constant one up; the last one is not 0.  Empty: zero.
using Polynomial1 = std::vector<Integer>;
/// Coefficients of the powers of y from the constant one up, each a polynomial in x; the
/// last one is not zero.  Empty: zero.
using Polynomial2 = std::vector<Polynomial1>;

/// n / 2^k.
struct Dyadic {
  Integer n;
  int k = 0;
};

// ---- one variable

[[nodiscard]] Polynomial1 sum(const Polynomial1& f, const Polynomial1& g);
[[nodiscard]] Polynomial1 product(const Polynomial1& f, const Polynomial1& g);
/// Without the common factor of its coefficients; the leading one is positive.
[[nodiscard]] Polynomial1 primitive(Polynomial1 f);
/// Primitive.  One of the two must not be zero.
[[nodiscard]] Polynomial1 greatest_divisor(Polynomial1 f, Polynomial1 g);
/// The primitive polynomial with the same roots, each once.  Requires f not zero.
[[nodiscard]] Polynomial1 with_simple_roots(const Polynomial1& f);
[[nodiscard]] int sign_at(const Polynomial1& f, const Dyadic& x);

/// Points of the open interval from low to high, ascending, none of them a root: one lies
/// between any two neighbours among low, high and the polynomials' distinct roots, and
/// has few digits.  Polynomials that are zero are ignored.  By Descartes' rule of signs
/// and bisection (Collins and Akritas 1976).
[[nodiscard]] std::vector<Dyadic> separating_points(const std::vector<Polynomial1>& fs,
                                                    const Dyadic& low,
                                                    const Dyadic& high);

// ---- two variables

[[nodiscard]] Polynomial2 sum(const Polynomial2& f, const Polynomial2& g);
[[nodiscard]] Polynomial2 product(const Polynomial2& f, const Polynomial2& g);
[[nodiscard]] Polynomial2 negative(Polynomial2 f);
/// The polynomial in y where x is given, times a power of two.
[[nodiscard]] Polynomial1 at_x(const Polynomial2& f, const Dyadic& x);
/// With regard to y: a polynomial in x that vanishes where f and g have a common root,
/// and identically only if they have a common factor in which y occurs.
[[nodiscard]] Polynomial1 resultant(const Polynomial2& f, const Polynomial2& g);
[[nodiscard]] Polynomial2 derivative_by_y(const Polynomial2& f);

/// Polynomials with the same zeros as those given, no two with a common factor, none with
/// a repeated one: `in_x` the factors in which y does not occur.
struct CurveBasis {
  std::vector<Polynomial2> curves;
  std::vector<Polynomial1> in_x;

  /// f must not be zero.
  void add(const Polynomial2& f);
};

}  // namespace sightline::internal
