// The contacts of a line through four edges whose coordinates are not rational.
//
// Such a line is simple.  It contains no point with rational coordinates: through a
// rational point and two lines there is one line, a rational one, or a plane full, and
// then a third line that is not in that plane makes it rational as well.  So it meets no
// corner and no two crossing edges in one point.  It lies in the plane of no face,
// because there it would be held by the points where two of the four edges cross that
// plane, which are rational.  What is left are points inside faces, which block, and
// points inside edges; edges met in one point lie on one line, and block when their faces
// lie on both sides of it.

#pragma once

#include <array>

#include "linespace/transversals.h"
#include "skeleton/nodes/node_contacts.h"

namespace sightline::internal {

/// As contacts_along() for rational lines: the contacts along the maximal free segment
/// around those with the two given ridges' edges (scene edge ids, which the line meets).
/// `end` of the result says that the segment between these is blocked at a contact;
/// `second`, which of the two lines that meet the same edges it is: the one farther along
/// the first of the listed edges on which they differ, from points[0] to points[1].
/// Requires an irrational line.  Cost: some microseconds a face near the line.
[[nodiscard]] NodeContacts contacts_along(const Silhouettes& silhouettes,
                                          const ExactLine& line,
                                          const std::array<int, 2>& outer, bool grazes);

/// The maximal free segment around the contacts with these two edges, positions 0 and 1,
/// whose rounded points are given; nullopt where a contact between them blocks.  An outer
/// contact that blocks ends it, and is among the contacts.  Faces and order are exact,
/// positions are off by at most 2^-44 times the size of the scene's coordinates, by the
/// distance of the two points, times 1 + |position|: points are off by kQuotientError of
/// their coordinates.
[[nodiscard]] std::optional<FreeSegment> free_segment(const Silhouettes& silhouettes,
                                                      const ExactLine& line,
                                                      const std::array<int, 2>& outer);

}  // namespace sightline::internal
