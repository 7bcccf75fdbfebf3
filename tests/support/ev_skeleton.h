// The EV part of a skeleton alone.

#pragma once

#include "skeleton/build.h"

namespace sightline::testing {

[[nodiscard]] inline Skeleton build_ev_skeleton(const Scene& scene,
                                                SkeletonRequest request = {}) {
  request.ev = true;
  request.eee = request.ff = false;
  return build_skeleton(scene, request);
}

}  // namespace sightline::testing
