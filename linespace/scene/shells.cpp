// Which closed parts of objects are turned inside out, and turning them.
//
// A *shell* is a part of a closed object whose faces hang together by edges.  Its signed
// volume is positive where its fronts are outside.  A negative one is a cavity if the
// other shells of its object wind around it, a hollow if those of another object do; else
// it is turned inside out.

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <optional>

#include "linespace/numbers/rational.h"
#include "linespace/scene/scene.h"
#include "linespace/space/bvh.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

using Faces = std::vector<int>;

Rational exact_volume(const Scene& scene, const Faces& faces) {
  Rational sum = 0;
  const ExactPoint origin = exact_point(scene.point(scene.face_points(faces[0])[0]));
  for (const int f : faces) {
    hear_stop();
    const auto c = scene.face_points(f);
    const ExactPoint a = exact_difference(exact_point(scene.point(c[0])), origin);
    for (std::size_t k = 1; k + 1 < c.size(); ++k) {
      const ExactPoint p = exact_difference(exact_point(scene.point(c[k])), origin);
      const ExactPoint q = exact_difference(exact_point(scene.point(c[k + 1])), origin);
      sum += exact_dot(a, exact_cross(p, q));
    }
  }
  return sum;
}

// Sign of the volume on the fronts' backs.
Sign volume_sign(const Scene& scene, const Faces& faces) {
  const Point& origin = scene.point(scene.face_points(faces[0])[0]);
  double sum = 0;
  double size = 0;
  std::size_t terms = 0;
  for (const int f : faces) {
    const auto c = scene.face_points(f);
    const Point a = scene.point(c[0]) - origin;
    for (std::size_t k = 1; k + 1 < c.size(); ++k, ++terms) {
      const Point p = scene.point(c[k]) - origin;
      const Point q = scene.point(c[k + 1]) - origin;
      sum += a.dot(p.cross(q));
      size += a.cwiseAbs().sum() * p.cwiseAbs().sum() * q.cwiseAbs().sum();
    }
  }
  // A term is off by at most 10 units of the last place of `size`'s: 3 of the
  // differences, 7 of products and sums; the sum by one more for each further term.
  const double error =
      (10 + static_cast<double>(terms)) * size * std::numeric_limits<double>::epsilon() +
      std::numeric_limits<double>::min();
  if (sum > error) return Sign::Positive;
  if (sum < -error) return Sign::Negative;
  return static_cast<Sign>(exact_volume(scene, faces).sign());
}

// Of a closed surface seen from a point, the faces that a ray in the direction
// (1, t, t^2) may meet.
class AheadOf {
 public:
  AheadOf(const Scene& scene, const Point& eye) : scene_(scene), eye_(eye) {}

  // The ray's way to x, y and z: it misses the face's box where these leave it no
  // parameter.  The differences are rounded, and t and t^2 are small whole numbers: the
  // parameters are off by less than 4 units in the last place.
  [[nodiscard]] bool may_meet(int face, int t) const {
    double from = 0, to = std::numeric_limits<double>::infinity();
    double factor = 1;
    for (int k = 0; k < 3; ++k, factor *= t) {
      const auto [low, high] = reach(face, k);
      from = std::max(from, outward(low, -1) / factor);
      to = std::min(to, outward(high, 1) / factor);
    }
    return from <= to;
  }
  /// The eye is in the box of the face.
  [[nodiscard]] bool is_within(int face) const {
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = reach(face, k);
      if (low > 0 || high < 0) return false;
    }
    return true;
  }

 private:
  // The sign of a rounded difference is right.
  [[nodiscard]] std::array<double, 2> reach(int face, int axis) const {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const int p : scene_.face_points(face)) {
      const double x = scene_.point(p)[axis] - eye_[axis];
      low = std::min(low, x);
      high = std::max(high, x);
    }
    return {low, high};
  }
  static double outward(double x, int way) { return x + way * 0x1p-50 * std::abs(x); }

  const Scene& scene_;
  const Point& eye_;
};

// A face from a point.
struct SeenFace {
  std::vector<ExactPoint> corners;
  int side;  // of the face's plane that the point is on

  SeenFace(const Scene& scene, int face, const Point& p, const ExactPoint& eye) {
    const auto t = plane_corners(scene, face);
    side = static_cast<int>(orient3d(t[0], t[1], t[2], p));
    for (const int c : scene.face_points(face)) {
      corners.push_back(exact_difference(exact_point(scene.point(c)), eye));
    }
  }

  // The point is on the face: in its plane, and the corners turn one way about it.
  [[nodiscard]] bool holds_the_point() const {
    if (side != 0) return false;
    const ExactPoint normal = exact_cross(exact_difference(corners[1], corners[0]),
                                          exact_difference(corners[2], corners[0]));
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const ExactPoint& next = corners[(k + 1) % corners.size()];
      if (exact_dot(normal, exact_cross(corners[k], next)) < 0) return false;
    }
    return true;
  }
};

