// From arcs and their crossings to vertices and edges.

#pragma once

#include "shadows/planar/arcs/crossings.h"
#include "shadows/planar/planar_data.h"

namespace sightline::internal {

/// Everything but faces.
[[nodiscard]] PlanarData vertices_and_edges(std::span<const PlaneCurve> curves,
                                            const PlaneOutline& outline,
                                            CrossingCounts& counts);

}  // namespace sightline::internal
