#include "linespace/light/source_patches.h"

#include <algorithm>
#include <optional>

namespace sightline::internal {
namespace {

// The plane as seen along a coordinate axis, from the front: two coordinates and a
// weight.
class Drawing {
 public:
  explicit Drawing(const LightPlane& plane) {
    double largest = -1;
    for (int i = 0; i < 3; ++i) {
      const double size = std::abs(plane.near[i].v);
      if (sign_of(plane.exact[i]) == Sign::Zero || size <= largest) continue;
      largest = size;
      axis_ = i;
    }
    flipped_ = sign_of(plane.exact[axis_]) == Sign::Negative;
  }

  // Positive where a, b, c turn counter-clockwise.
  [[nodiscard]] Sign turn(const LightPoint& a, const LightPoint& b,
                          const LightPoint& c) const {
    const Sign s = decide(det(a.near, b.near, c.near),
                          [&] { return det(a.exact, b.exact, c.exact); });
    return flipped_ ? -s : s;
  }
  // Sign of a - b in one of the two coordinates.
  [[nodiscard]] static Sign order(const LightPoint& a, const LightPoint& b, int axis) {
    return decide(a.near[axis] - b.near[axis], [&] {
      return a.exact[axis] * b.exact[3] - b.exact[axis] * a.exact[3];
    });
  }
  // A coordinate that changes along ab.
  [[nodiscard]] int along(const LightPoint& a, const LightPoint& b) const {
    const int u = (axis_ + 1) % 3;
    return order(a, b, u) != Sign::Zero ? u : (axis_ + 2) % 3;
  }
  [[nodiscard]] bool same(const LightPoint& a, const LightPoint& b) const {
    return order(a, b, (axis_ + 1) % 3) == Sign::Zero &&
           order(a, b, (axis_ + 2) % 3) == Sign::Zero;
  }
  // Where the line ab meets the line cd, which is not parallel.
  [[nodiscard]] LightPoint meeting(const LightPoint& a, const LightPoint& b,
                                   const LightPoint& c, const LightPoint& d) const {
    const Ring at_a = det(c.exact, d.exact, a.exact);
    const Ring at_b = det(c.exact, d.exact, b.exact);
    return light_point(combination(at_b, a.exact, at_a, b.exact));
  }
  [[nodiscard]] static LightPoint middle(const LightPoint& a, const LightPoint& b) {
    return light_point(
        combination(Ring(b.exact[3]), a.exact, Ring(-a.exact[3]), b.exact));
  }

 private:
  template <class T>
  [[nodiscard]] T det(const Four<T>& a, const Four<T>& b, const Four<T>& c) const {
    const int u = (axis_ + 1) % 3;
    const int v = (axis_ + 2) % 3;
    return a[u] * (b[v] * c[3] - b[3] * c[v]) - a[v] * (b[u] * c[3] - b[3] * c[u]) +
           a[3] * (b[u] * c[v] - b[v] * c[u]);
  }

  int axis_ = 2;
  bool flipped_ = false;
};

using Polygon = std::vector<const LightPoint*>;

bool comes_before(const LightPoint& a, const LightPoint& b) {
  for (int i = 0; i < 3; ++i) {
    const Sign s = Drawing::order(a, b, i);
    if (s != Sign::Zero) return s == Sign::Negative;
  }
  return false;
}

// Finds the outline of the union of convex polygons, and adds feet.
class OutlineFinder {
 public:
  OutlineFinder(SourcePatch& patch, const std::vector<Polygon>& polygons)
      : patch_(patch), polygons_(polygons), drawing_(patch.plane) {}

  void add_outline() {
    for (std::size_t f = 0; f < polygons_.size(); ++f) {
      for (std::size_t k = 0; k < polygons_[f].size(); ++k) add_side(f, k);
    }
    join_sides();
  }

