#include "linespace/swaths/edge_cuts.h"

#include <CGAL/Gmpq.h>

#include <algorithm>
#include <cmath>

#include "linespace/lines/rounded_root.h"
#include "linespace/lines/transversals.h"
#include "linespace/numbers/predicates.h"

namespace sightline::internal {

Cut make_cut(CutKind kind, std::int32_t feature, const std::array<std::int32_t, 3>& plane,
             const BoundedValue& at_start, const BoundedValue& at_end) {
  const auto [lo, hi] =
      enclosed_root(at_start.value, at_start.error, at_end.value, at_end.error);
  return {kind, feature, plane, lo, hi};
}

Cut exact_cut(const Rational& parameter) {
  constexpr double slack = 8 * std::numeric_limits<double>::epsilon();
  const double s = parameter.convert_to<double>();
  Cut cut{
      CutKind::Side, -1, {-1, -1, -1}, s * (1 - slack), std::min(1.0, s * (1 + slack))};
  cut.exact = &parameter;
  return cut;
}

Rational exact_parameter(const Scene& scene, const LineThrough& edge, const Cut& cut) {
  if (cut.kind == CutKind::Start) return 0;
  if (cut.kind == CutKind::End) return 1;
  if (cut.exact != nullptr) return *cut.exact;
  const auto at = [&](const Point& p) {
    return ring_orient3d(scene.point(cut.plane[0]), scene.point(cut.plane[1]),
                         scene.point(cut.plane[2]), p);
  };
  const Ring x = at(edge.from);
  const Ring y = at(edge.to);
  // Only where a sign was left to rounding does the plane not cross the edge's line.
  if (x == y) return Rational(cut.parameter());
  return Rational((CGAL::Gmpq(x) / CGAL::Gmpq(Ring(x - y))).mpq());
}

double rounded_parameter(const Scene& scene, const LineThrough& edge, const Cut& cut) {
  if (cut.hi - cut.lo <= kRangeError || thread_precision == Precision::Double) {
    return cut.parameter();
  }
  if (cut.exact == nullptr) {
    const auto at = [&](const Point& p) {
      return ball_orient3d(scene.point(cut.plane[0]), scene.point(cut.plane[1]),
                           scene.point(cut.plane[2]), p);
    };
    if (const auto s = rounded_root(at(edge.from), at(edge.to))) return *s;
  }
  return exact_parameter(scene, edge, cut).convert_to<double>();
}

Sign compare(const Scene& scene, const LineThrough& edge, const Cut& a, const Cut& b) {
  const auto fixed = [](const Cut& c) {
    return c.kind == CutKind::Start ? -1 : c.kind == CutKind::End ? 1 : 0;
  };
  const int fa = fixed(a);
  const int fb = fixed(b);
  if (fa != 0 || fb != 0) return static_cast<Sign>((fa > fb) - (fa < fb));
  if (a.hi < b.lo) return Sign::Negative;
  if (a.lo > b.hi) return Sign::Positive;
  if (a.exact != nullptr || b.exact != nullptr) {
    const Rational x = exact_parameter(scene, edge, a);
    const Rational y = exact_parameter(scene, edge, b);
    return x < y ? Sign::Negative : x > y ? Sign::Positive : Sign::Zero;
  }
  if (a.plane == b.plane) return Sign::Zero;
  if (a.kind == b.kind && a.feature >= 0 && a.feature == b.feature) return Sign::Zero;
  const auto plane_of = [&](const Cut& c) {
    return PlaneThrough{scene.point(c.plane[0]), scene.point(c.plane[1]),
                        scene.point(c.plane[2])};
  };
  return compare_crossings(edge, plane_of(a), plane_of(b));
}

void CutUnion::add(const Cut& from, const Cut& to) {
  if (order(from, to) >= 0) return;
  // [first, last) are the intervals that the new one meets.
  const auto first =
      std::find_if(intervals_.begin(), intervals_.end(),
                   [&](const CutInterval& i) { return order(i.to, from) >= 0; });
  auto last = first;
  while (last != intervals_.end() && order(last->from, to) <= 0) ++last;
  if (first == last) {
    intervals_.insert(first, {from, to});
    return;
  }
  if (order(from, first->from) < 0) first->from = from;
  const Cut& furthest = std::prev(last)->to;
  first->to = order(to, furthest) > 0 ? to : furthest;
  intervals_.erase(std::next(first), last);
}

std::vector<CutInterval> CutUnion::complement() const {
  std::vector<CutInterval> open;
  Cut at = start_cut();
  for (const CutInterval& i : intervals_) {
    if (order(at, i.from) < 0) open.push_back({at, i.from});
    at = i.to;
  }
  if (order(at, end_cut()) < 0) open.push_back({at, end_cut()});
  return open;
}

}  // namespace sightline::internal
