// Comparing two views of a path, and naming what happens between them.

#pragma once

#include <span>
#include <vector>

#include "linespace/path/path_candidates.h"
#include "linespace/path_events.h"

namespace sightline::internal {

/// The labelled structures are equal; of views that are not general, those of their maps.
[[nodiscard]] bool same_structure(const PathScene& scene, const PointView& x,
                                  const PointView& y);

/// Facets, with their sides, of which area is seen in x and not in y.
[[nodiscard]] std::vector<int> seen_only_in(const PointView& x, const PointView& y);

/// Events at an eye that is on them, seen from there: its accidents, but for those that
/// last on the way before and after it too, in ascending order.  What lies in the
/// plane of a facet that is seen edge-on is a part of the facet's event.
[[nodiscard]] std::vector<PathEvent> events_of(const Scene& scene, const PointView& at,
                                               std::span<const Accident> before,
                                               std::span<const Accident> after);

/// The event that a candidate makes.
[[nodiscard]] PathEvent event_of(const PathScene& scene, const Candidate& candidate);

/// For a candidate of three lines that come into one point of the picture, where two of
/// them are seen to cross in the view before: whether the third is seen to cross one of
/// these two in the view before or in the view after.
[[nodiscard]] bool is_seen(const Candidate& candidate, const PathScene& scene,
                           const SeenElements& before, const SeenElements& after);

}  // namespace sightline::internal
