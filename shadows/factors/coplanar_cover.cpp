#include "shadows/factors/coplanar_cover.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "linespace/predicates.h"
#include "shadows/factors/exchange_geometry.h"
#include "shadows/factors/plane_regions.h"

namespace sightline::internal {
namespace {

/// A direction in 1/4096, so that planes that face alike differ by one at most.
std::array<long long, 2> cells_of(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d n = normal.normalized();
  const double x = 4096 * (n.x() + 2.5 * n.y() + 7.3 * n.z());
  return {static_cast<long long>(std::floor(x)),
          static_cast<long long>(std::floor(x + 0.5))};
}

Eigen::Vector3d normal_of(const PointList& polygon) {
  const auto c = spanning_corners(polygon);
  return (c[1] - c[0]).cross(c[2] - c[0]);
}

/// Drops the coordinate along which the plane faces most: exact, and back again along
/// the plane.
class Projection {
 public:
  explicit Projection(const PointList& polygon)
      : at_(polygon[0]), normal_(normal_of(polygon)) {
    normal_.cwiseAbs().maxCoeff(&dropped_);
    u_ = (dropped_ + 1) % 3;
    v_ = (dropped_ + 2) % 3;
    if (normal_[dropped_] < 0) std::swap(u_, v_);
  }
  [[nodiscard]] FlatPoint down(const Point& p) const { return {p[u_], p[v_]}; }
  [[nodiscard]] Point up(const FlatPoint& p) const {
    Point q;
    q[u_] = p.x;
    q[v_] = p.y;
    q[dropped_] = at_[dropped_];
    const double rise = normal_[u_] * (p.x - at_[u_]) + normal_[v_] * (p.y - at_[v_]);
    q[dropped_] -= rise / normal_[dropped_];
    return q;
  }

 private:
  Point at_;
  Eigen::Vector3d normal_;
  int dropped_ = 0, u_ = 0, v_ = 0;
};

HalfPlane left_of(const FlatPoint& a, const FlatPoint& b) {
  const double ux = b.x - a.x, uy = b.y - a.y;
  return {-uy, ux, uy * a.x - ux * a.y};
}

}  // namespace

CoplanarCover::CoplanarCover(std::vector<PointList> polygons) {
  for (PointList& p : polygons) add(std::move(p));
}

void CoplanarCover::add(PointList polygon) {
  Box box{polygon[0], polygon[0]};
  for (const Point& p : polygon) {
    box.low = box.low.cwiseMin(p);
    box.high = box.high.cwiseMax(p);
  }
  for (const long long cell : cells_of(normal_of(polygon))) {
    by_plane_.emplace(cell, polygons_.size());
  }
  boxes_.push_back(box);
  polygons_.push_back(std::move(polygon));
}

std::vector<const PointList*> CoplanarCover::in_plane(const PointList& polygon) const {
  std::vector<std::size_t> found;
  const Eigen::Vector3d normal = normal_of(polygon);
  const auto c = spanning_corners(polygon);
  Point low = polygon[0], high = polygon[0];
  for (const Point& p : polygon) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  for (const long long cell : cells_of(normal)) {
    const auto [first, last] = by_plane_.equal_range(cell);
    for (auto it = first; it != last; ++it) {
      const Box& box = boxes_[it->second];
      if ((box.low.array() > high.array()).any() ||
          (low.array() > box.high.array()).any())
        continue;
      const PointList& other = polygons_[it->second];
      if (normal.dot(normal_of(other)) <= 0) continue;
      const bool flat = std::ranges::all_of(other, [&](const Point& p) {
        return orient3d(c[0], c[1], c[2], p) == Sign::Zero;
      });
      if (flat) found.push_back(it->second);
    }
  }
  std::ranges::sort(found);
  found.erase(std::ranges::unique(found).begin(), found.end());
  std::vector<const PointList*> result;
  for (const std::size_t i : found) result.push_back(&polygons_[i]);
  return result;
}

bool CoplanarCover::touches(const PointList& polygon) const {
  return !in_plane(polygon).empty();
}

std::vector<PointList> CoplanarCover::uncovered(const PointList& polygon) const {
  const std::vector<const PointList*> others = in_plane(polygon);
  if (others.empty()) return {polygon};
  const Projection projection(polygon);
  PlanePolygon flat;
  for (const Point& p : polygon) flat.push_back(projection.down(p));
  PlaneRegions open;
  open.assign(flat);
  const double whole = doubled_area(flat);
  std::vector<HalfPlane> sides;
  for (const PointList* other : others) {
    sides.clear();
    for (std::size_t i = 0; i < other->size(); ++i) {
      sides.push_back(left_of(projection.down((*other)[i]),
                              projection.down((*other)[(i + 1) % other->size()])));
    }
    open.remove(sides);
  }
  // Less than what rounding leaves along a cut, some dozens of 2^-53 of the whole.
  constexpr double kSliver = 1e-14;
  std::vector<PointList> result;
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (doubled_area(open[i]) < kSliver * whole) continue;
    PointList part;
    for (const FlatPoint& p : open[i]) part.push_back(projection.up(p));
    result.push_back(std::move(part));
  }
  return result;
}

}  // namespace sightline::internal
