// Rational numbers and exact points, for what is constructed and then asked again.

#pragma once

#include <Eigen/Core>
#include <array>
#include <boost/multiprecision/gmp.hpp>

#include "linespace/numbers/vectors.h"

namespace sightline::internal {

/// Not CGAL::Exact_rational, which is another type where gmpxx is installed.
using Rational = boost::multiprecision::number<boost::multiprecision::gmp_rational,
                                               boost::multiprecision::et_off>;
using ExactPoint = std::array<Rational, 3>;

[[nodiscard]] inline ExactPoint exact_point(const Eigen::Vector3d& p) {
  return {Rational(p.x()), Rational(p.y()), Rational(p.z())};
}

/// The nearest double.  Where numerator and denominator are doubles their quotient is it.
[[nodiscard]] inline double nearest_double(const Rational& x) {
  const mpz_srcptr num = mpq_numref(x.backend().data());
  const mpz_srcptr den = mpq_denref(x.backend().data());
  constexpr std::size_t kBits = 53;
  if (mpz_sizeinbase(num, 2) <= kBits && mpz_sizeinbase(den, 2) <= kBits) {
    return mpz_get_d(num) / mpz_get_d(den);
  }
  return x.convert_to<double>();
}

[[nodiscard]] inline ExactPoint exact_difference(const ExactPoint& to,
                                                 const ExactPoint& from) {
  return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
}
[[nodiscard]] inline Rational exact_dot(const ExactPoint& u, const ExactPoint& v) {
  return dot(u, v);
}
[[nodiscard]] inline ExactPoint exact_cross(const ExactPoint& u, const ExactPoint& v) {
  return cross(u, v);
}
/// det(b - a, c - a, d - a), whose sign orient3d gives.
[[nodiscard]] inline Rational exact_orient(const ExactPoint& a, const ExactPoint& b,
                                           const ExactPoint& c, const ExactPoint& d) {
  return exact_dot(exact_difference(d, a),
                   exact_cross(exact_difference(b, a), exact_difference(c, a)));
}

[[nodiscard]] inline Eigen::Vector3d rounded(const ExactPoint& p) {
  return {nearest_double(p[0]), nearest_double(p[1]), nearest_double(p[2])};
}

/// x / y.  The signs that a caller knows say that y is not 0; at precision Double they
/// may be wrong, and then it is a half: any number keeps a wrong answer an answer.
[[nodiscard]] inline Rational quotient(const Rational& x, const Rational& y) {
  return y == 0 ? Rational(1, 2) : Rational(x / y);
}

/// a + s (b - a).
[[nodiscard]] inline ExactPoint along(const ExactPoint& a, const ExactPoint& b,
                                      const Rational& s) {
  return {a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2])};
}

}  // namespace sightline::internal
