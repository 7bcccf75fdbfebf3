// Where the view of a scene can change by corners, edges and facets: planes in space, and
// on the sphere of directions the great circles parallel to them.
//
// Events of three edges in one line of sight (EEE) have other surfaces.

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "aspect/cells/sphere_cells.h"
#include "linespace/light/homogeneous.h"

namespace sightline::internal {

/// Planes, each once, of all corners with all edges and of all faces.  Corners are the
/// ends of edges, and the points in which two edges cross in space.  A superset of the
/// surfaces of EV and F events: nothing asks whether they are seen.  nullopt where there
/// would be more than `most`.
[[nodiscard]] std::optional<std::vector<LightPlane>> event_planes(const Scene& scene,
                                                                  std::size_t most);
/// The same for eyes infinitely far away: of parallel planes one.
[[nodiscard]] std::optional<std::vector<CircleNormal>> event_circles(const Scene& scene,
                                                                     std::size_t most);

/// The planes' normals span space.
[[nodiscard]] bool span_space(std::span<const CircleNormal> normals);

}  // namespace sightline::internal
