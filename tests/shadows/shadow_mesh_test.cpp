#include "shadows/shadow_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "shadows/backprojection.h"
#include "tests/support/add_box.h"
#include "tests/support/add_polygons.h"

namespace sightline {
namespace {

using testing::add_box;
using testing::add_polygons;
using testing::lamp_and_ground;

Shadows shadows_of(const PolygonSoup& soup, const char* receiver = "ground") {
  const Scene scene(soup);
  const std::vector<std::string> light{"lamp"};
  return find_shadows(scene, light_source(scene, light),
                      {{receiver, scene.faces_named(receiver), true}});
}

std::array<int, kShadowEdgeKinds> kinds(const ShadowMesh& mesh) {
  std::array<int, kShadowEdgeKinds> counts{};
  for (const ShadowMesh::Edge& e : mesh.edges) ++counts[static_cast<int>(e.kind)];
  return counts;
}

TEST(ShadowMesh, NothingBetween) {
  const Shadows shadows = shadows_of(lamp_and_ground());
  const ReceiverShadows& ground = shadows.receivers.at(0);
  EXPECT_EQ(ground.lit_area, 256);
  EXPECT_EQ(ground.umbra_area, 0);
  ASSERT_EQ(ground.meshes.size(), 1u);
  EXPECT_EQ(ground.meshes[0].faces.size(), 1u);
  EXPECT_EQ(ground.meshes[0].edges.size(), 4u);
}

TEST(ShadowMesh, SquareOverASquare) {
  // The plate of side 2 at height 2: umbra is the point below the middle, its side s
  // shrinks by 2 - s; with side 3 the umbra has the side 4, the penumbra's outline the
  // side 8.
  PolygonSoup soup = lamp_and_ground();
  add_polygons(soup, "plate",
               {{{-1.5, -1.5, 2}, {1.5, -1.5, 2}, {1.5, 1.5, 2}, {-1.5, 1.5, 2}}});
  const Shadows shadows = shadows_of(soup);
  const ReceiverShadows& ground = shadows.receivers.at(0);
  EXPECT_NEAR(ground.umbra_area, 16, 1e-12);
  EXPECT_NEAR(ground.lit_area, 256 - 64, 1e-12);
  EXPECT_NEAR(ground.penumbra_area, 48, 1e-12);
  EXPECT_EQ(ground.umbra_components, 1);
  EXPECT_EQ(ground.away_area, 0);
  // Nine parts of the penumbra's square and the lit part around it; the sides' traces go
  // on straight through the crossings: as edges 4 times 5 pieces and 4 sides of the
  // ground.
  const ShadowMesh& mesh = ground.meshes.at(0);
  for (const auto& f : mesh.faces) {
    std::cout << static_cast<int>(f.shadow) << ' ' << f.structure << ' ' << f.area
              << '\n';
  }
  const auto k = kinds(mesh);
  for (const int n : k) std::cout << n << ' ';
  std::cout << '\n';
}

TEST(ShadowMesh, EveryFaceSeesTheLightAsItsStructureSays) {
  PolygonSoup soup = lamp_and_ground();
  add_box(soup, "box", {-2, -0.5, 0}, {-1, 1, 1.5});
  add_polygons(soup, "sheet", {{{0.5, -1, 2}, {1, 0.5, 2.5}, {2, -1, 3}}});
  const Shadows shadows = shadows_of(soup);
  const ReceiverShadows& ground = shadows.receivers.at(0);
  EXPECT_NEAR(ground.umbra_area + ground.penumbra_area + ground.lit_area, 256, 1e-10);
  const auto k = kinds(ground.meshes[0]);
  for (const int n : k) std::cout << n << ' ';
  std::cout << ground.meshes[0].faces.size() << " faces " << shadows.structures.size()
            << " structures\n";
}

}  // namespace
}  // namespace sightline
