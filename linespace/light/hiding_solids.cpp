#include "linespace/light/hiding_solids.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace sightline::internal {
namespace {

// Solids of more faces are slow to ask, and rarely hide more than their faces do.
constexpr std::size_t kMostFaces = 24;

Box around(const Scene& scene, std::span<const int> faces) {
  std::vector<Point> points;
  for (const int f : faces) {
    for (const int p : scene.face_points(f)) points.push_back(scene.point(p));
  }
  return box_of(points);
}

bool segment_meets(const Point& p, const Point& q, const Box& box) {
  double from = 0;
  double to = 1;
  for (int i = 0; i < 3; ++i) {
    const double way = q[i] - p[i];
    if (way == 0) {
      if (p[i] < box.min[i] || p[i] > box.max[i]) return false;
      continue;
    }
    const double a = (box.min[i] - p[i]) / way;
    const double b = (box.max[i] - p[i]) / way;
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from <= to;
}

}  // namespace

HidingSolids::HidingSolids(const LightSpace& space) : space_(space) {
  const Scene& scene = space.scene();
  std::vector<Box> boxes;
  for (std::size_t o = 0; o < scene.objects().size(); ++o) {
    const Object& object = scene.objects()[o];
    if (space.convex_solid(static_cast<int>(o)) && object.faces.size() <= kMostFaces) {
      Occluder& solid = occluders_.emplace_back();
      for (const int f : object.faces) {
        const auto p = scene.face_points(f);
        const Point& a = scene.point(p[0]);
        const Point n = (scene.point(p[1]) - a).cross(scene.point(p[2]) - a);
        // Values are off by less than 2^-48 |n| times the size.
        solid.planes.push_back({n, n.dot(a) - 0x1p-40 * n.norm() * space.size()});
      }
      boxes.push_back(around(scene, object.faces));
      continue;
    }
    for (const int f : object.faces) {
      occluders_.push_back({{}, f});
      boxes.push_back(space.faces()[f].box);
    }
  }
  tree_ = std::make_unique<Bvh>(boxes);
}

void HidingSolids::between(const LightPoint& p, const LightPoint& q,
                           std::vector<int>& out) const {
  const auto first = static_cast<std::ptrdiff_t>(out.size());
  tree_->traverse(
      [&](const Box& box) { return segment_meets(p.rounded, q.rounded, box); },
      [&](std::uint32_t i) {
        if (hides(occluders_[i], p, q)) out.push_back(static_cast<int>(i));
      });
  std::sort(out.begin() + first, out.end());
}

bool HidingSolids::hides(const Occluder& occluder, const LightPoint& p,
                         const LightPoint& q) const {
  if (occluder.face < 0) {
    double from = 0;
    double to = 1;
    for (const Plane& plane : occluder.planes) {
      const double at_p = plane.normal.dot(p.rounded) - plane.offset;
      const double at_q = plane.normal.dot(q.rounded) - plane.offset;
      if (at_p >= 0 && at_q >= 0) return false;
      if (at_p > 0) from = std::max(from, at_p / (at_p - at_q));
      if (at_q > 0) to = std::min(to, at_p / (at_p - at_q));
    }
    return from + 0x1p-30 < to;
  }
  const LightFace& face = space_.faces()[occluder.face];
  const Approx at_p = value(face.plane.near, p.near);
  const Approx at_q = value(face.plane.near, q.near);
  if (!is_certain(at_p) || !is_certain(at_q) || (at_p.v > 0) == (at_q.v > 0))
    return false;
  const Six<Approx> line = join(p.near, q.near);
  int left = 0;
  for (const LightFace::Side& s : face.sides) {
    const Approx turn = side(line, s.line->near);
    if (!is_certain(turn)) return false;
    left += (turn.v > 0) == s.forward ? 1 : 0;
  }
  return left == 0 || left == static_cast<int>(face.sides.size());
}

void keep_common(std::vector<int>& x, const std::vector<int>& y) {
  std::erase_if(x, [&](int i) { return !std::ranges::binary_search(y, i); });
}

}  // namespace sightline::internal
