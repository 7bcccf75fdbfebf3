#include "shadows/planar/plane_curve.h"

#include <gmp.h>

namespace sightline::internal {

CurveEnd rational_end(const Rational& s) { return {{-s, 1, 0}, false}; }

// s = (a + b sqrt(d)) / c is a root of (c s - a)^2 - b^2 d, the larger one where b > 0.
CurveEnd curve_end_at(const QuadraticRoot& s) {
  const Rational a = rational(s.a), b = rational(s.b), c = rational(s.c);
  const Rational square = b * b * rational(s.d);
  if (square == 0) return rational_end(a / c);
  return {{a * a - square, -2 * a * c, c * c}, b > 0};
}

PlaneCurve plane_segment(int id, const PlanePoint& a, const PlanePoint& b) {
  return {id,        {a[0], b[0] - a[0], 0}, {a[1], b[1] - a[1], 0},
          {1, 0, 0}, rational_end(0),        rational_end(1)};
}

RationalQuadratic rational_quadratic(const Quadratic<Ring>& h) {
  const Rational h0 = rational(h.h0), h1 = rational(h.h1), h2 = rational(h.h2);
  return {h0, h1 - 2 * h0, h0 - h1 + h2};
}

}  // namespace sightline::internal
