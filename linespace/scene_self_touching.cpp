// Faces of one object that meet where they do not share a corner or an edge.
//
// Both faces are convex and exactly planar.  Whatever they have in common beyond shared
// corners and shared sides shows as one of these, each an exact test:
//   1. a corner of one lies on the other and is no corner of it;
//   2. a side of one crosses the other's plane inside the other;
//   3. a side of one lies in the other's plane and crosses a side of it, or joins two
//      corners of it through its inside, or is a side of it too with both faces,
//      coplanar, on the same side of it.

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>

#include "linespace/bvh_internal.h"
#include "linespace/predicates.h"
#include "linespace/scene_internal.h"
#include "linespace/stop_scope_internal.h"

namespace sightline {
namespace internal {
namespace {

using Corners = std::span<const int>;

bool contains(Corners ids, int point) {
  return std::find(ids.begin(), ids.end(), point) != ids.end();
}

class FacePair {
 public:
  FacePair(const Scene& scene, int f, int g)
      : scene_(scene), ids_{scene.face_points(f), scene.face_points(g)} {}

  // Beyond the corners and sides they share.
  bool meets() {
    for (int k = 0; k < 2; ++k) {
      const PlaneThrough plane = plane_of(1 - k);
      bool above = false, below = false, on = false;
      auto& signs = signs_[k];
      signs.clear();
      for (const int id : ids_[k]) {
        const Sign s = contains(ids_[1 - k], id)
                           ? Sign::Zero
                           : orient3d(plane.a, plane.b, plane.c, scene_.point(id));
        signs.push_back(s);
        above = above || s == Sign::Positive;
        below = below || s == Sign::Negative;
        on = on || s == Sign::Zero;
      }
      if (above != below && !on) return false;
      coplanar_ = !above && !below;
    }
    return (!shares_side_across() && (corner_inside(0) || corner_inside(1))) ||
           pierces(0) || pierces(1) || runs_inside(0) || runs_inside(1);
  }

 private:
  PlaneThrough plane_of(int k) const {
    return {scene_.point(ids_[k][0]), scene_.point(ids_[k][1]), scene_.point(ids_[k][2])};
  }

  // The common case, decided without further signs: two triangles in different planes
  // that share a side have nothing else in common.
  bool shares_side_across() const {
    if (coplanar_ || ids_[0].size() != 3 || ids_[1].size() != 3) return false;
    return std::count(signs_[0].begin(), signs_[0].end(), Sign::Zero) == 2 &&
           std::count_if(ids_[0].begin(), ids_[0].end(),
                         [&](int id) { return contains(ids_[1], id); }) == 2;
  }

  // Orientation in the plane of face k: the sign of turning left as the face's corners.
  Sign turn(int k, int a, int b, int c) {
    if (!axis_[k]) {
      const PlaneThrough t = plane_of(k);
      const Point size = (t.b - t.a).cross(t.c - t.a).cwiseAbs();
      std::array<int, 3> axes{0, 1, 2};
      std::sort(axes.begin(), axes.end(),
                [&](int i, int j) { return size[i] > size[j]; });
      for (const int axis : axes) {
        const Sign s = orient2d(axis, t.a, t.b, t.c);
        if (s == Sign::Zero) continue;
        axis_[k] = axis;
        front_[k] = s;
        break;
      }
    }
    return front_[k] *
           orient2d(*axis_[k], scene_.point(a), scene_.point(b), scene_.point(c));
  }

  // Point p, in the plane of face k, lies on it or its border.
  bool covers(int k, int p) {
    const Corners c = ids_[k];
    for (std::size_t i = 0; i < c.size(); ++i) {
      if (turn(k, c[i], c[(i + 1) % c.size()], p) == Sign::Negative) return false;
    }
    return true;
  }

  bool corner_inside(int k) {
    for (std::size_t i = 0; i < ids_[k].size(); ++i) {
      const int p = ids_[k][i];
      if (signs_[k][i] == Sign::Zero && !contains(ids_[1 - k], p) && covers(1 - k, p)) {
        return true;
      }
    }
    return false;
  }

