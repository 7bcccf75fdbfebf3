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

/// How many edges of each kind.
struct Kinds {
  int boundary = 0, contact = 0, plane = 0, face = 0, ee = 0, ev = 0, eee = 0;
  [[nodiscard]] std::array<int, kShadowEdgeKinds> counts() const {
    return {boundary, contact, plane, face, ee, ev, eee};
  }
};

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
  // A grid of three by three squares, the umbra in its middle, and the lit part around
  // it: 24 sides, along each of which two edges of one plane line up.
  const ShadowMesh& mesh = ground.meshes.at(0);
  EXPECT_EQ(mesh.faces.size(), 10u);
  EXPECT_EQ(shadows.structures.size(), 10u);
  EXPECT_EQ(kinds(mesh), (Kinds{.boundary = 4, .ee = 24}.counts()));
}

TEST(ShadowMesh, EveryFaceSeesTheLightAsItsStructureSays) {
  PolygonSoup soup = lamp_and_ground();
  add_box(soup, "box", {-2, -0.5, 0}, {-1, 1, 1.5});
  add_polygons(soup, "sheet", {{{0.5, -1, 2}, {1, 0.5, 2.5}, {2, -1, 3}}});
  const Shadows shadows = shadows_of(soup);
  const ReceiverShadows& ground = shadows.receivers.at(0);
  EXPECT_NEAR(ground.umbra_area + ground.penumbra_area + ground.lit_area, 256, 1e-10);
  EXPECT_EQ(ground.meshes[0].faces.size(), 38u);
  EXPECT_EQ(shadows.structures.size(), 37u);
  const Kinds expected{.boundary = 9, .contact = 4, .face = 4, .ee = 27, .ev = 43};
  EXPECT_EQ(kinds(ground.meshes[0]), expected.counts());
}

// The lamp's corner is a hair too high: two triangles, but no edge of the mesh comes from
// the diagonal.
TEST(ShadowMesh, BentLamp) {
  const auto mesh_with = [](double bend) {
    PolygonSoup soup;
    add_polygons(soup, "lamp",
                 {{{-1, -1, 4}, {-1, 1, 4}, {1, 1.25, 4}, {1.5, -1, 4 + bend}}});
    add_polygons(soup, "ground", {{{-8, -8, 0}, {8, -8, 0}, {8, 8, 0}, {-8, 8, 0}}});
    add_polygons(soup, "sheet", {{{0.5, -1, 2}, {1, 0.5, 2.5}, {2, -1, 3}}});
    add_polygons(soup, "post", {{{-1, 0.5, 0.25}, {-0.5, 1, 0.5}, {-1.25, 0.25, 2}}});
    return shadows_of(soup).receivers.at(0).meshes.at(0);
  };
  const ShadowMesh plane = mesh_with(0), bent = mesh_with(0x1p-45);
  EXPECT_EQ(bent.faces.size(), plane.faces.size());
  EXPECT_EQ(kinds(bent), kinds(plane));
}

}  // namespace
}  // namespace sightline
