#include "viewers/far_ends.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace sightline::viewers {
namespace {

Point normal_of(const Scene& scene, int face) {
  const std::span<const int> ids = scene.face_points(face);
  const Point& a = scene.point(ids[0]);
  return (scene.point(ids[1]) - a).cross(scene.point(ids[2]) - a).normalized();
}

/// A line that grazes an edge at a rounded point enters or leaves the solid by an ulp, as
/// chance has it.  What is listed and drawn is the line moved outwards by 2^-32 of the
/// scene's diameter: above the rounding of any point of the scene, below what shows.
Point moved_outwards(const Scene& scene, const Edge& edge, const Point& p) {
  Point out = Point::Zero();
  for (const Edge::Side& side : edge.sides) out += normal_of(scene, side.face);
  if (edge.sides.size() < 2 || out.norm() == 0) return p;
  const double diameter = (scene.bounds()[1] - scene.bounds()[0]).norm();
  return p + std::ldexp(diameter, -32) * out.normalized();
}

std::vector<int> source_polygons(const Scene& scene, const std::vector<int>& faces) {
  std::vector<int> polygons;
  for (const int f : faces) polygons.push_back(scene.faces()[f].source);
  std::sort(polygons.begin(), polygons.end());
  polygons.erase(std::unique(polygons.begin(), polygons.end()), polygons.end());
  return polygons;
}

std::optional<FarEnds> far_ends_between(const Scene& scene, const OcclusionIndex& index,
                                        const Point& a, const Point& b) {
  if (a == b) return std::nullopt;
  const std::optional<FreeSegment> free = index.maximal_free_segment(a, b);
  if (!free) return std::nullopt;
  const double length = (b - a).norm();
  const double beyond = 0.2 * (scene.bounds()[1] - scene.bounds()[0]).norm() / length;
  const double from = std::isfinite(free->from) ? free->from : -beyond;
  const double to = std::isfinite(free->to) ? free->to : 1 + beyond;
  FarEnds ends;
  ends.points = {a + from * (b - a), a + to * (b - a)};
  ends.faces = {source_polygons(scene, free->from_faces),
                source_polygons(scene, free->to_faces)};
  ends.contacts = free->contacts;
  return ends;
}

}  // namespace

Point point_on_edge(const Scene& scene, const Edge& edge, double s) {
  const Point& a = scene.point(edge.points[0]);
  const Point& b = scene.point(edge.points[1]);
  return s <= 0.5 ? Point(a + s * (b - a)) : Point(b - (1 - s) * (b - a));
}

std::optional<FarEnds> far_ends(const Scene& scene, const OcclusionIndex& index,
                                const SkeletonArc& arc, double s) {
  const Edge& edge = scene.edges()[arc.edge];
  return far_ends_between(scene, index, scene.point(arc.vertex),
                          moved_outwards(scene, edge, point_on_edge(scene, edge, s)));
}

std::optional<FarEnds> far_ends(const Scene& scene, const OcclusionIndex& index,
                                const SkeletonNode& node) {
  return far_ends_between(scene, index, node.segment[0], node.segment[1]);
}

}  // namespace sightline::viewers
