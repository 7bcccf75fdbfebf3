// Scenes of lights and sensors that people publicly ask other programs about, each built
// anew after the report's description, with what is right found by hand.  The reports are
// issues of the named projects on GitHub.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "linespace/occlusion.h"
#include "shadows/backprojection.h"
#include "shadows/lit_picture.h"
#include "tests/support/add_box.h"

namespace sightline {
namespace {

using testing::add_box;

// Of an element at the origin with the normal z to the rectangle [0, a] x [0, b] at
// height c; odd in a and in b.
double corner_factor(double a, double b, double c) {
  const double x = a / c, y = b / c;
  const double u = std::sqrt(1 + x * x), v = std::sqrt(1 + y * y);
  return (x / u * std::atan(y / u) + y / v * std::atan(x / v)) / (2 * std::numbers::pi);
}

// Of an element at the origin with the normal x to the rectangle [0, a] x [0, b] at
// height c.
double upright_factor(double a, double b, double c) {
  const double r = std::hypot(a, c);
  return (std::atan(b / c) - c / r * std::atan(b / r)) / (2 * std::numbers::pi);
}

// A polygon, counter-clockwise seen from its front, as a group of its own; its number.
int add_sheet(PolygonSoup& soup, const std::string& name,
              const std::vector<Point>& corners) {
  std::vector<int> polygon;
  for (const Point& p : corners) {
    polygon.push_back(static_cast<int>(soup.vertices.size()));
    soup.vertices.push_back(p);
  }
  const int number = static_cast<int>(soup.polygons.size());
  soup.groups.push_back({name, {number}});
  soup.polygons.push_back(polygon);
  return number;
}

// A rectangle that faces down.
int add_lamp(PolygonSoup& soup, double half, double height) {
  return add_sheet(soup, "lamp",
                   {{-half, -half, height},
                    {-half, half, height},
                    {half, half, height},
                    {half, -half, height}});
}

struct Lit {
  explicit Lit(const PolygonSoup& soup, const std::vector<std::string>& light = {"lamp"},
               const std::vector<std::string>& both_sides = {})
      : scene(soup),
        source(light_source(scene, light, both_sides)),
        index(scene, source) {}
  [[nodiscard]] Backprojection at(const Point& p, const Eigen::Vector3d& normal) const {
    return index.from(shadow_point(p, normal));
  }
  Scene scene;
  LightSource source;
  BackprojectionIndex index;
};

const Eigen::Vector3d kUp{0, 0, 1}, kDown{0, 0, -1};

// mitsuba3 1505: should a rectangle of light shine to one side, or to both?  To its
// front, and to both where it is asked to.
TEST(ShadowPublic, BothSidesOfALight) {
  PolygonSoup soup;
  add_lamp(soup, 1, 4);
  const Lit one(soup), both(soup, {"lamp"}, {"lamp"});
  const double factor = 4 * corner_factor(1, 1, 4);
  EXPECT_NEAR(*one.at({0, 0, 0}, kUp).form_factor, factor, 1e-15);
  EXPECT_EQ(*one.at({0, 0, 8}, kDown).form_factor, 0);
  EXPECT_EQ(one.at({0, 0, 8}, kDown).shadow, ShadowClass::Umbra);
  EXPECT_NEAR(*both.at({0, 0, 0}, kUp).form_factor, factor, 1e-15);
  EXPECT_NEAR(*both.at({0, 0, 8}, kDown).form_factor, factor, 1e-15);
  EXPECT_EQ(both.at({0, 0, 8}, kDown).visible_fraction, 1);
}

// hive 602: next to no sun reaches a building's sensor; it stood inside a building of the
// context.  Within a solid, and below it on the ground, all is umbra: to be told from a
// sensor that is shaded.
TEST(ShadowPublic, SensorInABuilding) {
  PolygonSoup soup;
  add_lamp(soup, 30, 60);
  add_box(soup, "building", {-5, -5, 0}, {5, 5, 10});
  add_sheet(soup, "ground", {{-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}});
  const Lit sky(soup);
  for (const Point& p : {Point{0, 0, 5}, Point{0, 0, 0}, Point{4, -4, 0}}) {
    const Backprojection seen = sky.at(p, kUp);
    EXPECT_EQ(seen.shadow, ShadowClass::Umbra);
    EXPECT_EQ(seen.visible_fraction, 0);
    EXPECT_EQ(*seen.form_factor, 0);
  }
  EXPECT_EQ(sky.at({0, 0, 10}, kUp).shadow, ShadowClass::Lit);
  const Backprojection foot = sky.at({5, 0, 0}, kUp);
  EXPECT_EQ(foot.shadow, ShadowClass::Penumbra);
  EXPECT_NEAR(foot.visible_fraction, 25. / 60, 1e-15);  // of the lamp x > 5
}

// honeybee-radiance 726: a model in millimetres.  Classes, fractions and form factors do
// not know the unit; areas do.
TEST(ShadowPublic, MillimetresForMetres) {
  PolygonSoup metres;
  add_lamp(metres, 1, 3);
  add_box(metres, "table", {-0.5, -0.25, 0.75}, {0.5, 0.75, 0.875});
  PolygonSoup millimetres = metres;
  for (Point& p : millimetres.vertices) p *= 1000;
  const Lit small(metres), large(millimetres);
  std::array<int, 3> classes{};
  for (int i = -16; i <= 16; ++i) {
    for (int j = -16; j <= 16; ++j) {
      const Point p(i / 8., j / 8., 0);
      const Backprojection a = small.at(p, kUp), b = large.at(1000 * p, kUp);
      ++classes[static_cast<int>(a.shadow)];
      EXPECT_EQ(a.shadow, b.shadow);
      EXPECT_NEAR(a.visible_fraction, b.visible_fraction, 1e-14);
      EXPECT_NEAR(*a.form_factor, *b.form_factor, 1e-14);
    }
  }
  for (const int n : classes) EXPECT_GT(n, 0);
}

// Sensors on a tilted roof, their coordinates computed in doubles: rounding puts some
// behind the roof, where they lie in the dark.  "on" puts each exactly on it.
TEST(ShadowPublic, SensorsOnATiltedRoof) {
  PolygonSoup soup;
  add_lamp(soup, 40, 70);
  const double length = 7.3, depth = 4.1, rise = 2.7;
  const int roof = add_sheet(soup, "roof",
                             {{0, 0, 3.1},
                              {length, 0, 3.1},
                              {length, depth, 3.1 + rise},
                              {0, depth, 3.1 + rise}});
  const Lit sky(soup);
  const Eigen::Vector3d normal{0, -rise, depth};
  int dark = 0, lit = 0;
  for (int i = 1; i < 40; ++i) {
    for (int j = 1; j < 40; ++j) {
      const double t = j / 40.;
      const Point p(length * i / 40., depth * t, 3.1 + rise * t);
      const Backprojection written = sky.at(p, normal);
      const Backprojection on =
          sky.index.from(shadow_point_on(sky.scene, roof, shadow_point(p).at));
      ++(written.shadow == ShadowClass::Umbra ? dark : lit);
      EXPECT_EQ(on.shadow, ShadowClass::Lit);
      EXPECT_EQ(on.visible_fraction, 1);
      if (written.shadow != ShadowClass::Umbra) {
        EXPECT_NEAR(*written.form_factor, *on.form_factor, 1e-14);
      }
    }
  }
  EXPECT_GT(dark, 100);
  EXPECT_GT(lit, 100);
}

// Daylight through a window with its pane: the pane is a face like all others.  Without
// it a desk 3 behind the wall sees the sky through the window, 2 wide, from 1 to 2 above
// the desk.
TEST(ShadowPublic, DaylightThroughAWindowWithItsPane) {
  PolygonSoup soup;
  add_sheet(soup, "sky",
            {{-10, -60, -60}, {-10, 60, -60}, {-10, 60, 60}, {-10, -60, 60}});
  const auto wall = [&](const char* name, double y0, double y1, double z0, double z1) {
    return add_sheet(soup, name, {{0, y0, z0}, {0, y1, z0}, {0, y1, z1}, {0, y0, z1}});
  };
  wall("below", -50, 50, -50, 1);
  wall("above", -50, 50, 2, 50);
  wall("left", -50, -1, 1, 2);
  wall("right", 1, 50, 1, 2);
  const Lit open(soup, {"sky"});
  const Backprojection seen = open.at({3, 0, 0}, kUp);
  EXPECT_EQ(seen.shadow, ShadowClass::Penumbra);
  EXPECT_NEAR(*seen.form_factor, 2 * (upright_factor(2, 1, 3) - upright_factor(1, 1, 3)),
              1e-15);
  wall("pane", -1, 1, 1, 2);
  const Lit closed(soup, {"sky"});
  EXPECT_EQ(closed.at({3, 0, 0}, kUp).shadow, ShadowClass::Umbra);
}

// View3D 4: factors from a point to a given set of surfaces.  On the floor of a cube,
// in its middle: the other five, which add up to one.
TEST(ShadowPublic, PointToSurfaces) {
  PolygonSoup soup;
  add_sheet(soup, "top", {{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}});
  add_sheet(soup, "west", {{-1, -1, 0}, {-1, 1, 0}, {-1, 1, 2}, {-1, -1, 2}});
  add_sheet(soup, "east", {{1, 1, 0}, {1, -1, 0}, {1, -1, 2}, {1, 1, 2}});
  add_sheet(soup, "south", {{1, -1, 0}, {-1, -1, 0}, {-1, -1, 2}, {1, -1, 2}});
  add_sheet(soup, "north", {{-1, 1, 0}, {1, 1, 0}, {1, 1, 2}, {-1, 1, 2}});
  double sum = 0;
  for (const char* name : {"top", "west", "east", "south", "north"}) {
    const double factor = *Lit(soup, {name}).at({0, 0, 0}, kUp).form_factor;
    const double expected = std::string(name) == "top" ? 4 * corner_factor(1, 1, 2)
                                                       : 2 * upright_factor(2, 1, 1);
    EXPECT_NEAR(factor, expected, 1e-15) << name;
    sum += factor;
  }
  EXPECT_NEAR(sum, 1, 1e-15);
}

PolygonSoup plate_below_a_lamp() {
  PolygonSoup soup;
  add_lamp(soup, 1, 4);
  add_sheet(soup, "plate",
            {{-1.5, -1.5, 2}, {1.5, -1.5, 2}, {1.5, 1.5, 2}, {-1.5, 1.5, 2}});
  add_sheet(soup, "ground", {{-8, -8, 0}, {8, -8, 0}, {8, 8, 0}, {-8, 8, 0}});
  return soup;
}

// A picture with soft shadows, without a display: a row of pixels of the floor below a
// plate of half-side 3/2 half way up to the lamp, from umbra through penumbra to light.
TEST(ShadowPublic, SoftShadows) {
  const Lit lit(plate_below_a_lamp());
  const OcclusionIndex occlusion(lit.scene);
  const double half_angle = 75 * std::numbers::pi / 180;
  const PictureCamera camera{{0, 0, 1.75}, {0, 0, 0}, {0, 1, 0}, 2 * half_angle, 101, 3};
  const auto exact = lit_picture(occlusion, lit.index, lit.source, camera, 0, 1);
  const auto rays = lit_picture(occlusion, lit.index, lit.source, camera, 4096, 1);
  ASSERT_EQ(exact.size(), 303U);
  int umbra = 0, penumbra = 0;
  for (int i = 0; i < 101; ++i) {
    const LitPixel& pixel = exact[101 + i];
    ASSERT_EQ(pixel.kind, LitPixel::Kind::Surface);
    const double x = std::abs((2 * i + 1) / 101. - 1) * 1.75 * std::tan(half_angle);
    // What is seen of the lamp begins at 3 - x.
    const double from = std::clamp(3 - x, -1., 1.);
    const double expected =
        2 * (corner_factor(1 - x, 1, 4) - corner_factor(from - x, 1, 4));
    EXPECT_NEAR(pixel.value, expected, 1e-12) << x;
    EXPECT_NEAR(rays[101 + i].value, expected, 4e-3) << x;
    umbra += expected == 0 ? 1 : 0;
    penumbra += expected > 0 && x < 4 ? 1 : 0;
  }
  EXPECT_GT(umbra, 20);
  EXPECT_GT(penumbra, 20);
}

// The same scene with values between exact ones: which pixels are interpolated, and how
// far off.
TEST(ShadowPublic, SmoothPicturesAreNearExactOnes) {
  const Lit lit(plate_below_a_lamp());
  const OcclusionIndex occlusion(lit.scene);
  const PictureCamera camera{{-9, -7, 6}, {0, 0, 1}, {0, 0, 1}, 1, 102, 75};
  const auto exact = lit_picture(occlusion, lit.index, lit.source, camera, 0, 1);
  const auto smooth = smooth_lit_picture(occlusion, lit.index, lit.source, camera, 0.02);
  const auto all = smooth_lit_picture(occlusion, lit.index, lit.source, camera, 0);
  ASSERT_EQ(smooth.size(), exact.size());
  ASSERT_EQ(all.size(), exact.size());
  double brightest = 0;
  for (const LitPixel& p : exact) {
    if (p.kind == LitPixel::Kind::Surface) brightest = std::max(brightest, p.value);
  }
  int between = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    ASSERT_EQ(smooth[i].kind, exact[i].kind) << i;
    ASSERT_EQ(smooth[i].face, exact[i].face) << i;
    EXPECT_EQ(all[i].value, exact[i].value) << i;
    EXPECT_NEAR(smooth[i].value, exact[i].value, 0.02 * brightest) << i;
    if (i % 102 % 2 == 0 && i % 102 % 4 == i / 102 % 4) {
      EXPECT_EQ(smooth[i].value, exact[i].value) << i;
    }
    between += smooth[i].value != exact[i].value ? 1 : 0;
  }
  EXPECT_GT(between, static_cast<int>(exact.size()) / 4);
}

// Points on a slanting wall are rounded, half of them behind it: rays begin before it.
// The rays of docs/pictures/soft_shadow_rays.png once left stripes of darkness on walls.
TEST(ShadowPublic, RandomRaysOnASlantingWall) {
  PolygonSoup soup;
  add_lamp(soup, 1, 4);
  add_sheet(soup, "wall", {{-3, 2, 0}, {3, 2.3, 0.1}, {0.1, 3.7, 5}});
  const Lit lit(soup);
  const OcclusionIndex occlusion(lit.scene);
  const PictureCamera camera{{0, -4, 1.5}, {0, 3, 1.5}, {0, 0, 1}, 1, 41, 41};
  const auto exact = lit_picture(occlusion, lit.index, lit.source, camera, 0, 1);
  const auto rays = lit_picture(occlusion, lit.index, lit.source, camera, 64, 1);
  int compared = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    if (exact[i].kind != LitPixel::Kind::Surface || exact[i].value < 0.01) continue;
    EXPECT_NEAR(rays[i].value, exact[i].value, 0.5 * exact[i].value);
    ++compared;
  }
  EXPECT_GT(compared, 200);
}

}  // namespace
}  // namespace sightline
