#include "linespace/sight/critical_cuts.h"

#include <algorithm>

#include "linespace/contacts/contact.h"
#include "linespace/lines/rounded_root.h"
#include "linespace/sight/plane_crossings.h"
#include "linespace/silhouettes/drawn.h"
#include "linespace/silhouettes/plane_values.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {

std::vector<Cut> critical_cuts(const Silhouettes& g, const Star& star, const Point& e0,
                               const Point& e1, const PlaneSide& plane,
                               std::span<const int> faces,
                               std::deque<Rational>& positions) {
  const Scene& scene = g.scene();
  const Point& v = scene.point(star.point);
  std::vector<Cut> cuts;
  // A corner off the plane of viewpoint and edge: with a point of that plane and the
  // viewpoint it spans a plane that crosses the edge where the line to the point does.
  const int off_plane = corner_off(scene, faces, plane);
  // Appends the cut by a plane through three points, where it lies inside the edge.
  const auto add = [&](CutKind kind, int feature, std::array<std::int32_t, 3> points) {
    const PlaneSide cutter(
        {scene.point(points[0]), scene.point(points[1]), scene.point(points[2])});
    const PlaneValues on_edge = plane_values(cutter, e0, e1);
    if (on_edge.sign0 == on_edge.sign1 || on_edge.zero_at_end()) return;
    cuts.push_back(make_cut(kind, feature, points, on_edge.at0, on_edge.at1));
  };
  // 1. By each face: where the line passes one of its sides, or one of its corners that
  // lies in the plane of viewpoint and edge, and where it ends in the face's plane.
  for (const int f : faces) {
    hear_stop();
    const auto corners = scene.face_points(f);
    const std::size_t n = corners.size();
    for (std::size_t k = 0; k < n; ++k) {
      const int p = corners[k];
      const int q = corners[(k + 1) % n];
      // A side that ends in the viewpoint spans no plane with it.
      if (p != star.point && q != star.point) {
        const int edge = scene.edge_of_side(f, static_cast<int>(k));
        add(CutKind::Side, edge, {star.point, std::min(p, q), std::max(p, q)});
      }
      if (p != star.point && off_plane >= 0 && plane(scene.point(p)) == Sign::Zero) {
        add(CutKind::Side, -1, {star.point, p, off_plane});
      }
    }
    // The plane of a face at the viewpoint bounds where that supports; any other one is
    // where the edge enters the face.
    const bool at_viewpoint = g.face_plane(f)(v) == Sign::Zero;
    add(at_viewpoint ? CutKind::Support : CutKind::Pierce, scene.faces()[f].facet,
        plane_points(scene, f));
  }
  // 2. Where faces cross each other in the plane of viewpoint and edge, in points that
  // are no corners: their coordinates are rational, and so is the place on the edge.
  if (off_plane >= 0) {
    const ExactPoint eye = exact_point(v);
    const ExactPoint up = exact_point(scene.point(off_plane));
    for (const ExactPoint& x : plane_crossings(scene, faces, plane, off_plane)) {
      hear_stop();
      // None: the line through the point does not meet the edge.
      auto s = parameter_towards(eye, x, up, exact_point(e0), exact_point(e1));
      if (!s) continue;
      positions.push_back(std::move(*s));
      cuts.push_back(exact_cut(positions.back()));
    }
  }
  // 3. At a corner that is no convex cone: where two of its edges appear in line, so that
  // the gaps between its faces open or close.
  if (!star.convex) {
    for (std::size_t i = 0; i < star.rays.size(); ++i) {
      for (std::size_t j = i + 1; j < star.rays.size(); ++j) {
        if (collinear(v, scene.point(star.rays[i]), scene.point(star.rays[j]))) continue;
        add(CutKind::Saddle, -1, {star.point, star.rays[i], star.rays[j]});
      }
    }
  }
  // 4. In order along the edge, each position once: which of two equal cuts stays does
  // not matter, since the contacts of the line there are listed.
  const LineThrough line{e0, e1};
  std::sort(cuts.begin(), cuts.end(), [&](const Cut& a, const Cut& b) {
    hear_stop();
    return compare(scene, line, a, b) == Sign::Negative;
  });
  cuts.erase(std::unique(cuts.begin(), cuts.end(),
                         [&](const Cut& a, const Cut& b) {
                           return compare(scene, line, a, b) == Sign::Zero;
                         }),
             cuts.end());
  return cuts;
}

}  // namespace sightline::internal
