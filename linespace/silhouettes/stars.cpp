// The faces around corners.

#include <algorithm>
#include <array>

#include "linespace/silhouettes/silhouettes.h"
#include "linespace/work/parallel.h"
#include "linespace/work/stop_scope.h"

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

// The angle of a face at one of its corners, or all around a point of it that is none,
// as wedges of less than half a turn: (far point, far point, facet).
using Wedge = std::array<std::int32_t, 3>;
void add_wedges(const Scene& s, int f, int p, std::vector<Wedge>& wedges) {
  const Point& at = s.point(p);
  const auto c = s.face_points(f);
  const std::size_t n = c.size();
  const int facet = s.faces()[f].facet;
  const auto found = std::find(c.begin(), c.end(), p);
  if (found == c.end()) {
    const InPlaneSide left_of(s, f);
    for (std::size_t k = 0; k < n; ++k) {
      const int q = c[k];
      const int r = c[(k + 1) % n];
      if (left_of(s.point(q), s.point(r), at) != Sign::Zero)
        wedges.push_back({q, r, facet});
    }
    return;
  }
  const auto k = static_cast<std::size_t>(found - c.begin());
  const int next = c[(k + 1) % n];
  const int previous = c[(k + n - 1) % n];
  if (!collinear(at, s.point(next), s.point(previous))) {
    wedges.push_back({next, previous, facet});
    return;
  }
  // The point lies on a straight side of the polygon: half a plane.
  for (std::size_t m = 2; m < n; ++m) {
    const int third = c[(k + m) % n];
    if (collinear(at, s.point(next), s.point(third))) continue;
    wedges.push_back({next, third, facet});
    wedges.push_back({third, previous, facet});
    break;
  }
}

// The far ends of a face's sides with the point that are edges: sides of its wedges.
std::vector<std::int32_t> ends_of_edges_at(const Scene& s, int f, int p) {
  const auto c = s.face_points(f);
  const std::size_t n = c.size();
  std::vector<std::int32_t> ends;
  for (std::size_t k = 0; k < n; ++k) {
    if (s.edge_of_side(f, static_cast<int>(k)) < 0) continue;
    const int q = c[k];
    const int r = c[(k + 1) % n];
    const Point& at = s.point(p);
    const bool beside = !collinear(at, s.point(q), s.point(r)) ||
                        same_direction(at, s.point(q), s.point(r));
    if (q != p && r != p && beside) continue;
    if (q != p) ends.push_back(q);
    if (r != p) ends.push_back(r);
  }
  return ends;
}

// The solids around the star are locally one convex cone.
bool is_one_cone(const Silhouettes& g, const Star& star, std::span<const Wedge> wedges) {
  const Scene& s = g.scene();
  const auto edges = s.edges_at(star.point);
  bool convex = std::all_of(star.faces.begin(), star.faces.end(),
                            [&](int f) { return g.solid_behind(f); }) &&
                std::all_of(edges.begin(), edges.end(),
                            [&](int e) { return s.edges()[e].kind == EdgeKind::Convex; });
  // Locally convex along every edge and one fan: check it is one cone.
  for (const int f : star.faces) {
    if (!convex) break;
    const int facet = s.faces()[f].facet;
    for (const Wedge& w : wedges) {
      if (w[2] == facet) continue;
      for (int end = 0; end < 2 && convex; ++end) {
        if (g.face_plane(f)(s.point(w[end])) != Sign::Positive) continue;
        // Rays shared with the facet itself may rise above another of its triangles.
        convex = std::any_of(wedges.begin(), wedges.end(), [&](const Wedge& other) {
          return other[2] == facet && (other[0] == w[end] || other[1] == w[end]);
        });
      }
    }
  }
  return convex;
}

}  // namespace

