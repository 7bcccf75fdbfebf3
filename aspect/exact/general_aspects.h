// Exact aspect graphs of scenes that are not one convex solid.

#pragma once

#include <string>
#include <variant>

#include "aspect/aspect_graph.h"

namespace sightline::internal {

/// The cells of all planes (great circles) of corners with edges and of facets, an exact
/// view in each, neighbours with equal labels joined.  Certified: outside these planes
/// views change at EEE events only, and the scene has none.
///
/// Or a line that says why this scene's graph is not to be had so: it has EEE events,
/// objects that cross, or too many planes.  Budget: of what was stopped the cells seen up
/// to then, not complete.
[[nodiscard]] std::variant<AspectGraph, std::string> general_aspects(
    const Scene& scene, const AspectRequest& request);

}  // namespace sightline::internal
