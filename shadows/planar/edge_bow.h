// An edge as a rational Bezier curve in doubles: points, area beside its chord, drawing.

#pragma once

#include <Eigen/Core>

#include "shadows/planar/planar_data.h"

namespace sightline::internal {

/// ((1-t)^2 p + 2 t (1-t) middle + t^2 q) / ((1-t)^2 + 2 t (1-t) weight + t^2), 0 <= t <=
/// 1, weight > -1.  A segment has the weight 1 and its own middle.
struct EdgeBow {
  Eigen::Vector2d p, q;
  Eigen::Vector2d middle;  ///< the middle control point times its weight
  double weight;

  [[nodiscard]] Eigen::Vector2d at(double t) const;
  /// The two halves, up to t = 1/2 and from there on.
  [[nodiscard]] std::array<EdgeBow, 2> halves() const;
  /// Distance from the chord of the point that is furthest from it.
  [[nodiscard]] double height() const;
};
[[nodiscard]] EdgeBow edge_bow(const PlanarData& map, int e);

/// The area between a curve and its chord, positive where the curve, seen along the
/// chord, lies on its right: what it adds to a face on its left.  Exact to some 1e-15 of
/// the area of the triangle of its control points.
[[nodiscard]] double area_beside_chord(const EdgeBow& bow);

}  // namespace sightline::internal
