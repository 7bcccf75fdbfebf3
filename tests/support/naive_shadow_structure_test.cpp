// The structure that the naive shadows tell, and where they find material, by hand.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/add_box.h"
#include "tests/support/add_polygons.h"
#include "tests/support/naive_material.h"
#include "tests/support/shadow_scenes.h"

namespace sightline::testing {
namespace {

Vec3 vec(double x, double y, double z) { return exact(Point(x, y, z)); }

/// Level, front below.
std::vector<Point> level(double x0, double y0, double x1, double y1, double z) {
  return {{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}};
}

std::vector<NaiveSeenSource> structure(const PolygonSoup& soup,
                                       const std::vector<std::string>& lights,
                                       const Vec3& p) {
  const Scene scene(soup);
  return naive_shadow(scene, {"", soup, lights, {}}).structure(p);
}

/// Ends of the edges of a boundary, one for each side.
std::vector<std::array<Vec3, 2>> edges(const std::vector<NaiveSide>& boundary) {
  std::vector<std::array<Vec3, 2>> result;
  for (const NaiveSide& side : boundary) {
    EXPECT_EQ(side.size(), 1u);
    EXPECT_EQ(side[0].kind, NaiveSideName::Kind::Edge);
    result.push_back(side[0].ends);
  }
  return result;
}

TEST(NaiveShadowStructure, SeenPartIsOnTheLeft) {
  PolygonSoup soup;
  add_polygons(soup, "light", {level(0, 0, 2, 2, 2)});
  const auto seen = structure(soup, {"light"}, vec(1, 5, 0));
  ASSERT_EQ(seen.size(), 1u);
  ASSERT_EQ(seen[0].boundaries.size(), 1u);
  // Counter-clockwise seen from the front, where the point is.
  auto corners = seen[0].corners[0];
  ASSERT_EQ(corners.size(), 4u);
  const auto first =
      std::ranges::find_if(corners, [](const auto& c) { return c.at == Point(0, 0, 2); });
  ASSERT_NE(first, corners.end());
  std::rotate(corners.begin(), first, corners.end());
  const auto expected = level(0, 0, 2, 2, 2);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(corners[i].at, expected[i]);
}

TEST(NaiveShadowStructure, PartsThatTouchInAPointAreTwo) {
  PolygonSoup soup;
  add_polygons(soup, "light", {level(-1, -1, 1, 1, 2)});
  add_polygons(soup, "plate", {level(-2, -2, 0, 0, 1)});
  add_polygons(soup, "other", {level(0, 0, 2, 2, 1)});
  const auto seen = structure(soup, {"light"}, vec(0, 0, 0));
  ASSERT_EQ(seen.size(), 1u);
  ASSERT_EQ(seen[0].boundaries.size(), 2u);
  for (const auto& boundary : seen[0].boundaries) EXPECT_EQ(boundary.size(), 4u);
}

TEST(NaiveShadowStructure, HolesAreBoundariesOfTheirOwn) {
  PolygonSoup soup;
  add_polygons(soup, "light", {level(-1, -1, 1, 1, 2)});
  // Of two pieces, one of them cut in two with a corner in the middle of a side.
  add_polygons(soup, "plate",
               {level(-0.25, -0.25, 0, 0.25, 1), level(0, -0.25, 0.25, 0.125, 1),
                level(0, 0.125, 0.25, 0.25, 1)});
  const auto seen = structure(soup, {"light"}, vec(0, 0, 0));
  ASSERT_EQ(seen.size(), 1u);
  ASSERT_EQ(seen[0].boundaries.size(), 2u);
  auto hole = edges(seen[0].boundaries[0]);
  if (hole[0][0][2] == 2) hole = edges(seen[0].boundaries[1]);
  std::ranges::sort(hole);
  const std::vector<std::array<Vec3, 2>> expected{
      {vec(-0.25, -0.25, 1), vec(-0.25, 0.25, 1)},
      {vec(-0.25, -0.25, 1), vec(0.25, -0.25, 1)},
      {vec(-0.25, 0.25, 1), vec(0.25, 0.25, 1)},
      {vec(0.25, -0.25, 1), vec(0.25, 0.25, 1)}};
  EXPECT_EQ(hole, expected);
}

TEST(NaiveShadowStructure, CeilingAndJointsAreNoSides) {
  PolygonSoup soup;
  add_polygons(soup, "ceiling",
               {level(0, 0, 1, 1, 2), level(1, 0, 2, 1, 2), level(2, 0, 3, 1, 2)});
  const auto seen = structure(soup, {"#1-2"}, vec(0, 0, 0));
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_EQ(seen[0].polygons, (std::vector<int>{1, 2}));
  ASSERT_EQ(seen[0].boundaries.size(), 1u);
  auto sides = edges(seen[0].boundaries[0]);
  std::ranges::sort(sides);
  // Two sides go on straight along the rest of the ceiling, and are one edge with that.
  const std::vector<std::array<Vec3, 2>> expected{{vec(0, 0, 2), vec(3, 0, 2)},
                                                  {vec(0, 1, 2), vec(3, 1, 2)},
                                                  {vec(1, 0, 2), vec(1, 1, 2)},
                                                  {vec(3, 0, 2), vec(3, 1, 2)}};
  EXPECT_EQ(sides, expected);
}

TEST(NaiveShadowStructure, EdgesEndWhereJointsBegin) {
  PolygonSoup soup;
  add_polygons(soup, "light", {level(-9, -9, 9, 9, 2)});
  // An L of three squares.
  add_polygons(soup, "plate",
               {level(0, 0, 1, 1, 1), level(1, 0, 2, 1, 1), level(0, 1, 1, 2, 1)});
  const auto seen = structure(soup, {"light"}, vec(0, 0, 0));
  ASSERT_EQ(seen.size(), 1u);
  ASSERT_EQ(seen[0].boundaries.size(), 2u);
  auto hole = edges(seen[0].boundaries[0]);
  if (hole[0][0][2] == 2) hole = edges(seen[0].boundaries[1]);
  std::ranges::sort(hole);
  const std::vector<std::array<Vec3, 2>> expected{
      {vec(0, 0, 1), vec(0, 2, 1)}, {vec(0, 0, 1), vec(2, 0, 1)},
      {vec(0, 2, 1), vec(1, 2, 1)}, {vec(1, 1, 1), vec(1, 2, 1)},
      {vec(1, 1, 1), vec(2, 1, 1)}, {vec(2, 0, 1), vec(2, 1, 1)}};
  EXPECT_EQ(hole, expected);
}

TEST(NaiveShadowStructure, CutsAndHorizon) {
  PolygonSoup soup;
  add_polygons(soup, "light", {level(-1, -1, 1, 1, 2)});
  add_polygons(soup, "wall", {{{0.5, -3, 0}, {0.5, 3, 0}, {0.5, 3, 4}, {0.5, -3, 4}}});
  const Scene scene(soup);
  const auto seen = naive_shadow(scene, {"", soup, {"light"}, {}})
                        .structure(vec(0, 0, 0), vec(1, 0, 0));
  ASSERT_EQ(seen.size(), 1u);
  ASSERT_EQ(seen[0].boundaries.size(), 1u);
  std::vector<NaiveSideName::Kind> kinds;
  for (const NaiveSide& side : seen[0].boundaries[0]) {
    ASSERT_EQ(side.size(), 1u);
    kinds.push_back(side[0].kind);
  }
  using enum NaiveSideName::Kind;
  EXPECT_EQ(std::ranges::count(kinds, Edge), 2);
  EXPECT_EQ(std::ranges::count(kinds, Cut), 1);
  EXPECT_EQ(std::ranges::count(kinds, Horizon), 1);
}

std::vector<Body> bodies(const PolygonSoup& soup) {
  auto result = bodies_of(naive_shadow_faces(Scene(soup), {}));
  for (Body& body : result) std::ranges::sort(body);
  return result;
}

/// Fronts inside.
void add_room(PolygonSoup& soup, const char* name, const Point& low, const Point& high) {
  const std::size_t first = soup.polygons.size();
  add_box(soup, name, low, high);
  for (std::size_t f = first; f < soup.polygons.size(); ++f) {
    std::ranges::reverse(soup.polygons[f]);
  }
}

/// All faces become one group.
void unite(PolygonSoup& soup) {
  PolygonSoup::Group all{.name = "all", .faces = {}};
  for (int f = 0; f < static_cast<int>(soup.polygons.size()); ++f) all.faces.push_back(f);
  soup.groups = {all};
}

TEST(NaiveMaterial, RoomsCavitiesAndHollows) {
  const Body six{0, 1, 2, 3, 4, 5}, twelve{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  PolygonSoup room;
  add_room(room, "room", {0, 0, 0}, {8, 8, 8});
  EXPECT_TRUE(bodies(room).empty());

  PolygonSoup furnished;
  add_box(furnished, "box", {1, 1, 0}, {2, 2, 1});
  add_room(furnished, "room", {0, 0, 0}, {8, 8, 8});
  EXPECT_EQ(bodies(furnished), std::vector<Body>{six});
  unite(furnished);
  EXPECT_EQ(bodies(furnished), std::vector<Body>{six});

  PolygonSoup house;
  add_box(house, "house", {-1, -1, -1}, {9, 9, 9});
  add_room(house, "room", {0, 0, 0}, {8, 8, 8});
  EXPECT_EQ(bodies(house), std::vector<Body>{twelve});
  unite(house);
  EXPECT_EQ(bodies(house), std::vector<Body>{twelve});

  // Open boxes bound nothing.
  PolygonSoup open;
  add_box(open, "box", {0, 0, 0}, {1, 1, 1});
  open.polygons.pop_back();
  open.groups[0].faces.pop_back();
  EXPECT_TRUE(bodies(open).empty());
}

}  // namespace
}  // namespace sightline::testing
