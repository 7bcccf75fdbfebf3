// The view of one convex solid, written down from its facets alone: what a test of
// pictures and files can know without the code that finds views.

#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "linespace/visibility_map.h"

namespace sightline::testing {

/// Where the eye sees a point of space, as MapVertex::at tells it.
inline Point seen_at(const Viewpoint& eye, const Point& p) {
  const Point& e = eye.at.nearest;
  if (eye.kind == Viewpoint::Kind::Eye) return (p - e).normalized();
  return p - p.dot(e) / e.squaredNorm() * e;
}

inline Viewpoint plain_viewpoint(Viewpoint::Kind kind, const Point& at) {
  Viewpoint eye;
  eye.kind = kind;
  eye.at.nearest = at;
  eye.at.is_double = {true, true, true};
  return eye;
}

namespace internal_convex_view {

inline bool is_front(const Scene& scene, int face, const Viewpoint& eye) {
  const auto corners = scene.face_points(face);
  const Point& a = scene.point(corners[0]);
  const Point normal = (scene.point(corners[1]) - a).cross(scene.point(corners[2]) - a);
  const Point& e = eye.at.nearest;
  return normal.dot(eye.kind == Viewpoint::Kind::Eye ? Point(e - a) : e) > 0;
}

/// The number of the corner's vertex, which is made if need be.
inline int vertex_of(PointView& view, const Scene& scene, int corner) {
  const auto found = std::ranges::find(view.vertices, corner, &MapVertex::corner);
  if (found != view.vertices.end()) {
    return static_cast<int>(found - view.vertices.begin());
  }
  view.vertices.push_back(
      {MapVertexKind::Corner, corner, {}, {}, seen_at(view.eye, scene.point(corner))});
  return static_cast<int>(view.vertices.size()) - 1;
}

/// The half-edge of this side of a face, whose region it gets on its left.
inline int half_edge(PointView& view, const Scene& scene, int face, int side,
                     int region) {
  const auto corners = scene.face_points(face);
  const int a = corners[side];
  const int b = corners[(side + 1) % corners.size()];
  const int edge = scene.edge_of_side(face, side);
  const auto found = std::ranges::find_if(
      view.edges, [&](const MapEdge& e) { return e.line.edge == edge; });
  if (found != view.edges.end()) {
    found->right = region;
    found->kind = MapEdgeKind::Crease;
    return 2 * static_cast<int>(found - view.edges.begin()) + 1;
  }
  const int from = vertex_of(view, scene, a), to = vertex_of(view, scene, b);
  view.edges.push_back({{edge, {-1, -1}},
                        MapEdgeKind::Silhouette,
                        {from, to},
                        region,
                        0,
                        {scene.point(a), scene.point(b)}});
  return 2 * static_cast<int>(view.edges.size()) - 2;
}

/// The outline, walked with the background on its left.
inline std::vector<int> outline(const PointView& view) {
  std::map<int, int> leaving;  // vertex -> half-edge
  for (std::size_t e = 0; e < view.edges.size(); ++e) {
    if (view.edges[e].right != 0) continue;
    leaving[view.edges[e].ends[1]] = 2 * static_cast<int>(e) + 1;
  }
  std::vector<int> walk;
  for (int v = leaving.begin()->first; walk.size() < leaving.size();) {
    walk.push_back(leaving.at(v));
    v = view.edges[walk.back() / 2].ends[0];
  }
  return walk;
}

}  // namespace internal_convex_view

/// Of a scene that is one convex solid with a face per facet, from outside, none of its
/// facets edge-on.  Region 0 is the background; measures are 1 each; facets have their
/// own numbers as patches.
inline PointView convex_view(const Scene& scene, const Viewpoint& eye) {
  namespace in = internal_convex_view;
  PointView view{};
  view.eye = eye;
  view.place = EyePlace::Free;
  view.components = view.background_pieces = 1;
  view.general = true;
  view.structure = "one convex solid";
  view.regions.push_back({{}, {}, std::nullopt, {}});
  for (int f = 0; f < static_cast<int>(scene.faces().size()); ++f) {
    if (!in::is_front(scene, f, eye)) continue;
    const int facet = scene.faces()[f].facet;
    const int region = static_cast<int>(view.regions.size());
    std::vector<int> walk;
    for (int side = 0; side < scene.faces()[f].corner_count; ++side) {
      walk.push_back(in::half_edge(view, scene, f, side, region));
    }
    view.regions.push_back({{facet}, {facet}, 1.0, {walk}});
    view.facets.push_back({facet, true, 1, 1.0, {}});
  }
  view.regions[0].boundary = {in::outline(view)};
  std::ranges::sort(view.facets, {}, &SeenFacet::facet);
  return view;
}

}  // namespace sightline::testing
