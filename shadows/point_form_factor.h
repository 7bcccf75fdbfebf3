// The form factor of an element of surface to a polygon of which nothing is hidden.
//
// The closed form is Lambert's (Photometria, 1760): a sum over the polygon's sides, each
// the angle under which the side is seen times a cosine; so is its gradient.
// Neighbours: backprojection.h finds which part of a source is seen.

#pragma once

#include <span>

#include "linespace/scene.h"

namespace sightline {

/// Integral over the part of the polygon above the horizon of p, that is where
/// normal.(s - p) > 0, of cos cos' / (pi r^2): cos at p to the normal, cos' at s to the
/// polygon's.
/// polygon: the corners of a plane simple polygon, scene units.  Counter-clockwise as
/// seen from p counts positive, clockwise negative: so a hole is a clockwise polygon.
/// normal: of any length but 0.  0 for a p in the polygon's plane.
/// Error: some 1e-16 for each side; none is lost where p is near the polygon.
[[nodiscard]] double point_form_factor(const Point& p, const Eigen::Vector3d& normal,
                                       std::span<const Point> polygon);

}  // namespace sightline
