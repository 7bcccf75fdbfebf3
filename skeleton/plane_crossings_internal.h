// Points of a plane at which the contacts of its lines can change although no edge
// crosses the plane there: where sides of faces that lie in it cross.

#pragma once

#include <span>
#include <vector>

#include "linespace/contact_internal.h"
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

}  // namespace sightline::internal