  bool pierces(int k) const {
    const Corners own = ids_[k], other = ids_[1 - k];
    for (std::size_t i = 0; i < own.size(); ++i) {
      const std::size_t j = (i + 1) % own.size();
      if (signs_[k][i] * signs_[k][j] != Sign::Negative) continue;
      bool left = false, right = false;
      for (std::size_t m = 0; m < other.size() && !(left && right); ++m) {
        const Sign s =
            orient3d(scene_.point(own[i]), scene_.point(own[j]), scene_.point(other[m]),
                     scene_.point(other[(m + 1) % other.size()]));
        left = left || s == Sign::Positive;
        right = right || s == Sign::Negative;
      }
      if (!(left && right)) return true;
    }
    return false;
  }

  bool runs_inside(int k) {
    const Corners own = ids_[k], other = ids_[1 - k];
    for (std::size_t i = 0; i < own.size(); ++i) {
      const std::size_t j = (i + 1) % own.size();
      if (signs_[k][i] != Sign::Zero || signs_[k][j] != Sign::Zero) continue;
      if (contains(other, own[i]) && contains(other, own[j])) {
        bool left = false, right = false;
        for (const int p : other) {
          const Sign s = turn(1 - k, own[i], own[j], p);
          left = left || s == Sign::Positive;
          right = right || s == Sign::Negative;
        }
        if (left && right) return true;
        if (coplanar_ &&
            same_side(own, i, j, left ? Sign::Positive : Sign::Negative, k)) {
          return true;
        }
        continue;
      }
      for (std::size_t m = 0; m < other.size(); ++m) {
        const int c = other[m], d = other[(m + 1) % other.size()];
        if (turn(1 - k, own[i], own[j], c) * turn(1 - k, own[i], own[j], d) ==
                Sign::Negative &&
            turn(1 - k, c, d, own[i]) * turn(1 - k, c, d, own[j]) == Sign::Negative) {
          return true;
        }
      }
    }
    return false;
  }

  // Face k lies to `side` of its own side from corner i to j, as the other face sees it.
  bool same_side(Corners own, std::size_t i, std::size_t j, Sign side, int k) {
    return std::any_of(own.begin(), own.end(),
                       [&](int p) { return turn(1 - k, own[i], own[j], p) == side; });
  }

  const Scene& scene_;
  std::array<Corners, 2> ids_;
  std::array<std::vector<Sign>, 2> signs_;
  bool coplanar_ = false;
  std::array<std::optional<int>, 2> axis_;
  std::array<Sign, 2> front_{};
};

bool overlap(const Box& a, const Box& b) {
  for (int k = 0; k < 3; ++k) {
    if (a.max[k] < b.min[k] || b.max[k] < a.min[k]) return false;
  }
  return true;
}

}  // namespace
}  // namespace internal

std::vector<Defect> find_self_touching(const Scene& scene) {
  using internal::Box;
  const auto faces = scene.faces();
  std::vector<Box> boxes;
  boxes.reserve(faces.size());
  std::vector<Point> points;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    points.clear();
    for (const int p : scene.face_points(static_cast<int>(f))) {
      points.push_back(scene.point(p));
    }
    boxes.push_back(internal::box_of(points));
  }
  const internal::Bvh tree(boxes);
  std::vector<std::pair<int, int>> pairs;  // polygons of the file
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const int f = static_cast<int>(i);
    tree.traverse([&](const Box& box) { return internal::overlap(box, boxes[i]); },
                  [&](std::uint32_t item) {
                    internal::hear_stop();
                    const int g = static_cast<int>(item);
                    if (g <= f || faces[g].object != faces[f].object ||
                        faces[g].source == faces[f].source ||
                        !internal::overlap(boxes[g], boxes[i])) {
                      return;
                    }
                    if (internal::FacePair(scene, f, g).meets()) {
                      pairs.emplace_back(faces[f].source, faces[g].source);
                    }
                  });
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  std::vector<Defect> defects;
  defects.reserve(pairs.size());
  for (const auto& [i, j] : pairs) {
    defects.push_back({"self-touching",
                       "faces " + std::to_string(i) + " and " + std::to_string(j) +
                           " meet beyond the corners and edges they share",
                       {i, j},
                       {}});
  }
  return defects;
}

}  // namespace sightline
