#include "linespace/light/source_sight.h"

#include <algorithm>
#include <unordered_map>

#include "linespace/light/source_shaft.h"
#include "linespace/work/parallel.h"

namespace sightline::internal {

SourceSight::SourceSight(const PatchSpace& at, const HidingSolids& solids,
                         const Request& request, Stage& stage)
    : at_(at), solids_(solids) {
  for (const Point& h : at.patch.hull) hull_.push_back(light_point(h));
  const std::size_t n = at.space.edges().size();
  sees_source_.assign(n, 0);
  nearer_.resize(n);
  const auto& edges = at.front_edges;
  for_each_of(0, edges.size(), edges.size(), request, stage, [&](std::size_t i) {
    const auto& ends = at.space.edges()[edges[i]].line->ends;
    std::vector<int> hiding = hiding_source(*ends[0]);
    if (!hiding.empty()) keep_common(hiding, hiding_source(*ends[1]));
    sees_source_[edges[i]] = hiding.empty() ? 1 : 0;
  });
  for_each_of(0, edges.size(), edges.size(), request, stage, [&](std::size_t i) {
    if (sees_source_[edges[i]] != 0) nearer_[edges[i]] = find_nearer(edges[i]);
  });
}

bool SourceSight::sees_source(const LightPoint& p) const {
  return hiding_source(p).empty();
}

std::vector<int> SourceSight::hiding_source(const LightPoint& p) const {
  std::vector<int> common;
  std::vector<int> next;
  for (std::size_t k = 0; k < hull_.size(); ++k) {
    next.clear();
    solids_.between(p, hull_[k], next);
    if (k == 0) {
      common = next;
    } else {
      keep_common(common, next);
    }
    if (common.empty()) break;
  }
  return common;
}

bool SourceSight::may_see(const LightPoint& p, int edge) const {
  const auto& ends = at_.space.edges()[edge].line->ends;
  std::vector<int> hiding;
  solids_.between(p, *ends[0], hiding);
  if (hiding.empty()) return true;
  std::vector<int> other;
  solids_.between(p, *ends[1], other);
  keep_common(hiding, other);
  return hiding.empty();
}

std::vector<int> SourceSight::find_nearer(int edge) const {
  const LightSpace& space = at_.space;
  const LightEdge& own = space.edges()[edge];
  const LightPoint& a0 = *own.line->ends[0];
  const LightPoint& a1 = *own.line->ends[1];
  const SourceShaft shaft(a0.rounded, a1.rounded, at_.patch.hull, space.size());
  const auto height = [&](int point) { return at_.heights[point]; };
  const Approx h0 = height(own.points[0]);
  const Approx h1 = height(own.points[1]);
  const double top = std::max(h0.v + h0.e, h1.v + h1.e);
  // Occluders between a point and both ends of the edge, once for each point.
  std::unordered_map<int, std::vector<int>> known;
  const auto hiding = [&](int point) -> const std::vector<int>& {
    const auto [at, fresh] = known.try_emplace(point);
    if (fresh) {
      solids_.between(a0, space.point(point), at->second);
      if (!at->second.empty()) {
        std::vector<int> other;
        solids_.between(a1, space.point(point), other);
        keep_common(at->second, other);
      }
    }
    return at->second;
  };
  std::vector<int> out;
  space.edge_tree().traverse(
      [&](const Box& box) { return shaft.may_meet_before(box); },
      [&](std::uint32_t i) {
        const int e = static_cast<int>(i);
        if (e == edge || sees_source_[i] == 0) return;
        const LightEdge& other = space.edges()[i];
        const Approx g0 = height(other.points[0]);
        const Approx g1 = height(other.points[1]);
        if (std::min(g0.v - g0.e, g1.v - g1.e) > top) return;
        const LightPoint& q0 = *other.line->ends[0];
        const LightPoint& q1 = *other.line->ends[1];
        if (!shaft.may_meet_before(q0.rounded, q1.rounded)) return;
        if (never_grazes(space, other, a0, a1) || never_grazes(space, own, q0, q1)) {
          return;
        }
        std::vector<int> common = hiding(other.points[0]);
        if (!common.empty()) keep_common(common, hiding(other.points[1]));
        if (common.empty()) out.push_back(e);
      });
  std::ranges::sort(out);
  return out;
}

}  // namespace sightline::internal
