#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <optional>

#include "linespace/transversals_internal.h"
#include "skeleton/drawn_internal.h"
#include "skeleton/generators_internal.h"

namespace sightline::internal {
namespace {

Box box_between(const Point& p, const Point& q) {
  const std::array<Point, 2> both{p, q};
  return box_of(both);
}

Box box_of_face(const Scene& scene, int face) {
  std::vector<Point> points;
  for (const int p : scene.face_points(face)) points.push_back(scene.point(p));
  return box_of(points);
}

std::vector<Box> boxes_of_faces(const Scene& scene) {
  std::vector<Box> boxes;
  boxes.reserve(scene.faces().size());
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    boxes.push_back(box_of_face(scene, static_cast<int>(f)));
  }
  return boxes;
}

bool has_point(const Scene& scene, int face, int point) {
  const auto p = scene.face_points(face);
  return std::find(p.begin(), p.end(), point) != p.end();
}

// Same ray from the origin: collinear, and not opposite.
bool same_direction(const Point& origin, const Point& p, const Point& q) {
  if (!collinear(origin, p, q)) return false;
  for (int i = 0; i < 3; ++i) {
    if (p[i] != origin[i])
      return (p[i] > origin[i]) == (q[i] > origin[i]) && q[i] != origin[i];
  }
  return false;
}

bool parallel(const RingVector& a, const RingVector& b) {
  return is_zero(a[1] * b[2] - a[2] * b[1]) && is_zero(a[2] * b[0] - a[0] * b[2]) &&
         is_zero(a[0] * b[1] - a[1] * b[0]);
}

// How a face of another object, or of the same one elsewhere, meets the open edge.
enum class EdgeTouch : std::uint8_t { None, Touches, ContainsInside };

}  // namespace

bool boxes_meet(const Box& a, const Box& b) {
  for (int i = 0; i < 3; ++i) {
    if (a.min[i] > b.max[i] || a.max[i] < b.min[i]) return false;
  }
  return true;
}

InPlaneSide::InPlaneSide(const Scene& scene, int face) {
  const auto corners = scene.face_points(face);
  const Point& a = scene.point(corners[0]);
  const Point& b = scene.point(corners[1]);
  const Point& c = scene.point(corners[2]);
  const Point n = (b - a).cross(c - a);
  n.cwiseAbs().maxCoeff(&axis_);
  // The rounded normal only proposes the axis; take the first that really works.
  for (int tried = 0; tried < 3; ++tried, axis_ = (axis_ + 1) % 3) {
    orientation_ = Sign::Positive;
    orientation_ = (*this)(a, b, c);
    if (orientation_ != Sign::Zero) return;
  }
}

Sign InPlaneSide::operator()(const Point& p, const Point& q, const Point& x) const {
  // Any point above p on the axis spans the same plane with p and q: exactness does not
  // depend on which one.
  Point above = p;
  above[axis_] = p[axis_] > 0 ? -p[axis_] : (p[axis_] < 0 ? -p[axis_] : 1.0);
  const Sign s = orient3d(p, q, above, x);
  return (above[axis_] > p[axis_] ? s : -s) * orientation_;
}

PointInFace locate_in_plane(const Scene& scene, int face, const Point& x) {
  const InPlaneSide left_of(scene, face);
  const auto corners = scene.face_points(face);
  bool boundary = false;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Point& p = scene.point(corners[k]);
    const Point& q = scene.point(corners[(k + 1) % corners.size()]);
    const Sign s = left_of(p, q, x);
    if (s == Sign::Negative) return PointInFace::Outside;
    if (s == Sign::Zero) boundary = true;
  }
  return boundary ? PointInFace::Boundary : PointInFace::Inside;
}

