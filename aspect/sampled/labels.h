// What a view is called in an aspect graph, and what else is told of it.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "aspect/aspect_graph.h"
#include "linespace/point_view.h"

namespace sightline::internal {

struct ViewLabels {
  std::string label;  ///< of the request's kind
  std::string faces;  ///< the set of visible patches
  std::string shape;
  std::string structure;
  std::vector<int> facets;
};

/// Of a view that is general.
[[nodiscard]] ViewLabels labels_of(const PointView& view, const Scene& scene,
                                   const AspectRequest& request);
/// nullopt for a viewpoint on an event, on the scene, or inside a closed object: it
/// belongs to no aspect.
[[nodiscard]] std::optional<ViewLabels> labels_of(const PointViewIndex& index,
                                                  const Viewpoint& at,
                                                  const AspectRequest& request);

}  // namespace sightline::internal
