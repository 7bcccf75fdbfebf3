#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "shadows/factors/factor_sides.h"
#include "shadows/form_factors.h"

namespace sightline {
namespace {

using namespace internal;

using Vector = Eigen::Vector3d;
/// Directions, joined by great circles.
using Walk = std::vector<Vector>;

/// The part of a closed walk in a half-space through the eye, closed along its boundary.
Walk clipped(const Walk& walk, const Vector& normal) {
  // Directions are unit vectors; what lies in the plane but for rounding is in it.
  const double slack = 4e-16 * normal.norm();
  const auto height = [&](const Vector& v) {
    const double h = normal.dot(v);
    return std::abs(h) <= slack ? 0 : h;
  };
  Walk part;
  if (std::ranges::none_of(walk, [&](const Vector& v) { return height(v) > 0; }))
    return part;
  for (std::size_t i = 0; i < walk.size(); ++i) {
    const Vector &a = walk[i], &b = walk[(i + 1) % walk.size()];
    const double ha = height(a), hb = height(b);
    if (ha >= 0) part.push_back(a);
    if ((ha > 0 && hb < 0) || (ha < 0 && hb > 0)) {
      const Vector cut = a * std::abs(hb) + b * std::abs(ha);
      if (cut.norm() > 0) part.push_back(cut.normalized());
    }
  }
  return part;
}

/// Lambert's sum, positive for walks that the eye sees counter-clockwise.  Around a walk
/// along the horizon it is known but for a whole number.
double lambert(const Walk& walk, const Vector& unit) {
  double sum = 0;
  for (std::size_t i = 0; i < walk.size(); ++i) {
    const Vector &a = walk[i], &b = walk[(i + 1) % walk.size()];
    const Vector across = a.cross(b);
    const double length = across.norm();
    if (length > 0) sum += std::atan2(length, a.dot(b)) / length * unit.dot(across);
  }
  return -sum / (2 * std::numbers::pi);
}

/// Adds up what is met above the horizon, and above another plane for the sky.
struct Clip {
  Vector unit;
  std::vector<Vector> planes;  ///< of half-spaces that are kept

  [[nodiscard]] double of(const std::vector<Walk>& walks) const {
    double sum = 0;
    for (Walk walk : walks) {
      for (const Vector& plane : planes) walk = clipped(walk, plane);
      sum += lambert(walk, unit);
    }
    return sum;
  }
};

/// The closed walks of a region's boundary; seen from the eye the region is on the left.
std::vector<Walk> walks_of(const PointView& view, const MapRegion& region) {
  std::vector<Walk> walks;
  for (const std::vector<int>& cycle : region.boundary) {
    Walk walk;
    for (const int step : cycle) {
      const MapEdge& edge = view.edges[step / 2];
      walk.push_back(view.vertices[edge.ends[step % 2]].at);
    }
    walks.push_back(std::move(walk));
  }
  return walks;
}

/// Around what an eye on the scene cannot look into: the material of a solid.
std::vector<Walk> walks_around_material(const PointView& view) {
  std::multimap<int, int> next;
  for (const MapEdge& edge : view.edges) {
    if (edge.left == -1 && edge.right == -1) continue;
    if (edge.left == -1) next.emplace(edge.ends[0], edge.ends[1]);
    if (edge.right == -1) next.emplace(edge.ends[1], edge.ends[0]);
  }
  std::vector<Walk> walks;
  while (!next.empty()) {
    Walk walk;
    int at = next.begin()->first;
    for (auto it = next.find(at); it != next.end(); it = next.find(at)) {
      walk.push_back(view.vertices[at].at);
      at = it->second;
      next.erase(it);
    }
    walks.push_back(std::move(walk));
  }
  return walks;
}

double nearest_in_unit(double x) { return x - std::floor(x + 1e-9); }

}  // namespace

struct PointFactorIndex::Impl {
  Impl(const Scene& s, std::span<const FormFactorSurface> surfaces,
       const Request& request)
      : scene(s),
        views(s, request),
        count(surfaces.size()),
        sides(sides_by_face(s, surfaces)) {}

