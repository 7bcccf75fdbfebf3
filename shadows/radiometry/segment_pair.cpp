#include "shadows/radiometry/segment_pair.h"

#include <Eigen/Geometry>
#include <cmath>
#include <complex>
#include <limits>

#include "shadows/radiometry/dilogarithm.h"

namespace sightline::internal {
namespace {

using Vector = Eigen::Vector3d;
using Complex = std::complex<double>;

/// Adds terms up and remembers how large they were.
struct Sum {
  double value = 0, size = 0;
  void add(double term) {
    value += term;
    size += std::abs(term);
  }
};

double log_or_zero(double x) { return x > 0 ? std::log(x) : 0; }

/// Of parallel lines at distance h, the second antiderivative of ln(h^2 + x^2) / 2.
void add_parallel(double x, double h, double sign, Sum& sum) {
  const double l = log_or_zero(h * h + x * x);
  sum.add(sign * 0.25 * (x * x - h * h) * l);
  sum.add(-sign * 0.75 * x * x);
  if (h > 0) sum.add(sign * h * x * std::atan(x / h));
}

/// The antiderivative of ln(e^2 + x^2), times a factor.
void add_log(double x, double e, double factor, Sum& sum) {
  sum.add(factor * x * (log_or_zero(e * e + x * x) - 2));
  if (e > 0) sum.add(factor * 2 * e * std::atan(x / e));
}

/// Two lines whose common perpendicular has length h and that make an angle with cosine c
/// and sine s > 0, positions counted from its feet:
///   r^2 = h^2 + x^2 + y^2 - 2 c x y.
struct SkewLines {
  double h, c, s;

  /// Adds the integral of ln r over [0, x] x [0, y].  With g = ln r^2, the divergence of
  /// (x, y) g is 2 g + 2 - 2 h^2 / r^2, so that
  ///   integral of g = (x P + y Q) / 2 - x y + h^2 J,
  /// P and Q the integrals of g along the sides at x and y, J that of 1 / r^2.
  void add(double x, double y, double sign, Sum& sum) const {
    if (x == 0 || y == 0) return;
    const double beside_x = std::hypot(h, s * x), beside_y = std::hypot(h, s * y);
    add_log(y - c * x, beside_x, 0.25 * sign * x, sum);
    add_log(-c * x, beside_x, -0.25 * sign * x, sum);
    add_log(x - c * y, beside_y, 0.25 * sign * y, sum);
    add_log(-c * y, beside_y, -0.25 * sign * y, sum);
    sum.add(-0.5 * sign * x * y);
    // J is at most pi w / s, so that less than this is nothing beside rounding.
    if (h * h > 1e-20 * s * (std::abs(x) + std::abs(y))) {
      const double w = std::asinh(s * x / h);
      const double factor = 0.5 * sign * h * h / s;
      add_angle(y, w, factor, sum);
      add_angle(0, w, -factor, sum);
    }
  }

 private:
  /// The integral from 0 to w, with x = h / s sinh w, of the argument of
  ///   h cosh w + i (y - c x),
  /// a quadratic polynomial in z = e^w over z, with constant term's argument that of
  /// s + i c and roots in the upper and the lower half-plane.
  void add_angle(double y, double w, double factor, Sum& sum) const {
    const double t = y / h, root = std::hypot(t, 1 / s);
    const double plus = t > 0 ? 1 / (s * s * (root + t)) : root - t;
    const double minus = t > 0 ? root + t : 1 / (s * s * (root - t));
    const Complex first = plus * s * Complex(-c, s), second = minus * s * Complex(c, -s);
    sum.add(factor * w * std::atan2(c, s));
    const double z = std::exp(w);
    for (const Complex& r : {first, second}) {
      sum.add(-factor * dilogarithm(z / r).imag());
      sum.add(factor * dilogarithm(1. / r).imag());
    }
  }
};

}  // namespace

LogIntegral log_integral(const Point& a0, const Point& a1, const Point& b0,
                         const Point& b1) {
  const double length_a = (a1 - a0).norm(), length_b = (b1 - b0).norm();
  if (length_a == 0 || length_b == 0) return {0, 0};
  const Vector u = (a1 - a0) / length_a, v = (b1 - b0) / length_b, w = b0 - a0;
  const Vector across = u.cross(v);
  const double c = u.dot(v), s = across.norm();
  Sum sum;
  // Unit vectors of one line differ by their rounding.
  constexpr double kParallel = 1e-15;
  if (s <= kParallel) {
    const double at = u.dot(w), h = (w - at * u).norm();
    const double b_end = at + (c > 0 ? length_b : -length_b);
    const double low = std::min(at, b_end), high = std::max(at, b_end);
    // Over x in [0, length_a] and y in [low, high], of a function of x - y.
    add_parallel(length_a - low, h, 1, sum);
    add_parallel(length_a - high, h, -1, sum);
    add_parallel(-low, h, -1, sum);
    add_parallel(-high, h, 1, sum);
    return {sum.value, sum.size};
  }
  // Where the feet are far off, nothing is left of the digits.
  constexpr double kLeastSine = 1e-4;
  if (s < kLeastSine) return {0, std::numeric_limits<double>::infinity()};
  const double wu = w.dot(u), wv = w.dot(v);
  const double foot_a = (wu - c * wv) / (s * s), foot_b = (c * wu - wv) / (s * s);
  const SkewLines lines{std::abs(w.dot(across)) / s, c, s};
  lines.add(length_a - foot_a, length_b - foot_b, 1, sum);
  lines.add(length_a - foot_a, -foot_b, -1, sum);
  lines.add(-foot_a, length_b - foot_b, -1, sum);
  lines.add(-foot_a, -foot_b, 1, sum);
  return {sum.value, sum.size};
}

}  // namespace sightline::internal
