// Exact arithmetic in Q(sqrt D), for lines that meet four lines.
//
// Ring holds every value that doubles give by sums and products.  A Surd a + b sqrt(D)
// does not carry its D: all surds of one line share one, and mixing two lines is explicit
// (sign_of_sum).

#pragma once

#include <CGAL/Mpzf.h>

#include <array>
#include <optional>

#include "linespace/numbers/rational.h"
#include "linespace/numbers/vectors.h"
#include "linespace/predicates.h"

namespace sightline::internal {

using Ring = CGAL::Mpzf;
using RingVector = std::array<Ring, 3>;

[[nodiscard]] inline Sign sign_of(const Ring& x) {
  return static_cast<Sign>(static_cast<int>(CGAL::sign(x)));
}
[[nodiscard]] Rational rational(const Ring& x);
[[nodiscard]] inline bool is_zero(const Ring& x) { return sign_of(x) == Sign::Zero; }

/// a + b sqrt(D), D >= 0.
struct Surd {
  Ring a = 0;
  Ring b = 0;
};
using SurdVector = std::array<Surd, 3>;

[[nodiscard]] inline Surd operator+(const Surd& x, const Surd& y) {
  return {x.a + y.a, x.b + y.b};
}
[[nodiscard]] inline Surd operator-(const Surd& x, const Surd& y) {
  return {x.a - y.a, x.b - y.b};
}
[[nodiscard]] inline Surd operator-(const Surd& x) { return {-x.a, -x.b}; }
[[nodiscard]] inline Surd operator*(const Surd& x, const Ring& y) {
  return {x.a * y, x.b * y};
}
[[nodiscard]] inline Surd operator*(const Ring& x, const Surd& y) { return y * x; }
[[nodiscard]] inline Surd product(const Surd& x, const Surd& y, const Ring& d) {
  if (is_zero(x.b) && is_zero(y.b)) return {x.a * y.a, 0};
  return {x.a * y.a + x.b * y.b * d, x.a * y.b + x.b * y.a};
}

[[nodiscard]] inline SurdVector cross(const SurdVector& u, const SurdVector& v,
                                      const Ring& d) {
  return {product(u[1], v[2], d) - product(u[2], v[1], d),
          product(u[2], v[0], d) - product(u[0], v[2], d),
          product(u[0], v[1], d) - product(u[1], v[0], d)};
}

[[nodiscard]] Sign sign_of(const Surd& x, const Ring& d);
[[nodiscard]] inline bool is_zero(const Surd& x, const Ring& d) {
  return sign_of(x, d) == Sign::Zero;
}

/// The sign of x + y sqrt(E) for x and y in Q(sqrt D).
[[nodiscard]] Sign sign_of_sum(const Surd& x, const Surd& y, const Ring& d,
                               const Ring& e);

/// The square root of d when it is rational.
[[nodiscard]] std::optional<Ring> rational_root(const Ring& d);

/// x / y, off by at most kQuotientError of itself; also by 2^-1000 where it is that
/// small, and infinite where it is beyond all doubles.  Requires y != 0.
inline constexpr double kQuotientError = 0x1p-48;
[[nodiscard]] double quotient(const Surd& x, const Surd& y, const Ring& d);

inline constexpr double kValueError = 0x1p-49;
/// x times 2^k as a double, off by at most kValueError of itself, for a k common to all
/// of `values`, the largest magnitude being in [1/2, 1); values below 2^-1000 become 0.
template <std::size_t N>
[[nodiscard]] std::array<double, N> scaled(const std::array<Surd, N>& values,
                                           const Ring& d);

}  // namespace sightline::internal
