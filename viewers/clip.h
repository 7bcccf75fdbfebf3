// What of polygons, segments and drawings lies inside an axis-aligned box.
//
// In doubles, for pictures: nothing is decided on what comes out.  A box is its corner
// with the smallest and its corner with the largest coordinates, and is closed: what lies
// in one of its faces is inside.

#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "viewers/picture.h"

namespace sightline::viewers {

/// The part of a convex polygon inside the box, a point per corner, in the polygon's
/// order: one plane of the box after the other (Sutherland and Hodgman, "Reentrant
/// Polygon Clipping", 1974).  No point is outside of the box, not by an ulp.
///
/// Empty when the polygon is outside, or touches the box only in a point or along a line.
/// A polygon inside comes back as it is.  Requires finite coordinates.
[[nodiscard]] std::vector<Point> clip_polygon(std::span<const Point> polygon,
                                              const std::array<Point, 2>& box);

/// The part of a segment inside the box, in the segment's direction (Liang and Barsky,
/// "A New Concept and Method for Line Clipping", 1984).  No end is outside of the box.
///
/// Empty when the segment is outside, touches the box in a single point, or is a point.
/// Requires finite coordinates.
[[nodiscard]] std::optional<std::array<Point, 2>> clip_segment(
    const std::array<Point, 2>& segment, const std::array<Point, 2>& box);

/// What of the drawing is inside the box: triangles, veils and strokes cut at its faces.
/// Solids appear cut open (Drawing::cut).
[[nodiscard]] Drawing clipped(const Drawing& drawing, const std::array<Point, 2>& box);

/// No triangle, veil or stroke.
[[nodiscard]] bool is_empty(const Drawing& drawing);

}  // namespace sightline::viewers
