// Aspect graphs from samples and from the events between them.

#pragma once

#include "aspect/aspect_graph.h"

namespace sightline::internal {

/// Between neighbouring viewpoints of different labels the events on the way are asked
/// for (view_path.h), and views taken between them join the viewpoints where their label
/// is new there; until nothing is new.
[[nodiscard]] AspectGraph refined_aspects(const Scene& scene,
                                          const AspectRequest& request);

}  // namespace sightline::internal
