// Which edges can be generators, and what lines do at them.

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>

#include "linespace/sight/free_segment.h"
#include "linespace/silhouettes/drawn.h"
#include "linespace/silhouettes/edge_touches.h"
#include "linespace/silhouettes/silhouettes.h"
#include "linespace/work/parallel.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

// Of all faces at the edge and at those that coincide with it, which are its neighbours
// in the scene's order; ridges or not.
std::vector<std::int32_t> facets_along(const Scene& scene, int edge) {
  const auto edges = scene.edges();
  const auto coincides = [&](int k) {
    return k >= 0 && k < static_cast<int>(edges.size()) &&
           edges[k].points == edges[edge].points;
  };
  int first = edge;
  while (coincides(first - 1)) --first;
  std::vector<std::int32_t> facets;
  for (int k = first; coincides(k); ++k) {
    for (const Edge::Side& side : edges[k].sides) {
      facets.push_back(scene.faces()[side.face].facet);
    }
  }
  sort_unique(facets);
  return facets;
}

}  // namespace

struct Silhouettes::EdgeFaces {
  std::vector<std::int32_t> thirds, faces;  // a point of each half-plane, its face
  int a = -1, b = -1;                       // those that bound a gap of more than half
  bool reflex = false;                      // of a closed object: that gap is inside
  bool touched = false, foot = false;
  std::vector<std::int32_t> pierced_by = {};  // as of Ridge
  std::vector<BuriedStretch> buried = {};     // as of Ridge
  bool many = false;                          // polygon mode: more than two half-planes
  bool is_ridge = false;  // of its own, or a part of the one before it
  [[nodiscard]] bool has_gap() const { return a >= 0 && b >= 0; }
};

void Silhouettes::find_ridges(const Request& request, Stage& stage) {
  const auto edges = scene_->edges();
  ridge_of_edge_.assign(edges.size(), -1);
  // Edges between the same points follow each other; where each such group begins.
  std::vector<int> groups;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i == 0 || edges[i].points != edges[i - 1].points) {
      groups.push_back(static_cast<int>(i));
    }
  }
  groups.push_back(static_cast<int>(edges.size()));
  std::vector<Box> boxes;
  // Groups are looked at in parallel, some at a time; ridges are added in their order.
  constexpr std::size_t kAtOnce = 1 << 16;
  const std::size_t count = groups.size() - 1;
  std::vector<EdgeFaces> looked_at;
  for (std::size_t first = 0; first < count; first += kAtOnce) {
    const std::size_t last = std::min(first + kAtOnce, count);
    const int first_edge = groups[first];
    looked_at.assign(groups[last] - first_edge, {});
    for_each_of(first, last, count, request, stage, [&](std::size_t i) {
      const std::size_t size = groups[i + 1] - groups[i];
      look_at_edges(groups[i], {looked_at.data() + groups[i] - first_edge, size});
    });
    for (std::size_t i = first; i < last; ++i) {
      for (int edge = groups[i]; edge < groups[i + 1]; ++edge) {
        hear_stop();
        add_edge(edge, looked_at[edge - first_edge], boxes);
      }
      find_joined_crease(groups[i], groups[i + 1]);
    }
  }
  ridge_tree_ = Bvh(boxes);
  constexpr int kGroup = 32;  // speed only
  ridge_groups_ = ridge_groups(ridge_tree_, kGroup);
  ridge_sides_.reserve(ridges_.size());
  for (const std::uint32_t i : ridge_tree_.items()) {
    ridge_sides_.emplace_back(*scene_, ridges_[i]);
  }
}

// The edge becomes a ridge, or a part of one, or nothing.
void Silhouettes::add_edge(int edge, const EdgeFaces& at, std::vector<Box>& boxes) {
  if (!at.is_ridge) return;
  // Edges of several objects that coincide are one generator.
  if (join_ridge(edge, at)) return;
  ridge_of_edge_[edge] = static_cast<int>(ridges_.size());
  if (at.many && !at.touched) {
    add_gaps(edge, at, boxes);
  } else {
    add_ridge(edge, at, boxes);
  }
  if (ridge_of_edge_[edge] == static_cast<int>(ridges_.size())) ridge_of_edge_[edge] = -1;
}

