// Scenes and eyes on which the exact view from a point is compared with the naive one.

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "linespace/scene.h"
#include "tests/support/naive_view.h"

namespace sightline::testing {

struct ViewScene {
  std::string name;
  PolygonSoup soup;
};

/// 107 scenes of 10 to 100 faces, the same on every machine: polytopes in general
/// position, boxes on integer grids, touching and flush ones, rooms with furniture,
/// sheets that cross, frames, cuts into triangles, facets that coincide.
[[nodiscard]] std::vector<ViewScene> view_scenes();

/// A few scenes of 200 to 300 faces, where the library leaves out what others cover.
[[nodiscard]] std::vector<ViewScene> large_view_scenes();

/// `count` eyes and directions: a third anywhere, as doubles, small integers or
/// fractions; a third in planes of faces and on lines of edges; a third on facets, edges
/// and corners (directions: along edges, in faces, across faces).  Some are 2^-60 beside
/// that, some 2^40 scene sizes away.
[[nodiscard]] std::vector<NaiveEye> view_eyes(const Scene& scene, std::uint64_t seed,
                                              int count);

/// The same in planes, on lines and on the scene, but off by multiples of 2^-40 to 2^-80.
[[nodiscard]] std::vector<NaiveEye> eyes_barely_off(const Scene& scene,
                                                    std::uint64_t seed, int count);

}  // namespace sightline::testing