void Silhouettes::find_stars(const Request& request, Stage& stage) {
  const auto corners = scene_->corners();
  star_of_point_.assign(scene_->points().size(), -1);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    star_of_point_[corners[i]] = static_cast<int>(i);
  }
  stars_.resize(corners.size());
  for_each_of(0, corners.size(), corners.size(), request, stage,
              [&](std::size_t i) { stars_[i] = star_of(corners[i]); });
}

// None of these faces of the facet, all that have the point, has it on a side that is an
// edge.
bool Silhouettes::inside_facet(int point, int facet,
                               std::span<const std::int32_t> faces) const {
  const Scene& s = *scene_;
  const Point& at = s.point(point);
  for (const int f : faces) {
    if (s.faces()[f].facet != facet) continue;
    const auto c = s.face_points(f);
    for (std::size_t k = 0; k < c.size(); ++k) {
      if (s.edge_of_side(f, static_cast<int>(k)) < 0) continue;
      const int p = c[k];
      const int q = c[(k + 1) % c.size()];
      if (p == point || q == point || collinear(s.point(p), s.point(q), at)) return false;
    }
  }
  return true;
}

Star Silhouettes::star_of(int p) const {
  const Scene& s = *scene_;
  const Point& at = s.point(p);
  Star star;
  star.point = p;
  // 1. Its own facets: those with a corner here.
  for (const int e : s.edges_at(p)) {
    for (const Edge::Side& side : s.edges()[e].sides) {
      star.facets.push_back(s.faces()[side.face].facet);
    }
  }
  sort_unique(star.facets);
  // A facet may have several faces here: each of them is own, or none.
  const auto is_own = [&](int f) {
    return std::binary_search(star.facets.begin(), star.facets.end(), s.faces()[f].facet);
  };
  // 2. The faces at the point: whether it is one of their vertices does not matter. Those
  // that have it inside or on a side come from the boxes that contain it.
  star.faces.assign(s.faces_at(p).begin(), s.faces_at(p).end());
  const Box box = box_of(std::array<Point, 1>{at});
  face_tree_.traverse([&](const Box& other) { return boxes_meet(box, other); },
                      [&](std::uint32_t item) {
                        const int f = static_cast<int>(item);
                        // Faces with the point for a vertex are known; others must
                        // have it in their plane, and not outside of their sides.
                        if (has_point(s, f, p) || face_planes_[f](at) != Sign::Zero)
                          return;
                        if (locate_in_plane(s, f, at) != PointInFace::Outside)
                          star.faces.push_back(f);
                      });
  // 3. Facets of others that the point lies on.  Inside of one, all lines but those in
  // its plane cross it.
  std::vector<Wedge> wedges;
  for (const int f : star.faces) add_wedges(s, f, p, wedges);
  std::vector<std::int32_t> foreign;
  for (const int f : star.faces) {
    if (!is_own(f)) foreign.push_back(s.faces()[f].facet);
  }
  sort_unique(foreign);
  // One face of such a facet is kept, for its plane.
  for (const int facet : foreign) {
    if (!inside_facet(p, facet, star.faces)) continue;
    star.in_plane_only = true;
    star.planes.push_back(
        *std::find_if(star.faces.begin(), star.faces.end(),
                      [&](std::int32_t f) { return s.faces()[f].facet == facet; }));
  }
  // 4. Near the point each face is a wedge between two rays.  Rays of one direction are
  // one, however far their ends are: `ray` finds the number of the ray towards a point.
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
  // 5. Which rays are edges; the other ones only divide faces of one facet.
  star.along_edge.assign(star.rays.size(), 0);
  for (const int f : star.faces) {
    for (const int end : ends_of_edges_at(s, f, p)) star.along_edge[ray(end)] = 1;
  }

  // 6. Touched by nothing, and the intersection of the half-spaces behind its faces: such
  // a corner is judged by its planes alone.
  star.touched = !foreign.empty() || objects_at(p).size() > 1;
  star.convex = !star.touched && is_one_cone(*this, star, wedges);
  return star;
}

}  // namespace sightline::internal
