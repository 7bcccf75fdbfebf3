// What a planar map is made of: arcs of lines and conics in one plane, exactly.
//
// A curve is X(s) = (x(s) : y(s) : w(s)), three polynomials of degree 2 at most, for s
// between two ends.  The ends are roots of polynomials of degree 2 at most.  This is what
// a swath of lines marks on a plane (linespace/swaths/exact_swath.h).

#pragma once

#include <array>
#include <vector>

#include "linespace/numbers/rational.h"
#include "linespace/swaths/quadratic_root.h"

namespace sightline::internal {

/// Coefficients of 1, s and s^2.
using RationalQuadratic = std::array<Rational, 3>;

/// The smaller or the larger root of a polynomial with real roots; of a linear one its
/// only root, whatever `larger` says.
struct CurveEnd {
  RationalQuadratic polynomial;
  bool larger = false;
};
[[nodiscard]] CurveEnd rational_end(const Rational& s);
/// The same number.
[[nodiscard]] CurveEnd curve_end_at(const QuadraticRoot& s);

/// The arc of X between `from` and `to`.  Requires from < to, w not 0 from `from` to
/// `to`, ends included, and X injective there.
struct PlaneCurve {
  int id = 0;
  RationalQuadratic x, y, w;
  CurveEnd from, to;
};

using PlanePoint = std::array<Rational, 2>;

/// The segment from a (s = 0) to b (s = 1).  Requires a != b.
[[nodiscard]] PlaneCurve plane_segment(int id, const PlanePoint& a, const PlanePoint& b);

/// h0 (1 - s)^2 + h1 s (1 - s) + h2 s^2, the form in which a swath gives its traces.
[[nodiscard]] RationalQuadratic rational_quadratic(const Quadratic<Ring>& h);

/// A polygon: its outer ring and its holes, in any order and orientation.  The rings
/// are simple and may touch one another, themselves and each other, in single points.
using PlaneOutline = std::vector<std::vector<PlanePoint>>;

}  // namespace sightline::internal
