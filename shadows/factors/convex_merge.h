// Convex polygons of one plane that touch along whole sides, joined where the union is
// convex: fewer surfaces to integrate, fewer blockers.

#pragma once

#include <vector>

#include "linespace/scene.h"

namespace sightline::internal {

using PointList = std::vector<Point>;

/// Polygons convex, exactly planar, counter-clockwise as seen from their fronts; two are
/// joined if both fronts face alike.  The union stays what it is, exactly: corners that
/// become straight are left out only where this is certain.  Cost: n log n.
[[nodiscard]] std::vector<PointList> merged_convex(std::vector<PointList> polygons);

}  // namespace sightline::internal
