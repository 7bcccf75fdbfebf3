#include "aspect/choice/apart.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

#include "linespace/numbers/rational.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

std::vector<Point> corners_of(const Scene& scene, int face) {
  std::vector<Point> out;
  for (const int p : scene.face_points(face)) out.push_back(scene.point(p));
  return out;
}

Point middle_of(std::span<const Point> polygon) {
  Point sum = Point::Zero();
  for (const Point& p : polygon) sum += p;
  return sum / static_cast<double>(polygon.size());
}

// Triangles with the same middle lines, or a fan of a larger polygon.
std::vector<std::vector<Point>> parts_of(std::span<const Point> polygon) {
  std::vector<std::vector<Point>> out;
  if (polygon.size() > 3) {
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
      out.push_back({polygon[0], polygon[k], polygon[k + 1]});
    return out;
  }
  const Point &a = polygon[0], &b = polygon[1], &c = polygon[2];
  const Point ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
  return {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}};
}

}  // namespace

SightProofs::SightProofs(const Scene& scene, const ViewSpace& space,
                         const std::vector<PatchSide>& sides)
    : scene_(&scene), space_(&space), sides_(&sides), occlusion_(scene) {}

bool SightProofs::hides(int face, const ViewRegion& region,
                        std::span<const Point> polygon) const {
  const std::vector<Point> f = corners_of(*scene_, face);
  const std::size_t n = f.size();
  // 1. The region on one side of the face's plane, the polygon on the other; some of each
  // may lie in it.
  const auto front = [&](const Point& p) { return orient3d(f[0], f[1], f[2], p); };
  int above = 0, below = 0;
  for (const Point& p : polygon) {
    above += front(p) == Sign::Positive ? 1 : 0;
    below += front(p) == Sign::Negative ? 1 : 0;
  }
  if ((above > 0) == (below > 0)) return false;
  const bool eyes_above = below > 0;
  const Point &b = f[eyes_above ? 1 : 2], &c = f[eyes_above ? 2 : 1];
  if (!space_->never_below(region, f[0], b, c)) return false;
  // 2. For eye E and point X, strictly on the two sides, XE crosses the face iff
  // (A - X) x (B - X) . (E - X) has the sign of the eyes' side, or is 0, for each side AB
  // of it.  That is linear in E and in X, so that corners tell of all of them.
  for (const Point& x : polygon) {
    for (std::size_t k = 0; k < n; ++k) {
      const Point &from = f[k], &to = f[(k + 1) % n];
      if (!space_->never_below(region, x, eyes_above ? from : to, eyes_above ? to : from))
        return false;
    }
  }
  return true;
}

bool SightProofs::face_hidden(const ViewRegion& region, std::span<const Point> polygon,
                              const PatchSide& side, int halvings) const {
  const Point from = space_->middle(region), to = middle_of(polygon);
  std::set<int> tried;
  for (const Contact& contact : occlusion_.contacts(from, to)) {
    for (const Touch& touch : contact.touches) {
      if (std::ranges::binary_search(side.faces, touch.face)) continue;
      if (tried.insert(touch.face).second && hides(touch.face, region, polygon))
        return true;
    }
  }
  if (tried.empty() || halvings == 0) return false;
  return std::ranges::all_of(parts_of(polygon), [&](const std::vector<Point>& part) {
    return face_hidden(region, part, side, halvings - 1);
  });
}

bool SightProofs::hidden(const ViewRegion& region, const PatchSide& side) const {
  return std::ranges::all_of(side.faces, [&](int face) {
    return face_hidden(region, corners_of(*scene_, face), side, 1);
  });
}

bool SightProofs::unseen(const ViewRegion& region, int side) const {
  return space_->behind(region, (*sides_)[side]);
}

bool SightProofs::never_both(int a, int b, int most_regions) const {
  const PatchSide &p = (*sides_)[a], &q = (*sides_)[b];
  if (a != b && p.group == q.group && p.along != q.along) {
    // Nobody is in front of both: the planes coincide, or face away from each other.
    const bool far = space_->whole().front().high[3] == 0;
    if (far || (p.along ? p : q).rank >= (p.along ? q : p).rank) return true;
  }
  std::vector<ViewRegion> open = space_->whole();
  for (int regions = 0; !open.empty();) {
    hear_stop();
    const ViewRegion region = open.back();
    open.pop_back();
    if (unseen(region, a) || unseen(region, b)) continue;
    if (hidden(region, p) || (a != b && hidden(region, q))) continue;
    if (++regions > most_regions) return false;
    for (const ViewRegion& half : space_->halves(region)) open.push_back(half);
  }
  return true;
}

bool SightProofs::buried(const PatchSide& side) const {
  const auto lies_on = [&](int face, int lid) {
    const std::vector<Point> polygon = corners_of(*scene_, face);
    const std::vector<Point> f = corners_of(*scene_, lid);
    const bool in_plane = std::ranges::all_of(polygon, [&](const Point& p) {
      return orient3d(f[0], f[1], f[2], p) == Sign::Zero;
    });
    if (!in_plane) return false;
    const auto cross = [](const Point& a, const Point& b, const Point& c) {
      const ExactPoint o = exact_point(a);
      return exact_cross(exact_difference(exact_point(b), o),
                         exact_difference(exact_point(c), o));
    };
    const ExactPoint normal = cross(f[0], f[1], f[2]);
    if (exact_dot(normal, cross(side.plane[0], side.plane[1], side.plane[2])) > 0)
      return false;
    return std::ranges::all_of(polygon, [&](const Point& p) {
      for (std::size_t k = 0; k < f.size(); ++k) {
        if (exact_dot(normal, cross(f[k], f[(k + 1) % f.size()], p)) < 0) return false;
      }
      return true;
    });
  };
  return std::ranges::all_of(side.faces, [&](int face) {
    const std::vector<Point> p = corners_of(*scene_, face);
    const std::vector<int> near = occlusion_.faces_meeting_triangle(p[0], p[1], p[2]);
    return std::ranges::any_of(near, [&](int lid) {
      return lid != face && scene_->solid_behind(lid) && lies_on(face, lid);
    });
  });
}

}  // namespace sightline::internal
