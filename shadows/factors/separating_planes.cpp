#include "shadows/factors/separating_planes.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace sightline::internal {

SeparatingPlanes::SeparatingPlanes(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                   std::span<const Eigen::Vector3d> polygon) {
  half_spaces_.reserve(3 * polygon.size());
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d& a = polygon[i];
    const Eigen::Vector3d& b = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    add((b - a).cross(from - a), polygon, from, to);
    add((b - a).cross(to - a), polygon, from, to);
    add((to - from).cross(a - from), polygon, from, to);
  }
}

// Any normal does: the limit is the largest value.  One that has points far on both sides
// is no side of the hull, and not worth keeping.
void SeparatingPlanes::add(const Eigen::Vector3d& normal,
                           std::span<const Eigen::Vector3d> polygon,
                           const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const double f = normal.dot(from), t = normal.dot(to);
  double low = std::min(f, t), high = std::max(f, t);
  for (const Eigen::Vector3d& p : polygon) {
    const double h = normal.dot(p);
    low = std::min(low, h);
    high = std::max(high, h);
  }
  // Far above rounding: a plane that is kept though it passes a little beside an end only
  // moves outwards to the largest value.
  constexpr double kOneSided = 1e-9;
  const double width = high - low;
  if (!(width > 0)) return;
  const auto near = [&](double value, double limit) {
    return std::abs(value - limit) <= kOneSided * width;
  };
  // The plane passes through one of the ends.
  if (near(f, high) || near(t, high)) half_spaces_.push_back({normal, high});
  if (near(f, low) || near(t, low)) half_spaces_.push_back({-normal, -low});
}

bool SeparatingPlanes::beside(std::span<const Eigen::Vector3d> corners) const {
  return std::ranges::any_of(half_spaces_, [&](const HalfSpace& half) {
    return std::ranges::all_of(corners, [&](const Eigen::Vector3d& p) {
      return half.normal.dot(p) >= half.limit;
    });
  });
}

}  // namespace sightline::internal
