// Which edges can be generators, and what lines do at them.

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>

#include "linespace/sight/free_segment.h"
#include "linespace/silhouettes/drawn.h"
#include "linespace/silhouettes/silhouettes.h"
#include "linespace/work/parallel.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

// How a face of another object, or of the same one elsewhere, meets the open edge.
// Pierced: in one point inside the face's facet, which it lies across.
enum class EdgeTouch : std::uint8_t { None, Pierced, Touches, ContainsInside };

// Where face f, which is not one of the edge's own, meets the open segment e0 e1.
EdgeTouch touch_of(const Scene& scene, const PlaneSide& plane, int f, const Point& e0,
                   const Point& e1) {
  const Sign s0 = plane(e0);
  const Sign s1 = plane(e1);
  const auto corners = scene.face_points(f);
  const std::size_t n = corners.size();
  // 1. The edge is not in the face's plane.  An end in that plane is no inner point: such
  // an edge meets nothing here.
  if (s0 != Sign::Zero || s1 != Sign::Zero) {
    if (s0 == s1 || s0 == Sign::Zero || s1 == Sign::Zero) return EdgeTouch::None;
    // Crosses the plane inside: within the closed polygon unless it passes some side on
    // the outside.
    bool at_edge = false;
    for (std::size_t k = 0; k < n; ++k) {
      const Sign s =
          orient3d(scene.point(corners[k]), scene.point(corners[(k + 1) % n]), e0, e1);
      // The edge meets a side of the face: that counts unless the side is flat.
      if (s == Sign::Zero) {
        at_edge |= scene.edge_of_side(f, static_cast<int>(k)) >= 0;
        continue;
      }
      // Seen from the front a line going to the back passes inside on the left.
      const Sign inside = s0 == Sign::Positive ? Sign::Negative : Sign::Positive;
      if (s != inside) return EdgeTouch::None;
    }
    return at_edge ? EdgeTouch::Touches : EdgeTouch::Pierced;
  }
  // 2. Coplanar: clip combinatorially.  Outside some side as a whole: no touch.
  const InPlaneSide left_of(scene, f);
  // How many sides each end is outside of: none for an end within the face.
  bool along_side = false;
  int outside_ends[2] = {0, 0};
  for (std::size_t k = 0; k < n; ++k) {
    const Point& p = scene.point(corners[k]);
    const Point& q = scene.point(corners[(k + 1) % n]);
    const Sign a = left_of(p, q, e0);
    const Sign b = left_of(p, q, e1);
    if (a == Sign::Zero && b == Sign::Zero) {
      along_side = true;
      continue;
    }
    if (a != Sign::Positive && b != Sign::Positive) return EdgeTouch::None;
    outside_ends[0] += a == Sign::Negative;
    outside_ends[1] += b == Sign::Negative;
  }
  // A segment that crosses two sides' lines outside the polygon is found out by the
  // polygon's corners all lying on one side of it.
  bool left = false, right = false;
  for (const int c : corners) {
    const Sign s = left_of(e0, e1, scene.point(c));
    left |= s == Sign::Positive;
    right |= s == Sign::Negative;
  }
  if (along_side) return EdgeTouch::Touches;
  if (!left || !right) {
    // At most a corner of the polygon lies on the open segment.
    return EdgeTouch::Touches;
  }
  // 3. Both ends within the face: all of the edge is inside of it.
  return outside_ends[0] == 0 && outside_ends[1] == 0 ? EdgeTouch::ContainsInside
                                                      : EdgeTouch::Touches;
}

// The stretch of the edge e0 e1, as parameters, that lies in a coplanar face's closed
// polygon; nullopt when it is a point at most, or runs along a side that is not flat.
std::optional<std::array<Rational, 2>> stretch_inside(const Scene& scene, int f,
                                                      const Point& e0, const Point& e1) {
  const InPlaneSide left_of(scene, f);
  const auto corners = scene.face_points(f);
  const int n = static_cast<int>(corners.size());
  Rational low = 0;
  Rational high = 1;
  for (int k = 0; k < n; ++k) {
    const Point& p = scene.point(corners[k]);
    const Point& q = scene.point(corners[(k + 1) % n]);
    const Sign a = left_of(p, q, e0);
    const Sign b = left_of(p, q, e1);
    if (a == Sign::Zero && b == Sign::Zero && scene.edge_of_side(f, k) >= 0) {
      return std::nullopt;
    }
    if (a != Sign::Negative && b != Sign::Negative) continue;
    if (a != Sign::Positive && b != Sign::Positive) return std::nullopt;
    const Rational x = left_of.value(p, q, e0);
    const Rational y = left_of.value(p, q, e1);
    const Rational s = x / (x - y);
    if (a == Sign::Negative) low = std::max(low, s);
    if (b == Sign::Negative) high = std::min(high, s);
  }
  if (low >= high) return std::nullopt;
  return std::array<Rational, 2>{low, high};
}

