// The areas on the ground of a small scene beside naive ones.

#pragma once

#include "tests/shadows/mesh_proof/naive_shadow_areas.h"
#include "tests/support/shadow_scenes.h"

namespace sightline::testing {

struct GroundAreas {
  NaiveShadowAreas right;
  double off;  ///< the largest difference of the three areas, a share of the ground
};
/// Of the first object of one face.
[[nodiscard]] GroundAreas ground_areas(const ShadowScene& lit);

}  // namespace sightline::testing
