#include "aspect/choice/view_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "linespace/picture/view_scene.h"

namespace sightline::internal {
namespace {

constexpr double kPi = std::numbers::pi;

// Of distributions whose parts have at most these shares, and one, the background, any:
// the largest entropy.  It is concave, so that at the largest each share is its own limit
// or a common level (Kuhn and Tucker).
double most_entropy(std::vector<double> limits) {
  std::ranges::sort(limits);
  double left = 1, sum = 0;
  const auto term = [](double x) { return x > 0 ? -x * std::log2(x) : 0; };
  auto others = static_cast<double>(limits.size() + 1);
  for (const double limit : limits) {
    if (limit * others >= left) break;
    sum += term(limit);
    left -= limit;
    --others;
  }
  return sum + others * term(left / others);
}

class RegionMeasure {
 public:
  RegionMeasure(const Scene& scene, const ViewSpace& space,
                const std::vector<PatchSide>& sides, ViewMeasure measure,
                const std::vector<bool>& counts)
      : space_(space), sides_(sides), measure_(measure), counts_(counts) {
    for (const PatchSide& side : sides) {
      Box box{Point::Constant(std::numeric_limits<double>::infinity()),
              Point::Constant(-std::numeric_limits<double>::infinity())};
      for (const int f : side.faces) {
        for (const int p : scene.face_points(f)) {
          box.low = box.low.cwiseMin(scene.point(p));
          box.high = box.high.cwiseMax(scene.point(p));
        }
      }
      boxes_.push_back(box);
    }
  }

  double operator()(const ViewRegion& region, const std::vector<int>& possible) const {
    const bool far = region.high[3] == 0;
    std::vector<double> weights;
    for (const int s : possible) weights.push_back(weight(region, s, far));
    // A weight has eight roundings at most, and a sum one for each of its terms.
    const double up = 1 + kUnit * (16 + 2 * static_cast<double>(weights.size()));
    if (measure_ == ViewMeasure::Entropy) {
      for (double& w : weights) w *= up / (4 * kPi);
      return up * most_entropy(std::move(weights));
    }
    double sum = most_together(sides_, possible, weights, far);
    if (measure_ == ViewMeasure::SolidAngle && !far)
      sum = std::min({sum, 4 * kPi, by_solids(possible, weights)});
    if (measure_ == ViewMeasure::SolidAngle && far)
      sum = std::min(sum, by_mean_normal(region, possible));
    // Sums of counts are exact.
    return measure_ == ViewMeasure::Faces ? sum : sum * up;
  }

 private:
  struct Box {
    Point low, high;
  };

  [[nodiscard]] double weight(const ViewRegion& region, int s, bool far) const {
    const PatchSide& side = sides_[s];
    if (measure_ == ViewMeasure::Faces) return counts_.empty() || counts_[s] ? 1 : 0;
    if (measure_ == ViewMeasure::Area) return side.area;
    if (far) return side.area * space_.most_sine(region, side);
    // A plane is seen under less than half of all directions.
    const double d = space_.least_distance(region, boxes_[s].low, boxes_[s].high);
    return std::min(2 * kPi, side.area / (d * d));
  }

  // Sides that all of the region is in front of have, projected together, at most the
  // length of the sum of their normals, each as long as the side's area.
  [[nodiscard]] double by_mean_normal(const ViewRegion& region,
                                      const std::vector<int>& possible) const {
    Eigen::Vector3d normals = Eigen::Vector3d::Zero();
    double others = 0;
    for (const int s : possible) {
      if (space_.in_front(region, sides_[s])) {
        normals += sides_[s].area * sides_[s].normal.normalized();
      } else {
        others += weight(region, s, true);
      }
    }
    return normals.norm() + others;
  }

  // A convex solid is seen under less than half of all directions from outside.
  [[nodiscard]] double by_solids(const std::vector<int>& possible,
                                 const std::vector<double>& weights) const {
    std::map<int, double> solids;
    double sum = 0;
    for (std::size_t i = 0; i < possible.size(); ++i) {
      const int solid = sides_[possible[i]].solid;
      (solid < 0 ? sum : solids[solid]) += weights[i];
    }
    for (const auto& [solid, angle] : solids) sum += std::min(angle, 2 * kPi);
    return sum;
  }

  const ViewSpace& space_;
  const std::vector<PatchSide>& sides_;
  ViewMeasure measure_;
  const std::vector<bool>& counts_;
  std::vector<Box> boxes_;
};

// Corners of maps are points, and their other vertices lie on two lines, or on a line and
// a facet: each two of them, once.
double most_vertices(const PointViewIndex& index) {
  const Scene& scene = index.shared().scene();
  const auto lines = static_cast<double>(index.shared().lines().size());
  const auto facets = static_cast<double>(scene.facets().size());
  return static_cast<double>(scene.points().size()) + lines * (lines - 1) / 2 +
         lines * facets;
}

}  // namespace

double measure_bound(const PointViewIndex& index, const ViewpointRequest& request,
                     const std::vector<PatchSide>& sides, ViewMeasure measure,
                     double reached, const std::vector<bool>& counts) {
  if (sides.empty()) return reached;
  if (measure == ViewMeasure::Structure) return most_vertices(index);
  const Scene& scene = index.shared().scene();
  const ViewSpace space(scene, request);
  const RegionMeasure bound(scene, space, sides, measure, counts);
  // Some seconds at most: a step costs a tenth of a microsecond a side.
  const int steps =
      std::clamp(static_cast<int>(2e6 / static_cast<double>(sides.size())), 100, 5'000);
  return bound_over(space, sides, std::cref(bound), reached, steps);
}

double graph_bound(const std::vector<SeenParts>& views,
                   const std::vector<PatchSide>& sides, const ViewpointRequest& request,
                   ViewMeasure measure) {
  std::map<int, double> areas;
  for (const PatchSide& side : sides) areas[side.patch] = side.area;
  double most = 0;
  for (const SeenParts& view : views) {
    double area = 0;
    for (const int patch : view.patches) area += areas.at(patch);
    const auto n = static_cast<double>(view.patches.size());
    switch (measure) {
      case ViewMeasure::Faces:
      case ViewMeasure::Structure:
        most = std::max(most, view.value[static_cast<int>(measure)]);
        break;
      case ViewMeasure::Area:
        most = std::max(most, area);
        break;
      case ViewMeasure::SolidAngle:
        // Of directions the projected area is less; of eyes a solid is less than half.
        most = request.projection == Projection::Orthographic ? std::max(most, area)
                                                              : 2 * kPi;
        break;
      case ViewMeasure::Entropy:
        // The background has half of all directions or more.
        most = std::max(most, 1 + std::log2(n) / 2);
        break;
    }
  }
  return most;
}

}  // namespace sightline::internal
