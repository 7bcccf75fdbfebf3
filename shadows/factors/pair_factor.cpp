#include "shadows/factors/pair_factor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "linespace/polygon_visibility.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

/// The part of a convex polygon on or before a plane; corners that are found are rounded.
PointList before(const PlaneSide& plane, const PointList& polygon) {
  PointList part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const Sign sa = plane(a), sb = plane(b);
    if (sa != Sign::Negative) part.push_back(a);
    if (sa * sb == Sign::Negative) {
      const double ha = plane.value(a).value, hb = plane.value(b).value;
      part.push_back(a + ha / (ha - hb) * (b - a));
    }
  }
  return part;
}

/// Of two that see each other: an opening may be less than what can be told.  Corners of
/// windows and backs may be rounded, so that for these there may be none.
double above_zero(double value, const PreparedSide& target) {
  if (value > 0) return value;
  return target.of >= 0 ? std::numeric_limits<double>::min() : 0;
}

}  // namespace

ExchangeArea PairFactor::of(const SenderPart& from, const PreparedSide& b,
                            double tolerance) {
  const PreparedSide& a = from.side;
  ++counts_.pairs;
  blockers_.between(a, b, &from.hidden, between_);
  if (between_.empty()) {
    ++counts_.open;
    ExchangeArea result = exchange_area(a.polygon, b.polygon, {}, tolerance);
    result.value = above_zero(result.value, b);
    return result;
  }
  if (blockers_.hidden_by_one(a, b, between_)) return {};
  ++counts_.partial;
  ExchangeArea result = among_blockers(a, b, from.hidden, tolerance, kMostCuts);
  counts_.evaluations += result.evaluations;
  // Below this, what was found may be rounding.
  constexpr double kSmall = 1e-12;
  if (result.value <= kSmall * std::min(a.area, b.area)) {
    blockers_.between(a, b, &from.hidden, between_);
    decide(a, b, result);
  }
  return result;
}

ExchangeArea PairFactor::among_blockers(const PreparedSide& a, const PreparedSide& b,
                                        const std::vector<char>& hidden, double tolerance,
                                        int cuts) {
  // The time of an integral grows with the third power of the number of blockers; halves
  // have some two thirds of them each.
  constexpr std::size_t kCrowd = 20;
  hear_stop();
  std::vector<int> entered = between_;
  blockers_.leave_out_exits(a, entered);
  if (entered.size() <= kCrowd || cuts == 0) {
    polygons_.clear();
    for (const int i : entered) polygons_.push_back(blockers_.polygon(i));
    return exchange_area(a.polygon, b.polygon, polygons_, tolerance);
  }
  const bool first = a.area >= b.area;
  ExchangeArea sum;
  for (PointList& half : halves((first ? a : b).polygon)) {
    if (half.size() < 3 || area_of(half) == 0) continue;
    const PreparedSide part = part_of(first ? a : b, std::move(half));
    const PreparedSide& from = first ? part : a;
    const PreparedSide& to = first ? b : part;
    if (!facing(from, to)) continue;
    blockers_.between(from, to, &hidden, between_);
    if (blockers_.hidden_by_one(from, to, between_)) continue;
    const ExchangeArea e = among_blockers(from, to, hidden, 0.5 * tolerance, cuts - 1);
    sum.value += e.value;
    sum.error += e.error;
    sum.evaluations += e.evaluations;
  }
  return sum;
}

ExchangeArea PairFactor::rising(const SenderPart& from, const PreparedSide& b,
                                const Eigen::Vector3d& up, double tolerance) {
  const PreparedSide& a = from.side;
  blockers_.between(a, b, &from.hidden, between_);
  if (blockers_.hidden_by_one(a, b, between_)) return {};
  blockers_.leave_out_exits(a, between_);
  polygons_.clear();
  for (const int i : between_) polygons_.push_back(blockers_.polygon(i));
  return exchange_area(a.polygon, b.polygon, polygons_, tolerance, up);
}

void PairFactor::decide(const PreparedSide& a, const PreparedSide& b, ExchangeArea& sum) {
  constexpr int kCuts = 4;
  if (blockers_.hidden_by_parts(a.polygon, b.polygon, between_, kCuts)) {
    sum = {};
    return;
  }
  ++counts_.decided;
  VisibilityQuestion question{before(b.plane, a.polygon), before(a.plane, b.polygon), {}};
  for (const int i : between_) question.occluders.push_back(blockers_.polygon(i));
  std::optional<VisibilityAnswer> answer;
  try {
    answer = polygon_visibility(question);
  } catch (const InvalidInput&) {
    // Rounding has left a part before the other's plane without area.
  }
  if (answer && answer->verdict == Verdict::Hidden) sum = {};
  if (answer && answer->verdict == Verdict::Visible) sum.value = above_zero(sum.value, b);
  sum.value = std::max(sum.value, 0.0);
}

}  // namespace sightline::internal
