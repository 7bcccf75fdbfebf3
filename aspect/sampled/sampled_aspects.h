// Aspect graphs from views at samples: what is found, not what there is.

#pragma once

#include <set>
#include <string>

#include "aspect/aspect_graph.h"
#include "linespace/point_view.h"

namespace sightline::internal {

/// Aspects are the connected sets of neighbouring samples with one label.
[[nodiscard]] AspectGraph sampled_aspects(const Scene& scene,
                                          const AspectRequest& request);

/// request.check further random views, against labels.  Throws Stopped.
[[nodiscard]] AspectCheck check_labels(const PointViewIndex& index,
                                       const AspectRequest& request,
                                       const std::set<std::string>& labels);

}  // namespace sightline::internal
