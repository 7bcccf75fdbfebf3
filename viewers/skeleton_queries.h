// Answers to questions asked of a finished skeleton: arcs by what their lines end on, and
// the events that a moving viewpoint crosses.

#pragma once

#include <array>
#include <string>
#include <vector>

#include "skeleton/view_events.h"
#include "viewers/answer.h"

namespace sightline::viewers {

/// Arcs with a line that ends on the group's facets, or ("outside") that leaves the
/// scene: the events that the group sees.  Their numbers, ascending, each once.  Throws
/// InvalidInput for unknown groups.
[[nodiscard]] std::vector<std::uint32_t> seen_from(const Scene& scene,
                                                   const EndIndex& ends,
                                                   const std::string& group);

/// Arcs with a line that runs from one group to the other; either may be "outside".
[[nodiscard]] std::vector<std::uint32_t> between_ends(
    const Scene& scene, const EndIndex& ends, const std::array<std::string, 2>& groups);

/// {"arcs": counts by kind, "list": every arc as arc_json() with its "pieces" whose ends
/// are named by group, or "outside"}.
[[nodiscard]] Json arcs_by_ends_json(const Scene& scene, const Skeleton& skeleton,
                                     const EndIndex& ends,
                                     const std::vector<std::uint32_t>& arcs);

/// One element per event, in order: "u", "point", "kind", "tie", then the arc as
/// arc_json() and "side", or the facet.
[[nodiscard]] Json events_json(const Scene& scene, const Skeleton& skeleton,
                               const std::vector<ViewEvent>& events);

}  // namespace sightline::viewers
