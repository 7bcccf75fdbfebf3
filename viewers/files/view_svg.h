// The drawing of a view as SVG, every line and patch with its name.

#pragma once

#include <string>

#include "viewers/pictures/view_drawing.h"

namespace sightline::viewers {

/// The text of an SVG file, its longer side 1000 wide or high:
///   path.patch    a region, even-odd; data-region, data-patch, data-facets, data-object
///   line.KIND     a map edge (silhouette, crease, ...); data-edge its number in the map,
///                 data-line the edge of the scene or the two facets
///   circle.KIND   a map vertex (corner, t, touch, accident); data-vertex
/// Each has a <title> that tells the same in words.  Numbers are those of the answer.
[[nodiscard]] std::string view_svg(const Scene& scene, const PointView& view,
                                   const ViewDrawing& drawing);

}  // namespace sightline::viewers
