// Scenes of a "ground" under one or two lights with a few blockers: small enough for all
// planes and quadrics of their corners and edges to be tried on each scan line.

#pragma once

#include <vector>

#include "tests/support/shadow_scenes.h"

namespace sightline::testing {

/// 24 scenes.  In every third all coordinates are small integers and all sides parallel
/// to the axes, the others are in general position.  Lights: a square, a tilted triangle,
/// a square and a triangle.  Blockers, up to three: sheets in mid air, sheets that stand
/// on the ground, boxes on the ground, tetrahedra, two sheets that cross.
[[nodiscard]] std::vector<ShadowScene> small_lit_scenes();

}  // namespace sightline::testing
