// Where the traces of a source's events cross a segment on a receiver, in doubles; and
// the structure of what a point sees of a convex source, by the exact view through it.

#pragma once

#include <string>
#include <vector>

#include "linespace/light/light_events.h"
#include "linespace/point_view.h"

namespace sightline::testing {

/// Positions u in [0, 1], ascending, where a piece on a face of that facet crosses the
/// segment from p to q, which lies in the facet's plane.
[[nodiscard]] std::vector<double> light_crossings(const internal::LightSpace& space,
                                                  const internal::LightEvents& events,
                                                  int facet, const Point& p,
                                                  const Point& q);

/// Pieces whose middle line, in doubles, misses the receiver's face or the source, or
/// does not pass its generators between the two, or certainly passes the inside of a face
/// there.  Horizons are left out.
[[nodiscard]] int wrong_pieces(const internal::LightSpace& space,
                               const internal::LightEvents& events);

/// Positions in [0, 1], ascending, where the segment crosses the line in which some face
/// touches or cuts the plane of that facet: its feet there.
[[nodiscard]] std::vector<double> foot_crossings(const Scene& scene, int facet,
                                                 const Point& p, const Point& q);

/// The boundaries of what the eye sees of some facets, within a convex window that holds
/// them, as text: for each the cyclic list of what its sides lie on.  Edges on one line
/// have one name, and so have all in the plane of the receiver, which are its horizon.
[[nodiscard]] std::string seen_structure(const PointViewIndex& index, const Scene& scene,
                                         const std::vector<Point>& window,
                                         const std::vector<int>& facets, int receiver,
                                         const Point& eye);

}  // namespace sightline::testing