// How often the faces, a closed surface, wind around p; nullopt where p is on one.  By
// the crossings of a ray in the direction (1, t, t^2): one through a side of a face is
// bad, and each side makes two t bad at most, so that some t decides.  In the plane of a
// face that p is not on, the ray does not meet it.
std::optional<int> winding_number(const Scene& scene, const Faces& faces,
                                  const Point& p) {
  const ExactPoint eye = exact_point(p);
  const AheadOf ahead(scene, p);
  for (const int f : faces) {
    hear_stop();
    if (ahead.is_within(f) && SeenFace(scene, f, p, eye).holds_the_point()) {
      return std::nullopt;
    }
  }
  for (int t = 1;; ++t) {
    const ExactPoint way{1, t, t * t};
    int winding = 0;
    bool bad = false;
    for (const int f : faces) {
      hear_stop();
      if (!ahead.may_meet(f, t)) continue;
      const SeenFace face(scene, f, p, eye);
      bool meets = face.side != 0;
      bool through_side = false;
      for (std::size_t k = 0; k < face.corners.size() && meets; ++k) {
        const ExactPoint& a = face.corners[k];
        const ExactPoint& b = face.corners[(k + 1) % face.corners.size()];
        // From behind the face its sides turn the right-handed way about the ray.
        const int turn = exact_dot(way, exact_cross(a, b)).sign() * -face.side;
        meets = turn >= 0;
        through_side = through_side || turn == 0;
      }
      bad = bad || (meets && through_side);
      if (meets) winding -= face.side;
    }
    if (!bad) return winding;
  }
}

// The shells of closed objects, by object.
std::vector<std::vector<Faces>> shells_of(const Scene& scene,
                                          const std::vector<HalfEdge>& half_edges) {
  DisjointSets sets(scene.faces().size());
  std::vector<std::uint8_t> closed(scene.objects().size(), 1);
  for (std::size_t i = 0; i < half_edges.size();) {
    const auto edge = same_edge(half_edges, i);
    for (const HalfEdge& e : edge) sets.unite(e.face, edge[0].face);
    if (!is_balanced(edge)) closed[edge[0].object] = 0;
    i += edge.size();
  }
  std::vector<std::vector<Faces>> shells(scene.objects().size());
  std::vector<int> number(scene.faces().size(), -1);
  for (std::size_t o = 0; o < shells.size(); ++o) {
    if (closed[o] == 0) continue;
    for (const int f : scene.objects()[o].faces) {
      int& at = number[sets.find(f)];
      if (at < 0) {
        at = static_cast<int>(shells[o].size());
        shells[o].emplace_back();
      }
      shells[o][at].push_back(f);
    }
  }
  return shells;
}

Box box_of(const Scene& scene, const Faces& faces) {
  const Point& first = scene.point(scene.face_points(faces[0])[0]);
  Box box{{first[0], first[1], first[2]}, {first[0], first[1], first[2]}};
  for (const int f : faces) {
    for (const int p : scene.face_points(f)) {
      for (int i = 0; i < 3; ++i) {
        box.min[i] = std::min(box.min[i], scene.point(p)[i]);
        box.max[i] = std::max(box.max[i], scene.point(p)[i]);
      }
    }
  }
  return box;
}

bool contains(const Box& outer, const Box& inner) {
  for (int i = 0; i < 3; ++i) {
    if (outer.min[i] > inner.min[i] || outer.max[i] < inner.max[i]) return false;
  }
  return true;
}

// The shells of an object by their boxes.
class ShellBoxes {
 public:
  ShellBoxes(const Scene& scene, const std::vector<Faces>& shells)
      : scene_(scene), shells_(shells), boxes_(boxes_of(scene, shells)), tree_(boxes_) {}

  /// The other shells wind around this one.
  [[nodiscard]] bool is_cavity(std::size_t shell) const {
    if (shells_.size() < 2) return false;
    for (const int f : shells_[shell]) {
      for (const int p : scene_.face_points(f)) {
        if (const auto winding = winding_of_others(shell, scene_.point(p))) {
          return *winding > 0;
        }
      }
    }
    return true;  // touches them in all its corners
  }

 private:
  static std::vector<Box> boxes_of(const Scene& scene, const std::vector<Faces>& shells) {
    std::vector<Box> boxes;
    boxes.reserve(shells.size());
    for (const Faces& shell : shells) boxes.push_back(box_of(scene, shell));
    return boxes;
  }

  // Shells whose boxes do not hold the point do not wind around it.
  [[nodiscard]] std::optional<int> winding_of_others(std::size_t shell,
                                                     const Point& p) const {
    const Box at{{p.x(), p.y(), p.z()}, {p.x(), p.y(), p.z()}};
    Faces others;
    tree_.traverse([&](const Box& node) { return contains(node, at); },
                   [&](std::uint32_t i) {
                     if (i == shell || !contains(boxes_[i], at)) return;
                     others.insert(others.end(), shells_[i].begin(), shells_[i].end());
                   });
    return winding_number(scene_, others, p);
  }

