// Where two arcs meet, exactly.

#pragma once

#include <vector>

#include "shadows/planar/arcs/plane_arc.h"

namespace sightline::internal {

struct ArcCrossing {
  ArcParameter on_a, on_b;
};

/// How many pairs of arcs were decided how.
struct CrossingCounts {
  long pairs = 0;
  long by_filter = 0;  ///< apart, by the arcs' control points
  long by_end = 0;     ///< an end was found on the other arc's line or conic, exactly
  long by_exact = 0;   ///< roots were isolated in exact arithmetic
};

/// Appends all points in which two arcs meet: crossings, touches and ends.  Of arcs of
/// one conic those ends of each that lie on the other.  Requires different arcs; arcs of
/// one line do not meet.
void append_crossings(const PlaneArcs& all, int a, int b, std::vector<ArcCrossing>& out,
                      CrossingCounts& counts);

}  // namespace sightline::internal
