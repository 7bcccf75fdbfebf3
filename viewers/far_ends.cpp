#include "viewers/far_ends.h"

#include <Eigen/Geometry>
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

FarEnds far_ends(const Scene& scene, const SkeletonLines& lines, const SkeletonArc& arc,
                 double s) {
  const Edge& edge = scene.edges()[arc.edge];
  return far_ends_of(scene, lines.line(arc, s), scene.point(arc.vertex),
                     point_on_edge(scene, edge, s));
}

std::optional<FarEnds> far_ends(const Scene& scene, const SkeletonLines& lines,
                                const Skeleton& skeleton, const SkeletonNode& node) {
  const auto free = lines.line(skeleton, node);
  if (!free) return std::nullopt;
  return far_ends_of(scene, *free, node.segment[0], node.segment[1]);
}

}  // namespace sightline::viewers
