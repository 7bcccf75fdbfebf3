// Vertex and edge whose triangle holds something more than crossing faces: corners in its
// plane, coplanar faces, touching solids, cuts that coincide.  Slow, general, exact:
// every stretch between two critical positions, and every critical position, is judged by
// the contacts of its line.

#pragma once

#include <deque>
#include <span>
#include <vector>

#include "linespace/contact_internal.h"
#include "skeleton/edge_cuts_internal.h"
#include "skeleton/generators_internal.h"
#include "skeleton/vertex_view_internal.h"

namespace sightline::internal {

class KnownLines;

/// All positions strictly inside the edge e0 e1 where the contacts of its lines through
/// the star's point with these faces can change, in order, without repeats.  `plane` is
/// that of the point and the edge; positions that no three points span go to `positions`,
/// which the cuts then point into.
[[nodiscard]] std::vector<Cut> critical_cuts(const Generators& generators,
                                             const Star& star, const Point& e0,
                                             const Point& e1, const PlaneSide& plane,
                                             std::span<const int> faces,
                                             std::deque<Rational>& positions);

/// Adds the arcs of one vertex and one ridge.  `plane` is theirs, `closed` holds parts
/// known to be hidden or unsupported, `ending` those in which the viewpoint can only be
/// an end contact (polygon mode), `faces` all faces that meet the triangle between.
void add_degenerate_pair(const Generators& generators, const Star& star,
                         const Ridge& ridge, const PlaneSide& plane,
                         const CutUnion& closed, std::span<const CutInterval> ending,
                         std::span<const std::int32_t> faces, VertexView& out);

/// The node at a cut of a ridge as its contacts make it: in solid mode left to
/// find_further_contacts(), in polygon mode found among `faces` (all that meet the
/// triangle between).  `arc_ends` are those of the arc that ends there.
std::uint32_t contact_node(const Generators& generators, const Star& star,
                           const Ridge& ridge, std::span<const std::int32_t> faces,
                           const Cut& cut, const std::array<bool, 2>& arc_ends,
                           VertexView& out);

/// Looks at nodes of a view along their whole maximal free segments: those with more
/// contacts than their kind has become Degenerate, with all generators listed from the
/// end with the smaller one.  Looked at are nodes found among zero signs, and all that
/// `probe` is not certain of: whatever else was asked for, so that a part names its nodes
/// as the whole does.
void find_further_contacts(const Generators& generators, const Star& star,
                           LineProbe& probe, KnownLines& known, VertexView& view);

}  // namespace sightline::internal
