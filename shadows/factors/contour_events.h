// Where along a contour piece the integrand changes its formula.

#pragma once

#include <vector>

#include "shadows/factors/exchange_geometry.h"

namespace sightline::internal {

/// Positions strictly inside the piece, ascending, at which a line from sender to target
/// through it meets a corner and a side of others, or three sides, or at which the piece
/// passes the plane of a blocker: there the polygon of the sender that sees the target
/// past the piece may change its structure.  Rounded.  Cost: E^2 for E sides, and a
/// little more for each triple of sides that cross in the picture.
[[nodiscard]] std::vector<double> contour_events(const ExchangeGeometry& geometry,
                                                 const ContourPiece& piece);

}  // namespace sightline::internal