// At edges between the same points, from `first` on: the faces, the gap between them, and
// what other faces touch them.
void Silhouettes::look_at_edges(int first, std::span<EdgeFaces> found) const {
  std::optional<EdgeTouches> touches;
  for (std::size_t i = 0; i < found.size(); ++i) {
    hear_stop();
    const Edge& e = scene_->edges()[first + i];
    EdgeFaces& at = found[i];
    if (!look_at_own_faces(e, at)) continue;
    // Faces along a chain of mesh edges merged into this one are its own.
    std::vector<std::int32_t> own;
    for (const int f : at.faces) own.push_back(scene_->faces()[f].facet);
    sort_unique(own);
    if (found.size() == 1) {
      find_touching(e, EdgeTouches(*this, e.points, own).without({}), at);
    } else {
      if (!touches) touches.emplace(*this, e.points, std::span<const std::int32_t>{});
      find_touching(e, touches->without(own), at);
    }
  }
}

// The faces at the edge and the gap between them; false where no line has a contact.
bool Silhouettes::look_at_own_faces(const Edge& e, EdgeFaces& at) const {
  const Scene& s = *scene_;
  const Point& e0 = s.point(e.points[0]);
  const Point& e1 = s.point(e.points[1]);
  // The third point of each face at the edge gives the direction of its half-plane.
  for (const Edge::Side& side : e.sides) {
    for (const int p : s.face_points(side.face)) {
      if (collinear(e0, e1, s.point(p))) continue;
      at.thirds.push_back(p);
      at.faces.push_back(side.face);
      break;
    }
  }
  if (polygon() && at.thirds.size() > 2) {
    EdgeFan fan(*this, e0, e1);
    for (const int f : at.faces) fan.add(f);
    fan.close();
    at.many = fan.leaves().size() > 2;
  }
  at.a = extreme_half_plane(e, at, Sign::Positive);
  at.b = extreme_half_plane(e, at, Sign::Negative);
  if (!at.has_gap() && !polygon()) return false;
  // In a closed object the gap must be outside: fronts face it.
  const bool closed = solid_behind(e.sides[0].face);
  at.reflex = closed && at.thirds.size() > 1 && e.kind == EdgeKind::Reflex;
  if (at.reflex && !polygon()) return false;
  if (closed && e.kind == EdgeKind::NonManifold && at.has_gap() &&
      !fronts_face_gap(e, at)) {
    if (!polygon()) return false;
    at.a = at.b = -1;
  }
  return true;
}

// The half-plane at the edge to one side of which all others strictly are: a position in
// at.thirds, -1 when there is none.
int Silhouettes::extreme_half_plane(const Edge& e, const EdgeFaces& at,
                                    Sign wanted) const {
  const Scene& s = *scene_;
  const Point& e0 = s.point(e.points[0]);
  const Point& e1 = s.point(e.points[1]);
  const auto beyond = [&](std::size_t k, std::size_t l) {
    hear_stop();
    const Sign t = orient3d(e0, e1, s.point(at.thirds[k]), s.point(at.thirds[l]));
    if (t != Sign::Zero) return t == wanted;
    // Same half-plane or the opposite one: told apart by any plane through the edge
    // other than theirs.
    const InPlaneSide left_of(s, at.faces[k]);
    return left_of(e0, e1, s.point(at.thirds[k])) ==
           left_of(e0, e1, s.point(at.thirds[l]));
  };
  if (at.thirds.empty()) return -1;
  // A half-plane that has some other on its wrong side is none, and that other, which the
  // one asked for has on its right side, stands in for it: one pass leaves one candidate.
  std::size_t k = 0;
  for (std::size_t l = 1; l < at.thirds.size(); ++l) {
    if (!beyond(k, l)) k = l;
  }
  for (std::size_t l = 0; l < at.thirds.size(); ++l) {
    if (l != k && !beyond(k, l)) return -1;
  }
  return static_cast<int>(k);
}

