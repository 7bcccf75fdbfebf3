// The exact polynomials of a swath (linespace/swath.h, which has the notation).

#pragma once

#include <array>

#include "linespace/lines/transversals.h"
#include "linespace/numbers/surd.h"
#include "linespace/predicates.h"

namespace sightline::internal {

/// A point with a weight: (x, y, z) / w.
struct WeightedPoint {
  RingVector x;
  Ring w;
};

/// A weighted point that is linear in s, by its values at 0 and 1.
using MovingPoint = std::array<WeightedPoint, 2>;

/// X(s) on the first generator and Y(s) on the last.
struct ExactSwath {
  MovingPoint first, last;

  /// Zero where the line at s meets another one.
  [[nodiscard]] Quadratic<Ring> meeting(const LineThrough& line) const;
  /// x, y, z, w of where the line at s meets a plane; all zero where it lies in it.
  [[nodiscard]] std::array<Quadratic<Ring>, 4> trace(const PlaneThrough& plane) const;
};

/// The values of a plane at a moving point, for s = 0 and 1; positive in front of it.
[[nodiscard]] std::array<Ring, 2> values(const PlaneThrough& plane, const MovingPoint& x);

/// The lines through a vertex and the points of an edge.
[[nodiscard]] ExactSwath exact_swath(const Eigen::Vector3d& vertex,
                                     const LineThrough& edge);
/// The lines through three edges.  All weights of `last` are zero, and its coordinates,
/// where every line between the outer edges meets the middle one's line.
[[nodiscard]] ExactSwath exact_swath(const LineThrough& first, const LineThrough& middle,
                                     const LineThrough& last);

}  // namespace sightline::internal
