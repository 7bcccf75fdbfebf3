#include "linespace/portals/nearby.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "linespace/lines/transversals.h"

namespace sightline::internal {
namespace {

using Vector = Eigen::Vector3d;

/// Divides by the power of two that leaves the largest component in [1/2, 1).
Vector scaled(const Vector& v) {
  int exponent = 0;
  (void)std::frexp(v.cwiseAbs().maxCoeff(), &exponent);
  return v.unaryExpr([exponent](double x) { return std::ldexp(x, -exponent); });
}

double det(double a, double b, double c, double d) { return a * d - b * c; }

}  // namespace

// With e = 2^-53.  Components of d are off by kValueError = 16 e of themselves, those of
// the scaled u by e.  A is d x m / |d|^2: products of two numbers off by 16 e each, a
// difference, and a quotient whose divisor is off by 35 e at most: under 128 e |m| / |d|,
// with lengths.  So H - A is off by `off`, and divided by the largest of its components
// over all edges (a power of two above it), by `off` over that.  Components of d x u are
// off by 2 * 20 e, of (H - A) x u by 2 (off + 4 e); all of them are below 2.  Of a 3 x 3
// determinant of numbers below 2 that are off by at most E the six products are off by
// 12 E + 24 e each, 73 E in all as E is above 32 e, and it is below 48; then the product
// of four components is off by 4 (48 E + 2 * 73 E) + 1024 e, below 1024 E.
NearbyLines::NearbyLines(const ExactLine& line, const std::vector<Edge>& edges) {
  const auto& r = line.coordinates().rounded;
  const Vector d = scaled({r[0], r[1], r[2]});
  const Vector m(r[3], r[4], r[5]);
  const Vector direction(r[0], r[1], r[2]);
  const Vector at = direction.cross(m) / direction.squaredNorm();
  const double off_line = 128 * kUnit * m.norm() / direction.norm();
  int axis = 0;
  (void)d.cwiseAbs().maxCoeff(&axis);
  const int j = (axis + 1) % 3, k = (axis + 2) % 3;
  double reach = 0, off = 0;
  for (const Edge& e : edges) {
    const Vector from_line = e.edge.from - at;
    reach = std::max(reach, from_line.cwiseAbs().maxCoeff());
    off = std::max(off, off_line + 4 * kUnit * (e.edge.from.norm() + at.norm()));
  }
  int exponent = 0;
  (void)std::frexp(reach, &exponent);
  for (const Edge& e : edges) {
    const Vector u = scaled(e.edge.to - e.edge.from);
    const Vector h = (e.edge.from - at).unaryExpr([exponent](double x) {
      return std::ldexp(x, -exponent);
    });
    const Vector first = d.cross(u), second = h.cross(u);
    forms_.push_back({first[j], first[k], second[j], second[k]});
    allowed_.push_back(e.allowed);
  }
  error_ = 1024 * (std::ldexp(2 * off, -exponent) + 64 * kUnit);
}

NearbyLines::Way NearbyLines::way(int i, int j, int k) const {
  const auto &a = forms_[i], &b = forms_[j], &c = forms_[k];
  const auto minor = [&](int x, int y, int z) {
    return a[x] * det(b[y], b[z], c[y], c[z]) - a[y] * det(b[x], b[z], c[x], c[z]) +
           a[z] * det(b[x], b[y], c[x], c[y]);
  };
  return {minor(1, 2, 3), -minor(0, 2, 3), minor(0, 1, 3), -minor(0, 1, 2)};
}

double NearbyLines::value(const Way& way, int edge) const {
  const auto& c = forms_[edge];
  return way[0] * c[0] + way[1] * c[1] + way[2] * c[2] + way[3] * c[3];
}

bool NearbyLines::may_touch(const Way& way, int edge) const {
  return !(std::abs(value(way, edge)) > error_);
}

bool NearbyLines::may_pass(const Way& way) const {
  bool with = true, against = true;  // what n c_h says of each way
  for (std::size_t h = 0; h < forms_.size(); ++h) {
    if (allowed_[h] == AllowedSide::Any || may_touch(way, static_cast<int>(h))) continue;
    if (allowed_[h] == AllowedSide::None) return false;
    const bool positive = value(way, static_cast<int>(h)) > 0;
    (positive == (allowed_[h] == AllowedSide::Positive) ? against : with) = false;
    if (!with && !against) return false;
  }
  return true;
}

}  // namespace sightline::internal
