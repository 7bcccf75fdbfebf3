// The exact aspect graph of one convex solid: its facets' planes cut view space into
// cells, each an aspect.

#pragma once

#include "aspect/aspect_graph.h"
#include "aspect/convex/convex_solid.h"

namespace sightline::internal {

/// Requires no `of`.  Cost: directions n^2 log n, points n^3 log n; where a
/// list is wanted a view for each aspect.
[[nodiscard]] AspectGraph convex_aspects(const Scene& scene, const ConvexSolid& solid,
                                         const AspectRequest& request);

}  // namespace sightline::internal
