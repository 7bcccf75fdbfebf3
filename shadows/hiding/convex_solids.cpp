#include "shadows/hiding/convex_solids.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "shadows/factors/exchange_geometry.h"
#include "shadows/factors/factor_sides.h"

namespace sightline::internal {
namespace {

// Solids are shrunk by this share of the scene's coordinates, so that one that is said to
// be met is met.  A plane's value, and its value where a segment was found to cross it,
// are each off by less than 16 roundings, 2^-49 of the coordinates: 2^9 times less.
constexpr double kMargin = 0x1p-40;

}  // namespace

ConvexSolids::ConvexSolids(const Scene& scene) : tree_({}) {
  first_.push_back(0);
  for (const Object& object : scene.objects()) {
    const bool solid = object.convex && !object.inside_out;
    of_object_.push_back(solid ? static_cast<int>(boxes_.size()) : -1);
    if (!solid) continue;
    std::vector<Point> points;
    for (const int f : object.faces) {
      const PointList p = listed_polygon(scene, f, false);
      points.insert(points.end(), p.begin(), p.end());
      const auto c = spanning_corners(p);
      const Eigen::Vector3d n = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
      planes_.emplace_back(n.x(), n.y(), n.z(), -n.dot(c[0]));
    }
    boxes_.push_back(box_of(points));
    first_.push_back(planes_.size());
  }
  tree_ = Bvh(boxes_, 1);
  const auto& [low, high] = scene.bounds();
  margin_ = kMargin * (low.cwiseAbs().cwiseMax(high.cwiseAbs())).maxCoeff();
}

bool ConvexSolids::meets(int solid, const Point& x, const Point& y) const {
  double from = 0, to = 1;
  for (std::size_t i = first_[solid]; i < first_[solid + 1]; ++i) {
    const Eigen::Vector4d& plane = planes_[i];
    const double hx = plane.head<3>().dot(x) + plane[3] + margin_;
    const double hy = plane.head<3>().dot(y) + plane[3] + margin_;
    if (hx >= 0 && hy >= 0) return false;
    if (hx > 0) from = std::max(from, hx / (hx - hy));
    if (hy > 0) to = std::min(to, hx / (hx - hy));
    if (from >= to) return false;
  }
  return true;
}

// A convex set that meets every segment between corners of two convex sets meets all
// segments between the two: a plane that has the convex set on one side and a segment on
// the other also has on that other side a corner of either.
bool ConvexSolids::hides(int solid, std::span<const Point> from,
                         std::span<const Point> to) const {
  return std::ranges::all_of(from, [&](const Point& x) {
    return std::ranges::all_of(to, [&](const Point& y) { return meets(solid, x, y); });
  });
}

}  // namespace sightline::internal
