#include "linespace/between/glued_solids.h"

#include <algorithm>
#include <array>

#include "linespace/predicates.h"
#include "linespace/scene/scene.h"

namespace sightline::internal {
namespace {

/// Which sides of a face's plane have corners of another face.
struct Sides {
  bool front = false, behind = false;

  Sides(const Scene& scene, int plane, int face) {
    const auto corners = plane_corners(scene, plane);
    for (const int p : scene.face_points(face)) {
      const Sign side = orient3d(corners[0], corners[1], corners[2], scene.point(p));
      front |= side == Sign::Positive;
      behind |= side == Sign::Negative;
    }
  }
};

/// All corners of face b are behind all planes of the convex solid's faces, or in them.
bool holds(const Scene& scene, const Object& solid, int b) {
  return std::ranges::none_of(solid.faces,
                              [&](int f) { return Sides(scene, f, b).front; });
}

}  // namespace

bool is_convex_solid(const Object& object) { return object.convex && !object.inside_out; }

bool in_one_plane(const Scene& scene, int a, int b) {
  const Sides sides(scene, a, b);
  return !sides.front && !sides.behind;
}

GluedSolids::GluedSolids(const Scene& scene, int face,
                         const std::function<std::vector<int>(int)>& near)
    : scene_(scene), face_(face) {
  for (const int f : near(face)) {
    const int object = scene.faces()[f].object;
    if (!is_convex_solid(scene.objects()[object])) continue;
    if (in_one_plane(scene, face, f)) faces_[object].push_back(f);
  }
  for (auto& [object, faces] : faces_) {
    std::ranges::sort(faces);
    if (object == scene.faces()[face].object ||
        holds(scene, scene.objects()[object], face)) {
      holding_.push_back(faces.front());
    }
  }
}

bool GluedSolids::hide(int b) const {
  return std::ranges::any_of(holding_, [&](int f) {
    if (Sides(scene_, f, b).front) return false;
    // A face's plane with all of b in front or in it: what is inside the solid is behind.
    const Object& solid = scene_.objects()[scene_.faces()[f].object];
    return std::ranges::any_of(solid.faces,
                               [&](int side) { return !Sides(scene_, side, b).behind; });
  });
}

std::vector<std::vector<int>> GluedSolids::blockers(const GluedSolids& a,
                                                    const GluedSolids& b) {
  const Scene& scene = a.scene_;
  // For segments that end behind a's face, and in front of it.
  std::array<std::vector<int>, 2> sets;
  const auto add = [](std::vector<int>& set, const std::vector<int>& faces) {
    set.insert(set.end(), faces.begin(), faces.end());
  };
  bool differ = false;
  for (const auto& [object, at_a] : a.faces_) {
    const auto found = b.faces_.find(object);
    if (found == b.faces_.end()) continue;
    const std::vector<int>& at_b = found->second;
    const Sides of_b(scene, at_a.front(), b.face_);
    const Sides of_a(scene, at_b.front(), a.face_);
    // Segments inside the solid end behind its face at a and begin behind that at b.
    if (!of_b.behind || !of_a.behind) continue;
    if (!of_b.front || !of_a.front) {
      for (auto& set : sets) add(set, of_b.front ? at_b : at_a);
      continue;
    }
    // Those that end on the solid's side of a's plane must not begin on its face there;
    // no other meets its face at b.
    differ = true;
    const bool in_front = !Sides(scene, a.face_, at_b.front()).behind;
    add(sets[in_front ? 1 : 0], at_a);
    add(sets[in_front ? 0 : 1], at_b);
  }
  if (differ) return {sets[0], sets[1]};
  return {sets[0]};
}

}  // namespace sightline::internal
