#include "linespace/silhouettes/ridge_sides.h"

#include <algorithm>
#include <cmath>

#include "linespace/silhouettes/silhouettes.h"
#include "linespace/space/shaft.h"

namespace sightline::internal {

// With n off by `slack` and d = p - origin rounded once in each coordinate, n . d is off
// by at most (max slack + 5 u max |n|) |d|_1, in first order; |d|_1 itself rounds by a
// few u.
RidgeSides::RidgeSides(const Scene& scene, const Ridge& r)
    : origin_(scene.point(r.points[0])), touched_on_(touched_on(r)) {
  for (int k = 0; k < 2; ++k) {
    // Oriented as the ridge's planes: a through the second point and the first, b through
    // the first and the second.
    const Point& other = scene.point(r.points[1]);
    const BoundedPlane plane = plane_from(origin_, other, scene.point(r.thirds[k]));
    const double sign = k == 0 ? -1 : 1;
    double largest = 0;
    double slack = 0;
    for (int i = 0; i < 3; ++i) {
      normals_[k][i] = sign * plane.normal[i];
      largest = std::max(largest, std::abs(plane.normal[i]));
      slack = std::max(slack, plane.slack[i]);
    }
    slack_[k] = (1 + 16 * kUnit) * (slack + 16 * kUnit * largest);
  }
}

}  // namespace sightline::internal