// Some face in half-plane a shows its front to the gap.
bool Silhouettes::fronts_face_gap(const Edge& e, const EdgeFaces& at) const {
  const Scene& s = *scene_;
  const Point& e0 = s.point(e.points[0]);
  const Point& e1 = s.point(e.points[1]);
  for (std::size_t k = 0; k < at.thirds.size(); ++k) {
    const Point& third = s.point(at.thirds[k]);
    if (orient3d(e0, e1, s.point(at.thirds[at.a]), third) != Sign::Zero) continue;
    // The wedge is where e0, e1, third appear counter-clockwise.
    const InPlaneSide left_of(s, at.faces[k]);
    if (left_of(e0, e1, third) == Sign::Negative) return true;
  }
  return false;
}

// How faces that are not the edge's own touch it, and what it can become.
void Silhouettes::find_touching(const Edge& e, ForeignTouch found, EdgeFaces& at) const {
  const EdgeMeeting touched = found.touched;
  const bool inside_faces = found.covered || touched == EdgeMeeting::ContainsInside;
  // The foot of a wall is a valley of the union; what hangs below an open floor too.
  at.foot = polygon() && inside_faces && std::ranges::any_of(found.grounds, [&](int f) {
              const bool solid = solid_behind(f);
              return std::ranges::any_of(at.thirds, [&](int p) {
                const Sign side = face_planes_[f](scene_->point(p));
                return side == Sign::Positive || (!solid && side == Sign::Negative);
              });
            });
  at.touched =
      touched == EdgeMeeting::Pierced || touched == EdgeMeeting::Touches || at.foot;
  at.pierced_by = std::move(found.pierced_by);
  at.buried = buried_stretches(e.points, at.pierced_by);
  const bool all_buried = touched == EdgeMeeting::None && untouched_in_material(e.points);
  at.is_ridge = (!inside_faces || at.foot) && !all_buried;
}

// Whether an edge that faces of other objects touch at its ends at most is in material.
bool Silhouettes::untouched_in_material(std::array<std::int32_t, 2> points) const {
  bool on_surfaces = true;  // both ends
  for (const int p : points) {
    if (inside_material(p)) return true;
    const int star = star_of_point_[p];
    on_surfaces = on_surfaces && star >= 0 && stars_[star].touched;
  }
  return on_surfaces &&
         in_material(along(exact_point(scene_->point(points[0])),
                           exact_point(scene_->point(points[1])), Rational(1, 2)));
}

// To the ridge of an edge with the same ends, found before.
bool Silhouettes::join_ridge(int edge, const EdgeFaces& at) {
  const Edge& e = scene_->edges()[edge];
  if (ridges_.empty() || ridges_.back().points != e.points) return false;
  Ridge& ridge = ridges_.back();
  ridge.touched = true;
  ridge.pierced_by.clear();
  ridge.buried.clear();
  ridge.objects.push_back(e.object);
  ridge_of_edge_[edge] = static_cast<int>(ridges_.size() - 1);
  if (!polygon()) return true;
  // Named and grazed as in solid mode, which knows only edges that lines graze.
  const bool grazes = at.has_gap() && !at.reflex && !at.foot;
  if (!ridge.can_graze() && grazes) {
    std::vector<Box> unused;
    std::vector<std::int32_t> objects = std::move(ridge.objects);
    ridges_.pop_back();
    add_ridge(edge, at, unused);
    ridges_.back().objects = std::move(objects);
    ridges_.back().touched = true;
  }
  return true;
}

// Lines can end at a ridge that several edges joined, those numbered from `first` up to
// `end`, where the union of their faces has a crease.
void Silhouettes::find_joined_crease(int first, int end) {
  if (!polygon() || ridges_.empty()) return;
  Ridge& ridge = ridges_.back();
  if (ridge.points != scene_->edges()[first].points || ridge.objects.size() < 2) return;
  ridge.ends_in_front = ridge.ends_behind = ridge.any_side =
      shows_crease(ridge.points, first, end - 1);
}

