// Winding numbers, counted along a ray from the point that is moved aside infinitesimally
// where it would meet an edge or a corner (Edelsbrunner and Muecke 1990, "Simulation of
// simplicity").
//
// Let the ray run along coordinate axis k, and let u, v be the two axes after it.  All
// faces are dropped onto the plane of u and v, where the ray is a point.  This point is
// taken at (p_u + e, p_v + e^2) for an infinitesimal e > 0.  There it lies on no line
// through two different dropped points, so it is strictly inside or strictly outside each
// dropped face, and faces seen edge-on have no inside.  Of the faces that hold it inside,
// the ray passes those whose plane lies ahead of p.  A plane that contains p is neither
// ahead nor behind; but then p itself, a limit of the moved points, lies on the face.
// So the count is undecided for points on the surface only.

#include "linespace/scene/solid_index.h"

#include <algorithm>

#include "linespace/scene/scene.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

// Speed only: an object with more faces has a tree over them.
constexpr std::size_t kFewFaces = 32;

Box box_of_face(const Scene& scene, int face) {
  const auto ids = scene.face_points(face);
  const Point& first = scene.point(ids[0]);
  Box box{{first[0], first[1], first[2]}, {first[0], first[1], first[2]}};
  for (const int id : ids) {
    for (int i = 0; i < 3; ++i) {
      box.min[i] = std::min(box.min[i], scene.point(id)[i]);
      box.max[i] = std::max(box.max[i], scene.point(id)[i]);
    }
  }
  return box;
}

Box united(const Box& a, const Box& b) {
  Box both;
  for (int i = 0; i < 3; ++i) {
    both.min[i] = std::min(a.min[i], b.min[i]);
    both.max[i] = std::max(a.max[i], b.max[i]);
  }
  return both;
}

template <class P>
bool strictly_in(const Box& box, const P& p) {
  for (int i = 0; i < 3; ++i) {
    if (p[i] <= box.min[i] || p[i] >= box.max[i]) return false;
  }
  return true;
}

int narrowest_axis(const Box& box) {
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (box.max[i] - box.min[i] < box.max[axis] - box.min[axis]) axis = i;
  }
  return axis;
}

// As orient2d and orient3d, of a point that need not be one of doubles.
Sign turn_at(int axis, const Point& a, const Point& b, const Point& p) {
  return orient2d(axis, a, b, p);
}
Sign turn_at(int axis, const Point& a, const Point& b, const ExactPoint& p) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const ExactPoint from = exact_point(a);
  const ExactPoint to = exact_point(b);
  const Rational turn =
      (to[u] - from[u]) * (p[v] - from[v]) - (to[v] - from[v]) * (p[u] - from[u]);
  return static_cast<Sign>(turn.sign());
}
Sign side_of(const Point& a, const Point& b, const Point& c, const Point& p) {
  return orient3d(a, b, c, p);
}
Sign side_of(const Point& a, const Point& b, const Point& c, const ExactPoint& p) {
  return static_cast<Sign>(
      exact_orient(exact_point(a), exact_point(b), exact_point(c), p).sign());
}

// The closed polygon contains the point, which must lie in its plane.
template <class P>
bool contains_in_plane(const Scene& scene, int face, const P& p) {
  const auto ids = scene.face_points(face);
  const auto corner = [&](std::size_t k) -> const Point& {
    return scene.point(ids[k % ids.size()]);
  };
  for (int axis = 0; axis < 3; ++axis) {
    const Sign front = orient2d(axis, corner(0), corner(1), corner(2));
    if (front == Sign::Zero) continue;  // seen edge-on along this axis
    for (std::size_t k = 0; k < ids.size(); ++k) {
      if (turn_at(axis, corner(k), corner(k + 1), p) == -front) return false;
    }
    return true;
  }
  return false;
}

// A ray from a point along an axis, forward or backward.
template <class P>
struct Ray {
  const Scene& scene;
  const P& from;
  int axis;
  bool forward;

  // Turns of the dropped face around the moved point: 1 if the face is passed from its
  // back to its front by a ray that runs forward, -1 the other way, 0 if it is missed.
  [[nodiscard]] int turns(int face) const {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto ids = scene.face_points(face);
    int count = 0;
    for (std::size_t k = 0; k < ids.size(); ++k) {
      const Point& a = scene.point(ids[k]);
      const Point& b = scene.point(ids[k + 1 < ids.size() ? k + 1 : 0]);
      // The point counts as above what is level with it: it is moved along v.
      const bool a_above = a[v] > from[v], b_above = b[v] > from[v];
      if (a_above == b_above) continue;
      if (a[u] < from[u] && b[u] < from[u]) continue;  // left of the point
      // The side counts iff it passes the point on the latter's right.  A point on the
      // side is moved along u: then the side is on the left.
      const Sign s = turn_at(axis, a, b, from);
      if (b_above && s == Sign::Positive) ++count;
      if (a_above && s == Sign::Negative) --count;
    }
    return count;
  }

