#include "aspect/convex/convex_solid.h"

#include <algorithm>
#include <map>

#include "linespace/visibility_map.h"

namespace sightline::internal {

std::optional<ConvexSolid> convex_solid(const Scene& scene) {
  if (scene.objects().size() != 1 || !scene.objects()[0].convex ||
      scene.objects()[0].inside_out) {
    return std::nullopt;
  }
  ConvexSolid out;
  for (const Facet& facet : scene.facets()) {
    if (!facet.planar) return std::nullopt;
    const auto p = scene.face_points(facet.faces.front());
    out.planes.push_back(light_plane(light_point(scene.point(p[0])),
                                     light_point(scene.point(p[1])),
                                     light_point(scene.point(p[2]))));
  }
  std::map<int, int> corners;
  for (const int p : scene.corners())
    corners.emplace(p, static_cast<int>(corners.size()));
  out.corners = static_cast<int>(corners.size());
  for (const Edge& edge : scene.edges()) {
    if (edge.sides.size() != 2) return std::nullopt;
    ConvexSolid::Edge e{{corners.at(edge.points[0]), corners.at(edge.points[1])}, -1, -1};
    for (const Edge::Side& side : edge.sides)
      (side.forward ? e.left : e.right) = scene.faces()[side.face].facet;
    if (e.left < 0 || e.right < 0) return std::nullopt;
    out.edges.push_back(e);
  }
  return out;
}

ShapeMap ConvexSolid::map_of(const std::function<bool(int)>& shows) const {
  constexpr auto kind = [](MapEdgeKind k) { return static_cast<std::uint8_t>(k); };
  ShapeMap map;
  std::map<int, int> vertices;
  const auto vertex = [&](int corner) {
    const auto [it, is_new] =
        vertices.emplace(corner, static_cast<int>(map.vertex_kinds.size()));
    if (is_new) {
      map.vertex_kinds.push_back(static_cast<std::uint8_t>(MapVertexKind::Corner));
    }
    return it->second;
  };
  // Darts by region, each with the vertex that it leaves from.
  std::map<int, std::map<int, int>> leaving;  // region (-1: background), vertex, dart
  for (const Edge& e : edges) {
    const bool left = shows(e.left), right = shows(e.right);
    if (!left && !right) continue;
    const auto number = static_cast<int>(map.edges.size());
    map.edges.push_back(
        {{vertex(e.corners[0]), vertex(e.corners[1])},
         left && right ? kind(MapEdgeKind::Crease) : kind(MapEdgeKind::Silhouette)});
    leaving[left ? e.left : -1][map.edges.back().ends[0]] = 2 * number;
    leaving[right ? e.right : -1][map.edges.back().ends[1]] = 2 * number + 1;
  }
  for (auto& [region, darts] : leaving) {
    ShapeMap::Region out{static_cast<std::uint8_t>(region < 0 ? 0 : 1), {}};
    auto& walk = out.boundary.emplace_back();
    for (int v = darts.begin()->first;;) {
      const int d = darts.at(v);
      walk.push_back(d);
      v = map.edges[d / 2].ends[d % 2 == 0 ? 1 : 0];
      if (v == darts.begin()->first) break;
    }
    map.regions.push_back(std::move(out));
  }
  return map;
}

}  // namespace sightline::internal
