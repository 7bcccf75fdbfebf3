// The faces around corners.

#include <algorithm>

#include "linespace/stop_scope_internal.h"
#include "skeleton/generators_internal.h"
#include "skeleton/parallel_internal.h"

namespace sightline::internal {
namespace {

// Same ray from the origin: collinear, and not opposite.
bool same_direction(const Point& origin, const Point& p, const Point& q) {
  if (!collinear(origin, p, q)) return false;
  for (int i = 0; i < 3; ++i) {
    if (p[i] != origin[i])
      return (p[i] > origin[i]) == (q[i] > origin[i]) && q[i] != origin[i];
  }
  return false;
}

}  // namespace

void Generators::find_stars(const Request& request, Stage& stage) {
  const auto corners = scene_->corners();
  star_of_point_.assign(scene_->points().size(), -1);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    star_of_point_[corners[i]] = static_cast<int>(i);
  }
  stars_.resize(corners.size());
  for_each_of(0, corners.size(), corners.size(), request, stage,
              [&](std::size_t i) { stars_[i] = star_at(corners[i]); });
}

Star Generators::star_at(int p) const {
  const Scene& s = *scene_;
  Star star;
  star.point = p;
  const Point& at = s.point(p);
  const auto own = s.faces_at(p);
  star.faces.assign(own.begin(), own.end());
  std::vector<std::array<std::int32_t, 3>> wedges;  // far point, far point, facet
  for (const int f : own) {
    const auto c = s.face_points(f);
    const std::size_t n = c.size();
    const auto k = static_cast<std::size_t>(std::find(c.begin(), c.end(), p) - c.begin());
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
  const Box box = box_of(std::array<Point, 1>{at});
  face_tree_.traverse([&](const Box& other) { return boxes_meet(box, other); },
                      [&](std::uint32_t item) {
                        hear_stop();
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
  sort_unique(star.facets);
  const auto ray = [&](std::int32_t far) {
    hear_stop();
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
  bool convex = !star.touched && std::all_of(own.begin(), own.end(),
                                             [&](int f) { return solid_behind(f); });
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
  return star;
}

}  // namespace sightline::internal