  [[nodiscard]] bool may_meet(const Box& box) const {
    for (int i = 0; i < 3; ++i) {
      if ((i != axis || !forward) && from[i] < box.min[i]) return false;
      if ((i != axis || forward) && from[i] > box.max[i]) return false;
    }
    return true;
  }
};

}  // namespace

SolidIndex::SolidIndex(const Scene& scene)
    : scene_(&scene),
      solid_of_object_(scene.objects().size(), -1),
      solid_tree_(std::vector<Box>{}) {
  std::vector<Box> solid_boxes;
  std::vector<Box> boxes;
  for (std::size_t o = 0; o < scene.objects().size(); ++o) {
    const Object& object = scene.objects()[o];
    if (!object.closed || object.faces.empty()) continue;
    hear_stop();
    boxes.clear();
    for (const int f : object.faces) boxes.push_back(box_of_face(scene, f));
    Solid solid{static_cast<int>(o), boxes[0], 0};
    for (const Box& box : boxes) solid.box = united(solid.box, box);
    solid.axis = narrowest_axis(solid.box);
    if (boxes.size() > kFewFaces) {
      solid.tree = static_cast<int>(trees_.size());
      trees_.emplace_back(boxes);
    }
    solid_of_object_[o] = static_cast<std::int32_t>(solids_.size());
    solid_boxes.push_back(solid.box);
    solids_.push_back(solid);
  }
  solid_tree_ = Bvh(solid_boxes, 1);
}

template <class P>
std::optional<SolidIndex::Windings> SolidIndex::count_windings(int object,
                                                               const P& p) const {
  const Solid& solid = solids_[solid_of_object_[object]];
  const auto& faces = scene_->objects()[object].faces;
  const int k = solid.axis;
  // The nearer side of the box is left through fewer faces, as a rule.
  const bool forward = solid.box.max[k] - p[k] <= p[k] - solid.box.min[k];
  const Ray<P> ray{*scene_, p, k, forward};
  Windings count;
  // True when the point lies on the face, which ends the search.
  const auto look_at = [&](std::uint32_t item) {
    hear_stop();
    const int f = faces[item];
    const int turns = ray.turns(f);
    const Box box = box_of_face(*scene_, f);
    const bool beside = [&] {
      for (int i = 0; i < 3; ++i) {
        if (p[i] < box.min[i] || p[i] > box.max[i]) return true;
      }
      return false;
    }();
    if (turns == 0 && beside) return false;
    const auto t = plane_corners(*scene_, f);
    const Sign s = side_of(t[0], t[1], t[2], p);
    if (s == Sign::Zero) return turns != 0 || contains_in_plane(*scene_, f, p);
    // The face is ahead of a point behind its front iff the ray leaves through it.
    const int leaves = forward ? turns : -turns;
    int& kind = scene_->turned(f) ? count.turned : count.solid;
    if (leaves > 0 && s == Sign::Negative) kind += 1;
    if (leaves < 0 && s == Sign::Positive) kind -= 1;
    return false;
  };
  bool on_surface = false;
  if (solid.tree < 0) {
    for (std::uint32_t i = 0; i < faces.size() && !on_surface; ++i) {
      if (ray.may_meet(box_of_face(*scene_, faces[i]))) on_surface = look_at(i);
    }
  } else {
    on_surface = trees_[solid.tree].any_towards(
        Point::Unit(k), [&](const Box& box) { return ray.may_meet(box); }, look_at);
  }
  if (on_surface) return std::nullopt;
  return count;
}

std::optional<SolidIndex::Windings> SolidIndex::windings(int object,
                                                         const Point& p) const {
  return count_windings(object, p);
}
std::optional<SolidIndex::Windings> SolidIndex::windings(int object,
                                                         const ExactPoint& p) const {
  return count_windings(object, p);
}

bool SolidIndex::in_solid(const Point& p) const {
  return solid_tree_.any_towards(
      Point::Zero(), [&](const Box& box) { return strictly_in(box, p); },
      [&](std::uint32_t i) {
        return windings(solids_[i].object, p).value_or(Windings()).solid > 0;
      });
}

template <class P>
std::vector<int> SolidIndex::list_solids_around(const P& p) const {
  std::vector<int> found;
  solid_tree_.traverse([&](const Box& box) { return strictly_in(box, p); },
                       [&](std::uint32_t i) {
                         const int object = solids_[i].object;
                         const auto w = windings(object, p);
                         if (w && w->solid > 0) found.push_back(object);
                       });
  return found;
}

std::vector<int> SolidIndex::solids_around(const Point& p) const {
  return list_solids_around(p);
}
std::vector<int> SolidIndex::solids_around(const ExactPoint& p) const {
  return list_solids_around(p);
}

}  // namespace sightline::internal
