#include "linespace/swaths/quadratic_root.h"

#include <cmath>

namespace sightline::internal {
namespace {

// a s^2 + b s + c is h0 (1 - s)^2 + h1 s (1 - s) + h2 s^2.
struct Monomials {
  Ring a, b, c;
};
Monomials monomials(const Quadratic<Ring>& h) {
  return {h.h0 - h.h1 + h.h2, h.h1 - 2 * h.h0, h.h0};
}

}  // namespace

Sign compare(const QuadraticRoot& x, const QuadraticRoot& y) {
  return sign_of_sum({x.a * y.c - y.a * x.c, x.b * y.c}, {-(y.b * x.c), 0}, x.d, y.d);
}

Ring number_between(const QuadraticRoot& x, const QuadraticRoot& y) {
  const auto enclosed = [](const QuadraticRoot& r, double sign) {
    const double at = r.rounded();
    return Ring(at + sign * (std::abs(at) * 0x1p-40 + 0x1p-900));
  };
  Ring lo = enclosed(x, -1), hi = enclosed(y, 1);
  const Ring half = 0.5;
  for (;;) {
    const Ring middle = half * (lo + hi);
    const QuadraticRoot at{middle, 0, 1, 0};
    if (compare(at, x) != Sign::Positive) {
      lo = middle;
    } else if (compare(at, y) != Sign::Negative) {
      hi = middle;
    } else {
      return middle;
    }
  }
}

QuadraticRoot linear_root(const Ring& at0, const Ring& at1) {
  const Ring c = at0 - at1;
  if (sign_of(c) == Sign::Negative) return {-at0, 0, -c, 0};
  return {at0, 0, c, 0};
}

QuadraticRoot root(const Quadratic<Ring>& h, bool rises) {
  const auto [a, b, c] = monomials(h);
  const Sign sign_a = sign_of(a);
  if (sign_a == Sign::Zero) {
    if (sign_of(b) == Sign::Negative) return {c, 0, -b, 0};
    return {-c, 0, b, 0};
  }
  const Ring d = b * b - 4 * a * c;
  // The derivative is +sqrt(d) at (-b + sqrt(d)) / 2a, where the polynomial rises.
  const Ring sign = rises ? 1 : -1;
  if (sign_a == Sign::Positive) return {-b, sign, 2 * a, d};
  return {b, -sign, -2 * a, d};
}

std::vector<QuadraticRoot> roots(const Quadratic<Ring>& h) {
  const auto [a, b, c] = monomials(h);
  const Sign sign_a = sign_of(a);
  if (sign_a == Sign::Zero) {
    if (is_zero(b)) return {};
    return {root(h, true)};
  }
  switch (sign_of(Ring(b * b - 4 * a * c))) {
    case Sign::Negative:
      return {};
    case Sign::Zero:
      return {root(h, true)};
    case Sign::Positive:
      break;
  }
  // A polynomial that opens upwards falls at its smaller root.
  const bool upwards = sign_a == Sign::Positive;
  return {root(h, !upwards), root(h, upwards)};
}

}  // namespace sightline::internal
