#include "linespace/blockers/occluder_shadow.h"

#include <algorithm>
#include <array>
#include <vector>

namespace sightline::internal {

Shadow solid_shadow(const Silhouettes& g, int object, const Point& at) {
  const Scene& scene = g.scene();
  Shadow shadow;
  std::vector<BoundedPlane> faces;                 // last: most boxes are beside a shadow
  std::vector<std::array<std::int32_t, 3>> sides;  // smaller id, larger id, direction
  for (const int f : scene.objects()[object].faces) {
    if (g.face_plane(f)(at) != Sign::Positive) continue;
    const auto [a, b, c] = face_plane_through(scene, f);
    faces.push_back(plane_seen_from(at, a, b, c));
    const auto p = scene.face_points(f);
    for (std::size_t k = 0; k < p.size(); ++k) {
      const int from = p[k];
      const int to = p[(k + 1) % p.size()];
      sides.push_back({std::min(from, to), std::max(from, to), from < to});
    }
  }
  std::sort(sides.begin(), sides.end());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (i + 1 < sides.size() && sides[i][0] == sides[i + 1][0] &&
        sides[i][1] == sides[i + 1][1]) {
      ++i;
      continue;
    }
    const bool forward = sides[i][2] != 0;
    const Point& p = scene.point(sides[i][forward ? 0 : 1]);
    const Point& q = scene.point(sides[i][forward ? 1 : 0]);
    // The face lies to the left of its side pq: negative for the plane (viewpoint, p, q).
    shadow.planes.push_back(plane_from(at, p, q));
  }
  shadow.planes.insert(shadow.planes.end(), faces.begin(), faces.end());
  return shadow;
}

Shadow facet_shadow(const Silhouettes& g, int face, const Point& at) {
  const Scene& scene = g.scene();
  Shadow shadow;
  const auto outline = g.facet_outline(scene.faces()[face].facet);
  const Sign here = g.face_plane(face)(at);
  if (here == Sign::Zero) return shadow;
  const bool front = here == Sign::Positive;
  const auto add = [&](int from, int to) {
    const Point& p = scene.point(front ? from : to);
    const Point& q = scene.point(front ? to : from);
    shadow.planes.push_back(plane_from(at, p, q));
  };
  for (const auto& side : outline) add(side[0], side[1]);
  if (outline.empty()) {
    const auto corners = scene.face_points(face);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      add(corners[k], corners[(k + 1) % corners.size()]);
    }
  }
  const auto [a, b, c] = face_plane_through(scene, face);
  shadow.planes.push_back(front ? plane_seen_from(at, a, b, c)
                                : plane_seen_from(at, a, c, b));
  return shadow;
}

std::int64_t occluder_key(const Silhouettes& g, int face) {
  const Scene& scene = g.scene();
  const Face& f = scene.faces()[face];
  if (g.convex_solid(f.object)) return f.object;
  const auto objects = static_cast<std::int64_t>(scene.objects().size());
  if (!g.facet_outline(f.facet).empty()) return objects + f.facet;
  return objects + static_cast<std::int64_t>(scene.facets().size()) + face;
}

void add_occluder_faces(const Silhouettes& g, int face,
                        std::vector<std::int32_t>& faces) {
  const Scene& scene = g.scene();
  const Face& f = scene.faces()[face];
  if (g.convex_solid(f.object)) {
    const auto& all = scene.objects()[f.object].faces;
    faces.insert(faces.end(), all.begin(), all.end());
  } else if (!g.facet_outline(f.facet).empty()) {
    const auto& all = scene.facets()[f.facet].faces;
    faces.insert(faces.end(), all.begin(), all.end());
  } else {
    faces.push_back(face);
  }
}

int propose_occluder(const Silhouettes& g, const Point& from, const Point& target,
                     std::span<const std::uint32_t> facet_stamp, std::uint32_t stamp) {
  const Scene& scene = g.scene();
  const Point d = target - from;
  std::array<double, 3> inverse;
  for (int i = 0; i < 3; ++i) inverse[i] = 1 / d[i];
  double nearest = 1;
  int hit = -1;
  const Bvh& tree = g.face_tree();
  if (tree.empty()) return -1;
  const auto entry = [&](const Box& box) {
    double t0 = 0, t1 = nearest;
    for (int i = 0; i < 3; ++i) {
      double a = (box.min[i] - from[i]) * inverse[i];
      double b = (box.max[i] - from[i]) * inverse[i];
      if (a > b) std::swap(a, b);
      if (a > t0) t0 = a;
      if (b < t1) t1 = b;
    }
    return t0 <= t1 ? t0 : 2.0;
  };
  std::uint32_t stack[128];
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const Bvh::Node& node = tree.node(stack[--top]);
    if (entry(node.box) > nearest) continue;
    if (node.count == 0) {
      const double left = entry(tree.node(node.first).box);
      const double right = entry(tree.node(node.first + 1).box);
      const bool left_first = left <= right;
      stack[top++] = node.first + (left_first ? 1 : 0);
      stack[top++] = node.first + (left_first ? 0 : 1);
      continue;
    }
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const int f = static_cast<int>(tree.items()[node.first + i]);
      const auto corners = scene.face_points(f);
      const Point& a = scene.point(corners[0]);
      const Point n = (scene.point(corners[1]) - a).cross(scene.point(corners[2]) - a);
      const double slope = n.dot(d);
      const double t = n.dot(a - from) / slope;
      if (facet_stamp[scene.faces()[f].facet] == stamp) continue;
      if (!(t > 0 && t < nearest)) continue;
      bool inside = true;
      for (std::size_t k = 0; k < corners.size() && inside; ++k) {
        const Point p = scene.point(corners[k]) - from;
        const Point q = scene.point(corners[(k + 1) % corners.size()]) - from;
        inside = p.cross(q).dot(d) * slope >= 0;
      }
      if (inside) {
        nearest = t;
        hit = f;
      }
    }
  }
  return hit;
}

}  // namespace sightline::internal
