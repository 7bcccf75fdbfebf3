// From edges with their order around vertices to boundaries and faces.

#pragma once

#include "shadows/planar/planar_data.h"

namespace sightline::internal {

/// Sets `next`, `face` and `faces`.  Requires everything else, each vertex with an edge.
/// Throws InvalidInput where an edge lies outside the outline.
void find_faces(PlanarData& map);

}  // namespace sightline::internal
