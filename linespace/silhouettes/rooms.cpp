#include "linespace/silhouettes/rooms.h"

#include <algorithm>

#include "linespace/numbers/rational.h"
#include "linespace/silhouettes/silhouettes.h"
#include "linespace/swaths/edge_cuts.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

bool strictly_inside(const RoomsQuestion& q, const Object& object, const Point& p) {
  return std::all_of(object.faces.begin(), object.faces.end(),
                     [&](int f) { return q.face_planes[f](p) == Sign::Negative; });
}

// The part of a convex polygon behind a plane or on it.
std::vector<ExactPoint> clipped(const std::vector<ExactPoint>& polygon,
                                const std::array<ExactPoint, 3>& plane) {
  const auto height = [&](const ExactPoint& p) {
    const ExactPoint a = exact_difference(plane[1], plane[0]);
    const ExactPoint b = exact_difference(plane[2], plane[0]);
    return exact_dot(exact_cross(a, b), exact_difference(p, plane[0]));
  };
  std::vector<ExactPoint> out;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const ExactPoint& p = polygon[k];
    const ExactPoint& q = polygon[(k + 1) % polygon.size()];
    const Rational x = height(p);
    const Rational y = height(q);
    if (x <= 0) out.push_back(p);
    if ((x < 0 && y > 0) || (x > 0 && y < 0)) {
      const Rational s = x / (x - y);
      out.push_back(
          {p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1]), p[2] + s * (q[2] - p[2])});
    }
  }
  return out;
}

// Some point of the face is strictly inside the convex object: the part of the face that
// is not in front of any of the object's planes is not empty, and in none of them.
bool reaches_inside(const RoomsQuestion& q, int face, const Object& object) {
  const auto corners = q.scene.face_points(face);
  const bool corner_inside = std::any_of(corners.begin(), corners.end(), [&](int p) {
    return strictly_inside(q, object, q.scene.point(p));
  });
  if (corner_inside) return true;
  const bool beyond = std::any_of(object.faces.begin(), object.faces.end(), [&](int f) {
    return std::all_of(corners.begin(), corners.end(), [&](int p) {
      return q.face_planes[f](q.scene.point(p)) != Sign::Negative;
    });
  });
  if (beyond) return false;
  std::vector<ExactPoint> part;
  for (const int p : corners) part.push_back(exact_point(q.scene.point(p)));
  std::vector<std::array<ExactPoint, 3>> planes;
  for (const int f : object.faces) {
    const auto t = plane_points(q.scene, f);
    planes.push_back({exact_point(q.scene.point(t[0])), exact_point(q.scene.point(t[1])),
                      exact_point(q.scene.point(t[2]))});
    hear_stop_now();
    part = clipped(part, planes.back());
    if (part.empty()) return false;
  }
  return std::all_of(planes.begin(), planes.end(), [&](const auto& plane) {
    return std::any_of(part.begin(), part.end(), [&](const ExactPoint& p) {
      return exact_orient(plane[0], plane[1], plane[2], p).sign() < 0;
    });
  });
}

bool is_empty(const RoomsQuestion& q, int room) {
  const Object& object = q.scene.objects()[room];
  const Box& box = q.object_boxes[room];
  bool empty = true;
  q.face_tree.traverse([&](const Box& other) { return empty && boxes_meet(box, other); },
                       [&](std::uint32_t item) {
                         hear_stop();
                         const int f = static_cast<int>(item);
                         if (!empty || q.scene.faces()[f].object == room) return;
                         empty = !reaches_inside(q, f, object);
                       });
  return empty;
}

// Closed objects that have the point strictly inside, but for those in whose hollows it
// is.
template <class P>
std::vector<int> all_but_hollows(const Scene& scene, const SolidIndex& solids,
                                 const P& p) {
  std::vector<int> around = solids.solids_around(p);
  for (const Scene::Hollow& hollow : scene.hollows()) {
    hear_stop();
    const auto at = std::find(around.begin(), around.end(), hollow.around);
    if (at == around.end()) continue;
    const auto w = solids.windings(hollow.object, p);
    if (!w || w->solid < 0) around.erase(at);
  }
  return around;
}

}  // namespace

std::vector<std::uint8_t> empty_rooms(const RoomsQuestion& q) {
  std::vector<std::uint8_t> empty(q.scene.objects().size(), 0);
  for (std::size_t o = 0; o < empty.size(); ++o) {
    if (!q.scene.objects()[o].inside_out || q.convex[o] == 0) continue;
    empty[o] = is_empty(q, static_cast<int>(o));
  }
  return empty;
}

bool in_material(const Scene& scene, const SolidIndex& solids, const Point& p) {
  if (scene.hollows().empty()) return solids.in_solid(p);
  return !all_but_hollows(scene, solids, p).empty();
}

bool in_material(const Scene& scene, const SolidIndex& solids, const ExactPoint& p) {
  return !all_but_hollows(scene, solids, p).empty();
}

std::vector<int> material_at(const Scene& scene, const SolidIndex& solids,
                             const ExactPoint& p) {
  std::vector<int> objects = all_but_hollows(scene, solids, p);
  std::ranges::sort(objects);
  return objects;
}

}  // namespace sightline::internal
