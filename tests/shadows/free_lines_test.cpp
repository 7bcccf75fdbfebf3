// Form factors by a second way, on scenes that take little time; all of them and more are
// in free_lines_soak_test.cpp.

#include "tests/shadows/free_lines_comparison.h"
#include "tests/support/add_polygons.h"

namespace sightline {
namespace {

using Polygon = std::vector<Point>;

Polygon square(double low, double high, double z, bool up) {
  Polygon p{{low, low, z}, {high, low, z}, {high, high, z}, {low, high, z}};
  if (!up) std::ranges::reverse(p);
  return p;
}

// REFERENCES: the second way itself.
TEST(FreeLines, ReferenceValues) {
  const Polygon floor = square(0, 1, 0, true), ceiling = square(0, 1, 1, false);
  const Polygon wall{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}};
  const auto value = [&](const Polygon& to, std::vector<testing::FreeBlocker> blockers) {
    return testing::free_lines(floor, to, blockers, 1e-12).exchange;
  };
  EXPECT_NEAR(value(ceiling, {}), 0.199824895698387, 1e-13);
  EXPECT_NEAR(value(wall, {}), 0.200043776075403, 1e-13);
  EXPECT_NEAR(value(ceiling, {{square(0.25, 0.75, 0.25, true)}}), 0.115620602132415,
              1e-12);
  EXPECT_NEAR(value(ceiling, {{square(0.25, 0.75, 0.5, true)}}), 0.099506294598985,
              1e-12);
}

TEST(FreeLines, AgreeWithFormFactors) {
  const std::vector<testing::FormFactorScene> scenes = testing::form_factor_scenes();
  ASSERT_GE(scenes.size(), 40u);
  for (std::size_t k = 0; k < scenes.size(); k += 9) {
    testing::expect_two_ways_agree(scenes[k], 1, 1e-7);
  }
}

/// All faces as surfaces: rows add up to 1, within the accuracy asked for.
void expect_whole_rows(const PolygonSoup& soup) {
  const Scene scene(soup);
  FormFactorRequest request;
  request.threads = 1;
  const FormFactors f = form_factors(
      scene, surfaces_of(scene, {.groups = {}, .both_sides = {}, .each_face = true}),
      request);
  EXPECT_LE(f.error_bound, request.accuracy);
  for (std::size_t i = 0; i < f.rows.size(); ++i) {
    const FormFactorRow& row = f.rows[i];
    EXPECT_NEAR(f.row_sum(static_cast<int>(i)) + row.others + row.outside + row.backs, 1,
                1e-9)
        << f.names[i];
  }
}

// A fin that touches a wall along the line in which the target cuts the wall.  The side
// on which the target is seen was told from a point in the target's own plane, so that
// now and then the whole side was lost: 0.003 for 0.0087.
TEST(FreeLines, TargetCutByASurfaceItTouches) {
  PolygonSoup soup;
  testing::add_polygons(soup, "ceiling", {square(0, 1, 1, false)});
  testing::add_polygons(soup, "wall", {{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}});
  testing::add_polygons(soup, "fin", {{{0, 0, 0}, {0.25, 0.25, 0.5}, {0, 0.5, 0.5}}});
  testing::add_polygons(
      soup, "stop",
      {{{0.25, 0, 0}, {0.25, 0.625, 0}, {0.25, 0.625, 0.5}, {0.25, 0, 0.5}}});
  expect_whole_rows(soup);
}

// The planes of sender, target and blocker share a line.  Rounding left a strip of no
// width of the blocker between the other two, which hid a third of what is exchanged.
TEST(FreeLines, ThreePlanesThroughOneLine) {
  PolygonSoup soup;
  testing::add_polygons(soup, "floor", {square(0, 1, 0, true)});
  testing::add_polygons(
      soup, "leaning",
      {{{0.5, 0, -0.25}, {0.5, 1, -0.25}, {0.25, 1, 0.75}, {0.25, 0, 0.75}}});
  testing::add_polygons(soup, "upright",
                        {{{0.4375, 0.25, -0.5},
                          {0.4375, 0.5, -0.5},
                          {0.4375, 0.5, 0.5},
                          {0.4375, 0.25, 0.5}}});
  expect_whole_rows(soup);
}

}  // namespace
}  // namespace sightline
