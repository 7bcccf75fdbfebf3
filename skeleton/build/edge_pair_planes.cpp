// Curves of EdgePairs whose lines all lie in one plane: when they are free without a look
// at any of them.

#include <algorithm>
#include <optional>

#include "skeleton/build/edge_pair.h"

namespace sightline::internal {
namespace {

// Where points lie as seen from a plane, and a box around those in it.
struct Sides {
  bool front = false, back = false, on = false;
  Box touching{};

  void add(const Point& p, const PlaneSide& plane) {
    const Sign side = plane(p);
    front |= side == Sign::Positive;
    back |= side == Sign::Negative;
    if (side != Sign::Zero) return;
    for (int i = 0; i < 3; ++i) {
      touching.min[i] = on ? std::min(touching.min[i], p[i]) : p[i];
      touching.max[i] = on ? std::max(touching.max[i], p[i]) : p[i];
    }
    on = true;
  }
  [[nodiscard]] bool apart() const { return !on && front != back; }
  [[nodiscard]] bool across() const { return front && back; }
};

Sides sides_of_face(const Scene& scene, int face, const PlaneSide& plane) {
  Sides sides;
  for (const int p : scene.face_points(face)) sides.add(scene.point(p), plane);
  return sides;
}

Sides sides_of_solid(const Scene& scene, int object, const PlaneSide& plane) {
  Sides sides;
  for (const int face : scene.objects()[object].faces) {
    for (const int p : scene.face_points(face)) sides.add(scene.point(p), plane);
  }
  return sides;
}

bool some_meet(std::span<const Box> front, std::span<const Box> back) {
  return std::any_of(front.begin(), front.end(), [&](const Box& f) {
    return std::any_of(back.begin(), back.end(),
                       [&](const Box& b) { return boxes_meet(f, b); });
  });
}

}  // namespace

// The plane of the first edge and the one of the two others that is coplanar with it;
// none where both are: such lines may lie in both planes.
std::optional<PlaneSide> EdgePairs::plane_of_pencil(const Outer& outer,
                                                    const EeeCurve& curve) const {
  const auto at = [&](std::int32_t id) -> const Point& { return scene_.point(id); };
  const auto& p = outer.points.p;
  std::optional<PlaneSide> plane;
  for (const auto& e : {carriers_.all[curve.middle()].points, outer.points.q}) {
    if (orient3d(at(p[0]), at(p[1]), at(e[0]), at(e[1])) != Sign::Zero) continue;
    if (plane) return std::nullopt;
    const int k = collinear(at(p[0]), at(p[1]), at(e[0])) ? 1 : 0;
    plane = PlaneSide({at(p[0]), at(p[1]), at(e[k])});
  }
  return plane;
}

// Whether all lines of an open part, which lie in one plane, are free.  What lies on both
// sides of the plane, without a corner in it, hides lines as anywhere else, and no line
// inside an open part touches it, but one of the three edges where it is its own.  Convex
// solids that touch the plane from one side are grazed by lines in the plane, all at
// once; so are solids on both sides where they do not touch each other in the plane.
// Answers no for all else.
bool EdgePairs::free_in_plane(const Outer& outer, const EeeCurve& curve,
                              int middle) const {
  if (g_.polygon()) return false;
  const std::optional<PlaneSide> plane = plane_of_pencil(outer, curve);
  if (!plane) return false;
  std::vector<Box> front, back, across;  // what lines may touch
  for (const int ridge : {outer.first, middle, outer.last}) {
    const auto& p = g_.ridges()[ridge].points;
    const std::array<Point, 2> ends{scene_.point(p[0]), scene_.point(p[1])};
    if ((*plane)(ends[0]) != (*plane)(ends[1])) across.push_back(box_of(ends));
  }
  for (const std::int32_t blocker : view_.blockers()) {
    const Sides sides = blocker < 0 ? sides_of_face(scene_, ~blocker, *plane)
                                    : sides_of_solid(scene_, blocker, *plane);
    if (sides.apart() || (sides.across() && !sides.on)) continue;
    if (sides.across() || blocker < 0) return false;
    (sides.front ? front : back).push_back(sides.touching);
  }
  return !some_meet(front, back) && !some_meet(front, across) && !some_meet(back, across);
}

}  // namespace sightline::internal
