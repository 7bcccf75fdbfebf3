// What one view is worth: patches, areas, solid angles, entropy.

#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "aspect/viewpoints.h"
#include "linespace/point_view.h"

namespace sightline::internal {

/// A region of a view on its patch: closed outlines in space, in the patch's plane, that
/// bound it by the even-odd rule.
struct SeenRegion {
  int patch;
  std::vector<std::vector<Point>> outlines;
};

/// A view, as far as it counts: of the wanted faces.
struct SeenParts {
  Viewpoint at;
  Point point;                      ///< `at`, rounded
  std::string label;                ///< of the request's kind
  std::vector<int> facets;          ///< all that are seen, ascending
  std::vector<int> patches;         ///< that count, ascending
  std::vector<SeenRegion> regions;  ///< only where they are wanted
  std::array<double, 5> value;      ///< by ViewMeasure
};

/// nullopt where the view belongs to no aspect.
[[nodiscard]] std::optional<SeenParts> seen_parts(const PointViewIndex& index,
                                                  const Viewpoint& at,
                                                  const ViewpointRequest& request,
                                                  bool regions = false);

/// What a view shows that is there already, also one on an event or on the scene; its
/// label stays empty.
[[nodiscard]] SeenParts parts_of(const PointView& view, const Scene& scene,
                                 const ViewpointRequest& request, bool regions);

}  // namespace sightline::internal
