#include "linespace/sight/plane_crossings.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "linespace/sight/free_segment.h"
#include "linespace/swaths/edge_cuts.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

// The point strictly inside both segments where they cross, for four points in a plane
// that `off_plane` is not in.
std::optional<ExactPoint> crossing(const Scene& scene,
                                   const std::array<std::int32_t, 2>& s,
                                   const std::array<std::int32_t, 2>& t, int off_plane) {
  const Point& p = scene.point(s[0]);
  const Point& q = scene.point(s[1]);
  const Point& a = scene.point(t[0]);
  const Point& b = scene.point(t[1]);
  for (int i = 0; i < 3; ++i) {
    if (std::max(p[i], q[i]) < std::min(a[i], b[i]) ||
        std::max(a[i], b[i]) < std::min(p[i], q[i])) {
      return std::nullopt;
    }
  }
  const Point& up = scene.point(off_plane);
  const auto apart = [&](const Point& from, const Point& to, const Point& x,
                         const Point& y) {
    const Sign one = orient3d(from, to, up, x);
    return one != Sign::Zero && one == -orient3d(from, to, up, y);
  };
  if (!apart(p, q, a, b) || !apart(a, b, p, q)) return std::nullopt;
  const ExactPoint from = exact_point(a);
  const ExactPoint to = exact_point(b);
  const Rational x = exact_orient(exact_point(p), exact_point(q), exact_point(up), from);
  const Rational y = exact_orient(exact_point(p), exact_point(q), exact_point(up), to);
  return along(from, to, x / (x - y));
}

}  // namespace

int corner_off(const Scene& scene, std::span<const int> faces, const PlaneSide& plane) {
  for (const int f : faces) {
    for (const int p : scene.face_points(f)) {
      if (plane(scene.point(p)) != Sign::Zero) return p;
    }
  }
  return -1;
}

std::vector<ExactPoint> plane_crossings(const Scene& scene, std::span<const int> faces,
                                        const PlaneSide& plane, int off_plane) {
  std::vector<std::array<std::int32_t, 2>> sides;
  for (const int f : faces) {
    const auto corners = scene.face_points(f);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const int p = corners[k];
      const int q = corners[(k + 1) % corners.size()];
      if (plane(scene.point(p)) != Sign::Zero || plane(scene.point(q)) != Sign::Zero)
        continue;
      sides.push_back({std::min(p, q), std::max(p, q)});
    }
  }
  sort_unique(sides);
  std::vector<ExactPoint> found;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    hear_stop_now();
    for (std::size_t j = i + 1; j < sides.size(); ++j) {
      if (auto x = crossing(scene, sides[i], sides[j], off_plane)) {
        found.push_back(std::move(*x));
      }
    }
  }
  return found;
}

std::optional<Rational> parameter_towards(const ExactPoint& eye, const ExactPoint& x,
                                          const ExactPoint& off_plane,
                                          const ExactPoint& e0, const ExactPoint& e1) {
  const Rational a = exact_orient(eye, x, off_plane, e0);
  const Rational b = exact_orient(eye, x, off_plane, e1);
  if (a.sign() * b.sign() >= 0) return std::nullopt;
  return Rational(a / (a - b));
}

std::vector<Rational> pencil_stops(
    const Scene& scene, const std::array<std::array<std::int32_t, 2>, 3>& edges,
    std::span<const int> faces) {
  const auto at = [&](int edge, int k) -> const Point& {
    return scene.point(edges[edge][k]);
  };
  const auto coplanar = [&](int a, int b) {
    return orient3d(at(a, 0), at(a, 1), at(b, 0), at(b, 1)) == Sign::Zero;
  };
  const int other = coplanar(0, 1) ? 1 : coplanar(0, 2) ? 2 : -1;
  if (other < 0) return {};
  const int third = 3 - other;
  const int k = collinear(at(0, 0), at(0, 1), at(other, 0)) ? 1 : 0;
  const PlaneSide plane({at(0, 0), at(0, 1), at(other, k)});
  const int off_plane = corner_off(scene, faces, plane);
  if (off_plane < 0) return {};
  const auto point = [&](int edge, int i) { return exact_point(at(edge, i)); };
  const auto off = [&](const ExactPoint& x) {
    return exact_orient(point(0, 0), point(0, 1), point(other, k), x);
  };
  const Rational from = off(point(third, 0));
  const Rational to = off(point(third, 1));
  if (from == to) return {};
  const ExactPoint centre = along(point(third, 0), point(third, 1), from / (from - to));

  std::vector<ExactPoint> points = plane_crossings(scene, faces, plane, off_plane);
  std::vector<int> corners;
  for (const int f : faces) {
    for (const int p : scene.face_points(f)) {
      if (plane(scene.point(p)) == Sign::Zero) corners.push_back(p);
    }
  }
  sort_unique(corners);
  for (const int p : corners) points.push_back(exact_point(scene.point(p)));

  std::vector<Rational> found;
  const ExactPoint up = exact_point(scene.point(off_plane));
  for (const ExactPoint& x : points) {
    if (auto s = parameter_towards(centre, x, up, point(0, 0), point(0, 1))) {
      found.push_back(std::move(*s));
    }
  }
  return found;
}

}  // namespace sightline::internal
