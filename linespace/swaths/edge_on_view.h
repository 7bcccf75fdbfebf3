// Whether a viewpoint in the plane of a facet sees it edge-on.

#pragma once

#include "linespace/predicates.h"
#include "linespace/silhouettes/silhouettes.h"

namespace sightline::internal {

/// Let x be where the segment from a to b crosses the plane of the facet (its first
/// face's), outside the facet.  True when an open piece of the facet's sides is seen from
/// x: for all its points w the open segment xw is free, as docs/contacts.md has it.  So
/// other facets in the same plane do not hide it, nor does what touches the plane from
/// one side; but both together may, where they close what is between.  A facet of which
/// x sees single points only, through a gap of no width, is not seen.
///
/// Requires that a and b are strictly on different sides of the plane.  Decided exactly.
/// Cost: some microseconds a face near that crosses the plane, and a contact test.
[[nodiscard]] bool sees_edge_on(const Silhouettes& silhouettes, int facet,
                                const PlaneThrough& plane, const Point& a,
                                const Point& b);

}  // namespace sightline::internal
