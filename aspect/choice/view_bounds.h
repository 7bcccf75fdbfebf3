// What no view can exceed, by measure.

#pragma once

#include <vector>

#include "aspect/choice/candidates.h"
#include "aspect/choice/view_regions.h"

namespace sightline::internal {

/// No view of view space has more of this measure; `reached` is what some view has.
/// `counts`: by side, which of them count (Faces only; empty: all).
[[nodiscard]] double measure_bound(const PointViewIndex& index,
                                   const ViewpointRequest& request,
                                   const std::vector<PatchSide>& sides,
                                   ViewMeasure measure, double reached,
                                   const std::vector<bool>& counts = {});

/// The same from the views of a certified graph, one of each aspect.
[[nodiscard]] double graph_bound(const std::vector<SeenParts>& views,
                                 const std::vector<PatchSide>& sides,
                                 const ViewpointRequest& request, ViewMeasure measure);

}  // namespace sightline::internal
