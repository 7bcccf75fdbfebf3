#include "linespace/picture/patches.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "linespace/picture/classes.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

bool in_plane_of(const Silhouettes& g, int face, int other) {
  const Scene& scene = g.scene();
  for (const int p : scene.face_points(other)) {
    if (g.face_plane(face)(scene.point(p)) != Sign::Zero) return false;
  }
  return true;
}

// The interval of a coordinate axis that the corners of a face on the line pq cover;
// nullopt where fewer than two are on it.
std::optional<std::array<double, 2>> on_line(const Scene& scene, const InPlaneSide& side,
                                             int face, int p, int q, int axis) {
  std::optional<std::array<double, 2>> range;
  int count = 0;
  for (const int c : scene.face_points(face)) {
    const double x = scene.point(c)[axis];
    if (side(scene.point(p), scene.point(q), scene.point(c)) != Sign::Zero) continue;
    ++count;
    if (!range) range = {x, x};
    (*range)[0] = std::min((*range)[0], x);
    (*range)[1] = std::max((*range)[1], x);
  }
  return count < 2 ? std::nullopt : range;
}

// Normals of two faces of one plane point to the same side.
bool same_side(const Silhouettes& g, int f, int h) {
  const Scene& scene = g.scene();
  const auto c = scene.face_points(h);
  const Point off =
      point_off_plane(scene.point(c[0]), scene.point(c[1]), scene.point(c[2]));
  return g.face_plane(f)(off) == g.face_plane(h)(off);
}

}  // namespace

bool hang_together(const Scene& scene, int f, int h) {
  for (const auto& [face, other] : {std::pair(f, h), std::pair(h, f)}) {
    const InPlaneSide side(scene, face);
    const auto c = scene.face_points(face);
    for (std::size_t k = 0; k < c.size(); ++k) {
      const int p = c[k];
      const int q = c[(k + 1) % c.size()];
      const auto others = scene.face_points(other);
      const bool separates = std::ranges::none_of(others, [&](int x) {
        return side(scene.point(p), scene.point(q), scene.point(x)) == Sign::Positive;
      });
      if (!separates) continue;
      // All that they share lies on this line.
      int axis = 0;
      (scene.point(q) - scene.point(p)).cwiseAbs().maxCoeff(&axis);
      const auto a = on_line(scene, side, face, p, q, axis);
      const auto b = on_line(scene, side, other, p, q, axis);
      return a && b && std::max((*a)[0], (*b)[0]) < std::min((*a)[1], (*b)[1]);
    }
  }
  return true;
}

std::vector<int> find_patches(const Silhouettes& g,
                              const std::function<bool(int object)>& is_sheet) {
  const Scene& scene = g.scene();
  Classes classes(2 * scene.facets().size());
  const auto sheet = [&](int facet) { return is_sheet(scene.facets()[facet].object); };
  for (int f = 0; f < static_cast<int>(scene.faces().size()); ++f) {
    hear_stop();
    const int facet = scene.faces()[f].facet;
    g.face_tree().traverse([&](const Box& box) { return boxes_meet(box, g.face_box(f)); },
                           [&](std::uint32_t item) {
                             const int h = static_cast<int>(item);
                             const int other = scene.faces()[h].facet;
                             if (h <= f || other == facet || !in_plane_of(g, f, h))
                               return;
                             const bool same = same_side(g, f, h);
                             if (!same && !sheet(facet) && !sheet(other)) return;
                             if (!hang_together(scene, f, h)) return;
                             classes.join(2 * facet, 2 * other + (same ? 0 : 1));
                             classes.join(2 * facet + 1, 2 * other + (same ? 1 : 0));
                           });
  }
  std::vector<int> patches(2 * scene.facets().size());
  for (std::size_t i = 0; i < patches.size(); ++i) {
    patches[i] = classes.root(static_cast<int>(i));
  }
  return patches;
}

}  // namespace sightline::internal