  const Scene& scene;
  PointViewIndex views;
  std::size_t count;
  std::vector<std::vector<FactorSide>> sides;

  /// Whether the side of the facet that is seen is its file's front.
  [[nodiscard]] std::vector<FactorSide> of_face(int face, bool front) const {
    return sides[2 * face + (front != scene.turned(face) ? 0 : 1)];
  }
  void add(const FactorSide& side, double factor, PointFactors& result) const {
    if (side.of >= 0) {
      result.factors[side.of] += factor;
    } else {
      (side.of == kOthers ? result.others : result.backs) += factor;
    }
  }
  void add_region(const PointView& view, const MapRegion& region,
                  const std::map<int, bool>& fronts, const Clip& clip,
                  PointFactors& result) const;
};

void PointFactorIndex::Impl::add_region(const PointView& view, const MapRegion& region,
                                        const std::map<int, bool>& fronts,
                                        const Clip& clip, PointFactors& result) const {
  const std::vector<Walk> walks = walks_of(view, region);
  const Point& eye = view.eye.at.nearest;
  for (const int facet : region.facets) {
    const bool front = fronts.at(facet);
    const std::vector<int>& faces = scene.facets()[facet].faces;
    for (const int face : faces) {
      for (const FactorSide& side : of_face(face, front)) {
        Clip within = clip;
        if (region.facets.size() > 1 || faces.size() > 1 || side.of == kBacks) {
          const std::size_t n = side.polygon.size();
          for (std::size_t i = 0; i < n; ++i) {
            // Counter-clockwise around its front, which the eye sees.
            const Vector normal =
                (side.polygon[(i + 1) % n] - eye).cross(side.polygon[i] - eye);
            within.planes.push_back(normal.normalized());
          }
        }
        add(side, within.of(walks), result);
      }
    }
  }
}

PointFactorIndex::PointFactorIndex(const Scene& scene,
                                   std::span<const FormFactorSurface> surfaces,
                                   const Request& request)
    : impl_(std::make_unique<Impl>(scene, surfaces, request)) {}
PointFactorIndex::~PointFactorIndex() = default;
PointFactorIndex::PointFactorIndex(PointFactorIndex&&) noexcept = default;

PointFactors PointFactorIndex::at(const Viewpoint& eye, const Eigen::Vector3d& normal,
                                  const std::optional<Eigen::Vector3d>& up) const {
  PointFactors result;
  result.factors.assign(impl_->count, 0);
  Request alone;
  alone.threads = 1;
  const PointView view = impl_->views.view(eye, alone);
  if (view.place == EyePlace::Inside) {
    result.backs = 1;
    return result;
  }
  const Clip clip{normal.normalized(), {normal.normalized()}};
  std::map<int, bool> fronts;
  for (const SeenFacet& facet : view.facets) fronts[facet.facet] = facet.front;
  double background = 0, met = 0;
  Clip sky = clip;
  // All that is sent out above both horizons.
  if (up) {
    sky.planes.push_back(up->normalized());
    result.sky = 0.5 * (1 + clip.unit.dot(up->normalized()));
    result.sky -= sky.of(walks_around_material(view));
  }
  for (const MapRegion& region : view.regions) {
    if (region.facets.empty()) {
      background += clip.of(walks_of(view, region));
      continue;
    }
    met += clip.of(walks_of(view, region));
    if (up) result.sky -= sky.of(walks_of(view, region));
    impl_->add_region(view, region, fronts, clip, result);
  }
  // Sums along the horizon are known but for whole numbers; all of them together are 1.
  const double material = nearest_in_unit(clip.of(walks_around_material(view)));
  result.backs += material;
  if (view.background_pieces > 0 || view.regions.empty()) {
    result.outside = background + std::round(1 - met - material - background);
  }
  return result;
}

}  // namespace sightline