namespace {

// Where face f, which is not one of the edge's own, meets the open segment e0 e1.
EdgeTouch touch_of(const Scene& scene, const PlaneSide& plane, int f, const Point& e0,
                   const Point& e1) {
  const Sign s0 = plane(e0);
  const Sign s1 = plane(e1);
  const auto corners = scene.face_points(f);
  const std::size_t n = corners.size();
  if (s0 != Sign::Zero || s1 != Sign::Zero) {
    if (s0 == s1 || s0 == Sign::Zero || s1 == Sign::Zero) return EdgeTouch::None;
    // Crosses the plane inside: within the closed polygon unless it passes some side on
    // the outside.
    for (std::size_t k = 0; k < n; ++k) {
      const Sign s =
          orient3d(scene.point(corners[k]), scene.point(corners[(k + 1) % n]), e0, e1);
      if (s == Sign::Zero) continue;
      // Seen from the front a line going to the back passes inside on the left.
      const Sign inside = s0 == Sign::Positive ? Sign::Negative : Sign::Positive;
      if (s != inside) return EdgeTouch::None;
    }
    return EdgeTouch::Touches;
  }
  // Coplanar: clip combinatorially.  Outside some side as a whole: no touch.
  const InPlaneSide left_of(scene, f);
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

}  // namespace

Rational InPlaneSide::value(const Point& p, const Point& q, const Point& x) const {
  const int i = (axis_ + 1) % 3;
  const int j = (axis_ + 2) % 3;
  return (Rational(q[i]) - Rational(p[i])) * (Rational(x[j]) - Rational(p[j])) -
         (Rational(q[j]) - Rational(p[j])) * (Rational(x[i]) - Rational(p[i]));
}

Generators::Generators(const Scene& scene, int /*threads*/, EventMode events)
    : scene_(&scene),
      events_(events),
      face_boxes_(boxes_of_faces(scene)),
      face_tree_(face_boxes_),
      ridge_tree_(std::vector<Box>{}) {
  face_planes_.reserve(scene.faces().size());
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    face_planes_.emplace_back(face_plane_through(scene, static_cast<int>(f)));
  }
  object_starts_.assign(scene.points().size() + 1, 0);
  for (std::size_t p = 0; p < scene.points().size(); ++p) {
    std::vector<std::int32_t> ids;
    for (const int f : scene.faces_at(static_cast<int>(p)))
      ids.push_back(scene.faces()[f].object);
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    object_ids_.insert(object_ids_.end(), ids.begin(), ids.end());
    object_starts_[p + 1] = static_cast<std::int32_t>(object_ids_.size());
  }
  find_convex_solids();
  find_outlines();
  find_ridges();
  find_stars();
  find_inside();
  find_aligned();
}

void Generators::find_convex_solids() {
  const Scene& s = *scene_;
  convex_.assign(s.objects().size(), 0);
  std::vector<std::uint8_t> all_convex(s.objects().size(), 1);
  for (const Edge& e : s.edges()) {
    if (e.kind != EdgeKind::Convex) all_convex[e.object] = 0;
  }
  for (std::size_t o = 0; o < s.objects().size(); ++o) {
    const Object& object = s.objects()[o];
    if (object.convex) {
      convex_[o] = 1;
      continue;
    }
    // Folds by an ulp inside a facet do not count: every point lies behind every plane
    // but those of its own facets.
    if (!object.closed || !all_convex[o] || object.faces.size() > 400) continue;
    bool ok = true;
    for (std::size_t i = 0; i < object.faces.size() && ok; ++i) {
      const int f = object.faces[i];
      for (std::size_t j = 0; j < object.faces.size() && ok; ++j) {
        const int g = object.faces[j];
        if (s.faces()[g].facet == s.faces()[f].facet) continue;
        for (const int p : s.face_points(g)) {
          if (face_planes_[f](s.point(p)) != Sign::Positive) continue;
          const auto near = s.faces_at(p);
          ok = ok && std::any_of(near.begin(), near.end(), [&](int h) {
                 return s.faces()[h].facet == s.faces()[f].facet;
               });
        }
      }
    }
    convex_[o] = ok;
  }
}

