#include "linespace/silhouettes/edge_touches.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

// Where face f, which is not one of the edge's own, meets the open segment e0 e1.
EdgeMeeting touch_of(const Scene& scene, const PlaneSide& plane, int f, const Point& e0,
                     const Point& e1) {
  const Sign s0 = plane(e0);
  const Sign s1 = plane(e1);
  const auto corners = scene.face_points(f);
  const std::size_t n = corners.size();
  // 1. The edge is not in the face's plane.  An end in that plane is no inner point: such
  // an edge meets nothing here.
  if (s0 != Sign::Zero || s1 != Sign::Zero) {
    if (s0 == s1 || s0 == Sign::Zero || s1 == Sign::Zero) return EdgeMeeting::None;
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
      if (s != inside) return EdgeMeeting::None;
    }
    return at_edge ? EdgeMeeting::Touches : EdgeMeeting::Pierced;
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
    if (a != Sign::Positive && b != Sign::Positive) return EdgeMeeting::None;
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
  if (along_side) return EdgeMeeting::Touches;
  if (!left || !right) {
    // At most a corner of the polygon lies on the open segment.
    return EdgeMeeting::Touches;
  }
  // 3. Both ends within the face: all of the edge is inside of it.
  return outside_ends[0] == 0 && outside_ends[1] == 0 ? EdgeMeeting::ContainsInside
                                                      : EdgeMeeting::Touches;
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

bool holds(std::span<const std::int32_t> ascending, std::int32_t facet) {
  return std::ranges::binary_search(ascending, facet);
}

}  // namespace

EdgeTouches::EdgeTouches(const Silhouettes& silhouettes,
                         std::array<std::int32_t, 2> points,
                         std::span<const std::int32_t> skipped)
    : g_(silhouettes), points_(points) {
  const Scene& s = g_.scene();
  const Box box = box_of(std::array<Point, 2>{s.point(points[0]), s.point(points[1])});
  // In solid mode an edge inside a face makes no event, whatever else touches it.  That
  // ends the search where no edge has that face for its own.
  const auto enough = [&] {
    return !g_.polygon() && !skipped.empty() &&
           counts_[static_cast<int>(EdgeMeeting::ContainsInside)] > 0;
  };
  g_.face_tree().traverse(
      [&](const Box& other) { return !enough() && boxes_meet(box, other); },
      [&](std::uint32_t item) {
        hear_stop();
        const int f = static_cast<int>(item);
        if (!enough() && !holds(skipped, s.faces()[f].facet)) add(f);
      });
  for (std::size_t i = 0; i < items_.size(); ++i) {
    by_facet_.push_back(static_cast<std::int32_t>(i));
  }
  std::ranges::stable_sort(by_facet_, {},
                           [&](std::int32_t i) { return items_[i].facet; });
  covered_ = covered_without({});
  grounds_ = grounds_without({});
}

void EdgeTouches::add(std::int32_t face) {
  const Scene& s = g_.scene();
  const Point& e0 = s.point(points_[0]);
  const Point& e1 = s.point(points_[1]);
  const PlaneSide& plane = g_.face_plane(face);
  Item item{face, s.faces()[face].facet, touch_of(s, plane, face, e0, e1)};
  if (item.touch == EdgeMeeting::None) return;
  item.ground = item.touch == EdgeMeeting::ContainsInside;
  if (item.touch == EdgeMeeting::Touches && plane(e0) == Sign::Zero &&
      plane(e1) == Sign::Zero) {
    item.stretch = stretch_inside(s, face, e0, e1);
    item.ground = item.stretch.has_value();
  }
  ++counts_[static_cast<int>(item.touch)];
  items_.push_back(std::move(item));
}

bool EdgeTouches::covered_without(std::span<const std::int32_t> own) const {
  std::vector<std::array<Rational, 2>> stretches;
  for (const Item& item : items_) {
    if (item.stretch && !holds(own, item.facet)) stretches.push_back(*item.stretch);
  }
  return cover_edge(std::move(stretches));
}

std::vector<std::int32_t> EdgeTouches::grounds_without(
    std::span<const std::int32_t> own) const {
  // Copies have the same corners.
  std::set<std::tuple<std::array<std::int32_t, 3>, bool>> known;
  std::vector<std::int32_t> grounds;
  for (const Item& item : items_) {
    if (!item.ground || holds(own, item.facet)) continue;
    const bool solid = g_.solid_behind(item.face);
    if (known.insert({plane_points(g_.scene(), item.face), solid}).second) {
      grounds.push_back(item.face);
    }
  }
  return grounds;
}

ForeignTouch EdgeTouches::without(std::span<const std::int32_t> own) const {
  std::array<int, 4> counts = counts_;
  bool own_ground = false;
  for (const std::int32_t facet : own) {
    const auto same = std::ranges::equal_range(
        by_facet_, facet, {}, [&](std::int32_t i) { return items_[i].facet; });
    for (const std::int32_t i : same) {
      --counts[static_cast<int>(items_[i].touch)];
      own_ground |= items_[i].ground;
    }
  }
  ForeignTouch out;
  for (int touch = 3; touch > 0 && out.touched == EdgeMeeting::None; --touch) {
    if (counts[touch] > 0) out.touched = static_cast<EdgeMeeting>(touch);
  }
  out.covered = own_ground ? covered_without(own) : covered_;
  out.grounds = own_ground ? grounds_without(own) : grounds_;
  if (out.touched != EdgeMeeting::Pierced) return out;
  for (const Item& item : items_) {
    if (item.touch == EdgeMeeting::Pierced && !holds(own, item.facet)) {
      out.pierced_by.push_back(item.face);
    }
  }
  return out;
}

}  // namespace sightline::internal
