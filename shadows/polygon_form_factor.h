// The form factor of two polygons with nothing in between, in closed form.
//
// Neighbours: point_form_factor.h for a point and a polygon; form_factors.h for the
// surfaces of a scene, which hide each other.

#pragma once

#include <span>

#include "linespace/scene.h"

namespace sightline {

struct PolygonFormFactor {
  /// Share of what `from` sends out by its front that arrives at the front of `to`.
  double factor;
  double error_bound;  ///< of factor: what rounding may do
};

/// Corners of plane simple polygons, counter-clockwise as seen from their fronts, scene
/// units.  They may touch along an edge or at a corner; of polygons partly behind each
/// other's plane the parts before it count, on which side a corner lies being decided
/// exactly; coplanar ones exchange nothing, exactly 0.  factor times the area of `from`
/// is the same both ways.  Throws InvalidInput for polygons of fewer than three corners
/// or no area.
///
/// Method: Schroeder and Hanrahan, On the form factor between two polygons, SIGGRAPH
/// 1993: the double integral of ln r along both boundaries, with dilogarithms; reduced
/// here in another way, by Euler's identity for the homogeneous part of ln r.  Where that
/// loses digits, as for polygons that are small and far apart or nearly parallel sides,
/// the outer one of the two integrals is done numerically.  Cost: some microseconds.
[[nodiscard]] PolygonFormFactor polygon_form_factor(std::span<const Point> from,
                                                    std::span<const Point> to);

}  // namespace sightline
