// The part of a plane of the source that an eye sees, as a region: its boundary edges and
// what is seen along them.

#pragma once

#include <vector>

#include "shadows/seen/source_view.h"

namespace sightline::internal {

struct SeenPart {
  /// With the part seen on its left, as the eye sees it.
  struct Edge {
    int from, to;            ///< points
    std::vector<int> lines;  ///< all that are seen there, ascending; the first is drawn
    /// By position in `lines`: the view's piece; those of one line are in its order.
    std::vector<int> pieces;
    bool forward;  ///< the edge runs in the first line's own order
  };
  std::vector<PicturePoint> points;
  std::vector<Edge> edges;
};

[[nodiscard]] SeenPart seen_part(const SourceView& view);

}  // namespace sightline::internal
