#include <algorithm>
#include <map>

#include "skeleton/buried_stretches_internal.h"
#include "skeleton/edge_cuts_internal.h"
#include "skeleton/generators_internal.h"
#include "skeleton/plane_values_internal.h"

namespace sightline::internal {

std::array<double, 2> visible_range(std::span<const BuriedStretch> buried) {
  std::array<double, 2> range{0, 1};
  for (const BuriedStretch& b : buried) {
    if (b.from < 0) range[0] = std::max(range[0], b.high);
    if (b.to < 0) range[1] = std::min(range[1], b.low);
  }
  return range;
}

// The faces pierce the open edge.  Between two points where it passes faces, an edge is
// either in material all along or nowhere.  So it is up to the first of them where its
// first end is, from the last one on where its second end is, and between the two points
// where it enters and leaves a convex solid.
std::vector<BuriedStretch> Generators::buried_stretches(
    std::array<std::int32_t, 2> points, std::span<const std::int32_t> pierced_by) const {
  const Point& e0 = scene_->point(points[0]);
  const Point& e1 = scene_->point(points[1]);
  const LineThrough line{e0, e1};
  struct Hit {
    Cut cut;
    int face;
  };
  const auto before = [&](const Hit& a, const Hit& b) {
    return compare(*scene_, line, a.cut, b.cut) == Sign::Negative;
  };
  std::vector<Hit> hits;
  std::map<int, BuriedStretch> inside;  // by convex solid
  for (const int face : pierced_by) {
    const PlaneValues v = plane_values(face_planes_[face], e0, e1);
    const Hit hit{make_cut(CutKind::Pierce, scene_->faces()[face].facet,
                           plane_points(*scene_, face), v.at0, v.at1),
                  face};
    hits.push_back(hit);
    const int object = scene_->faces()[face].object;
    if (!convex_solid(object)) continue;
    BuriedStretch& b =
        inside.try_emplace(object, BuriedStretch{-1, -1, 0, 1}).first->second;
    if (v.sign0 == Sign::Positive) {
      b.from = face;
      b.low = hit.cut.hi;
    } else {
      b.to = face;
      b.high = hit.cut.lo;
    }
  }
  std::vector<BuriedStretch> buried;
  for (const auto& [object, stretch] : inside) buried.push_back(stretch);
  if (hits.empty()) return buried;
  const auto [first, last] = std::minmax_element(hits.begin(), hits.end(), before);
  const auto [from, to] = visible_range(buried);
  if (from == 0 && inside_material(points[0])) {
    buried.push_back({-1, first->face, 0, first->cut.lo});
  }
  if (to == 1 && inside_material(points[1])) {
    buried.push_back({last->face, -1, last->cut.hi, 1});
  }
  return buried;
}

}  // namespace sightline::internal
