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
  out.find_walks();
  return out;
}

void ConvexSolid::find_walks() {
  std::vector<std::vector<int>> sides(planes.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    sides[edges[e].left].push_back(2 * static_cast<int>(e));
    sides[edges[e].right].push_back(2 * static_cast<int>(e) + 1);
  }
  const auto end = [&](int d, int which) {
    return edges[d / 2].corners[which ^ (d % 2)];
  };
  for (const std::vector<int>& all : sides) {
    auto& walk = walks.emplace_back();
    for (int d = all.front(); walk.size() < all.size();) {
      walk.push_back(d);
      const auto next = std::ranges::find_if(
          all, [&](int other) { return end(other, 0) == end(d, 1); });
      d = *next;
    }
  }
}

ShapeMap ConvexSolid::map_of(const std::function<bool(int)>& shows) const {
  constexpr auto kind = [](MapEdgeKind k) { return static_cast<std::uint8_t>(k); };
  ShapeMap map;
  std::vector<int> vertices(corners, -1);
  const auto vertex = [&](int corner) {
    if (vertices[corner] < 0) {
      vertices[corner] = static_cast<int>(map.vertex_kinds.size());
      map.vertex_kinds.push_back(static_cast<std::uint8_t>(MapVertexKind::Corner));
    }
    return vertices[corner];
  };
  std::vector<int> number(edges.size(), -1);
  std::vector<int> outside;  // darts with the background on their left
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Edge& e = edges[i];
    const bool left = shows(e.left), right = shows(e.right);
    if (!left && !right) continue;
    number[i] = static_cast<int>(map.edges.size());
    map.edges.push_back(
        {{vertex(e.corners[0]), vertex(e.corners[1])},
         kind(left && right ? MapEdgeKind::Crease : MapEdgeKind::Silhouette)});
    if (left != right) outside.push_back(2 * number[i] + (left ? 1 : 0));
  }
  for (std::size_t f = 0; f < walks.size(); ++f) {
    if (!shows(static_cast<int>(f))) continue;
    auto& walk =
        map.regions.emplace_back(ShapeMap::Region{1, {}}).boundary.emplace_back();
    for (const int d : walks[f]) walk.push_back(2 * number[d / 2] + d % 2);
  }
  // What is seen of a convex solid has one outline, each corner of it once.
  std::vector<int> leaving(map.vertex_kinds.size(), -1);
  for (const int d : outside) leaving[map.edges[d / 2].ends[d % 2]] = d;
  auto& walk = map.regions.emplace_back(ShapeMap::Region{0, {}}).boundary.emplace_back();
  for (int d = outside.front();;) {
    walk.push_back(d);
    d = leaving[map.edges[d / 2].ends[1 - d % 2]];
    if (d == outside.front()) break;
  }
  return map;
}

}  // namespace sightline::internal
