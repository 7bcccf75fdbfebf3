// The edges of the mesh, their kinds, the facets they bound, and the maximal edges.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <compare>
#include <cstdio>

#include "linespace/predicates.h"
#include "linespace/scene/scene.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

// A corner of the face that is not on the line through p and q.
const Point& corner_off(const Scene& scene, int face, const Point& p, const Point& q) {
  const auto ids = scene.face_points(face);
  for (const int id : ids) {
    const Point& c = scene.point(id);
    if (c != p && c != q && (ids.size() == 3 || !collinear(p, q, c))) return c;
  }
  return scene.point(ids[0]);  // not reached: faces have area
}

// Two coplanar triangles pqc and qpd lie on opposite sides of pq.
bool unfolded(const Point& p, const Point& q, const Point& c, const Point& d) {
  for (int axis = 0; axis < 3; ++axis) {
    // Seen along a coordinate axis: pq with a point off it in that direction.
    Point up = p;
    up[axis] = p[axis] == 0 ? 1 : 0;
    const Sign s = orient3d(p, q, up, c);
    if (s != Sign::Zero) return orient3d(p, q, up, d) == -s;
  }
  return true;  // not reached: c is off the line pq
}

// Rounded; radians.
double angle_between(const Scene& scene, int f, int g) {
  const auto normal = [&](int face) -> Point {
    const auto t = plane_corners(scene, face);
    return (t[1] - t[0]).cross(t[2] - t[0]).stableNormalized();
  };
  const Point m = normal(f), n = normal(g);
  return std::atan2(m.cross(n).norm(), m.dot(n));
}

// How the faces of two opposite half-edges meet.
struct Meeting {
  EdgeKind kind;
  bool exact;  ///< Flat: the faces are exactly coplanar
  bool bulge;  ///< convex or coplanar and not folded back
};

Meeting meet(const Scene& scene, const HalfEdge& e, const HalfEdge& f) {
  const HalfEdge& along = e.forward ? e : f;  // runs from p to q
  const HalfEdge& back = e.forward ? f : e;
  const Point &p = scene.point(e.low), &q = scene.point(e.high);
  const Point& c = corner_off(scene, along.face, p, q);
  const Point& d = corner_off(scene, back.face, p, q);
  switch (orient3d(p, q, c, d)) {
    case Sign::Negative:
      return {EdgeKind::Convex, false, true};
    case Sign::Positive:
      return {EdgeKind::Reflex, false, false};
    default:
      break;
  }
  if (unfolded(p, q, c, d)) return {EdgeKind::Flat, true, true};
  return {EdgeKind::Convex, false, false};
}

std::string edge_name(const Scene& scene, const HalfEdge& e) {
  return "the edge from vertex " + std::to_string(scene.vertex_of(e.low)) +
         " to vertex " + std::to_string(scene.vertex_of(e.high));
}

}  // namespace

void SceneBuilder::collect_half_edges() {
  const std::size_t n = scene.corners_.size();
  std::vector<int> starts(scene.points_.size() + 1, 0);
  const auto for_each_side = [&](auto&& visit) {
    for (std::size_t f = 0; f < scene.faces_.size(); ++f) {
      const Face& face = scene.faces_[f];
      for (int i = 0; i < face.corner_count; ++i) {
        const int at = face.first_corner + i;
        const int to = scene.corners_[face.first_corner + (i + 1) % face.corner_count];
        visit(static_cast<int>(f), at, scene.corners_[at], to);
      }
    }
  };
  for_each_side([&](int, int, int from, int to) { ++starts[std::min(from, to) + 1]; });
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  half_edges.resize(n);
  std::vector<int> next(starts.begin(), starts.end() - 1);
  for_each_side([&](int f, int at, int from, int to) {
    half_edges[next[std::min(from, to)]++] = {
        std::min(from, to),     std::max(from, to), f,
        scene.faces_[f].object, from < to,          is_diagonal[at] != 0};
  });
  for (std::size_t p = 0; p + 1 < starts.size(); ++p) {
    stage.at(p, starts.size());
    std::sort(half_edges.begin() + starts[p], half_edges.begin() + starts[p + 1],
              [](const HalfEdge& e, const HalfEdge& f) {
                if (e.object != f.object) return e.object < f.object;
                if (e.high != f.high) return e.high < f.high;
                return e.face < f.face;
              });
  }
}

// Edges that only the flatness tolerance makes flat.
struct SceneBuilder::DeclaredFlat {
  int count = 0;
  double largest = 0;      // of their angles, radians
  std::vector<int> faces;  // at them, of the file
};

