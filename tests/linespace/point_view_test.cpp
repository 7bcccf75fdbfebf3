// The exact view from a point, on small scenes told by hand.

#include "linespace/point_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "tests/support/generators.h"

namespace sightline {
namespace {

int count(const PointView& view, MapVertexKind kind) {
  return static_cast<int>(std::ranges::count(view.vertices, kind, &MapVertex::kind));
}

int count(const PointView& view, MapEdgeKind kind) {
  return static_cast<int>(std::ranges::count(view.edges, kind, &MapEdge::kind));
}

// V - E + F = 1 + C.
void expect_euler(const PointView& view) {
  EXPECT_EQ(static_cast<int>(view.vertices.size()) - static_cast<int>(view.edges.size()) +
                static_cast<int>(view.regions.size()),
            1 + view.components);
}

TEST(PointView, CubeFromACorner) {
  const Scene scene(testing::boxes_soup({{{0, 0, 0}, {1, 1, 1}}}));
  const PointViewIndex index(scene);
  for (const Viewpoint& eye : {eye_far_along({1, 2, 3}), eye_at({2, 3, 4})}) {
    const PointView view = index.view(eye);
    EXPECT_EQ(view.vertices.size(), 7U);
    EXPECT_EQ(view.edges.size(), 9U);
    EXPECT_EQ(view.regions.size(), 4U);
    EXPECT_EQ(view.components, 1);
    EXPECT_EQ(view.background_pieces, 1);
    EXPECT_EQ(count(view, MapVertexKind::Corner), 7);
    EXPECT_EQ(count(view, MapEdgeKind::Silhouette), 6);
    EXPECT_EQ(count(view, MapEdgeKind::Crease), 3);
    EXPECT_EQ(view.facets.size(), 3U);
    EXPECT_TRUE(view.general);
    expect_euler(view);
  }
}

TEST(PointView, AreasOfACube) {
  const Scene scene(testing::boxes_soup({{{0, 0, 0}, {1, 1, 1}}}));
  const PointView view = PointViewIndex(scene).view(eye_far_along({1, 2, 3}));
  double sum = 0;
  for (const SeenFacet& f : view.facets) sum += f.measure;
  EXPECT_NEAR(sum, 6 / std::sqrt(14.0), 1e-15);
}

TEST(PointView, BoxBeforeAnother) {
  const Scene scene(
      testing::boxes_soup({{{0, 0, 0}, {1, 1, 1}}, {{-0.5, -3, 0.25}, {0.5, -2, 0.75}}}));
  const PointView view = PointViewIndex(scene).view(eye_at({0.1, -10, 0.4}));
  EXPECT_EQ(count(view, MapVertexKind::T), 2);
  expect_euler(view);
  double sum = 0;
  for (const MapRegion& r : view.regions) sum += *r.measure;
  EXPECT_NEAR(sum, 4 * std::numbers::pi, 1e-12);
}

TEST(PointView, BoxInARoom) {
  PolygonSoup soup =
      testing::boxes_soup({{{0, 0, 0}, {8, 8, 4}}, {{3, 3, 1}, {4, 4, 2}}});
  for (int i = 0; i < 6; ++i) std::ranges::reverse(soup.polygons[i]);
  const Scene scene(soup);
  const PointView view = PointViewIndex(scene).view(eye_at({1, 1.5, 3.25}));
  EXPECT_EQ(view.background_pieces, 0);
  EXPECT_EQ(view.components, 1);
  expect_euler(view);
  double sum = 0;
  for (const SeenFacet& f : view.facets) sum += f.measure;
  EXPECT_NEAR(sum, 4 * std::numbers::pi, 1e-12);
}

}  // namespace
}  // namespace sightline
