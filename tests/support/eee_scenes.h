// The seeded scenes on which the EEE skeleton is compared with its naive oracle.

#pragma once

#include <cstdint>

#include "tests/support/generators.h"

namespace sightline::testing {

/// 3 to 8 convex polyhedra in general position, dense, by seed: polytopes of 4 to 8 and
/// of 6 to 10 vertices, parallelepipeds, and slim and flat ones of very different size.
inline PolygonSoup eee_scene(std::uint64_t seed) {
  const int count = 3 + static_cast<int>(seed % 6);
  switch (seed / 6 % 4) {
    case 0:
      return random_polytopes(seed, count, {.max_vertices = 8, .density = 0.3});
    case 1:
      return random_parallelepipeds(seed, count, {.density = 0.25});
    case 2:
      return random_polytopes(seed, count,
                              {.min_vertices = 6, .max_vertices = 10, .density = 0.25});
    default:
      return random_polytopes(seed, count,
                              {.min_vertices = 4,
                               .max_vertices = 6,
                               .min_radius = 0.2,
                               .max_radius = 2,
                               .density = 0.3});
  }
}

}  // namespace sightline::testing
