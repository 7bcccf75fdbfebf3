// Walks along segments on a receiver: the view of the light must change where the mesh
// says so, and nowhere else.

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "shadows/backprojection.h"
#include "shadows/shadow_mesh.h"

namespace sightline::testing {

struct MeshWalk {
  int stretches = 0, crossings = 0;
  std::vector<std::string> differences;  ///< messages
};

/// `count` segments between random points of the facet's box; `samples` points of each
/// stretch between two edges are asked.
[[nodiscard]] MeshWalk walk_mesh(const Scene& scene, const BackprojectionIndex& light,
                                 const Shadows& shadows, const ShadowMesh& mesh,
                                 bool front, std::uint64_t seed, int count, int samples);

}  // namespace sightline::testing
