// The structure of what an eye sees of the source: closed boundaries and what their sides
// lie on.

#pragma once

#include <span>
#include <vector>

#include "shadows/light_seen.h"
#include "shadows/seen/seen_part.h"

namespace sightline::internal {

/// What is seen of one plane.
struct SeenPlane {
  const SourcePlane* plane;
  const SourceView* view;
  SeenPart part;
};

/// The closed boundaries of the part seen, the part on their left, with their sides'
/// names; in a canonical order.  Those of the triangles of a polygon that rounding has
/// bent are joined across its diagonals.
[[nodiscard]] std::vector<SeenBoundary> seen_boundaries(
    const SourceScene& source, std::span<const SeenPlane> planes);

}  // namespace sightline::internal
