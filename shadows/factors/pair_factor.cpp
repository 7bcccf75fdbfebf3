#include "shadows/factors/pair_factor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "linespace/polygon_visibility.h"

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

ExchangeArea PairFactor::of(const PreparedSide& a, const PreparedSide& b,
                            double tolerance) {
  ++counts_.pairs;
  blockers_.between(a, b, between_);
  polygons_.clear();
  if (between_.empty()) {
    ++counts_.open;
    ExchangeArea result = exchange_area(a.polygon, b.polygon, polygons_, tolerance);
    result.value = above_zero(result.value, b);
    return result;
  }
  if (blockers_.hidden_by_one(a, b, between_)) return {};
  entered_ = between_;
  blockers_.leave_out_exits(a, entered_);
  for (const int i : entered_) polygons_.push_back(blockers_.polygon(i));
  ++counts_.partial;
  ExchangeArea result = exchange_area(a.polygon, b.polygon, polygons_, tolerance);
  counts_.evaluations += result.evaluations;
  // Below this, what was found may be rounding.
  constexpr double kSmall = 1e-12;
  if (result.value <= kSmall * std::min(a.area, b.area)) decide(a, b, result);
  return result;
}

ExchangeArea PairFactor::rising(const PreparedSide& a, const PreparedSide& b,
                                const Eigen::Vector3d& up, double tolerance) {
  blockers_.between(a, b, between_);
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