void Generators::find_outlines() {
  constexpr std::size_t kMostFaces = 64;  // larger facets are seldom convex
  const Scene& s = *scene_;
  outlines_.resize(s.facets().size());
  for (std::size_t i = 0; i < s.facets().size(); ++i) {
    const Facet& facet = s.facets()[i];
    if (!facet.planar || facet.faces.size() < 2 || facet.faces.size() > kMostFaces)
      continue;
    std::vector<std::array<std::int32_t, 2>> sides;
    for (const int f : facet.faces) {
      const auto c = s.face_points(f);
      for (std::size_t k = 0; k < c.size(); ++k)
        sides.push_back({c[k], c[(k + 1) % c.size()]});
    }
    std::sort(sides.begin(), sides.end());
    std::vector<std::array<std::int32_t, 2>> outline;
    for (const auto& side : sides) {
      if (!std::binary_search(sides.begin(), sides.end(),
                              std::array<std::int32_t, 2>{side[1], side[0]})) {
        outline.push_back(side);
      }
    }
    const InPlaneSide left_of(s, facet.faces[0]);
    const bool convex =
        std::all_of(outline.begin(), outline.end(), [&](const auto& side) {
          return std::all_of(outline.begin(), outline.end(), [&](const auto& other) {
            return left_of(s.point(side[0]), s.point(side[1]), s.point(other[0])) !=
                   Sign::Negative;
          });
        });
    if (convex) outlines_[i] = std::move(outline);
  }
}

namespace {

std::vector<std::int32_t> facets_of(const Scene& scene,
                                    std::span<const std::int32_t> faces) {
  std::vector<std::int32_t> facets;
  for (const int f : faces) facets.push_back(scene.faces()[f].facet);
  return facets;
}

}  // namespace

struct Generators::EdgeFaces {
  std::vector<std::int32_t> thirds, faces;  // a point of each half-plane, its face
  int a = -1, b = -1;                       // those that bound a gap of more than half
  bool reflex = false;                      // of a closed object: that gap is inside
  bool touched = false, foot = false;
  bool many = false;  // polygon mode: more than two half-planes
  [[nodiscard]] bool has_gap() const { return a >= 0 && b >= 0; }
};

