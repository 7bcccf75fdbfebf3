#include "shadows/point_form_factor.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace sightline {
namespace {

/// The part above the horizon of what is a closed walk of vectors from p.
std::vector<Eigen::Vector3d> above(const Eigen::Vector3d& normal,
                                   std::span<const Eigen::Vector3d> walk) {
  std::vector<Eigen::Vector3d> part;
  const auto is_above = [&](const Eigen::Vector3d& v) { return normal.dot(v) > 0; };
  if (std::none_of(walk.begin(), walk.end(), is_above)) return part;
  for (std::size_t i = 0; i < walk.size(); ++i) {
    const Eigen::Vector3d& a = walk[i];
    const Eigen::Vector3d& b = walk[(i + 1) % walk.size()];
    const double height_a = normal.dot(a), height_b = normal.dot(b);
    if (height_a >= 0) part.push_back(a);
    if ((height_a > 0 && height_b < 0) || (height_a < 0 && height_b > 0)) {
      part.push_back((a * std::abs(height_b) + b * std::abs(height_a)) /
                     (std::abs(height_a) + std::abs(height_b)));
    }
  }
  return part;
}

}  // namespace

double point_form_factor(const Point& p, const Eigen::Vector3d& normal,
                         std::span<const Point> polygon) {
  std::vector<Eigen::Vector3d> rays;
  rays.reserve(polygon.size());
  for (const Point& corner : polygon) rays.push_back(corner - p);

  const Eigen::Vector3d unit = normal.normalized();
  const std::vector<Eigen::Vector3d> walk = above(unit, rays);
  double sum = 0;
  for (std::size_t i = 0; i < walk.size(); ++i) {
    const Eigen::Vector3d& a = walk[i];
    const Eigen::Vector3d& b = walk[(i + 1) % walk.size()];
    const Eigen::Vector3d across = a.cross(b);
    const double length = across.norm();
    if (length > 0) sum += std::atan2(length, a.dot(b)) / length * unit.dot(across);
  }
  return -sum / (2 * std::numbers::pi);
}

}  // namespace sightline
