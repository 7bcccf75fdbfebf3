#include "linespace/scene/face_pair.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "linespace/scene/scene.h"

namespace sightline::internal {
namespace {

bool contains(std::span<const int> ids, int point) {
  return std::find(ids.begin(), ids.end(), point) != ids.end();
}

}  // namespace

bool FacePair::meet(int f, int g) {
  ids_ = {scene_.face_points(f), scene_.face_points(g)};
  axis_ = {};
  coplanar_ = false;
  if (!find_signs()) return false;
  return (!shares_side_across() && (corner_inside(0) || corner_inside(1))) ||
         pierces(0) || pierces(1) || runs_inside(0) || runs_inside(1);
}

// False when one of the planes separates the faces.
bool FacePair::find_signs() {
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
  return true;
}

PlaneThrough FacePair::plane_of(int k) const {
  return {scene_.point(ids_[k][0]), scene_.point(ids_[k][1]), scene_.point(ids_[k][2])};
}

// The common case, decided without further signs: two triangles in different planes that
// share a side have nothing else in common.
bool FacePair::shares_side_across() const {
  if (coplanar_ || ids_[0].size() != 3 || ids_[1].size() != 3) return false;
  return std::count(signs_[0].begin(), signs_[0].end(), Sign::Zero) == 2 &&
         std::count_if(ids_[0].begin(), ids_[0].end(),
                       [&](int id) { return contains(ids_[1], id); }) == 2;
}

// Orientation in the plane of face k: the sign of turning left as the face's corners.
Sign FacePair::turn(int k, int a, int b, int c) {
  if (!axis_[k]) {
    const PlaneThrough t = plane_of(k);
    const Point size = (t.b - t.a).cross(t.c - t.a).cwiseAbs();
    std::array<int, 3> axes{0, 1, 2};
    std::sort(axes.begin(), axes.end(), [&](int i, int j) { return size[i] > size[j]; });
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
bool FacePair::covers(int k, int p) {
  const Corners c = ids_[k];
  for (std::size_t i = 0; i < c.size(); ++i) {
    if (turn(k, c[i], c[(i + 1) % c.size()], p) == Sign::Negative) return false;
  }
  return true;
}

bool FacePair::corner_inside(int k) {
  for (std::size_t i = 0; i < ids_[k].size(); ++i) {
    const int p = ids_[k][i];
    if (signs_[k][i] == Sign::Zero && !contains(ids_[1 - k], p) && covers(1 - k, p)) {
      return true;
    }
  }
  return false;
}

bool FacePair::pierces(int k) const {
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

bool FacePair::runs_inside(int k) {
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
      if (coplanar_ && same_side(own, i, j, left ? Sign::Positive : Sign::Negative, k)) {
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
bool FacePair::same_side(Corners own, std::size_t i, std::size_t j, Sign side, int k) {
  return std::any_of(own.begin(), own.end(),
                     [&](int p) { return turn(1 - k, own[i], own[j], p) == side; });
}

}  // namespace sightline::internal
