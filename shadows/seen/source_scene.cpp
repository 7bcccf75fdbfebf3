#include "shadows/seen/source_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <ranges>

#include "linespace/picture/classes.h"
#include "linespace/picture/patches.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

// The interval of a coordinate axis that two points cover.
std::array<double, 2> interval(const Scene& scene, const std::array<int, 2>& ends,
                               int axis) {
  const double a = scene.point(ends[0])[axis], b = scene.point(ends[1])[axis];
  return {std::min(a, b), std::max(a, b)};
}

// Andrew's chain over the plane's two widest coordinates.
std::vector<Point> hull_of(const Scene& scene, const SourcePlane& plane) {
  std::vector<Point> points;
  for (const auto& sides : plane.sides) {
    for (const auto& side : sides) points.push_back(scene.point(side.ends[0]));
  }
  const auto& first = plane.sides.front();
  const Point a = scene.point(first[0].ends[0]);
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (const auto& side : first) {
    normal += (scene.point(side.ends[0]) - a).cross(scene.point(side.ends[1]) - a);
  }
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  std::ranges::sort(points, [&](const Point& p, const Point& q) {
    return std::pair(p[x], p[y]) < std::pair(q[x], q[y]);
  });
  std::vector<Point> hull;
  const auto go = [&](std::size_t base, const Point& p) {
    const auto right = [&](const Point& o, const Point& q) {
      return (q[x] - o[x]) * (p[y] - o[y]) - (q[y] - o[y]) * (p[x] - o[x]) <= 0;
    };
    while (hull.size() >= base + 2 && right(hull[hull.size() - 2], hull.back()))
      hull.pop_back();
    hull.push_back(p);
  };
  for (const Point& p : points) go(0, p);
  const std::size_t base = hull.size() - 1;
  for (const Point& p : points | std::views::reverse) go(base, p);
  hull.pop_back();
  if (normal[axis] < 0) std::ranges::reverse(hull);
  return hull;
}

}  // namespace

SourceScene::SourceScene(const Scene& scene, const LightSource& source,
                         const Request& request)
    : scene_(scene, request) {
  group_by_planes(source);
  int names = 0, numbers = 0;
  std::vector<std::array<int, 2>> lines;
  for (SourcePlane& plane : planes_) {
    for (std::size_t i = 0; i < plane.faces.size(); ++i) {
      const auto corners = scene.face_points(plane.faces[i]);
      auto& sides = plane.sides.emplace_back();
      const auto n = static_cast<int>(corners.size());
      for (int k = 0; k < n; ++k) {
        const int p = corners[k], q = corners[(k + 1) % n];
        lines.push_back(plane.fronts[i] ? std::array{p, q} : std::array{q, p});
        const auto line = static_cast<int>(scene_.lines().size() + lines.size() - 1);
        sides.push_back({lines.back(), line, -1});
      }
    }
    name_sides(plane, names);
    find_source_faces(plane, numbers);
    plane.hull = hull_of(scene, plane);
  }
  find_diagonals();
  scene_ = scene_.with_lines({}, lines);
}

// Plane facets by patch, so that what touches or overlaps comes together; the triangles
// of a polygon that rounding has bent each for itself.
void SourceScene::group_by_planes(const LightSource& source) {
  const Scene& scene = scene_.scene();
  std::map<std::array<int, 2>, int> positions;
  const auto add = [&](int face, bool front) {
    const int facet = scene.faces()[face].facet;
    const bool planar = scene.facets()[facet].planar;
    const std::array<int, 2> key{planar ? scene_.patch(facet, front) : -1,
                                 planar ? -1 : 2 * face + (front ? 0 : 1)};
    const auto [it, is_new] = positions.emplace(key, static_cast<int>(planes_.size()));
    if (is_new) planes_.emplace_back();
    planes_[it->second].faces.push_back(face);
    planes_[it->second].fronts.push_back(front);
  };
  for (const int f : source.faces) {
    const bool front = !scene.turned(f);
    add(f, front);
    if (std::ranges::binary_search(source.both_sides, f)) add(f, !front);
  }
}

