// Meshes beside the naive oracle, in full.  From the environment:
// SIGHTLINE_MESH_SEGMENTS, on each facet (default 5; the proof asks for 1,000);
// SIGHTLINE_MESH_POINTS, of each face and edge (20); SIGHTLINE_MESH_SEED;
// SIGHTLINE_SCENE, a single scene of shadow_scenes.h.

#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "tests/shadows/mesh_proof/mesh_areas.h"
#include "tests/shadows/mesh_proof/mesh_orders.h"
#include "tests/shadows/mesh_proof/mesh_structures.h"
#include "tests/shadows/mesh_proof/small_lit_scenes.h"

namespace sightline::testing {
namespace {

int setting(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atoi(text);
}

TEST(MeshProofSoak, Structures) {
  const char* only = std::getenv("SIGHTLINE_SCENE");
  MeshSampleCounts sum;
  for (const ShadowScene& lit : shadow_scenes()) {
    if (only != nullptr && lit.name != only) continue;
    MeshStructures meshes(lit);
    MeshSamples samples{.points = setting("SIGHTLINE_MESH_POINTS", 20),
                        .segments = setting("SIGHTLINE_MESH_SEGMENTS", 5)};
    samples.no_edges_at_horizon = edges_at_horizon_differ(lit);
    for (const std::string& difference :
         meshes.differences(samples, setting("SIGHTLINE_MESH_SEED", 1)))
      ADD_FAILURE() << difference;
    sum += meshes.counts();
    std::cout << lit.name << ": " << meshes.counts() << std::endl;
  }
  std::cout << sum << '\n';
}

TEST(MeshProofSoak, Areas) {
  for (const ShadowScene& lit : small_lit_scenes()) {
    const GroundAreas areas = ground_areas(lit);
    std::cout << lit.name << ": " << areas.right.scan_lines << " scan lines, "
              << areas.right.asked << " points, off by " << areas.off << '\n';
    EXPECT_LT(areas.off, 1e-9) << lit.name;
  }
}

TEST(MeshProofSoak, Orders) {
  EdgeOrders sum;
  int number = 0;
  for (const ShadowScene& lit : small_lit_scenes()) {
    if (number++ % 3 == 2) continue;  // aligned
    const EdgeOrders orders = edge_orders(lit, 80, 20, 1);
    for (const std::string& difference : orders.differences) ADD_FAILURE() << difference;
    sum += orders;
  }
  std::cout << sum << '\n';
  EXPECT_GE(sum.edges, 1000);
}

}  // namespace
}  // namespace sightline::testing
