// Meshes beside the naive oracle: what points of faces and beside edges see, and where
// that changes along segments.  mesh_proof_soak looks at all faces and edges.

#include "tests/shadows/mesh_proof/mesh_structures.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

namespace sightline::testing {
namespace {

// SIGHTLINE_SCENE: names of scenes, anything between them.
bool wanted(const std::string& name) {
  const char* only = std::getenv("SIGHTLINE_SCENE");
  return only == nullptr || std::string(only).find(name) != std::string::npos;
}

TEST(MeshStructures, FacesAndEdgesSeeWhatTheMeshSays) {
  MeshSampleCounts sum;
  for (const ShadowScene& lit : shadow_scenes()) {
    if (!wanted(lit.name)) continue;
    MeshStructures meshes(lit);
    MeshSamples samples{.faces = 3, .edges = 3, .points = 3, .segments = 0};
    samples.no_edges_at_horizon = edges_at_horizon_differ(lit);
    for (const std::string& difference : meshes.differences(samples, 1))
      ADD_FAILURE() << difference;
    sum += meshes.counts();
  }
  std::cout << sum << '\n';
}

TEST(MeshStructures, ViewsChangeWhereSegmentsCrossEdges) {
  MeshSampleCounts sum;
  int number = 0;
  for (const ShadowScene& lit : shadow_scenes()) {
    if (!wanted(lit.name) || number++ % 8 != 0) continue;
    MeshStructures meshes(lit);
    MeshSamples samples{.faces = 0, .edges = 0, .points = 0, .segments = 1};
    samples.no_edges_at_horizon = edges_at_horizon_differ(lit);
    for (const std::string& difference : meshes.differences(samples, 2))
      ADD_FAILURE() << difference;
    sum += meshes.counts();
  }
  std::cout << sum << '\n';
}

}  // namespace
}  // namespace sightline::testing
