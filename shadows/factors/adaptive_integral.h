// Adaptive integration of several functions of one variable to one tolerance: the
// interval with the largest estimated error is cut in two until the sum is small enough.

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <queue>
#include <vector>

namespace sightline::internal {

/// Nodes from 0 outwards in [0, 1], Kronrod's weights, and Gauss' at every second node.
/// Kronrod, Nodes and weights of quadrature formulas, 1965; these digits follow from
/// their definition and are checked by a test.
template <std::size_t N>
struct KronrodRule {
  std::array<double, N> nodes, kronrod, gauss;  ///< gauss: 0 where it has no node
};

inline constexpr KronrodRule<4> kKronrod7{
    {0, 0.434243749346802558, 0.774596669241483377, 0.960491268708020284},
    {0.450916538658474142, 0.401397414775962223, 0.268488089868333441,
     0.104656226026467265},
    {0.888888888888888889, 0, 0.555555555555555556, 0}};

inline constexpr KronrodRule<8> kKronrod15{
    {0, 0.207784955007898468, 0.405845151377397167, 0.586087235467691130,
     0.741531185599394440, 0.864864423359769073, 0.949107912342758525,
     0.991455371120812639},
    {0.209482141084727828, 0.204432940075298892, 0.190350578064785410,
     0.169004726639267903, 0.140653259715525919, 0.104790010322250184,
     0.063092092629978553, 0.022935322010529225},
    {0.417959183673469388, 0, 0.381830050505118945, 0, 0.279705391489276668, 0,
     0.129484966168869693, 0}};

struct IntegralEstimate {
  double value = 0, error = 0;
};

/// The error is the difference of the two rules, which is that of the weaker one.
template <std::size_t N, class Function>
IntegralEstimate kronrod(const KronrodRule<N>& rule, double from, double to,
                         Function&& f) {
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  const double centre = f(middle);
  double k = rule.kronrod[0] * centre, g = rule.gauss[0] * centre;
  for (std::size_t i = 1; i < N; ++i) {
    const double step = half * rule.nodes[i];
    const double sum = f(middle - step) + f(middle + step);
    k += rule.kronrod[i] * sum;
    g += rule.gauss[i] * sum;
  }
  return {half * k, std::abs(half * (k - g))};
}

/// A part of the range of function number `function`.
struct Interval {
  int function;
  double from, to;
  IntegralEstimate estimate;
  bool operator<(const Interval& other) const {
    return estimate.error < other.estimate.error;
  }
};

struct AdaptiveResult {
  double value = 0, error = 0;
  std::int64_t evaluations = 0;
};

/// estimate(function, from, to) -> IntegralEstimate.  Ends where the errors add up to the
/// tolerance, or after so many cuts; or where nothing can be cut any more.
template <class Estimate>
AdaptiveResult integrate_adaptively(std::vector<Interval> intervals, double tolerance,
                                    int most_cuts, Estimate&& estimate) {
  double error = 0;
  for (Interval& i : intervals) {
    i.estimate = estimate(i.function, i.from, i.to);
    error += i.estimate.error;
  }
  std::make_heap(intervals.begin(), intervals.end());
  for (int cuts = 0; error > tolerance && cuts < most_cuts; ++cuts) {
    std::pop_heap(intervals.begin(), intervals.end());
    const Interval whole = intervals.back();
    const double middle = 0.5 * (whole.from + whole.to);
    if (!(whole.from < middle && middle < whole.to)) break;
    Interval left{whole.function, whole.from, middle, {}};
    Interval right{whole.function, middle, whole.to, {}};
    left.estimate = estimate(left.function, left.from, left.to);
    right.estimate = estimate(right.function, right.from, right.to);
    error += left.estimate.error + right.estimate.error - whole.estimate.error;
    intervals.back() = left;
    std::push_heap(intervals.begin(), intervals.end());
    intervals.push_back(right);
    std::push_heap(intervals.begin(), intervals.end());
  }
  AdaptiveResult result;
  for (const Interval& i : intervals) {
    result.value += i.estimate.value;
    result.error += i.estimate.error;
  }
  return result;
}

}  // namespace sightline::internal
