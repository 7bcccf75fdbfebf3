#include <algorithm>

#include "tests/support/naive_picture.h"
#include "tests/support/naive_sets.h"
#include "tests/support/naive_view.h"

namespace sightline::testing {
namespace {

/// +1 if the face's front is where its plane's canonical normal points, else -1.
int facing(const Scene& scene, int face) {
  return reversed(face_normal(scene, face)) ? -1 : 1;
}
/// Two coplanar convex faces have more than a point in common.
bool touch_along(const Scene& scene, int f, int g) {
  std::vector<Vec3> common;
  for (const int p : scene.face_points(f)) common.push_back(exact(scene.point(p)));
  const Vec3 normal = face_normal(scene, g).rational();
  const auto corners = scene.face_points(g);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 a = exact(scene.point(corners[i]));
    const Vec3 inward =
        cross(normal, exact(scene.point(corners[(i + 1) % corners.size()])) - a);
    std::vector<Vec3> kept;
    for (std::size_t k = 0; k < common.size(); ++k) {
      const Vec3& here = common[k];
      const Vec3& next = common[(k + 1) % common.size()];
      const Rational x = dot(inward, here - a), y = dot(inward, next - a);
      if (x.sign() >= 0) kept.push_back(here);
      if (x.sign() * y.sign() < 0)
        kept.push_back(here + Rational(x / (x - y)) * (next - here));
    }
    common = std::move(kept);
  }
  return std::ranges::any_of(common, [&](const Vec3& p) { return p != common[0]; });
}

}  // namespace

NaiveViewer::NaiveViewer(const Scene& scene) : scene_(scene) {
  const int facets = static_cast<int>(scene.facets().size());
  const int faces = static_cast<int>(scene.faces().size());
  std::vector<Ray> normals;
  std::vector<Rational> offsets;
  for (int f = 0; f < faces; ++f) {
    normals.push_back(canonical(face_normal(scene, f)));
    offsets.push_back(
        dot(normals[f].rational(), exact(scene.point(scene.face_points(f)[0]))));
  }
  Sets sets(facets);
  for (int f = 0; f < faces; ++f) {
    for (int g = 0; g < f; ++g) {
      const bool alike = is_sheet(scene, f) || is_sheet(scene, g) ||
                         facing(scene, f) == facing(scene, g);
      if (alike && normals[f] == normals[g] && offsets[f] == offsets[g] &&
          touch_along(scene, f, g)) {
        sets.join(scene.faces()[f].facet, scene.faces()[g].facet);
      }
    }
  }
  for (int i = 0; i < facets; ++i) patches_.push_back(sets.find(i));
}

int NaiveViewer::patch_of(int facet, bool front) const {
  const bool above = (facing(scene_, scene_.facets()[facet].faces[0]) > 0) == front;
  return 2 * patches_[facet] + (above ? 1 : 0);
}

}  // namespace sightline::testing
