// Seeded scenes of one convex source and one convex solid, general, aligned and touching,
// and points on which ShadowVolumes is held against two other ways.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "linespace/scene.h"
#include "shadows/shadow_volumes.h"

namespace sightline::testing {

/// Groups "lamp" and "solid", which may be a sheet; "far", two triangles that make the
/// box of the scene larger.  Of odd seeds coordinates are small integers: the two often
/// touch, share planes or cross.
[[nodiscard]] PolygonSoup volume_scene(std::uint64_t seed);

struct VolumeCounts {
  int scenes = 0, refused = 0;
  int points = 0, umbra = 0, penumbra = 0, lit = 0;
};

/// Asks `count` points of the seed's scene: random ones, and ones on the volumes'
/// corners, edges and sides and on the solid.  What differs, as a message.
[[nodiscard]] std::optional<std::string> volume_difference(std::uint64_t seed, int count,
                                                           VolumeCounts& counts);

}  // namespace sightline::testing
