#include "linespace/lines/rounded_root.h"

#include <cmath>

#include "linespace/generator.h"

namespace sightline::internal {
namespace {

// What is off by `error` at most.
struct Approximate {
  double value, error;
};

Approximate rounded(const BallNumber& x) { return {x.hi, x.radius + 2 * std::abs(x.lo)}; }

// x / y is off by (error of x + |x / y| error of y) / least |y|, and by its own rounding.
// The errors' roundings are covered by the factor 2.
std::optional<double> quotient(const Approximate& x, const Approximate& y) {
  const double least = std::abs(y.value) - y.error;
  const double s = x.value / y.value;
  const double error =
      2 * ((x.error + std::abs(s) * y.error) / least + kUnit * std::abs(s));
  // Not so where something is not a number.
  if (least > 0 && error <= kRangeError) return s;
  return std::nullopt;
}

}  // namespace

std::optional<double> rounded_root(const BallNumber& at0, const BallNumber& at1) {
  return quotient(rounded(at0), rounded(at0 - at1));
}

// h is h0 + b s + a s^2, of slope r = +-sqrt(b^2 - 4 a h0) at its zeros (r - b) / 2a =
// -2 h0 / (r + b); the one is taken in which nothing cancels.
std::optional<double> rounded_root(const Quadratic<BallNumber>& h, bool rises) {
  const BallNumber a = h.h0 - h.h1 + h.h2;
  const BallNumber b = h.h1 - h.h0 - h.h0;
  const BallNumber ah = a * h.h0;
  const BallNumber twice = ah + ah;
  const BallNumber discriminant = b * b - twice - twice;
  if (!(discriminant.hi > 4 * discriminant.radius)) return std::nullopt;
  const double root = std::sqrt(discriminant.hi);
  const double r = rises ? root : -root;
  // |sqrt(D) - sqrt(D0)| <= |D - D0| / sqrt(D0), and two roundings.
  const double r_error = rounded(discriminant).error / root + 2 * kUnit * root;
  const Approximate slope = rounded(b);
  const auto plus = [&](double x, double y) {
    return Approximate{x + y, r_error + slope.error + kUnit * std::abs(x + y)};
  };
  if ((r > 0) != (slope.value > 0))
    return quotient(plus(r, -slope.value), rounded(a + a));
  return quotient(rounded(-(h.h0 + h.h0)), plus(r, slope.value));
}

}  // namespace sightline::internal
