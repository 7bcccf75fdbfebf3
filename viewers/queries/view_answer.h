// What is seen from a point, as JSON and as rows of a table.

#pragma once

#include <string>
#include <string_view>

#include "linespace/visibility_map.h"
#include "viewers/answer.h"
#include "viewers/questions.h"

namespace sightline::viewers {

// The words of CONTRACT.md, section look.
[[nodiscard]] std::string_view name(EyePlace place);          ///< "corner", "free", ...
[[nodiscard]] std::string_view name(MapVertexKind kind);      ///< "t", "touch", ...
[[nodiscard]] std::string_view name(MapEdgeKind kind);        ///< "silhouette", ...
[[nodiscard]] std::string_view name(FurtherLine::Kind kind);  ///< "seam", "hidden"
[[nodiscard]] std::string_view name(AccidentKind kind);       ///< "edge_on", ...

/// "x0" to "z1": the sides of a box in the order of MapLine::box_side.
[[nodiscard]] std::string_view box_side_name(int side);

/// "edge 12", or "facets 3 and 7" where these cut through each other, or "facet 3 cut by
/// z1".
[[nodiscard]] std::string told(const MapLine& line);

/// How many of the view's vertices are of this kind.
[[nodiscard]] int count(const PointView& view, MapVertexKind kind);

/// Coordinates as they were asked: a number where it was one, else the text.
[[nodiscard]] Json asked_json(const ExactPosition& at,
                              const std::array<std::string, 3>& asked);
[[nodiscard]] Json asked_json(const BoxQuestion& box);

/// One of "views" in the answer of `sightline look`, with "map" if asked for.  A line in
/// the map is the id of an edge, or {"facets": [a, b]}; the "boundary" of a region lists
/// walks of edges with the region on the left, an edge twice where the region is on both
/// its sides.
[[nodiscard]] Json view_json(const Scene& scene, const ViewQuestion& question,
                             const PointView& view, bool with_map);

/// "from 1,2,1/3" or "direction 0,0,1", of such a view.
[[nodiscard]] std::string viewpoint_text(const Json& view);

/// The first line of the table of --csv.
inline constexpr std::string_view kViewCsvHead =
    "view,facet,object,faces,front,pieces,solid_angle,area,gradient_x,gradient_y,"
    "gradient_z\n";
/// A line for each facet that the view of this number sees (RFC 4180, but with line
/// feeds); numbers that the facet has not are left empty, faces are separated by blanks.
[[nodiscard]] std::string view_csv(const Scene& scene, std::size_t number,
                                   const PointView& view);

}  // namespace sightline::viewers
