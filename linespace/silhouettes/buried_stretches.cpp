#include "linespace/silhouettes/buried_stretches.h"

#include <algorithm>

#include "linespace/sight/free_segment.h"
#include "linespace/silhouettes/plane_values.h"
#include "linespace/silhouettes/silhouettes.h"
#include "linespace/swaths/edge_cuts.h"

namespace sightline::internal {

std::array<double, 2> visible_range(std::span<const BuriedStretch> buried) {
  std::array<double, 2> range{0, 1};
  for (const BuriedStretch& b : buried) {
    if (b.from < 0) range[0] = std::max(range[0], b.high);
    if (b.to < 0) range[1] = std::min(range[1], b.low);
  }
  return range;
}

// The faces pierce the open edge.  Between two neighbouring points where it passes faces,
// or one and an end of it, an edge is either in material all along or nowhere.
std::vector<BuriedStretch> Silhouettes::buried_stretches(
    std::array<std::int32_t, 2> points, std::span<const std::int32_t> pierced_by) const {
  if (pierced_by.empty()) return {};
  const Point& e0 = scene_->point(points[0]);
  const Point& e1 = scene_->point(points[1]);
  const LineThrough line{e0, e1};
  struct Hit {
    Cut cut;
    int face;
    Rational at;
  };
  std::vector<Hit> hits;
  for (const int face : pierced_by) {
    const PlaneValues v = plane_values(face_planes_[face], e0, e1);
    const Cut cut = make_cut(CutKind::Pierce, scene_->faces()[face].facet,
                             plane_points(*scene_, face), v.at0, v.at1);
    hits.push_back({cut, face, exact_parameter(*scene_, line, cut)});
  }
  std::ranges::sort(hits, {}, &Hit::at);
  std::vector<BuriedStretch> buried;
  const ExactPoint x0 = exact_point(e0);
  const ExactPoint x1 = exact_point(e1);
  for (std::size_t i = 0; i <= hits.size(); ++i) {
    const Hit* from = i == 0 ? nullptr : &hits[i - 1];
    const Hit* to = i == hits.size() ? nullptr : &hits[i];
    const Rational low = from != nullptr ? from->at : Rational(0);
    const Rational high = to != nullptr ? to->at : Rational(1);
    if (low == high || !in_material(along(x0, x1, (low + high) / 2))) continue;
    buried.push_back({from != nullptr ? from->face : -1, to != nullptr ? to->face : -1,
                      from != nullptr ? from->cut.hi : 0,
                      to != nullptr ? to->cut.lo : 1});
  }
  return buried;
}

}  // namespace sightline::internal