void SceneBuilder::classify_edges() {
  DisjointSets regions(scene.faces_.size());
  bulges.assign(scene.objects_.size(), 1);
  DeclaredFlat declared;
  for (std::size_t i = 0; i < half_edges.size();) {
    stage.at(i, half_edges.size());
    const std::size_t end = i + same_edge(half_edges, i).size();
    i = pass_diagonals(i, end, regions);
    const int count = static_cast<int>(end - i);
    if (count == 0) continue;
    MeshEdge edge{static_cast<int>(i), count, EdgeKind::NonManifold};
    if (count == 1) {
      edge.kind = EdgeKind::Boundary;
    } else if (count == 2 && half_edges[i].forward != half_edges[i + 1].forward) {
      edge.kind = kind_between(half_edges[i], half_edges[i + 1], regions, declared);
    } else {
      bulges[half_edges[i].object] = 0;
      report_non_manifold(edge);
    }
    mesh_edges.push_back(edge);
    i = end;
  }
  count_kinds();
  if (declared.count > 0) report_declared(std::move(declared));
  make_facets(regions);
}

// The two faces are of one facet.
void SceneBuilder::join_flat(int f, int g, bool exact, DisjointSets& regions) {
  regions.unite(f, g);
  if (!exact) inexact_faces.push_back(f);
}

// Cuts inside one polygon of the file are flat by declaration and no mesh edges: the
// pairs are swapped to the front of the group and passed over.  Returns where the rest of
// the group begins.
std::size_t SceneBuilder::pass_diagonals(std::size_t begin, std::size_t end,
                                         DisjointSets& regions) {
  for (std::size_t j = begin; j < end; ++j) {
    if (!half_edges[j].diagonal) continue;
    for (std::size_t k = j + 1; k < end; ++k) {
      hear_stop();
      if (!half_edges[k].diagonal || half_edges[j].forward == half_edges[k].forward ||
          scene.faces_[half_edges[j].face].source !=
              scene.faces_[half_edges[k].face].source) {
        continue;
      }
      const Meeting m = meet(scene, half_edges[j], half_edges[k]);
      join_flat(half_edges[j].face, half_edges[k].face, m.exact, regions);
      if (!m.bulge) bulges[half_edges[j].object] = 0;
      std::swap(half_edges[begin], half_edges[j]);
      std::swap(half_edges[begin + 1], half_edges[k]);
      begin += 2;
      j = begin - 1;
      break;
    }
  }
  return begin;
}

// The kind of an edge with these two faces, which agree about their front.
EdgeKind SceneBuilder::kind_between(const HalfEdge& e, const HalfEdge& f,
                                    DisjointSets& regions, DeclaredFlat& declared) {
  Meeting m = meet(scene, e, f);
  if (m.kind != EdgeKind::Flat && options.flatness > 0) {
    const double angle = angle_between(scene, e.face, f.face);
    if (angle <= options.flatness) {
      m.kind = EdgeKind::Flat;
      ++declared.count;
      declared.largest = std::max(declared.largest, angle);
      declared.faces.push_back(scene.faces_[e.face].source);
      declared.faces.push_back(scene.faces_[f.face].source);
    }
  }
  if (m.kind == EdgeKind::Flat) join_flat(e.face, f.face, m.exact, regions);
  if (!m.bulge) bulges[e.object] = 0;
  return m.kind;
}

void SceneBuilder::report_non_manifold(const MeshEdge& edge) {
  std::vector<int> sources;
  for (int j = edge.first; j < edge.first + edge.count; ++j) {
    sources.push_back(scene.faces_[half_edges[j].face].source);
  }
  const HalfEdge& e = half_edges[edge.first];
  const bool two = edge.count == 2;
  const std::string faces =
      two ? "faces " + std::to_string(sources[0]) + " and " + std::to_string(sources[1])
          : std::to_string(edge.count) + " faces";
  report(two ? "inconsistent orientation" : "non-manifold edge",
         faces + " share " + edge_name(scene, e) +
             (two ? " and run along it the same way" : ""),
         std::move(sources), {scene.vertex_of(e.low), scene.vertex_of(e.high)});
}

void SceneBuilder::report_declared(DeclaredFlat declared) {
  auto& faces = declared.faces;
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  char text[160];
  std::snprintf(text, sizeof text,
                "%d edges are taken as flat, the largest angle is %.3g radians",
                declared.count, declared.largest);
  report("declared flat", text, std::move(faces));
}

// As the file means them: at a face that was turned, a valley was a ridge.
void SceneBuilder::count_kinds() {
  for (const MeshEdge& e : mesh_edges) {
    MeshEdgeCounts& counts = scene.mesh_edges_;
    const bool turned = scene.turned(half_edges[e.first].face);
    ++(e.kind == EdgeKind::Convex     ? (turned ? counts.reflex : counts.convex)
       : e.kind == EdgeKind::Reflex   ? (turned ? counts.convex : counts.reflex)
       : e.kind == EdgeKind::Flat     ? counts.flat
       : e.kind == EdgeKind::Boundary ? counts.boundary
                                      : counts.nonmanifold);
  }
}

