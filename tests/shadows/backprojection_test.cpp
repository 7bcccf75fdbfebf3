#include "shadows/backprojection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "linespace/visibility_map.h"
#include "shadows/point_form_factor.h"
#include "tests/support/add_box.h"
#include "tests/support/add_polygons.h"

namespace sightline {
namespace {

using testing::add_box;
using testing::add_polygons;

// A square of side 2 that shines down.
const std::vector<Point> kLamp{{-1, -1, 4}, {-1, 1, 4}, {1, 1, 4}, {1, -1, 4}};

struct Lit {
  explicit Lit(PolygonSoup soup, const std::vector<std::string>& light = {"lamp"})
      : scene(std::move(soup)), index(scene, light_source(scene, light)) {}
  [[nodiscard]] Backprojection at(const Point& p) const {
    return index.from(shadow_point(p, {0, 0, 1}), {.gradient = true, .boundaries = true});
  }
  Scene scene;
  BackprojectionIndex index;
};

TEST(Backprojection, OpenLampIsLit) {
  PolygonSoup soup;
  add_polygons(soup, "lamp", {kLamp});
  const Lit lit(soup);
  const Backprojection seen = lit.at({0.5, 2, 0});
  EXPECT_EQ(seen.shadow, ShadowClass::Lit);
  EXPECT_EQ(seen.visible_fraction, 1);
  EXPECT_NEAR(*seen.form_factor, point_form_factor({0.5, 2, 0}, {0, 0, 1}, kLamp), 1e-15);
  ASSERT_EQ(seen.boundaries.size(), 1u);
  EXPECT_EQ(seen.boundaries[0].sides.size(), 4u);
  // Behind the lamp and in its plane all is umbra.
  EXPECT_EQ(lit.at({0, 0, 5}).shadow, ShadowClass::Umbra);
  EXPECT_EQ(lit.at({3, 0, 4}).shadow, ShadowClass::Umbra);
}

TEST(Backprojection, BoxHidesAPart) {
  PolygonSoup soup;
  add_polygons(soup, "lamp", {kLamp});
  add_box(soup, "box", {-8, -8, 1}, {0, 8, 2});
  const Lit lit(soup);
  // Below its middle: umbra; to the right: half of the lamp, for x = 0 runs under the
  // edge at x = 0.
  EXPECT_EQ(lit.at({-4, 0, 0}).shadow, ShadowClass::Umbra);
  EXPECT_EQ(lit.at({6, 0, 0}).shadow, ShadowClass::Lit);
  const Backprojection half = lit.at({0, 0, 0});
  EXPECT_EQ(half.shadow, ShadowClass::Penumbra);
  EXPECT_NEAR(half.visible_fraction, 0.5, 1e-15);
  EXPECT_NEAR(
      *half.form_factor,
      point_form_factor({0, 0, 0}, {0, 0, 1},
                        std::vector<Point>{{0, -1, 4}, {0, 1, 4}, {1, 1, 4}, {1, -1, 4}}),
      1e-15);
  // The line from x = 1/4 over the edge at height 2 meets the lamp at x = -1/4.
  const Backprojection more = lit.at({0.25, 0, 0});
  EXPECT_NEAR(more.visible_fraction, 0.625, 1e-15);
  ASSERT_EQ(more.boundaries.size(), 1u);
  EXPECT_EQ(more.boundaries[0].sides.size(), 4u);
}

TEST(Backprojection, GradientEqualsDifferences) {
  PolygonSoup soup;
  add_polygons(soup, "lamp", {kLamp});
  add_box(soup, "box", {-0.5, -0.25, 1}, {0.5, 0.75, 2});
  add_polygons(soup, "sheet", {{{0.5, -1, 3}, {1, 0.5, 2.5}, {2, -1, 3}}});
  const Lit lit(soup);
  const Point p{0.3, -0.4, 0.125};
  const Backprojection seen = lit.at(p);
  ASSERT_TRUE(seen.gradient.has_value());
  EXPECT_EQ(seen.shadow, ShadowClass::Penumbra);
  const double h = 0x1p-10;
  for (int axis = 0; axis < 3; ++axis) {
    const auto f = [&](double steps) {
      Point q = p;
      q[axis] += steps * h;
      return *lit.at(q).form_factor;
    };
    const double slope = (8 * (f(1) - f(-1)) - (f(2) - f(-2))) / (12 * h);
    EXPECT_NEAR((*seen.gradient)[axis], slope, 1e-9) << axis;
  }
}

TEST(Backprojection, GradientHasTwoSidesInThePlaneOfAFace) {
  // In the plane x = 1/2 of the box's side: towards smaller x the lower edge of that side
  // hides, towards larger x the upper one.
  PolygonSoup soup;
  add_polygons(soup, "lamp", {kLamp});
  add_box(soup, "box", {-8, -8, 1}, {0.5, 8, 2});
  const Lit lit(soup);
  const Backprojection seen = lit.at({0.5, 0.25, 0});
  EXPECT_FALSE(seen.gradient.has_value());
  ASSERT_TRUE(seen.one_sided.has_value());
  const auto slope = [&](double step) {
    const auto f = [&](double x) { return *lit.at({x, 0.25, 0}).form_factor; };
    return (-3 * f(0.5) + 4 * f(0.5 + step) - f(0.5 + 2 * step)) / (2 * step);
  };
  std::array<double, 2> expected{slope(-0x1p-12), slope(0x1p-12)};
  std::array<double, 2> found{(*seen.one_sided)[0].x(), (*seen.one_sided)[1].x()};
  std::ranges::sort(expected);
  std::ranges::sort(found);
  EXPECT_NEAR(found[0], expected[0], 1e-6);
  EXPECT_NEAR(found[1], expected[1], 1e-6);
  EXPECT_GT(found[1] - found[0], 0.05);
  // Beside an edge-on sheet that nothing of the light is behind there is one gradient.
  EXPECT_TRUE(lit.at({3, 0.25, 0}).gradient.has_value());
}

TEST(Backprojection, HoleOfNextToNothingIsPenumbra) {
  PolygonSoup soup;
  add_polygons(soup, "lamp", {kLamp});
  const double gap = 0x1p-69;
  add_polygons(soup, "left", {{{-9, -9, 2}, {0, -9, 2}, {0, 9, 2}, {-9, 9, 2}}});
  add_polygons(soup, "right", {{{gap, -9, 2}, {9, -9, 2}, {9, 9, 2}, {gap, 9, 2}}});
  const Lit lit(soup);
  const Backprojection seen = lit.at({0, 0, 0});
  EXPECT_EQ(seen.shadow, ShadowClass::Penumbra);
  EXPECT_NEAR(seen.visible_fraction / gap, 1, 1e-12);
  EXPECT_NEAR(*seen.form_factor / gap, 1, 1);
  EXPECT_GT(*seen.form_factor, 0);
  soup.vertices[8].x() = soup.vertices[11].x() = 0;
  EXPECT_EQ(Lit(soup).at({0, 0, 0}).shadow, ShadowClass::Umbra);
}

TEST(Backprojection, HorizonCutsTheLamp) {
  PolygonSoup soup;
  add_polygons(soup, "lamp", {kLamp});
  const Lit lit(soup);
  // Below the horizon of a normal along x is what lies at x < 0.
  const Backprojection seen =
      lit.index.from(shadow_point({0, 0, 0}, {3, 0, 0}), {.boundaries = true});
  EXPECT_EQ(seen.shadow, ShadowClass::Penumbra);
  EXPECT_NEAR(seen.visible_fraction, 0.5, 1e-15);
  ASSERT_EQ(seen.boundaries.size(), 1u);
  EXPECT_EQ(seen.boundaries[0].sides.size(), 4u);
  EXPECT_NEAR(*seen.form_factor, point_form_factor({0, 0, 0}, {1, 0, 0}, kLamp), 1e-15);
}

TEST(Backprojection, BlockerThatCutsTheLamp) {
  PolygonSoup soup;
  add_polygons(soup, "lamp", {kLamp});
  add_box(soup, "box", {-0.5, -0.5, 3}, {0.5, 0.5, 5});
  const Lit lit(soup);
  const Backprojection seen = lit.at({0, 0, 0});
  EXPECT_NEAR(seen.visible_fraction, 1 - (4. / 3) * (4. / 3) / 4, 1e-15);
  ASSERT_EQ(seen.boundaries.size(), 2u);
  // From the side the foot of the box is seen, where its face cuts the lamp.
  const Backprojection foot = lit.at({8, 0, 0});
  bool cut = false;
  for (const SeenBoundary& boundary : foot.boundaries) {
    for (const auto& side : boundary.sides) cut |= side[0].kind == SeenSide::Kind::Cut;
  }
  EXPECT_TRUE(cut);
}

TEST(Backprojection, FarAwayAndAllButInTheLampsPlane) {
  // From 2^56 away along two sides of the lamp, and a quarter below its plane, at a point
  // that no double is near: half of the lamp lies behind an upright sheet that reaches
  // through the plane.
  PolygonSoup soup;
  add_polygons(soup, "lamp", {{{1, 0, 4}, {0, -1, 4}, {-1, 0, 4}, {0, 1, 4}}});
  add_polygons(soup, "sheet",
               {{{1.5, 1.5, 3}, {-0.5, 3.5, 3}, {-0.5, 3.5, 5}, {1.5, 1.5, 5}}});
  const Lit lit(soup);
  for (const char* y : {"504403158265495553/7", "504403158265495566/7"}) {
    const Viewpoint far =
        viewpoint(Viewpoint::Kind::Eye, {"504403158265495552/7", y, "15/4"});
    EXPECT_NEAR(lit.index.from({far.at, std::nullopt}).visible_fraction, 0.5, 1e-15);
  }
}

TEST(Backprojection, PartsOfAWallCountOnceAndTheirJointsAreNoSides) {
  PolygonSoup soup;
  add_polygons(soup, "a", {{{-1, -1, 4}, {-1, 1, 4}, {0, 1, 4}, {0, -1, 4}}});
  add_polygons(soup, "b", {{{-0.5, -1, 4}, {-0.5, 1, 4}, {1, 1, 4}, {1, -1, 4}}});
  const Lit lit(soup, {"a", "b"});
  const Backprojection seen = lit.at({0.5, 2, 0});
  EXPECT_EQ(seen.shadow, ShadowClass::Lit);
  EXPECT_NEAR(*seen.form_factor, point_form_factor({0.5, 2, 0}, {0, 0, 1}, kLamp), 1e-15);
  ASSERT_EQ(seen.boundaries.size(), 1u);
  EXPECT_EQ(seen.boundaries[0].sides.size(), 4u);
}

}  // namespace
}  // namespace sightline
