// What a drawing may show besides the map: seams, and edges that are hidden.

#pragma once

#include <vector>

#include "linespace/view/line_view.h"
#include "linespace/view/view_map.h"

namespace sightline::internal {

[[nodiscard]] std::vector<FurtherLine> seam_lines(const EyeSpace& eye,
                                                  const ViewGraph& graph,
                                                  const ViewMap& map);
/// Of all edges of the scene.  Hears a stop.
[[nodiscard]] std::vector<FurtherLine> hidden_lines(const EyeSpace& eye,
                                                    const EyeStar& star);

}  // namespace sightline::internal