void SceneBuilder::make_facets(DisjointSets& regions) {
  for (std::size_t f = 0; f < scene.faces_.size(); ++f) {
    const int first = regions.find(static_cast<int>(f));
    Face& face = scene.faces_[f];
    if (first == static_cast<int>(f)) {
      face.facet = static_cast<int>(scene.facets_.size());
      scene.facets_.push_back({face.object, {}, true});
    } else {
      face.facet = scene.faces_[first].facet;
    }
    scene.facets_[face.facet].faces.push_back(static_cast<int>(f));
  }
  // A face declared coplanar with a neighbour has a point off the neighbour's plane.
  for (const int f : inexact_faces) scene.facets_[scene.faces_[f].facet].planar = false;
}

namespace {

// Chains mesh edges that continue each other straight between the same facets.
struct EdgeJoiner {
  const Scene& scene;
  const std::vector<HalfEdge>& half_edges;
  const std::vector<MeshEdge>& edges;

  std::span<const HalfEdge> sides(int e) const {
    return {half_edges.data() + edges[e].first, static_cast<std::size_t>(edges[e].count)};
  }
  int low(int e) const { return sides(e)[0].low; }
  int high(int e) const { return sides(e)[0].high; }
  int other_end(int e, int p) const { return low(e) == p ? high(e) : low(e); }

