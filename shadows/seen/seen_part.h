// The part of a plane of the source that an eye sees, as a region: its boundary edges,
// their names, its closed boundaries.

#pragma once

#include <vector>

#include "shadows/light_seen.h"
#include "shadows/seen/source_view.h"

namespace sightline::internal {

struct SeenPart {
  /// With the part seen on its left, as the eye sees it.
  struct Edge {
    int from, to;            ///< points
    std::vector<int> lines;  ///< all that are seen there, ascending; the first is drawn
    bool forward;            ///< the edge runs in that line's own order
  };
  std::vector<PicturePoint> points;
  std::vector<Edge> edges;
};

[[nodiscard]] SeenPart seen_part(const SourceView& view);

/// The closed walks along the edges, the part seen on their left: positions in `edges`.
[[nodiscard]] std::vector<std::vector<int>> boundary_walks(const EyeSpace& eye,
                                                           const SeenPart& part);

/// Names the walks' sides; in a canonical order.
[[nodiscard]] std::vector<SeenBoundary> seen_boundaries(const SourceScene& source,
                                                        const SourcePlane& plane,
                                                        const SourceView& view,
                                                        const SeenPart& part);

}  // namespace sightline::internal
