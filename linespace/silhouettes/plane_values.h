// A plane's values at the two ends of an edge, as bounds and as exact signs.

#pragma once

#include "linespace/silhouettes/silhouettes.h"

namespace sightline::internal {

struct PlaneValues {
  BoundedValue at0, at1;
  Sign sign0, sign1;

  /// The plane meets the edge's line in an end.
  [[nodiscard]] bool zero_at_end() const {
    return sign0 == Sign::Zero || sign1 == Sign::Zero;
  }
};

[[nodiscard]] inline PlaneValues plane_values(const PlaneSide& plane, const Point& p0,
                                              const Point& p1) {
  PlaneValues v{plane.value(p0), plane.value(p1), {}, {}};
  v.sign0 = sign_of(v.at0, plane, p0);
  v.sign1 = sign_of(v.at1, plane, p1);
  return v;
}

}  // namespace sightline::internal
