// Aspect graphs from views at samples: what is found, not what there is.

#pragma once

#include "aspect/aspect_graph.h"

namespace sightline::internal {

/// Aspects are the connected sets of neighbouring samples with one label.
[[nodiscard]] AspectGraph sampled_aspects(const Scene& scene,
                                          const AspectRequest& request);

}  // namespace sightline::internal
