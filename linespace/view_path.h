// What an eye sees on its way along a path: every visual event that it crosses, in order,
// and the view between each two.
//
// A path is a row of viewpoints, all eyes or all directions.  Two neighbours E0 and E1
// make a segment, on which the eye is at (1 - u) E0 + u E1, 0 <= u <= 1.  For directions
// too: then sight turns along the shorter great circle, and u depends on the lengths of
// the two vectors.
//
//   const PointViewIndex index(scene);
//   const std::vector path{eye_at({-5, -9, 1}), eye_at({5, -9, 1})};
//   const ViewPath walk = view_path(index, path);
//   for (const PathChange& c : walk.changes)
//     std::cout << c.segment << ' ' << c.u << ": " << c.events.size() << '\n';
//
// The answer is exact: which events there are, their order, and the views between them
// are decided by exact signs; only u is rounded.  How, and why nothing is missed:
// linespace/path/path_walk.h.
// Neighbours: path_events.h has the values; point_view.h gives one view;
// skeleton/view_events.h asks a skeleton that is there already, for segments of points,
// and tells events that change nothing, too.

#pragma once

#include <span>

#include "linespace/path_events.h"
#include "linespace/point_view.h"

namespace sightline {

/// Of a view's map.
[[nodiscard]] MapCounts map_counts(const PointView& view);

/// Walks along the path.  Laws:
/// 1. Two neighbouring stretches of one segment have different structures, and there is a
///    change between them.
/// 2. Where a segment meets the next, its last stretch and the next segment's first have
///    one structure, or there is a change at u = 1 of the former.
/// 3. An event at the path's very beginning or end is not told.  A path that runs
///    in an event surface (in the plane of a facet, say) has views that are not general;
///    of these the maps are compared, and accidents that go on are no events.
/// A path of one viewpoint has no segments.  Throws InvalidInput for a path that mixes
/// eyes and directions, for opposite neighbouring directions, for coordinates that
/// PointViewIndex::view refuses, and for a scene that a box cuts.  Of the request budget
/// and stop are heard; the precision is always Exact. The threads share parts of the
/// path, and their number changes nothing.  Cost: a view for each event and for each
/// suspected one; for n edges and k visible map edges met on the way, k n tests of a few
/// nanoseconds.
[[nodiscard]] ViewPath view_path(const PointViewIndex& index,
                                 std::span<const Viewpoint> path, bool keep_views = true,
                                 const Request& request = {});

}  // namespace sightline