// The stretches cover the whole edge.
bool cover_edge(std::vector<std::array<Rational, 2>> stretches) {
  std::sort(stretches.begin(), stretches.end());
  Rational reached = 0;
  for (const auto& [from, to] : stretches) {
    if (from > reached) return false;
    reached = std::max(reached, to);
  }
  return reached >= 1;
}

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
  std::vector<Box> boxes;
  // Edges are looked at in parallel, some at a time; ridges are added in their order.
  constexpr std::size_t kAtOnce = 1 << 16;
  std::vector<EdgeFaces> looked_at;
  for (std::size_t first = 0; first < edges.size(); first += kAtOnce) {
    const std::size_t last = std::min(first + kAtOnce, edges.size());
    looked_at.assign(last - first, {});
    for_each_of(first, last, edges.size(), request, stage, [&](std::size_t i) {
      looked_at[i - first] = look_at_edge(static_cast<int>(i));
    });
    for (std::size_t i = first; i < last; ++i) {
      hear_stop();
      add_edge(static_cast<int>(i), looked_at[i - first], boxes);
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

// The faces at the edge, the gap between them, and what other faces touch the edge.
Silhouettes::EdgeFaces Silhouettes::look_at_edge(int edge) const {
  const Scene& s = *scene_;
  const Edge& e = s.edges()[edge];
  const Point& e0 = s.point(e.points[0]);
  const Point& e1 = s.point(e.points[1]);
  // The third point of each face at the edge gives the direction of its half-plane.
  EdgeFaces at;
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
  if (!at.has_gap() && !polygon()) return at;
  // In a closed object the gap must be outside: fronts face it.
  const bool closed = solid_behind(e.sides[0].face);
  at.reflex = closed && at.thirds.size() > 1 && e.kind == EdgeKind::Reflex;
  if (at.reflex && !polygon()) return at;
  if (closed && e.kind == EdgeKind::NonManifold && at.has_gap() &&
      !fronts_face_gap(e, at)) {
    if (!polygon()) return at;
    at.a = at.b = -1;
  }
  find_touching(e, at);
  return at;
}

// The half-plane at the edge to one side of which all others strictly are: a position in
// at.thirds, -1 when there is none.
int Silhouettes::extreme_half_plane(const Edge& e, const EdgeFaces& at,
                                    Sign wanted) const {
  const Scene& s = *scene_;
  const Point& e0 = s.point(e.points[0]);
  const Point& e1 = s.point(e.points[1]);
  for (std::size_t k = 0; k < at.thirds.size(); ++k) {
    hear_stop_now();
    bool ok = true;
    for (std::size_t l = 0; l < at.thirds.size() && ok; ++l) {
      if (l == k) continue;
      const Sign t = orient3d(e0, e1, s.point(at.thirds[k]), s.point(at.thirds[l]));
      if (t == Sign::Zero) {
        // Same half-plane or the opposite one: told apart by any plane through the edge
        // other than theirs.
        const InPlaneSide left_of(s, at.faces[k]);
        ok = left_of(e0, e1, s.point(at.thirds[k])) ==
             left_of(e0, e1, s.point(at.thirds[l]));
      } else {
        ok = t == wanted;
      }
    }
    if (ok) return static_cast<int>(k);
  }
  return -1;
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
void Silhouettes::find_touching(const Edge& e, EdgeFaces& at) const {
  const Scene& s = *scene_;
  const Point& e0 = s.point(e.points[0]);
  const Point& e1 = s.point(e.points[1]);
  const Box box = box_of(std::array<Point, 2>{e0, e1});
  EdgeTouch touched = EdgeTouch::None;
  std::vector<std::array<Rational, 2>> stretches;
  std::vector<int> grounds;  // faces that contain a part of the edge
  const auto is_own = [&](int f) {
    // Faces along a chain of mesh edges merged into this one are its own.
    return std::any_of(at.faces.begin(), at.faces.end(), [&](int own) {
      return s.faces()[own].facet == s.faces()[f].facet;
    });
  };
  face_tree_.traverse(
      [&](const Box& other) {
        return (polygon() || touched != EdgeTouch::ContainsInside) &&
               boxes_meet(box, other);
      },
      [&](std::uint32_t item) {
        hear_stop();
        const int f = static_cast<int>(item);
        if (!polygon() && touched == EdgeTouch::ContainsInside) return;
        if (is_own(f)) return;
        const EdgeTouch touch = touch_of(s, face_planes_[f], f, e0, e1);
        touched = std::max(touched, touch);
        if (touch == EdgeTouch::Pierced) at.pierced_by.push_back(f);
        if (touch == EdgeTouch::ContainsInside) grounds.push_back(f);
        if (touch == EdgeTouch::Touches && face_planes_[f](e0) == Sign::Zero &&
            face_planes_[f](e1) == Sign::Zero) {
          if (const auto stretch = stretch_inside(s, f, e0, e1))
            stretches.push_back(*stretch), grounds.push_back(f);
        }
      });
  const bool covered = cover_edge(std::move(stretches));
  const bool inside_faces = covered || touched == EdgeTouch::ContainsInside;
  // The foot of a wall is a valley of the union; what hangs below an open floor too.
  at.foot = polygon() && inside_faces &&
            std::any_of(grounds.begin(), grounds.end(), [&](int f) {
              const bool solid = solid_behind(f);
              return std::any_of(at.thirds.begin(), at.thirds.end(), [&](int p) {
                const Sign side = face_planes_[f](s.point(p));
                return side == Sign::Positive || (!solid && side == Sign::Negative);
              });
            });
  at.touched = touched == EdgeTouch::Pierced || touched == EdgeTouch::Touches || at.foot;
  if (touched != EdgeTouch::Pierced) at.pierced_by.clear();
  at.buried = buried_stretches(e.points, at.pierced_by);
  const bool all_buried = touched == EdgeTouch::None && untouched_in_material(e.points);
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
    const std::int32_t first = ridge.edge;
    ridges_.pop_back();
    add_ridge(edge, at, unused);
    ridges_.back().objects = std::move(objects);
    ridges_.back().touched = true;
    const bool crease = shows_crease(e.points, first, edge);
    ridges_.back().ends_in_front = ridges_.back().ends_behind = crease;
    ridges_.back().any_side = crease;
    return true;
  }
  const bool crease = shows_crease(e.points, std::min(ridge.edge, edge), edge);
  ridge.ends_in_front = ridge.ends_behind = ridge.any_side = crease;
  return true;
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