  const Scene& scene_;
  const std::vector<Faces>& shells_;
  std::vector<Box> boxes_;
  Bvh tree_;
};

// All corners of the shell are in the other object's material or on its surface, and
// some are in it.
bool lies_in(const Scene& scene, const Faces& shell, const Faces& other) {
  bool inside = false;
  for (const int f : shell) {
    for (const int p : scene.face_points(f)) {
      const auto winding = winding_number(scene, other, scene.point(p));
      if (winding && *winding <= 0) return false;
      inside = inside || winding.has_value();
    }
  }
  return inside;
}

// Closed objects by their boxes.
class ClosedObjects {
 public:
  ClosedObjects(const Scene& scene, const std::vector<std::vector<Faces>>& shells)
      : scene_(scene), tree_(std::vector<Box>{}) {
    std::vector<Box> boxes;
    for (std::size_t o = 0; o < shells.size(); ++o) {
      if (shells[o].empty()) continue;
      objects_.push_back(static_cast<int>(o));
      boxes.push_back(box_of(scene, scene.objects()[o].faces));
    }
    boxes_ = boxes;
    tree_ = Bvh(boxes);
  }

  // The first other object that has the shell in its material, -1 for none.
  [[nodiscard]] int around(int object, const Faces& shell) const {
    const Box box = box_of(scene_, shell);
    int found = -1;
    tree_.traverse([&](const Box& node) { return contains(node, box); },
                   [&](std::uint32_t i) {
                     const int o = objects_[i];
                     if (o == object || (found >= 0 && o > found)) return;
                     if (!contains(boxes_[i], box)) return;
                     if (lies_in(scene_, shell, scene_.objects()[o].faces)) found = o;
                   });
    return found;
  }

 private:
  const Scene& scene_;
  std::vector<int> objects_;
  std::vector<Box> boxes_;
  Bvh tree_;
};

}  // namespace

// By the fronts of the file first, as long as they are in place; then all are turned.
void SceneBuilder::turn_shells() {
  const auto all = shells_of(scene, half_edges);
  scene.sides_.assign(scene.faces_.size(), Scene::FaceSides::Sheet);
  std::vector<const Faces*> turned;
  std::optional<ClosedObjects> closed;
  for (std::size_t o = 0; o < all.size(); ++o) {
    stage.at(o, all.size());
    Object& object = scene.objects_[o];
    std::optional<ShellBoxes> boxes;
    for (std::size_t i = 0; i < all[o].size(); ++i) {
      hear_stop();
      const Faces& shell = all[o][i];
      for (const int f : shell) scene.sides_[f] = Scene::FaceSides::Solid;
      if (volume_sign(scene, shell) != Sign::Negative) continue;
      if (!boxes) boxes.emplace(scene, all[o]);
      if (boxes->is_cavity(i)) continue;
      if (!closed) closed.emplace(scene, all);
      const int around = closed->around(static_cast<int>(o), shell);
      if (around >= 0) {
        scene.hollows_.push_back({static_cast<int>(o), around});
      } else {
        object.inside_out = true;
        turned.push_back(&shell);
      }
      report_inside_out(shell, all[o].size() > 1, around);
    }
  }
  for (const Faces* shell : turned) {
    for (const int f : *shell) {
      scene.sides_[f] = Scene::FaceSides::Turned;
      turn_face(f);
    }
  }
  for (HalfEdge& e : half_edges) {
    if (scene.turned(e.face)) e.forward = !e.forward;
  }
}

void SceneBuilder::report_inside_out(const std::vector<int>& shell, bool is_part,
                                     int around) {
  const auto name = [&](int object) {
    return "object '" + scene.objects_[object].name + "'";
  };
  std::vector<int> sources;
  for (const int f : shell) sources.push_back(scene.faces_[f].source);
  sources.erase(std::unique(sources.begin(), sources.end()), sources.end());
  report("inside-out",
         (is_part ? "a closed part of " : "") + name(scene.faces_[shell[0]].object) +
             " is turned inside out, its faces clockwise seen from outside: taken for " +
             (around >= 0 ? "a hollow in " + name(around) : "a room, with air inside"),
         std::move(sources));
}

// Lists a face's corners the other way round; again the first three are not collinear.
void SceneBuilder::turn_face(int f) {
  const Face& face = scene.faces_[f];
  const auto corners = scene.corners_.begin() + face.first_corner;
  const auto diagonals = is_diagonal.begin() + face.first_corner;
  const int n = face.corner_count;
  std::reverse(corners + 1, corners + n);
  std::reverse(diagonals, diagonals + n);
  for (int k = 0; k < n; ++k) {
    const auto t = plane_corners(scene, f);
    if (!collinear(t[0], t[1], t[2])) return;
    std::rotate(corners, corners + 1, corners + n);
    std::rotate(diagonals, diagonals + 1, diagonals + n);
  }
}

}  // namespace sightline::internal
