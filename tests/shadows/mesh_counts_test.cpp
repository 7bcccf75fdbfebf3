// Counts of edges by kind in scenes that people know: the small ones of the table in
// docs/shadows.md.

#include <gtest/gtest.h>

#include "linespace/mesh_io.h"
#include "shadows/shadow_mesh.h"

namespace sightline {
namespace {

struct Counts {
  std::size_t faces = 0, structures = 0;
  std::array<int, kShadowEdgeKinds> kinds{};
};

Counts counts_of(const std::string& file, const std::string& light) {
  const Scene scene(read_mesh(file));
  const std::vector<std::string> lights{light};
  std::vector<Receiver> receivers;
  for (const Object& o : scene.objects()) {
    if (o.name != light) receivers.push_back({o.name, o.faces, true});
  }
  const Shadows shadows = find_shadows(scene, light_source(scene, lights), receivers);
  Counts result;
  result.structures = shadows.structures.size();
  for (const ReceiverShadows& r : shadows.receivers) {
    EXPECT_NEAR(r.umbra_area + r.penumbra_area + r.lit_area, r.area, 1e-12 * r.area);
    for (const ShadowMesh& mesh : r.meshes) {
      result.faces += mesh.faces.size();
      for (const auto& e : mesh.edges) ++result.kinds[static_cast<int>(e.kind)];
    }
  }
  return result;
}

using Kinds = std::array<int, kShadowEdgeKinds>;

TEST(MeshCounts, CornellBox) {
  const Counts c = counts_of(SIGHTLINE_EXAMPLES "/scenes/cornell.obj", "light");
  EXPECT_EQ(c.faces, 366u);
  EXPECT_EQ(c.structures, 276u);
  EXPECT_EQ(c.kinds, (Kinds{232, 30, 130, 42, 14, 400, 2}));
}

TEST(MeshCounts, TableUnderACeilingLight) {
  const Counts c = counts_of(SIGHTLINE_TEST_DATA "/shadows/table.obj", "lamp");
  EXPECT_EQ(c.faces, 56u);
  EXPECT_EQ(c.structures, 10u);
  EXPECT_EQ(c.kinds, (Kinds{156, 32, 0, 0, 24, 0, 0}));
}

}  // namespace
}  // namespace sightline