void Generators::find_ridges() {
  const Scene& s = *scene_;
  ridge_of_edge_.assign(s.edges().size(), -1);
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < s.edges().size(); ++i) {
    const Edge& e = s.edges()[i];
    const Point& e0 = s.point(e.points[0]);
    const Point& e1 = s.point(e.points[1]);
    // The third point of each face at the edge gives the direction of its half-plane.
    EdgeFaces at;
    auto& [thirds, faces, a, b, reflex, is_touched, is_foot, many] = at;
    for (const Edge::Side& side : e.sides) {
      for (const int p : s.face_points(side.face)) {
        if (collinear(e0, e1, s.point(p))) continue;
        thirds.push_back(p);
        faces.push_back(side.face);
        break;
      }
    }
    // The two half-planes with all others strictly to one side of them.
    const auto extreme = [&](Sign wanted) {
      for (std::size_t k = 0; k < thirds.size(); ++k) {
        bool ok = true;
        for (std::size_t l = 0; l < thirds.size() && ok; ++l) {
          if (l == k) continue;
          const Sign t = orient3d(e0, e1, s.point(thirds[k]), s.point(thirds[l]));
          if (t == Sign::Zero) {
            // Same half-plane or the opposite one: told apart by any plane through the
            // edge other than theirs.
            const InPlaneSide left_of(s, faces[k]);
            ok = left_of(e0, e1, s.point(thirds[k])) ==
                 left_of(e0, e1, s.point(thirds[l]));
          } else {
            ok = t == wanted;
          }
        }
        if (ok) return static_cast<int>(k);
      }
      return -1;
    };
    if (polygon() && thirds.size() > 2) {
      EdgeFan fan(*this, e0, e1);
      for (const int f : faces) fan.add(f);
      fan.close();
      many = fan.leaves().size() > 2;
    }
    a = extreme(Sign::Positive);
    b = extreme(Sign::Negative);
    if (!at.has_gap() && !polygon()) continue;
    // In a closed object the gap must be outside: fronts face it.
    const bool closed = s.objects()[e.object].closed;
    reflex = closed && thirds.size() > 1 && e.kind == EdgeKind::Reflex;
    if (reflex && !polygon()) continue;
    if (closed && e.kind == EdgeKind::NonManifold && at.has_gap()) {
      const auto fronts_gap = [&](int k, Sign wanted) {
        // Positive side of (e0, e1, third) is the wedge for a, the gap for b.
        const PlaneThrough p = face_plane_through(s, faces[k]);
        const Point n = (p.b - p.a).cross(p.c - p.a);
        const Point m = (e1 - e0).cross(s.point(thirds[k]) - e0);
        return (n.dot(m) > 0) == (wanted == Sign::Positive);
      };
      bool some = false;
      for (std::size_t k = 0; k < thirds.size(); ++k) {
        if (orient3d(e0, e1, s.point(thirds[a]), s.point(thirds[k])) == Sign::Zero) {
          some |= fronts_gap(static_cast<int>(k), Sign::Negative);
        }
      }
      if (!some && !polygon()) continue;
      if (!some) a = b = -1;
    }
    const Box box = box_between(e0, e1);
    EdgeTouch touched = EdgeTouch::None;
    std::vector<std::array<Rational, 2>> stretches;
    std::vector<int> grounds;  // faces that contain a part of the edge
    face_tree_.traverse(
        [&](const Box& other) {
          return (polygon() || touched != EdgeTouch::ContainsInside) &&
                 boxes_meet(box, other);
        },
        [&](std::uint32_t item) {
          const int f = static_cast<int>(item);
          if (!polygon() && touched == EdgeTouch::ContainsInside) return;
          if (has_point(s, f, e.points[0]) && has_point(s, f, e.points[1])) {
            const bool own = std::find(faces.begin(), faces.end(), f) != faces.end();
            if (own || s.faces()[f].object == e.object) return;
          }
          // Faces along a chain of mesh edges merged into this one are its own.
          for (const int own : faces) {
            if (s.faces()[own].facet == s.faces()[f].facet) return;
          }
          const EdgeTouch touch = touch_of(s, face_planes_[f], f, e0, e1);
          touched = std::max(touched, touch);
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
    const bool foot =
        polygon() && inside_faces &&
        std::any_of(grounds.begin(), grounds.end(), [&](int f) {
          const bool solid = s.objects()[s.faces()[f].object].closed;
          return std::any_of(thirds.begin(), thirds.end(), [&](int p) {
            const Sign side = face_planes_[f](s.point(p));
            return side == Sign::Positive || (!solid && side == Sign::Negative);
          });
        });
    is_foot = foot;
    is_touched = touched == EdgeTouch::Touches || foot;
    if (covered && !foot) continue;
    const int edge = static_cast<int>(i);
    // Edges of several objects that coincide are one generator.
    if (join_ridge(edge, at)) continue;
    if (inside_faces && !foot) continue;
    ridge_of_edge_[i] = static_cast<int>(ridges_.size());
    if (many && !is_touched) {
      add_gaps(edge, at, boxes);
    } else {
      add_ridge(edge, at, boxes);
    }
    if (ridge_of_edge_[i] == static_cast<int>(ridges_.size())) ridge_of_edge_[i] = -1;
  }
  ridge_tree_ = Bvh(boxes);
}

// To the ridge of an edge with the same ends, found before.
bool Generators::join_ridge(int edge, const EdgeFaces& at) {
  const Edge& e = scene_->edges()[edge];
  if (ridges_.empty() || ridges_.back().points != e.points) return false;
  Ridge& ridge = ridges_.back();
  ridge.touched = true;
  ridge.objects.push_back(e.object);
  const auto facets = facets_of(*scene_, at.faces);
  ridge.all_facets.insert(ridge.all_facets.end(), facets.begin(), facets.end());
  ridge_of_edge_[edge] = static_cast<int>(ridges_.size() - 1);
  if (!polygon()) return true;
  // Named and grazed as in solid mode, which knows only edges that lines graze.
  const bool grazes = at.has_gap() && !at.reflex && !at.foot;
  if (!ridge.can_graze() && grazes) {
    std::vector<Box> unused;
    std::vector<std::int32_t> objects = std::move(ridge.objects);
    std::vector<std::int32_t> all_facets = std::move(ridge.all_facets);
    const std::int32_t first = ridge.edge;
    ridges_.pop_back();
    add_ridge(edge, at, unused);
    ridges_.back().objects = std::move(objects);
    ridges_.back().all_facets = std::move(all_facets);
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
bool Generators::shows_crease(std::array<std::int32_t, 2> points, std::int32_t first_edge,
                              std::int32_t last_edge) const {
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
void Generators::add_ridge(int edge, const EdgeFaces& at, std::vector<Box>& boxes) {
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
                     facets_of(s, at.faces),
                     at.touched});
  boxes.push_back(box_between(e0, e1));
  if (!polygon()) return;
  Ridge& ridge = ridges_.back();
  ridge.grazes = at.has_gap() && !at.reflex;
  ridge.foot = at.foot;
  const bool closed = s.objects()[e.object].closed;
  const bool crease = thirds.size() > 1 || at.touched;
  ridge.ends_in_front = (crease && !at.reflex) || at.many;
  ridge.ends_behind = (crease && (at.reflex || !closed)) || at.many;
  ridge.any_side = at.many;
}

// Of an edge with three faces or more, touched by no others: one ridge for each gap in
// which something is to be seen.
void Generators::add_gaps(int edge, const EdgeFaces& at, std::vector<Box>& boxes) {
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
                facets_of(s, at.faces),
                false};
    ridge.grazes = false;
    ridge.ends_behind = true;
    // Lines along a leaf between two gaps are told once.
    const EdgeFan::Sector& before = sectors[(k + sectors.size() - 1) % sectors.size()];
    ridge.ends_along = {fan.ends_along(sector.from) && !narrow(before),
                        fan.ends_along(sector.to)};
    ridges_.push_back(std::move(ridge));
    boxes.push_back(box_between(e0, e1));
  }
}