  // The segment in which a face meets the plane, unless it is certainly off the patch.
  void add_foot(const LightPoint& from, const LightPoint& to, int face) {
    if (drawing_.same(from, to) || off_hull(from, to)) return;
    for (const SourcePatch::Side& s : patch_.sides) {
      if ((drawing_.same(*s.ends[0], from) && drawing_.same(*s.ends[1], to)) ||
          (drawing_.same(*s.ends[0], to) && drawing_.same(*s.ends[1], from))) {
        return;
      }
    }
    patch_.sides.push_back({{keep(from), keep(to)}, face});
  }

  void add_corners() {
    for (std::size_t i = 0; i < patch_.sides.size(); ++i) {
      for (const LightPoint* p : patch_.sides[i].ends) add_corner(*p);
      for (std::size_t j = 0; j < i; ++j) add_crossing(patch_.sides[i], patch_.sides[j]);
    }
  }

  void find_hull() {
    std::vector<const LightPoint*> points;
    for (const Polygon& p : polygons_) points.insert(points.end(), p.begin(), p.end());
    // Gift wrapping: the sources of people have few corners.
    const LightPoint* first = *std::ranges::min_element(
        points,
        [](const LightPoint* a, const LightPoint* b) { return comes_before(*a, *b); });
    const LightPoint* at = first;
    do {
      hull_.push_back(at);
      const LightPoint* next = nullptr;
      for (const LightPoint* p : points) {
        if (drawing_.same(*p, *at)) continue;
        const Sign turn =
            next == nullptr ? Sign::Negative : drawing_.turn(*at, *next, *p);
        if (turn == Sign::Negative || (turn == Sign::Zero && farther(*at, *next, *p))) {
          next = p;
        }
      }
      at = next;
    } while (!drawing_.same(*at, *first));
    for (const LightPoint* p : hull_) patch_.hull.push_back(p->rounded);
  }

 private:
  // On one ray from a, c is farther than b.
  [[nodiscard]] bool farther(const LightPoint& a, const LightPoint& b,
                             const LightPoint& c) const {
    const int axis = drawing_.along(a, b);
    return Drawing::order(c, b, axis) == Drawing::order(b, a, axis);
  }

  [[nodiscard]] bool off_hull(const LightPoint& p, const LightPoint& q) const {
    for (std::size_t k = 0; k < hull_.size(); ++k) {
      const LightPoint& a = *hull_[k];
      const LightPoint& b = *hull_[(k + 1) % hull_.size()];
      if (drawing_.turn(a, b, p) == Sign::Negative &&
          drawing_.turn(a, b, q) == Sign::Negative) {
        return true;
      }
    }
    return false;
  }

  const LightPoint* keep(const LightPoint& p) {
    for (const LightPoint& q : patch_.points) {
      if (drawing_.same(p, q)) return &q;
    }
    patch_.points.push_back(p);
    return &patch_.points.back();
  }

  void add_corner(const LightPoint& p) {
    const LightPoint* kept = keep(p);
    if (std::ranges::find(patch_.corners, kept) == patch_.corners.end()) {
      patch_.corners.push_back(kept);
    }
  }

  void add_crossing(const SourcePatch::Side& s, const SourcePatch::Side& t) {
    const auto apart = [&](const SourcePatch::Side& x, const SourcePatch::Side& y) {
      const Sign a = drawing_.turn(*x.ends[0], *x.ends[1], *y.ends[0]);
      const Sign b = drawing_.turn(*x.ends[0], *x.ends[1], *y.ends[1]);
      return a != b || a == Sign::Zero;
    };
    const bool parallel =
        drawing_.turn(*s.ends[0], *s.ends[1], *t.ends[0]) == Sign::Zero &&
        drawing_.turn(*s.ends[0], *s.ends[1], *t.ends[1]) == Sign::Zero;
    if (parallel || !apart(s, t) || !apart(t, s)) return;
    add_corner(drawing_.meeting(*s.ends[0], *s.ends[1], *t.ends[0], *t.ends[1]));
  }

