// Points of a plane at which the contacts of its lines can change although no edge
// crosses the plane there: where sides of faces that lie in it cross.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "linespace/contacts/contact.h"
#include "linespace/numbers/rational.h"
#include "linespace/predicates.h"
#include "linespace/scene.h"

namespace sightline::internal {

/// A corner of these faces off the plane; -1 where there is none.
[[nodiscard]] int corner_off(const Scene& scene, std::span<const int> faces,
                             const PlaneSide& plane);

/// The points strictly inside two sides that cross in the plane.  `off_plane` is a scene
/// point off it.  Cost: quadratic in the number of sides in the plane.
[[nodiscard]] std::vector<ExactPoint> plane_crossings(const Scene& scene,
                                                      std::span<const int> faces,
                                                      const PlaneSide& plane,
                                                      int off_plane);

/// Where the line through `eye` and x meets the segment from e0 (0) to e1 (1) strictly
/// inside, all in one plane that `off_plane` is not in; nullopt where it does not.
[[nodiscard]] std::optional<Rational> parameter_towards(const ExactPoint& eye,
                                                        const ExactPoint& x,
                                                        const ExactPoint& off_plane,
                                                        const ExactPoint& e0,
                                                        const ExactPoint& e1);

/// Where two of three edges are coplanar, the lines that meet all are a pencil of their
/// plane, through the point in which the third edge crosses it: the parameters on the
/// first edge of the lines to corners in the plane and to crossings of sides.  Empty
/// where no two are.  The first edge must be one of the two.
[[nodiscard]] std::vector<Rational> pencil_stops(
    const Scene& scene, const std::array<std::array<std::int32_t, 2>, 3>& edges,
    std::span<const int> faces);

}  // namespace sightline::internal
