// Meshes of lit scenes against what points of the receivers see.

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/shadows/mesh_walk.h"
#include "tests/support/shadow_scenes.h"

namespace sightline::testing {
namespace {

TEST(ShadowMeshOracle, ViewsChangeWhereTheMeshSaysSo) {
  const char* only = std::getenv("SIGHTLINE_SCENE");
  const int stride = only != nullptr ? 1 : 4;
  int stretches = 0, number = 0;
  for (const ShadowScene& lit : shadow_scenes()) {
    if (number++ % stride != 0) continue;
    if (only != nullptr && std::string(only) != "all" && lit.name != only) continue;
    const Scene scene(lit.soup);
    const LightSource source = light_source(scene, lit.lights, lit.two_sided);
    const BackprojectionIndex light(scene, source);
    for (const Object& object : scene.objects()) {
      SCOPED_TRACE(lit.name + ", " + object.name);
      Shadows shadows;
      try {
        shadows = find_shadows(scene, source, {{object.name, object.faces, true}});
      } catch (const std::exception& error) {
        ADD_FAILURE() << error.what();
        continue;
      }
      const ReceiverShadows& r = shadows.receivers.at(0);
      EXPECT_NEAR(r.umbra_area + r.penumbra_area + r.lit_area, r.area, 1e-12 * r.area);
      for (const ShadowMesh& mesh : r.meshes) {
        // Doubles cannot be told to lie on this or that triangle of a bent facet.
        if (!scene.facets()[mesh.facet].planar) continue;
        const MeshWalk walk = walk_mesh(scene, light, shadows, mesh, true, 1, 4, 2);
        stretches += walk.stretches;
        for (const std::string& difference : walk.differences)
          ADD_FAILURE() << difference;
      }
    }
  }
  EXPECT_GT(stretches, 100);
}

}  // namespace
}  // namespace sightline::testing
