#include "shadows/planar/arcs/arc_filter.h"

#include <algorithm>
#include <cmath>

#include "shadows/planar/arcs/arc_box.h"

namespace sightline::internal {
namespace {

double error_of(const BallNumber& x) {
  return (std::abs(x.lo) + x.radius) * (1 + 4 * kUnit);
}

// Rounds balls to doubles, and says how far off they are at most and how large.
void round(const std::array<std::array<BallNumber, 3>, 3>& in, int rows,
           std::array<std::array<double, 3>, 3>& out, double& error, double& size) {
  error = size = 0;
  for (int i = 0; i < rows; ++i) {
    double sum = 0;
    for (int j = 0; j < 3; ++j) {
      out[i][j] = in[i][j].hi;
      error = std::max(error, error_of(in[i][j]));
      sum += std::abs(in[i][j].hi);
    }
    size = std::max(size, sum * (1 + 4 * kUnit));
  }
}

bool one_sign(std::span<const double> values, double error) {
  const auto above = [&](double x) { return x > error; };
  const auto below = [&](double x) { return x < -error; };
  return std::ranges::all_of(values, above) || std::ranges::all_of(values, below);
}

}  // namespace

ArcDoubles arc_doubles(const PlaneSupport& support, const BallNumber& from,
                       const BallNumber& to) {
  ArcDoubles out{};
  out.straight = support.straight;
  out.degree = support.degree();
  round(control_points(support, from, to), out.degree + 1, out.points, out.point_error,
        out.point_size);
  const std::array<std::array<BallNumber, 3>, 3> line{support.balls.line};
  round(support.straight ? line : support.balls.inverse, support.straight ? 1 : 3,
        out.forms, out.form_error, out.form_size);
  return out;
}

// With u = 2^-53, a form r at a point p is off by at most
//   E = |p| e_r + |r| e_p + 3 e_r e_p + 4 u |r| |p|,   |.| sums of magnitudes.
// A Bernstein coefficient of a product is a mean of products of values of size at most Z:
// off by at most 2 Z E + E^2 + 6 u Z^2; F is the difference of two.  What underflows is
// less than kUnderflow.
bool certainly_beside(const ArcDoubles& a, const ArcDoubles& b) {
  const double e =
      (a.point_size * b.form_error + b.form_size * a.point_error +
       3 * b.form_error * a.point_error + 4 * kUnit * b.form_size * a.point_size) *
      (1 + 16 * kUnit);
  constexpr double kUnderflow = 0x1p-1000;
  double z[3][3];
  double largest = 0;
  const int rows = b.straight ? 1 : 3;
  for (int i = 0; i < rows; ++i) {
    for (int k = 0; k <= a.degree; ++k) {
      const std::array<double, 3>& p = a.points[k];
      z[i][k] = b.forms[i][0] * p[0] + b.forms[i][1] * p[1] + b.forms[i][2] * p[2];
      largest = std::max(largest, std::abs(z[i][k]));
    }
  }
  if (b.straight) return one_sign(std::span(z[0], a.degree + 1), e + kUnderflow);
  const double error =
      (2 * (2 * largest * e + e * e) + 16 * kUnit * largest * largest) * (1 + 16 * kUnit);
  const auto& [u, v, w] = z;
  if (a.degree == 1) {
    const double f[3] = {u[0] * w[0] - v[0] * v[0],
                         0.5 * (u[0] * w[1] + u[1] * w[0]) - v[0] * v[1],
                         u[1] * w[1] - v[1] * v[1]};
    return one_sign(f, error + kUnderflow);
  }
  const double f[5] = {
      u[0] * w[0] - v[0] * v[0], 0.5 * (u[0] * w[1] + u[1] * w[0]) - v[0] * v[1],
      (u[0] * w[2] + 4 * u[1] * w[1] + u[2] * w[0] - 2 * v[0] * v[2] - 4 * v[1] * v[1]) /
          6,
      0.5 * (u[1] * w[2] + u[2] * w[1]) - v[1] * v[2], u[2] * w[2] - v[2] * v[2]};
  return one_sign(f, error + kUnderflow);
}

}  // namespace sightline::internal
