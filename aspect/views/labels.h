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

/// The labels of a view, which must be general.
[[nodiscard]] ViewLabels labels_of(const PointView& view, const Scene& scene,
                                   const AspectRequest& request);
/// nullopt for a viewpoint on an event, on the scene, or inside a closed object: it
/// belongs to no aspect.
[[nodiscard]] std::optional<ViewLabels> labels_of(const PointViewIndex& index,
                                                  const Viewpoint& at,
                                                  const AspectRequest& request);

/// What the view is called alone: ViewLabels::label.
[[nodiscard]] std::string label_of(const PointView& view, const Scene& scene,
                                   const AspectRequest& request);

/// In this region something is seen of these faces (ascending; none: of any).
[[nodiscard]] bool counts_of(const MapRegion& region, const Scene& scene,
                             const std::vector<int>& of);

/// As a direction or an eye, whichever the projection asks for.
[[nodiscard]] Viewpoint viewpoint_at(const Point& at, Projection projection);

struct TakenViews {
  /// By viewpoint; nullopt where the view belongs to no aspect, or time was over first.
  std::vector<std::optional<ViewLabels>> labels;
  std::size_t views = 0;  ///< that were taken
  bool complete = true;
};

/// The labels of the views from all these points, on several threads.  `left`: its budget
/// and stop are heard.
[[nodiscard]] TakenViews take_views(const PointViewIndex& index,
                                    const std::vector<Point>& at,
                                    const AspectRequest& request, const Request& left);

}  // namespace sightline::internal
