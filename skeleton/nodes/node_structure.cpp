#include "skeleton/nodes/node_structure.h"

#include <algorithm>

#include "linespace/silhouettes/silhouettes.h"
#include "linespace/swaths/edge_cuts.h"

namespace sightline::internal {
namespace {

std::optional<NodeStructure> solid_structure(const SkeletonNode& node) {
  if (node.end) {
    const bool known = node.kind == NodeKind::VEE || node.kind == NodeKind::FEE;
    return known ? std::optional(NodeStructure{0, 1}) : std::nullopt;
  }
  switch (node.kind) {
    case NodeKind::VV:
      return NodeStructure{4, 0};
    case NodeKind::FF:
      return NodeStructure{0, 0};
    case NodeKind::VEE:
      return NodeStructure{1, 2};
    case NodeKind::FvE:
      return NodeStructure{1, 0};
    case NodeKind::EVE:
    case NodeKind::EEEE:
    case NodeKind::FEE:
      return NodeStructure{0, 2};
    default:
      return std::nullopt;
  }
}

// The side of a face's plane on which x lies.
int side_of(const Scene& scene, int face, const ExactPoint& x) {
  const auto p = plane_points(scene, face);
  return exact_orient(exact_point(scene.point(p[0])), exact_point(scene.point(p[1])),
                      exact_point(scene.point(p[2])), x)
      .sign();
}

// Where an edge crosses the plane of three points; nullopt where it does not cross.
std::optional<ExactPoint> crossing(const Scene& scene, int edge, const ExactPoint& a,
                                   const ExactPoint& b, const ExactPoint& c) {
  const auto& ends = scene.edges()[edge].points;
  const ExactPoint from = exact_point(scene.point(ends[0]));
  const ExactPoint to = exact_point(scene.point(ends[1]));
  const Rational x = exact_orient(a, b, c, from);
  const Rational y = exact_orient(a, b, c, to);
  if (x == y) return std::nullopt;
  const Rational s = x / (x - y);
  ExactPoint at;
  for (int i = 0; i < 3; ++i) at[i] = from[i] + s * (to[i] - from[i]);
  return at;
}

// The corner of one closed object all of whose edges there are convex.
bool convex_corner(const Scene& scene, int point) {
  const auto edges = scene.edges_at(point);
  if (edges.empty()) return false;
  const int object = scene.edges()[edges[0]].object;
  const auto faces = scene.faces_at(point);
  return std::all_of(edges.begin(), edges.end(),
                     [&](int e) { return scene.edges()[e].kind == EdgeKind::Convex; }) &&
         std::all_of(faces.begin(), faces.end(), [&](int f) {
           return scene.solid_behind(f) && scene.faces()[f].object == object;
         });
}

// Edges at a corner that are seen from x: not those between two backs.  nullopt where x
// lies in the plane of a face there, or the corner is not a simple one.
std::optional<int> visible_edges(const Scene& scene, int point, const ExactPoint& x) {
  const auto edges = scene.edges_at(point);
  const bool sheet = std::all_of(edges.begin(), edges.end(), [&](int e) {
    return scene.edges()[e].kind == EdgeKind::Boundary;
  });
  if (sheet) return static_cast<int>(edges.size());
  if (!convex_corner(scene, point)) return std::nullopt;
  int count = 0;
  for (const int e : edges) {
    bool seen = false;
    for (const Edge::Side& side : scene.edges()[e].sides) {
      const int s = side_of(scene, side.face, x);
      if (s == 0) return std::nullopt;
      seen |= s > 0;
    }
    count += seen;
  }
  return count;
}

std::optional<NodeStructure> vv_structure(const Scene& scene, int v, int w) {
  const auto at_v = visible_edges(scene, v, exact_point(scene.point(w)));
  const auto at_w = visible_edges(scene, w, exact_point(scene.point(v)));
  if (!at_v || !at_w) return std::nullopt;
  return NodeStructure{*at_v + *at_w, 0};
}

std::optional<NodeStructure> vee_structure(const Scene& scene, int v, int between,
                                           int last) {
  const auto& g = scene.edges()[between].points;
  const auto x = crossing(scene, last, exact_point(scene.point(v)),
                          exact_point(scene.point(g[0])), exact_point(scene.point(g[1])));
  const auto seen = x ? visible_edges(scene, v, *x) : std::nullopt;
  if (!seen) return std::nullopt;
  return NodeStructure{1, *seen};
}

// The face lies beyond its corner, where the corner turns from a graze into an end
// contact, or in front of it, where beyond its plane the line would come from inside.
std::optional<NodeStructure> fve_structure(const Scene& scene, int v, int facet,
                                           int edge) {
  if (!convex_corner(scene, v)) return std::nullopt;
  const auto p = plane_points(scene, scene.facets()[facet].faces[0]);
  const auto x = crossing(scene, edge, exact_point(scene.point(p[0])),
                          exact_point(scene.point(p[1])), exact_point(scene.point(p[2])));
  if (!x) return std::nullopt;
  bool beyond = true;
  bool before = true;
  for (const int f : scene.faces_at(v)) {
    if (scene.faces()[f].facet == facet) continue;
    const int s = side_of(scene, f, *x);
    beyond &= s > 0;
    before &= s < 0;
  }
  if (beyond == before) return std::nullopt;
  return NodeStructure{beyond ? 2 : 1, 0};
}

std::optional<NodeStructure> polygon_structure(const Scene& scene,
                                               const SkeletonNode& node,
                                               std::span<const Generator> generators) {
  const auto on_solid = [&](const Generator& g) {
    return g.kind != GeneratorKind::Face ||
           scene.solid_behind(scene.facets()[g.id].faces[0]);
  };
  if (!std::all_of(generators.begin(), generators.end(), on_solid)) return std::nullopt;
  switch (node.kind) {
    case NodeKind::VV:
      return vv_structure(scene, generators[0].id, generators[1].id);
    case NodeKind::VEE:
      return vee_structure(scene, generators[0].id, generators[1].id, generators[2].id);
    case NodeKind::FvE:
      return fve_structure(scene, generators[0].id, generators[1].id, generators[2].id);
    case NodeKind::EVE:
    case NodeKind::EEEE:
      return NodeStructure{0, 2};
    case NodeKind::FEE: {
      const bool between = generators[1].kind == GeneratorKind::Face;
      return NodeStructure{0, between ? 2 : 3};
    }
    default:
      return std::nullopt;
  }
}

}  // namespace

std::optional<NodeStructure> node_structure(const Scene& scene, const Skeleton& skeleton,
                                            const SkeletonNode& node) {
  if (node.self) return std::nullopt;
  if (skeleton.events == EventMode::Solid) return solid_structure(node);
  return polygon_structure(scene, node, skeleton.generators(node));
}

}  // namespace sightline::internal