void Generators::find_stars() {
  const Scene& s = *scene_;
  star_of_point_.assign(s.points().size(), -1);
  for (const int p : s.corners()) {
    star_of_point_[p] = static_cast<int>(stars_.size());
    Star star;
    star.point = p;
    const Point& at = s.point(p);
    const auto own = s.faces_at(p);
    star.faces.assign(own.begin(), own.end());
    std::vector<std::array<std::int32_t, 3>> wedges;  // far point, far point, facet
    for (const int f : own) {
      const auto c = s.face_points(f);
      const std::size_t n = c.size();
      const auto k =
          static_cast<std::size_t>(std::find(c.begin(), c.end(), p) - c.begin());
      const int next = c[(k + 1) % n];
      const int previous = c[(k + n - 1) % n];
      if (collinear(at, s.point(next), s.point(previous))) {
        // The point lies on a straight side of the polygon: half a plane.
        for (std::size_t m = 2; m < n; ++m) {
          const int third = c[(k + m) % n];
          if (collinear(at, s.point(next), s.point(third))) continue;
          wedges.push_back({next, third, s.faces()[f].facet});
          wedges.push_back({third, previous, s.faces()[f].facet});
          break;
        }
      } else {
        wedges.push_back({next, previous, s.faces()[f].facet});
      }
      star.facets.push_back(s.faces()[f].facet);
    }
    const Box box = box_between(at, at);
    face_tree_.traverse([&](const Box& other) { return boxes_meet(box, other); },
                        [&](std::uint32_t item) {
                          const int f = static_cast<int>(item);
                          if (has_point(s, f, p) || face_planes_[f](at) != Sign::Zero)
                            return;
                          const PointInFace where = locate_in_plane(s, f, at);
                          if (where == PointInFace::Outside) return;
                          star.faces.push_back(f);
                          star.touched = true;
                          const auto c = s.face_points(f);
                          const std::size_t n = c.size();
                          const InPlaneSide left_of(s, f);
                          if (where == PointInFace::Inside) {
                            star.in_plane_only = true;
                            star.planes.push_back(f);
                          }
                          for (std::size_t k = 0; k < n; ++k) {
                            const Point& q = s.point(c[k]);
                            const Point& r = s.point(c[(k + 1) % n]);
                            if (left_of(q, r, at) == Sign::Zero) continue;
                            wedges.push_back({c[k], c[(k + 1) % n], s.faces()[f].facet});
                          }
                        });
    std::sort(star.facets.begin(), star.facets.end());
    star.facets.erase(std::unique(star.facets.begin(), star.facets.end()),
                      star.facets.end());
    const auto ray = [&](std::int32_t far) {
      for (std::size_t r = 0; r < star.rays.size(); ++r) {
        if (star.rays[r] == far ||
            same_direction(at, s.point(star.rays[r]), s.point(far))) {
          return static_cast<std::int32_t>(r);
        }
      }
      star.rays.push_back(far);
      return static_cast<std::int32_t>(star.rays.size() - 1);
    };
    for (const auto& w : wedges) star.sectors.push_back({ray(w[0]), ray(w[1]), w[2]});

    star.touched = star.touched || objects_at(p).size() > 1;
    bool convex = !star.touched && s.objects()[s.faces()[own[0]].object].closed;
    for (const int e : s.edges_at(p))
      convex = convex && s.edges()[e].kind == EdgeKind::Convex;
    // Locally convex along every edge and one fan: check it is one cone.
    for (std::size_t k = 0; k < own.size() && convex; ++k) {
      for (const auto& w : wedges) {
        if (w[2] == s.faces()[own[k]].facet) continue;
        for (int end = 0; end < 2 && convex; ++end) {
          if (face_planes_[own[k]](s.point(w[end])) != Sign::Positive) continue;
          // Rays shared with the facet itself may rise above another of its triangles.
          convex = std::any_of(wedges.begin(), wedges.end(), [&](const auto& other) {
            return other[2] == s.faces()[own[k]].facet &&
                   (other[0] == w[end] || other[1] == w[end]);
          });
        }
      }
    }
    star.convex = convex;
    // Flat all around within its own object: no generator of transversal lines.
    stars_.push_back(std::move(star));
  }
}