void SourceScene::name_sides(SourcePlane& plane, int& names) const {
  const Scene& scene = scene_.scene();
  std::vector<SourcePlane::Side*> sides;
  for (auto& of_face : plane.sides) {
    for (auto& side : of_face) sides.push_back(&side);
  }
  const InPlaneSide in_plane(scene, plane.faces.front());
  const auto same_side = [&](const SourcePlane::Side& s, const SourcePlane::Side& t) {
    const Point &p = scene.point(s.ends[0]), &q = scene.point(s.ends[1]);
    for (const int x : t.ends) {
      if (in_plane(p, q, scene.point(x)) != Sign::Zero) return false;
    }
    int axis = 0;
    (q - p).cwiseAbs().maxCoeff(&axis);
    const auto a = interval(scene, s.ends, axis), b = interval(scene, t.ends, axis);
    const double along = scene.point(t.ends[1])[axis] - scene.point(t.ends[0])[axis];
    return (along > 0) == (q[axis] - p[axis] > 0) &&
           std::max(a[0], b[0]) <= std::min(a[1], b[1]);
  };
  Classes classes(sides.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    hear_stop();
    for (std::size_t j = 0; j < i; ++j) {
      if (same_side(*sides[i], *sides[j]))
        classes.join(static_cast<int>(i), static_cast<int>(j));
    }
  }
  for (std::size_t i = 0; i < sides.size(); ++i)
    sides[i]->name = names + classes.root(static_cast<int>(i));
  names += static_cast<int>(sides.size());
}

void SourceScene::find_source_faces(SourcePlane& plane, int& numbers) const {
  const Scene& scene = scene_.scene();
  const auto n = static_cast<int>(plane.faces.size());
  Classes classes(plane.faces.size());
  for (int i = 0; i < n; ++i) {
    hear_stop();
    const Box& box = scene_.silhouettes().face_box(plane.faces[i]);
    for (int j = 0; j < i; ++j) {
      if (boxes_meet(box, scene_.silhouettes().face_box(plane.faces[j])) &&
          hang_together(scene, plane.faces[i], plane.faces[j])) {
        classes.join(i, j);
      }
    }
  }
  for (int i = 0; i < n; ++i) plane.source_face.push_back(numbers + classes.root(i));
  numbers += n;
}

// The triangles of a bent polygon are planes of their own, and share corners.
void SourceScene::find_diagonals() {
  std::map<std::array<int, 2>, std::vector<SourcePlane*>> bent;  // by facet and side
  for (SourcePlane& plane : planes_) {
    const int facet = scene_.scene().faces()[plane.faces.front()].facet;
    if (scene_.scene().facets()[facet].planar) continue;
    auto& triangles = bent[{facet, plane.fronts.front() ? 1 : 0}];
    for (SourcePlane* other : triangles) {
      for (SourcePlane::Side& s : plane.sides.front()) {
        for (SourcePlane::Side& t : other->sides.front()) {
          if (s.ends[0] != t.ends[1] || s.ends[1] != t.ends[0]) continue;
          s.twin_line = t.line;
          t.twin_line = s.line;
        }
      }
      plane.source_face = other->source_face;
    }
    triangles.push_back(&plane);
  }
}

ExactPoint SourceScene::crossing(const SourcePlane& plane, int p, int q) const {
  const std::array<int, 3> key{static_cast<int>(&plane - planes_.data()), p, q};
  {
    const std::scoped_lock lock(mutex_);
    if (const auto it = crossings_.find(key); it != crossings_.end()) return it->second;
  }
  const ExactPoint x = scene_.exact(p), y = scene_.exact(q);
  const Rational u = scene_.exact_plane_value(plane.faces.front(), x);
  const Rational v = scene_.exact_plane_value(plane.faces.front(), y);
  ExactPoint at = along(x, y, quotient(u, u - v));
  const std::scoped_lock lock(mutex_);
  return crossings_.emplace(key, std::move(at)).first->second;
}

}  // namespace sightline::internal
