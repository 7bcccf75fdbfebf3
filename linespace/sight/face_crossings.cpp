#include "linespace/sight/face_crossings.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "linespace/numbers/rational.h"
#include "linespace/sight/free_segment.h"
#include "linespace/swaths/edge_cuts.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

using Segment = std::array<ExactPoint, 2>;

// Where a convex face meets the plane of another; nullopt where it has no corners on
// both sides.
std::optional<Segment> cut_by_plane(const Silhouettes& g, int face, int plane_of) {
  const Scene& scene = g.scene();
  const PlaneSide& plane = g.face_plane(plane_of);
  const auto corners = scene.face_points(face);
  const std::size_t n = corners.size();
  std::vector<Sign> signs;
  for (const int p : corners) signs.push_back(plane(scene.point(p)));
  if (std::ranges::find(signs, Sign::Positive) == signs.end() ||
      std::ranges::find(signs, Sign::Negative) == signs.end()) {
    return std::nullopt;
  }
  const auto t = plane_points(scene, plane_of);
  const auto value = [&](int p) {
    return exact_orient(exact_point(scene.point(t[0])), exact_point(scene.point(t[1])),
                        exact_point(scene.point(t[2])), exact_point(scene.point(p)));
  };
  std::vector<ExactPoint> met;
  for (std::size_t k = 0; k < n; ++k) {
    const int p = corners[k];
    const int q = corners[(k + 1) % n];
    const Sign s = signs[k];
    if (s == Sign::Zero) met.push_back(exact_point(scene.point(p)));
    if (s == Sign::Zero || signs[(k + 1) % n] != -s) continue;
    const Rational a = value(p);
    met.push_back(along(exact_point(scene.point(p)), exact_point(scene.point(q)),
                        quotient(a, Rational(a - value(q)))));
  }
  if (met.size() != 2) return std::nullopt;
  return Segment{met[0], met[1]};
}

// Of two segments on one line.
std::optional<Segment> common_part(Segment a, Segment b) {
  std::size_t axis = 0;
  while (axis < 2 && a[0][axis] == a[1][axis]) ++axis;
  for (Segment* s : {&a, &b}) {
    if ((*s)[1][axis] < (*s)[0][axis]) std::swap((*s)[0], (*s)[1]);
  }
  const ExactPoint& from = a[0][axis] < b[0][axis] ? b[0] : a[0];
  const ExactPoint& to = a[1][axis] < b[1][axis] ? a[1] : b[1];
  if (!(from[axis] < to[axis])) return std::nullopt;
  return Segment{from, to};
}

bool may_cross(const Silhouettes& g, int f, int h) {
  const Scene& scene = g.scene();
  if (scene.faces()[f].facet == scene.faces()[h].facet) return false;
  const int object = scene.faces()[f].object;
  return object != scene.faces()[h].object || !g.convex_solid(object);
}

Box box_around(const Segment& s) {
  Box box;
  for (int i = 0; i < 3; ++i) {
    const double a = s[0][i].convert_to<double>();
    const double b = s[1][i].convert_to<double>();
    // Conversions are off by a unit of the last place at most.
    const double slack = 4 * kUnit * (std::abs(a) + std::abs(b));
    box.min[i] = std::min(a, b) - slack;
    box.max[i] = std::max(a, b) + slack;
  }
  return box;
}

}  // namespace

FaceCrossings::FaceCrossings(const Silhouettes& g) : tree_(std::vector<Box>{}) {
  const int n = static_cast<int>(g.scene().faces().size());
  for (int f = 0; f < n; ++f) {
    hear_stop();
    g.face_tree().traverse([&](const Box& box) { return boxes_meet(box, g.face_box(f)); },
                           [&](std::uint32_t item) {
                             const int h = static_cast<int>(item);
                             if (h <= f || !may_cross(g, f, h)) return;
                             const auto a = cut_by_plane(g, f, h);
                             const auto b = a ? cut_by_plane(g, h, f) : std::nullopt;
                             if (!b) return;
                             if (auto s = common_part(*a, *b))
                               crossings_.push_back({f, h, std::move(*s)});
                           });
  }
  std::ranges::sort(crossings_, {},
                    [](const FaceCrossing& c) { return std::pair(c.f, c.h); });
  std::vector<Box> boxes;
  for (const FaceCrossing& c : crossings_) boxes.push_back(box_around(c.segment));
  tree_ = Bvh(boxes);
}

bool FaceCrossings::cross(int f, int h) const {
  return std::ranges::binary_search(
      crossings_, std::pair(std::min(f, h), std::max(f, h)), {},
      [](const FaceCrossing& c) { return std::pair(c.f, c.h); });
}

}  // namespace sightline::internal
