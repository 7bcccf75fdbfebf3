// Random curves for planar maps, of small integers, so that they often meet in one point,
// touch, overlap and share ends.

#pragma once

#include <array>
#include <random>
#include <vector>

#include "shadows/planar/plane_curve.h"

namespace sightline::internal {

inline PlaneOutline square_outline(int from, int to) {
  return {{{from, from}, {to, from}, {to, to}, {from, to}}};
}

class CurveGenerator {
 public:
  CurveGenerator(unsigned seed, int size) : random_(seed), size_(size) {}

  int number(int from, int to) {
    return std::uniform_int_distribution<int>(from, to)(random_);
  }
  PlanePoint point() { return {number(0, size_), number(0, size_)}; }

  PlaneCurve segment(int id) {
    for (;;) {
      const PlanePoint a = point(), b = point();
      if (a != b) return plane_segment(id, a, b);
    }
  }

  /// A rational Bezier curve with positive weights, which stays in the square.
  PlaneCurve arc(int id) {
    for (;;) {
      const std::array<PlanePoint, 3> p{point(), point(), point()};
      const std::array<int, 3> w{number(1, 3), number(1, 3), number(1, 3)};
      if (p[0] == p[2] || p[0] == p[1] || p[1] == p[2]) continue;
      // A curve that turns back on a line is not injective.
      const Rational turn = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) -
                            (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
      const Rational back = (p[1][0] - p[0][0]) * (p[2][0] - p[1][0]) +
                            (p[1][1] - p[0][1]) * (p[2][1] - p[1][1]);
      if (turn == 0 && back < 0) continue;
      return bezier(id, p, w);
    }
  }

  static PlaneCurve bezier(int id, const std::array<PlanePoint, 3>& p,
                           const std::array<int, 3>& w) {
    const auto polynomial = [](const Rational& a, const Rational& b, const Rational& c) {
      return RationalQuadratic{a, 2 * (b - a), a - 2 * b + c};
    };
    PlaneCurve curve;
    curve.id = id;
    curve.x = polynomial(w[0] * p[0][0], w[1] * p[1][0], w[2] * p[2][0]);
    curve.y = polynomial(w[0] * p[0][1], w[1] * p[1][1], w[2] * p[2][1]);
    curve.w = polynomial(w[0], w[1], w[2]);
    curve.from = rational_end(0);
    curve.to = rational_end(1);
    return curve;
  }

  /// Ends at roots of quadratics, many of them irrational, between 0 and 1.
  PlaneCurve shortened(PlaneCurve curve) {
    // (s - 1/4)^2 = k / 64 and (s - 3/4)^2 = k / 64, 0 <= k <= 3.
    const auto end = [&](const Rational& middle) {
      const Rational k = Rational(number(0, 3), 64);
      return CurveEnd{{middle * middle - k, -2 * middle, 1}, number(0, 1) == 1};
    };
    curve.from = end(Rational(1, 4));
    curve.to = end(Rational(3, 4));
    return curve;
  }

  /// The same points, with another parameter: s = 2 t / (1 + t), 0 and 1 stay.
  static PlaneCurve reparametrised(PlaneCurve curve) {
    for (RationalQuadratic* f : {&curve.x, &curve.y, &curve.w}) {
      const RationalQuadratic g = *f;
      *f = {g[0], 2 * g[0] + 2 * g[1], g[0] + 2 * g[1] + 4 * g[2]};
    }
    return curve;
  }

 private:
  std::mt19937 random_;
  int size_;
};

}  // namespace sightline::internal