  // (facet or face, whether the face runs along the edge as it leads to point p), sorted.
  // Unequal faces of a facet that is not planar have unequal planes: they must not mix.
  std::vector<std::pair<int, bool>> profile(int e, int p) const {
    std::vector<std::pair<int, bool>> found;
    for (const HalfEdge& h : sides(e)) {
      const Face& face = scene.faces()[h.face];
      const int plane = scene.facets()[face.facet].planar ? face.facet : -1 - h.face;
      found.emplace_back(plane, h.forward == (high(e) == p));
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  // The same for edges that continue each other.
  int key(int e) const { return profile(e, low(e)).front().first; }

  bool continues(int e, int f, int p) const {
    if (edges[e].kind != edges[f].kind || edges[e].count != edges[f].count) return false;
    const Point& a = scene.point(other_end(e, p));
    const Point& b = scene.point(p);
    const Point& c = scene.point(other_end(f, p));
    if (!collinear(a, b, c)) return false;
    for (int k = 0; k < 3; ++k) {
      if (a[k] != b[k] && (b[k] > a[k]) != (c[k] > b[k])) return false;
    }
    auto from = profile(e, p);
    auto to = profile(f, p);
    for (auto& side : to) side.second = !side.second;
    std::sort(to.begin(), to.end());
    return from == to;
  }

  // Which edge continues each mesh edge, at its low and at its high end; -1: none.
  // `candidates`: the edges that are not flat.
  std::vector<std::array<int, 2>> followers(std::span<const int> candidates) const;

  // The maximal edge that begins with mesh edge e and goes on both ways as its followers
  // say; `visit` hears of every mesh edge of it but e.
  template <class Visit>
  Edge maximal_edge(int e, std::span<const std::array<int, 2>> follower,
                    Visit&& visit) const;
};

std::vector<std::array<int, 2>> EdgeJoiner::followers(
    std::span<const int> candidates) const {
  // Around each point, the candidates by object and key: two of these may be one,
  // whatever other edges end there.
  struct End {
    int point, object, key, edge;
    auto operator<=>(const End&) const = default;
    [[nodiscard]] bool may_go_on_as(const End& other) const {
      return point == other.point && object == other.object && key == other.key;
    }
  };
  std::vector<End> ends;
  ends.reserve(2 * candidates.size());
  for (const int e : candidates) {
    const int object = sides(e)[0].object, k = key(e);
    ends.push_back({low(e), object, k, e});
    ends.push_back({high(e), object, k, e});
  }
  std::sort(ends.begin(), ends.end());
  std::vector<std::array<int, 2>> follower(edges.size(), {-1, -1});
  for (std::size_t i = 0; i < ends.size();) {
    std::size_t j = i + 1;
    while (j < ends.size() && ends[j].may_go_on_as(ends[i])) ++j;
    const int p = ends[i].point;
    for (std::size_t k = i; k < j; ++k) {
      hear_stop();
      const int e = ends[k].edge;
      int& after = follower[e][high(e) == p];
      for (std::size_t l = k + 1; l < j && after < 0; ++l) {
        const int f = ends[l].edge;
        int& before = follower[f][high(f) == p];
        if (before >= 0 || !continues(e, f, p)) continue;
        after = f;
        before = e;
      }
    }
    i = j;
  }
  return follower;
}

template <class Visit>
Edge EdgeJoiner::maximal_edge(int e, std::span<const std::array<int, 2>> follower,
                              Visit&& visit) const {
  std::array<int, 2> tips{low(e), high(e)};
  for (int& tip : tips) {
    int at = e;
    for (int f; (f = follower[at][high(at) == tip]) >= 0;) {
      visit(f);
      tip = other_end(f, tip);
      at = f;
    }
  }
  Edge edge{{std::min(tips[0], tips[1]), std::max(tips[0], tips[1])},
            edges[e].kind,
            sides(e)[0].object,
            {}};
  const bool turned = tips[0] > tips[1];
  for (const HalfEdge& h : sides(e)) {
    edge.sides.push_back({h.face, h.forward != turned});
  }
  std::sort(edge.sides.begin(), edge.sides.end(),
            [](const Edge::Side& s, const Edge::Side& t) {
              return s.forward != t.forward ? s.forward : s.face < t.face;
            });
  return edge;
}

// Sorts edges by their points, then by object; returns the new number of each.
std::vector<int> sort_edges(std::vector<Edge>& edges) {
  std::vector<int> order(edges.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    const Edge &a = edges[i], &b = edges[j];
    if (a.points != b.points) return a.points < b.points;
    return a.object != b.object ? a.object < b.object : i < j;
  });
  std::vector<Edge> sorted;
  sorted.reserve(order.size());
  std::vector<int> number(order.size());
  for (const int i : order) {
    number[i] = static_cast<int>(sorted.size());
    sorted.push_back(std::move(edges[i]));
  }
  edges = std::move(sorted);
  return number;
}

}  // namespace

void SceneBuilder::join_edges() {
  const EdgeJoiner joiner{scene, half_edges, mesh_edges};
  std::vector<int> candidates;  // not flat
  for (std::size_t e = 0; e < mesh_edges.size(); ++e) {
    if (mesh_edges[e].kind != EdgeKind::Flat) candidates.push_back(static_cast<int>(e));
  }
  const std::vector<std::array<int, 2>> follower = joiner.followers(candidates);
  std::vector<int> edge_of(mesh_edges.size(), -1);  // maximal edge of each mesh edge
  scene.edges_.reserve(candidates.size());
  for (const int e : candidates) {
    stage.at(static_cast<std::size_t>(e), mesh_edges.size());
    if (edge_of[e] >= 0) continue;
    const int id = static_cast<int>(scene.edges_.size());
    edge_of[e] = id;
    scene.edges_.push_back(
        joiner.maximal_edge(e, follower, [&](int f) { edge_of[f] = id; }));
  }
  const std::vector<int> number = sort_edges(scene.edges_);
  for (const int e : candidates) edge_of[e] = number[edge_of[e]];
  name_sides(edge_of);
  index_edges();
}

// Tells each side of a face its maximal edge; `edge_of` by mesh edge, -1: flat.
void SceneBuilder::name_sides(std::span<const int> edge_of) {
  scene.side_edges_.assign(scene.corners_.size(), -1);
  for (std::size_t e = 0; e < mesh_edges.size(); ++e) {
    if (edge_of[e] < 0) continue;
    const MeshEdge& edge = mesh_edges[e];
    for (int i = edge.first; i < edge.first + edge.count; ++i) {
      const HalfEdge& h = half_edges[i];
      const Face& face = scene.faces_[h.face];
      const int from = h.forward ? h.low : h.high;
      const int to = h.forward ? h.high : h.low;
      hear_stop();
      for (int k = 0; k < face.corner_count; ++k) {
        if (scene.corners_[face.first_corner + k] == from &&
            scene.corners_[face.first_corner + (k + 1) % face.corner_count] == to) {
          scene.side_edges_[face.first_corner + k] = edge_of[e];
        }
      }
    }
  }
}

// Lists the edges at each point, and the points at which some edge ends: the corners.
void SceneBuilder::index_edges() {
  auto& starts = scene.edge_starts_;
  starts.assign(scene.points_.size() + 1, 0);
  for (const Edge& edge : scene.edges_) {
    for (const int p : edge.points) ++starts[p + 1];
  }
  for (std::size_t p = 0; p + 1 < starts.size(); ++p) {
    if (starts[p + 1] > 0) scene.corner_points_.push_back(static_cast<int>(p));
  }
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  scene.edge_ids_.resize(2 * scene.edges_.size());
  std::vector<int> next(starts.begin(), starts.end() - 1);
  for (std::size_t e = 0; e < scene.edges_.size(); ++e) {
    for (const int p : scene.edges_[e].points) {
      scene.edge_ids_[next[p]++] = static_cast<int>(e);
    }
  }
}

}  // namespace sightline::internal
