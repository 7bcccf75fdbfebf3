// Pairs of arcs that certainly do not meet, at the price of some fifty multiplications.
//
// An arc is the curve of its control points P_k; the implicit form of another support
// along it is a polynomial whose Bernstein coefficients follow from the values of linear
// forms at the P_k.  If all coefficients have one sign, the arc lies on one side of that
// line or conic.

#pragma once

#include "shadows/planar/arcs/plane_support.h"

namespace sightline::internal {

/// An arc and its line or conic in doubles.
struct ArcDoubles {
  int degree;  ///< 1: a segment
  bool straight;
  /// Homogeneous control points, degree + 1 of them; each number is off by at most
  /// `point_error`.
  std::array<std::array<double, 3>, 3> points;
  double point_error;
  /// The forms z0, z1, z2 of a conic; of a line F in the first row.  Each number is off
  /// by at most `form_error`.
  std::array<std::array<double, 3>, 3> forms;
  double form_error;
  /// Largest sums of magnitudes of a point's, and of a form's three numbers.
  double point_size, form_size;
};
[[nodiscard]] ArcDoubles arc_doubles(const PlaneSupport& support, const BallNumber& from,
                                     const BallNumber& to);

/// True only if no point of arc a lies on the line or conic of arc b.
[[nodiscard]] bool certainly_beside(const ArcDoubles& a, const ArcDoubles& b);

}  // namespace sightline::internal
