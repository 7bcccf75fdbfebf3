#include "viewers/far_ends.h"

#include <algorithm>
#include <cmath>

namespace sightline::viewers {
std::vector<int> source_polygons(const Scene& scene, const std::vector<int>& faces) {
  std::vector<int> polygons;
  for (const int f : faces) polygons.push_back(scene.faces()[f].source);
  std::sort(polygons.begin(), polygons.end());
  polygons.erase(std::unique(polygons.begin(), polygons.end()), polygons.end());
  return polygons;
}

namespace {

FarEnds far_ends_of(const Scene& scene, const FreeSegment& free, const Point& a,
                    const Point& b) {
  const double length = (b - a).norm();
  const double beyond = 0.2 * (scene.bounds()[1] - scene.bounds()[0]).norm() / length;
  const double from = std::isfinite(free.from) ? free.from : -beyond;
  const double to = std::isfinite(free.to) ? free.to : 1 + beyond;
  FarEnds ends;
  ends.points = {a + from * (b - a), a + to * (b - a)};
  ends.faces = {source_polygons(scene, free.from_faces),
                source_polygons(scene, free.to_faces)};
  ends.contacts = free.contacts;
  return ends;
}

}  // namespace

Point point_on_edge(const Scene& scene, const Edge& edge, double s) {
  const Point& a = scene.point(edge.points[0]);
  const Point& b = scene.point(edge.points[1]);
  return s <= 0.5 ? Point(a + s * (b - a)) : Point(b - (1 - s) * (b - a));
}

std::optional<FarEnds> far_ends(const Scene& scene, const SkeletonLines& lines,
                                const SkeletonArc& arc, double s) {
  if (!arc.is_ev() && !(s > arc.range[0] && s < arc.range[1])) return std::nullopt;
  const auto free = lines.line(arc, s);
  const auto at = lines.points(arc, s);
  if (!free || !at) return std::nullopt;
  return far_ends_of(scene, *free, (*at)[0].nearest, (*at)[1].nearest);
}

std::optional<FarEnds> far_ends(const Scene& scene, const SkeletonLines& lines,
                                const Skeleton& skeleton, const SkeletonNode& node) {
  const auto free = lines.line(skeleton, node);
  if (!free) return std::nullopt;
  const auto& [a, b] = node.segment;
  return far_ends_of(scene, *free, a, b);
}

}  // namespace sightline::viewers