  // The parts of side k of polygon f beyond which no other polygon goes on.
  void add_side(std::size_t f, std::size_t k) {
    const LightPoint& from = *polygons_[f][k];
    const LightPoint& to = *polygons_[f][(k + 1) % polygons_[f].size()];
    std::vector<LightPoint> cuts{from, to};
    std::vector<std::size_t> near;
    for (std::size_t h = 0; h < polygons_.size(); ++h) {
      if (h == f || beside(from, to, polygons_[h])) continue;
      near.push_back(h);
      add_cuts(from, to, polygons_[h], cuts);
    }
    const int axis = drawing_.along(from, to);
    const Sign way = Drawing::order(to, from, axis);
    std::sort(cuts.begin(), cuts.end(), [&](const LightPoint& a, const LightPoint& b) {
      return Drawing::order(b, a, axis) == way;
    });
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      if (drawing_.same(cuts[i], cuts[i + 1])) continue;
      const LightPoint at = Drawing::middle(cuts[i], cuts[i + 1]);
      const bool inner = std::ranges::any_of(near, [&](std::size_t h) {
        return goes_on(from, to, at, polygons_[h], h < f);
      });
      if (!inner) patch_.sides.push_back({{keep(cuts[i]), keep(cuts[i + 1])}});
    }
  }

  // All of the polygon is strictly on one side of the line, or it lies beyond an end.
  [[nodiscard]] bool beside(const LightPoint& from, const LightPoint& to,
                            const Polygon& polygon) const {
    const Sign first = drawing_.turn(from, to, *polygon[0]);
    return first != Sign::Zero && std::ranges::all_of(polygon, [&](const LightPoint* p) {
             return drawing_.turn(from, to, *p) == first;
           });
  }

  // Where the side meets the sides of another polygon.
  void add_cuts(const LightPoint& from, const LightPoint& to, const Polygon& polygon,
                std::vector<LightPoint>& cuts) const {
    const int axis = drawing_.along(from, to);
    const Sign way = Drawing::order(to, from, axis);
    const auto add = [&](const LightPoint& p) {
      if (Drawing::order(p, from, axis) == way && Drawing::order(to, p, axis) == way) {
        cuts.push_back(p);
      }
    };
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const LightPoint& a = *polygon[k];
      const LightPoint& b = *polygon[(k + 1) % polygon.size()];
      const Sign at_a = drawing_.turn(from, to, a);
      const Sign at_b = drawing_.turn(from, to, b);
      if (at_a == Sign::Zero) add(a);
      if (at_a == -at_b && at_a != Sign::Zero) {
        add(drawing_.meeting(from, to, a, b));
      }
    }
  }

  // At a point inside the side the polygon covers what is on the right of it, or has the
  // same side there and comes first.
  [[nodiscard]] bool goes_on(const LightPoint& from, const LightPoint& to,
                             const LightPoint& at, const Polygon& polygon,
                             bool comes_first) const {
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const LightPoint& a = *polygon[k];
      const LightPoint& b = *polygon[(k + 1) % polygon.size()];
      const Sign turn = drawing_.turn(a, b, at);
      if (turn == Sign::Negative) return false;
      if (turn == Sign::Positive) continue;
      const int axis = drawing_.along(from, to);
      const bool same_way = Drawing::order(b, a, axis) == Drawing::order(to, from, axis);
      if (same_way && !comes_first) return false;
    }
    return true;
  }

  // Sides that go straight on become one.
  void join_sides() {
    auto& sides = patch_.sides;
    for (bool again = true; again;) {
      again = false;
      for (std::size_t i = 0; i < sides.size() && !again; ++i) {
        for (std::size_t j = 0; j < sides.size() && !again; ++j) {
          if (i == j || sides[i].ends[1] != sides[j].ends[0]) continue;
          const auto& [a, b] = sides[i].ends;
          const LightPoint* c = sides[j].ends[1];
          if (drawing_.turn(*a, *b, *c) != Sign::Zero || !farther(*a, *b, *c)) continue;
          sides[i].ends[1] = c;
          sides.erase(sides.begin() + static_cast<std::ptrdiff_t>(j));
          again = true;
        }
      }
    }
  }

  SourcePatch& patch_;
  const std::vector<Polygon>& polygons_;
  Drawing drawing_;
  std::vector<const LightPoint*> hull_;
};