// Ridges in order of one coordinate of their directions, which parallel ones share.
void Generators::find_aligned() {
  const Scene& s = *scene_;
  struct Direction {
    std::array<double, 3> unit;  // up to signs
    int ridge;
  };
  std::vector<Direction> all;
  for (std::size_t r = 0; r < ridges_.size(); ++r) {
    const auto& p = ridges_[r].points;
    const Point d = s.point(p[1]) - s.point(p[0]);
    const double size = d.cwiseAbs().maxCoeff();
    const Point u = (d / size).normalized().cwiseAbs();
    all.push_back({{u[0], u[1], u[2]}, static_cast<int>(r)});
  }
  std::sort(all.begin(), all.end(),
            [](const Direction& a, const Direction& b) { return a.unit < b.unit; });
  // A component of magnitude at most 1 after a difference, a quotient and a norm.
  constexpr double kWidth = 32 * kUnit;
  const auto solid_in_common = [&](const Ridge& a, const Ridge& b) {
    return std::any_of(a.objects.begin(), a.objects.end(), [&](std::int32_t o) {
      return convex_solid(o) &&
             std::find(b.objects.begin(), b.objects.end(), o) != b.objects.end();
    });
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      if (all[j].unit[0] - all[i].unit[0] > kWidth) break;
      if (std::abs(all[j].unit[1] - all[i].unit[1]) > kWidth ||
          std::abs(all[j].unit[2] - all[i].unit[2]) > kWidth) {
        continue;
      }
      const Ridge& a = ridges_[all[i].ridge];
      const Ridge& b = ridges_[all[j].ridge];
      const auto direction = [&](const Ridge& r) {
        return ring_difference(s.point(r.points[1]), s.point(r.points[0]));
      };
      if (solid_in_common(a, b) || !parallel(direction(a), direction(b))) continue;
      aligned_ = true;
      return;
    }
  }
}

