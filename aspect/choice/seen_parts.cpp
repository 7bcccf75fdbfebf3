#include "aspect/choice/seen_parts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "aspect/views/labels.h"
#include "linespace/picture/view_scene.h"

namespace sightline::internal {
namespace {

struct Plane {
  Point on;
  Eigen::Vector3d normal;  // of length 1
};

Plane plane_of(const Scene& scene, int facet) {
  const auto p = scene.face_points(scene.facets()[facet].faces[0]);
  const Point& a = scene.point(p[0]);
  return {a, (scene.point(p[1]) - a).cross(scene.point(p[2]) - a).normalized()};
}

// Where the line of sight to a point in space meets a plane.
class OntoPlane {
 public:
  OntoPlane(const Viewpoint& eye, const Plane& plane)
      : plane_(plane),
        is_eye_(eye.kind == Viewpoint::Kind::Eye),
        eye_(is_eye_ ? eye.at.nearest : Point(eye.at.nearest.normalized())) {}

  // A point of the plane stays as it is: seen at a flat angle, rounding would move it
  // far.
  [[nodiscard]] Point operator()(const Point& p) const {
    const double height = plane_.normal.dot(p - plane_.on);
    // A vertex is rounded in its last place, and so is the normal, times twice the ratio
    // of the first three corners' length and width: allowed are ratios up to 2^10.
    constexpr double kInPlane = 0x1p-40;
    const double size = (p - plane_.on).norm() + p.cwiseAbs().maxCoeff();
    if (std::abs(height) <= kInPlane * size) return p;
    const Eigen::Vector3d along = is_eye_ ? Eigen::Vector3d(p - eye_) : eye_;
    return p - height / plane_.normal.dot(along) * along;
  }
  [[nodiscard]] double distance(const Point& p) const {
    return std::abs(plane_.normal.dot(p - plane_.on));
  }

 private:
  Plane plane_;
  bool is_eye_;
  Point eye_;
};

double area(const std::vector<std::vector<Point>>& outlines) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& outline : outlines) {
    for (std::size_t i = 1; i + 1 < outline.size(); ++i)
      sum += (outline[i] - outline[0]).cross(outline[i + 1] - outline[0]);
  }
  return sum.norm() / 2;
}

double entropy(const std::map<int, double>& angles) {
  const double whole = 4 * std::numbers::pi;
  double out = 0, rest = whole;
  const auto add = [&](double angle) {
    if (angle > 0) out -= angle / whole * std::log2(angle / whole);
  };
  for (const auto& [patch, angle] : angles) {
    add(angle);
    rest -= angle;
  }
  add(rest);
  return out;
}

}  // namespace

SeenParts parts_of(const PointView& view, const Scene& scene,
                   const ViewpointRequest& request, bool regions) {
  SeenParts out;
  out.at = view.eye;
  out.point = view.eye.at.nearest;
  std::set<int> patches, vertices;
  std::map<int, double> angles;
  double seen_area = 0, measure = 0;
  for (const MapRegion& region : view.regions) {
    if (region.patches.empty() || !counts_of(region, scene, request.of)) continue;
    patches.insert(region.patches.begin(), region.patches.end());
    const OntoPlane onto(view.eye, plane_of(scene, region.facets[0]));
    SeenRegion seen{region.patches[0], {}};
    for (const auto& walk : region.boundary) {
      std::vector<Point>& outline = seen.outlines.emplace_back();
      for (std::size_t k = 0; k < walk.size(); ++k) {
        vertices.insert(view.edges[walk[k] / 2].ends[walk[k] % 2]);
        // The vertex as an end of the edge before it and of the one after it: one of
        // them may lie in the plane.
        const int before = walk[(k + walk.size() - 1) % walk.size()];
        const Point& p = view.edges[before / 2].segment[1 - before % 2];
        const Point& q = view.edges[walk[k] / 2].segment[walk[k] % 2];
        outline.push_back(onto(onto.distance(p) < onto.distance(q) ? p : q));
      }
    }
    seen_area += area(seen.outlines);
    measure += region.measure.value_or(0);
    angles[region.patches[0]] += region.measure.value_or(0);
    if (!regions) continue;
    for (const int patch : region.patches) {
      seen.patch = patch;
      out.regions.push_back(seen);
    }
  }
  out.patches.assign(patches.begin(), patches.end());
  for (const SeenFacet& f : view.facets) {
    if (out.facets.empty() || out.facets.back() != f.facet) out.facets.push_back(f.facet);
  }
  const auto count =
      static_cast<double>(request.of.empty() ? view.vertices.size() : vertices.size());
  out.value = {static_cast<double>(patches.size()), seen_area, measure, entropy(angles),
               count};
  return out;
}

std::optional<SeenParts> seen_parts(const PointViewIndex& index, const Viewpoint& at,
                                    const ViewpointRequest& request, bool regions) {
  const PointView view = index.view(at);
  if (view.place != EyePlace::Free || !view.general) return std::nullopt;
  const Scene& scene = index.shared().scene();
  SeenParts out = parts_of(view, scene, request, regions);
  out.label = label_of(view, scene, request);
  return out;
}

}  // namespace sightline::internal