LightPlane plane_of_face(const Scene& scene, int face, FaceSide side) {
  const auto p = scene.face_points(face);
  const bool front = side == FaceSide::Front;
  return light_plane(light_point(scene.point(p[front ? 0 : 2])),
                     light_point(scene.point(p[1])),
                     light_point(scene.point(p[front ? 2 : 0])));
}

// Both faces lie in the plane and face alike.
bool same_plane(const Scene& scene, const LightPlane& plane, int face, FaceSide side) {
  for (const int p : scene.face_points(face)) {
    if (sign_at(plane, light_point(scene.point(p))) != Sign::Zero) return false;
  }
  const LightPlane other = plane_of_face(scene, face, side);
  const Ring same = plane.exact[0] * other.exact[0] + plane.exact[1] * other.exact[1] +
                    plane.exact[2] * other.exact[2];
  return sign_of(same) == Sign::Positive;
}

// The segment in which the face meets the plane, if it reaches in front of it.
std::optional<std::array<LightPoint, 2>> foot_of(const Scene& scene,
                                                 const LightPlane& plane, int face) {
  const auto ids = scene.face_points(face);
  // Most faces lie on one side of the plane, as doubles can tell.
  bool all_before = true, all_beyond = true;
  for (const int p : ids) {
    const Point& x = scene.point(p);
    const Approx height =
        value(plane.near, Four<Approx>{{{x[0]}, {x[1]}, {x[2]}, {1.0}}});
    all_before &= is_certain(height) && height.v > 0;
    all_beyond &= is_certain(height) && height.v < 0;
  }
  if (all_before || all_beyond) return std::nullopt;
  std::vector<LightPoint> points;
  std::vector<Sign> signs;
  for (const int p : ids) {
    points.push_back(light_point(scene.point(p)));
    signs.push_back(sign_at(plane, points.back()));
  }
  if (std::ranges::find(signs, Sign::Positive) == signs.end()) return std::nullopt;
  std::vector<LightPoint> on;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::size_t next = (k + 1) % points.size();
    if (signs[k] == Sign::Zero) on.push_back(points[k]);
    if (signs[k] != Sign::Zero && signs[k] == -signs[next]) {
      const Ring a = value(plane.exact, points[k].exact);
      const Ring b = value(plane.exact, points[next].exact);
      on.push_back(light_point(combination(b, points[k].exact, a, points[next].exact)));
    }
  }
  if (on.size() < 2) return std::nullopt;
  const auto [least, most] = std::minmax_element(on.begin(), on.end(), comes_before);
  return std::array{*least, *most};
}

}  // namespace

std::vector<SourcePatch> source_patches(const Scene& scene, std::span<const int> faces,
                                        FaceSide side) {
  std::vector<SourcePatch> patches;
  for (const int f : faces) {
    const auto found = std::ranges::find_if(patches, [&](const SourcePatch& patch) {
      return same_plane(scene, patch.plane, f, side);
    });
    if (found != patches.end()) {
      found->faces.push_back(f);
    } else {
      patches.emplace_back();
      patches.back().faces = {f};
      patches.back().side = side;
      patches.back().plane = plane_of_face(scene, f, side);
    }
  }
  for (SourcePatch& patch : patches) {
    std::ranges::sort(patch.faces);
    std::deque<LightPoint> points;
    std::vector<Polygon> polygons;
    for (const int f : patch.faces) {
      Polygon& polygon = polygons.emplace_back();
      for (const int p : scene.face_points(f)) {
        points.push_back(light_point(scene.point(p)));
        polygon.push_back(&points.back());
      }
      if (side == FaceSide::Back) std::ranges::reverse(polygon);
    }
    OutlineFinder finder(patch, polygons);
    finder.find_hull();
    finder.add_outline();
    for (std::size_t f = 0; f < scene.faces().size(); ++f) {
      const int face = static_cast<int>(f);
      if (const auto foot = foot_of(scene, patch.plane, face)) {
        finder.add_foot((*foot)[0], (*foot)[1], face);
      }
    }
    finder.add_corners();
  }
  return patches;
}

}  // namespace sightline::internal