void Generators::find_inside() {
  const Scene& s = *scene_;
  inside_.assign(stars_.size(), 0);
  for (std::size_t o = 0; o < s.objects().size(); ++o) {
    const Object& object = s.objects()[o];
    if (!object.closed) continue;
    std::vector<Point> points;
    for (const int f : object.faces) {
      for (const int p : s.face_points(f)) points.push_back(s.point(p));
    }
    if (points.empty()) continue;
    const Box box = box_of(points);
    double volume = 0;
    if (!convex_[o]) {
      const Point origin = points[0];
      for (const int f : object.faces) {
        const auto c = s.face_points(f);
        for (std::size_t k = 1; k + 1 < c.size(); ++k) {
          volume += (s.point(c[0]) - origin)
                        .dot((s.point(c[k]) - origin).cross(s.point(c[k + 1]) - origin));
        }
      }
      if (volume <= 0) continue;
    }
    for (std::size_t i = 0; i < stars_.size(); ++i) {
      if (inside_[i]) continue;
      const Point& p = s.point(stars_[i].point);
      bool in_box = true;
      for (int k = 0; k < 3; ++k)
        in_box = in_box && p[k] > box.min[k] && p[k] < box.max[k];
      if (!in_box) continue;
      if (convex_[o]) {
        inside_[i] = std::all_of(object.faces.begin(), object.faces.end(), [&](int f) {
          return face_planes_[f](p) == Sign::Negative;
        });
      } else {
        inside_[i] = 0;  // filled by parity below
        // Crossings with a segment that leaves the box; a degenerate one is replaced.
        const auto at = objects_at(stars_[i].point);
        if (std::find(at.begin(), at.end(), static_cast<std::int32_t>(o)) != at.end())
          continue;
        const Point size{box.max[0] - box.min[0], box.max[1] - box.min[1],
                         box.max[2] - box.min[2]};
        for (int attempt = 1; attempt <= 16; ++attempt) {
          const Point far =
              p + Point{size[0] * (2 + 0.37 * attempt), size[1] * (1.1 + 0.61 * attempt),
                        size[2] * (3 - 0.13 * attempt) * (attempt % 2 ? 1 : -1)};
          int winding = 0;
          bool degenerate = false;
          for (const int f : object.faces) {
            const Sign s0 = face_planes_[f](p);
            const Sign s1 = face_planes_[f](far);
            const auto c = s.face_points(f);
            if (s0 == s1 && s0 != Sign::Zero) continue;
            bool hit = true;
            bool edge = false;
            for (std::size_t k = 0; k < c.size() && hit; ++k) {
              const Sign t =
                  orient3d(s.point(c[k]), s.point(c[(k + 1) % c.size()]), p, far);
              edge |= t == Sign::Zero;
              const Sign inward = (s0 == Sign::Positive || s1 == Sign::Negative)
                                      ? Sign::Negative
                                      : Sign::Positive;
              if (t != Sign::Zero && t != inward) hit = false;
            }
            if (!hit) continue;
            if (edge || s0 == Sign::Zero || s1 == Sign::Zero) {
              degenerate = true;
              break;
            }
            winding += s0 == Sign::Negative ? 1 : -1;
          }
          if (degenerate) continue;
          inside_[i] = winding > 0;
          break;
        }
      }
    }
  }
  for (const auto flag : inside_) inside_count_ += flag;
}

}  // namespace sightline::internal