// Of all edges between those ends with such numbers: lines can end there.
bool Silhouettes::shows_crease(std::array<std::int32_t, 2> points,
                               std::int32_t first_edge, std::int32_t last_edge) const {
  EdgeFan fan(*this, scene_->point(points[0]), scene_->point(points[1]));
  for (std::int32_t k = first_edge; k <= last_edge; ++k) {
    if (scene_->edges()[k].points != points) continue;
    for (const Edge::Side& side : scene_->edges()[k].sides) fan.add(side.face);
  }
  fan.close();
  return std::any_of(fan.sectors().begin(), fan.sectors().end(), [](const auto& s) {
    return s.free && s.turn != EdgeFan::Turn::Flat && s.from != s.to;
  });
}

// One ridge for the edge, whose gap is that between faces a and b.
void Silhouettes::add_ridge(int edge, const EdgeFaces& at, std::vector<Box>& boxes) {
  const Scene& s = *scene_;
  const Edge& e = s.edges()[edge];
  const Point& e0 = s.point(e.points[0]);
  const Point& e1 = s.point(e.points[1]);
  const auto& thirds = at.thirds;
  if (!at.has_gap() && !at.many) return;
  const auto a = static_cast<std::size_t>(at.has_gap() ? at.a : 0);
  const auto b = static_cast<std::size_t>(at.has_gap() ? at.b : 1);
  // Behind both planes is the wedge.
  ridges_.push_back({edge,
                     {e.object},
                     e.points,
                     PlaneSide({e1, e0, s.point(thirds[a])}),
                     PlaneSide({e0, e1, s.point(thirds[b])}),
                     {thirds[a], thirds[b]},
                     {s.faces()[at.faces[a]].facet, s.faces()[at.faces[b]].facet},
                     facets_along(s, edge),
                     at.touched});
  ridges_.back().pierced_by = at.pierced_by;
  ridges_.back().buried = at.buried;
  boxes.push_back(box_of(std::array<Point, 2>{e0, e1}));
  if (!polygon()) return;
  Ridge& ridge = ridges_.back();
  ridge.grazes = at.has_gap() && !at.reflex;
  ridge.foot = at.foot;
  const bool closed = solid_behind(e.sides[0].face);
  const bool crease = thirds.size() > 1 || at.touched;
  ridge.ends_in_front = (crease && !at.reflex) || at.many;
  ridge.ends_behind = (crease && (at.reflex || !closed)) || at.many;
  ridge.any_side = at.many;
}

// Of an edge with three faces or more, touched by no others: one ridge for each gap in
// which something is to be seen.
void Silhouettes::add_gaps(int edge, const EdgeFaces& at, std::vector<Box>& boxes) {
  const Scene& s = *scene_;
  const Edge& e = s.edges()[edge];
  if (at.has_gap() && !at.reflex) {
    add_ridge(edge, at, boxes);
    ridges_.back().ends_behind = ridges_.back().any_side = false;
  }
  const Point& e0 = s.point(e.points[0]);
  const Point& e1 = s.point(e.points[1]);
  EdgeFan fan(*this, e0, e1);
  for (const int face : at.faces) fan.add(face);
  fan.close();
  const auto sectors = fan.sectors();
  const auto narrow = [](const EdgeFan::Sector& x) {
    return x.free && x.turn == EdgeFan::Turn::Narrow;
  };
  for (std::size_t k = 0; k < sectors.size(); ++k) {
    const EdgeFan::Sector& sector = sectors[k];
    if (!narrow(sector)) continue;
    const EdgeFan::Leaf& a = fan.leaves()[sector.from];
    const EdgeFan::Leaf& b = fan.leaves()[sector.to];
    Ridge ridge{edge,
                {e.object},
                e.points,
                PlaneSide({e1, e0, s.point(a.third)}),
                PlaneSide({e0, e1, s.point(b.third)}),
                {a.third, b.third},
                {a.facet, b.facet},
                facets_along(s, edge),
                false};
    ridge.grazes = false;
    ridge.ends_behind = true;
    // Lines along a leaf between two gaps are told once.
    const EdgeFan::Sector& before = sectors[(k + sectors.size() - 1) % sectors.size()];
    ridge.ends_along = {fan.ends_along(sector.from) && !narrow(before),
                        fan.ends_along(sector.to)};
    ridges_.push_back(std::move(ridge));
    boxes.push_back(box_of(std::array<Point, 2>{e0, e1}));
  }
}

}  // namespace sightline::internal
