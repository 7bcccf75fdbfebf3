// Vertex and edge whose triangle holds something more than crossing faces: corners in its
// plane, coplanar faces, touching solids, cuts that coincide.  Slow, general, exact:
// every stretch between two critical positions, and every critical position, is judged by
// the contacts of its line.

#pragma once

#include <deque>
#include <span>
#include <vector>

#include "linespace/contacts/contact.h"
#include "linespace/sight/critical_cuts.h"
#include "linespace/silhouettes/silhouettes.h"
#include "linespace/swaths/edge_cuts.h"
#include "skeleton/build/vertex_view.h"

namespace sightline::internal {

/// Adds the arcs of one vertex and one ridge.  `plane` is theirs, `closed` holds parts
/// known to be hidden or unsupported, `ending` those in which the viewpoint can only be
/// an end contact (polygon mode), `faces` all faces that meet the triangle between.
void add_degenerate_pair(const Silhouettes& silhouettes, const Star& star,
                         const Ridge& ridge, const PlaneSide& plane,
                         const CutUnion& closed, std::span<const CutInterval> ending,
                         std::span<const std::int32_t> faces, VertexView& out);

/// The node at a cut of a ridge as its contacts make it: in solid mode left to
/// find_further_contacts(), in polygon mode found among `faces` (all that meet the
/// triangle between).  `arc_ends` are those of the arc that ends there.
std::uint32_t contact_node(const Silhouettes& silhouettes, const Star& star,
                           const Ridge& ridge, std::span<const std::int32_t> faces,
                           const Cut& cut, const std::array<bool, 2>& arc_ends,
                           VertexView& out);

}  // namespace sightline::internal
