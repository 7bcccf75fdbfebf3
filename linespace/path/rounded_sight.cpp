#include "linespace/path/rounded_sight.h"

#include <Eigen/Geometry>
#include <cmath>

namespace sightline::internal {

using Vector = Eigen::Vector3d;

// Below this share of its size a value is too small to be divided by.
constexpr double kFlat = 0x1p-20;

std::optional<SeenInLine> seen_in_line(const RoundedEye& eye, const PathLine& line,
                                       const Point& x, double size) {
  const Vector d = eye.sight(x);
  const double length = d.norm();
  if (!eye.is_direction && length < kFlat * size) return std::nullopt;
  const Vector way = line.b.rounded - line.a.rounded;
  const Vector a = Vector(line.a.rounded - x).cross(d), c = way.cross(d);
  if (c.norm() <= kFlat * way.norm() * length) return std::nullopt;
  SeenInLine seen{};
  seen.ratio = -a.dot(c) / c.squaredNorm();
  seen.at = at_ratio(line, seen.ratio);
  seen.depth = (seen.at - x).dot(d) / length;
  return seen;
}

std::optional<double> seen_crossing(const RoundedEye& eye, const PathLine& line,
                                    const PathLine& other, double size) {
  const Vector way = other.b.rounded - other.a.rounded;
  const Vector d = eye.sight(other.a.rounded);
  const Vector n = way.cross(d);
  if (!eye.is_direction && d.norm() < kFlat * size) return std::nullopt;
  if (n.norm() <= kFlat * way.norm() * d.norm()) return std::nullopt;
  const double at0 = n.dot(line.a.rounded - other.a.rounded);
  const double at1 = n.dot(line.b.rounded - other.a.rounded);
  const double length = (line.b.rounded - line.a.rounded).norm();
  if (std::abs(at1 - at0) <= kFlat * n.norm() * length) return std::nullopt;
  return at0 / (at0 - at1);
}

}  // namespace sightline::internal
