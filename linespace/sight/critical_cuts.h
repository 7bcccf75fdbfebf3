// Where along an edge the contacts of its lines through a vertex can change.

#pragma once

#include <deque>
#include <span>
#include <vector>

#include "linespace/silhouettes/silhouettes.h"
#include "linespace/swaths/edge_cuts.h"

namespace sightline::internal {

/// All positions strictly inside the edge e0 e1 where the contacts of its lines through
/// the star's point with these faces can change, in order, without repeats.  `plane` is
/// that of the point and the edge; positions that no three points span go to `positions`,
/// which the cuts then point into.
[[nodiscard]] std::vector<Cut> critical_cuts(const Silhouettes& silhouettes,
                                             const Star& star, const Point& e0,
                                             const Point& e1, const PlaneSide& plane,
                                             std::span<const int> faces,
                                             std::deque<Rational>& positions);

}  // namespace sightline::internal
