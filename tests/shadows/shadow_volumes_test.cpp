// Shadow volumes: closed forms, degenerate cases, laws on seeded scenes.

#include "shadows/shadow_volumes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "linespace/numbers/exact_position.h"
#include "shadows/backprojection.h"
#include "tests/shadows/volume_scenes.h"
#include "tests/support/add_box.h"
#include "tests/support/add_polygons.h"
#include "tests/support/random_geometry.h"

namespace sightline::testing {
namespace {

const std::vector<std::string> kLamp{"lamp"};

ShadowVolumes volumes_of(const Scene& scene, const std::string& solid = "solid") {
  return {scene, light_source(scene, kLamp), scene.faces_named(solid)};
}
ShadowVolumes volumes_of(const PolygonSoup& soup) { return volumes_of(Scene(soup)); }

// A square across z, its middle at (0, 0, z), facing up; reversed facing down.
std::vector<Point> square(double half, double z, bool down = false) {
  std::vector<Point> loop{
      {-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
  if (down) std::ranges::reverse(loop);
  return loop;
}

// A square lamp of this half-side at height 4 over a ground of half-side 8 at 0.
PolygonSoup lamp_over_ground(double half) {
  PolygonSoup soup;
  add_polygons(soup, "lamp", {square(half, 4, true)});
  add_polygons(soup, "ground", {square(8, 0)});
  return soup;
}

ExactPosition at(double x, double y, double z) {
  return internal::exact_position(internal::exact_point(Point(x, y, z)));
}

std::string why_refused(const PolygonSoup& soup) {
  try {
    (void)volumes_of(soup);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

std::set<ShadowSideKind> kinds(const ShadowVolume& volume) {
  std::set<ShadowSideKind> all;
  for (const ShadowVolume::Side& side : volume.sides) all.insert(side.kind);
  return all;
}

// ---- closed forms ---------------------------------------------------------------------

// t below a plate of side 3 at height 2 umbra is a square of side 3 + t / 2, umbra and
// penumbra one of side 3 + 5 t / 2.
TEST(ShadowVolumes, SquareOverASquarePlate) {
  PolygonSoup soup = lamp_over_ground(1);
  add_polygons(soup, "solid", {square(1.5, 2)});
  const ShadowVolumes volumes = volumes_of(soup);
  EXPECT_NEAR(volumes.umbra().volume, (64 - 27) / 1.5, 1e-12);
  EXPECT_NEAR(volumes.shadow().volume, (512 - 27) / 7.5, 1e-12);
  EXPECT_NEAR(volumes.penumbra_volume(), 40, 1e-12);
  EXPECT_NEAR(volumes.lit_volume(), 16 * 16 * 4 - 485 / 7.5, 1e-12);
  EXPECT_EQ(volumes.away_volume(), 0);
  EXPECT_EQ(volumes.solid_volume(), 0);
  EXPECT_EQ(volumes.umbra().vertices.size(), 8U);
  EXPECT_EQ(volumes.umbra().sides.size(), 6U);
  // Parallel sides: each slanted side holds two corners of the lamp and an edge.
  for (const ShadowVolume::Side& side : volumes.umbra().sides) {
    if (side.kind == ShadowSideKind::SourceCorner) {
      EXPECT_EQ(side.generators.size(), 2U);
    }
  }
  EXPECT_EQ(volumes.at(at(0, 0, 1)), ShadowClass::Umbra);
  EXPECT_EQ(volumes.at(at(2, 0, 0)), ShadowClass::Umbra) << "its border belongs to it";
  EXPECT_EQ(volumes.at(at(2.01, 0, 0)), ShadowClass::Penumbra);
  EXPECT_EQ(volumes.at(at(4, 0, 0)), ShadowClass::Lit) << "its border belongs to it";
  EXPECT_EQ(volumes.at(at(0, 0, 2)), ShadowClass::Lit) << "on the plate";
}

// The same below a box: the shadow of its lower facet's level is that of its upper one,
// which is nearer to the lamp.
TEST(ShadowVolumes, SquareOverABox) {
  PolygonSoup soup = lamp_over_ground(1);
  add_box(soup, "solid", {-1.5, -1.5, 1}, {1.5, 1.5, 2});
  const ShadowVolumes volumes = volumes_of(soup);
  EXPECT_NEAR(volumes.umbra().volume, (64 - 27) / 1.5, 1e-12) << "with the box in it";
  EXPECT_EQ(volumes.solid_volume(), 9);
  EXPECT_NEAR(volumes.shadow().volume, (512 - 27) / 7.5, 1e-12);
  EXPECT_EQ(volumes.at(at(0, 0, 1.5)), ShadowClass::Umbra) << "inside the box";
  EXPECT_EQ(volumes.at(at(0, 0, 2)), ShadowClass::Lit) << "on its top";
  EXPECT_EQ(volumes.at(at(1.5, 0, 1.5)), ShadowClass::Umbra) << "on its side";
  EXPECT_EQ(volumes.at(at(0, 0, 1)), ShadowClass::Umbra) << "on its underside";
}

// The lamp is twice as large: umbra is a pyramid of side 2 and height 1.
TEST(ShadowVolumes, SourceLargerThanTheSolidEndsInAnApex) {
  PolygonSoup soup = lamp_over_ground(2);
  add_polygons(soup, "solid", {square(1, 3)});
  const ShadowVolumes volumes = volumes_of(soup);
  EXPECT_NEAR(volumes.umbra().volume, 4.0 / 3, 1e-12);
  EXPECT_EQ(volumes.umbra().vertices.size(), 5U);
  EXPECT_EQ(volumes.at(at(0, 0, 2)), ShadowClass::Umbra) << "the apex";
  EXPECT_EQ(volumes.at(at(0, 0, 1.999)), ShadowClass::Penumbra);
}

TEST(ShadowVolumes, SourceLongerThanTheSolidEndsInARidge) {
  PolygonSoup soup = lamp_over_ground(2);
  add_polygons(soup, "solid", {{{-1.5, -1, 3}, {1.5, -1, 3}, {1.5, 1, 3}, {-1.5, 1, 3}}});
  const ShadowVolumes volumes = volumes_of(soup);
  // (3 - t) (2 - 2 t) over 0 <= t <= 1.
  EXPECT_NEAR(volumes.umbra().volume, 6 - 4 + 2.0 / 3, 1e-12);
  EXPECT_EQ(volumes.umbra().vertices.size(), 6U);
}

// ---- degenerate cases -----------------------------------------------------------------

TEST(ShadowVolumes, SolidBehindTheSource) {
  PolygonSoup soup = lamp_over_ground(1);
  add_box(soup, "solid", {-1, -1, 5}, {1, 1, 6});
  const ShadowVolumes volumes = volumes_of(soup);
  EXPECT_EQ(volumes.umbra().volume, 0);
  EXPECT_TRUE(volumes.umbra().vertices.empty());
  EXPECT_TRUE(volumes.shadow().sides.empty());
  EXPECT_EQ(volumes.away_volume(), 16 * 16 * 2);
  EXPECT_EQ(volumes.lit_volume(), 16 * 16 * 4);
  EXPECT_EQ(volumes.at(at(0, 0, 5)), ShadowClass::Umbra) << "all is behind the lamp";
}

// A box pressed against the lamp, and one against a half of it: from below that one some
// points see the other half.
TEST(ShadowVolumes, SolidTouchingTheSource) {
  PolygonSoup soup = lamp_over_ground(1);
  add_box(soup, "solid", {-2, -2, 3}, {2, 2, 4});
  const ShadowVolumes volumes = volumes_of(soup);
  EXPECT_EQ(volumes.umbra().volume, 16 * 16 * 4) << "nothing gets out";
  EXPECT_EQ(volumes.penumbra_volume(), 0);
  PolygonSoup half = lamp_over_ground(1);
  add_box(half, "solid", {0, -2, 3}, {2, 2, 4});
  const ShadowVolumes of_half = volumes_of(half);
  EXPECT_EQ(of_half.at(at(1, 0, 2)), ShadowClass::Umbra) << "it hides the rest too";
  EXPECT_EQ(of_half.at(at(0.5, 0, 2)), ShadowClass::Penumbra);
  EXPECT_EQ(of_half.at(at(-1, 0, 2)), ShadowClass::Penumbra);
  EXPECT_EQ(of_half.at(at(0.5, 0, 3)), ShadowClass::Umbra) << "on its underside";
}

TEST(ShadowVolumes, SourceInThePlaneOfAFacet) {
  PolygonSoup soup = lamp_over_ground(1);
  add_box(soup, "solid", {3, -1, 2}, {5, 1, 4});
  const ShadowVolumes volumes = volumes_of(soup);
  EXPECT_GT(volumes.penumbra_volume(), 0);
  for (const ShadowVolume::Side& side : volumes.shadow().sides) {
    // The top facet, the lamp's plane and the box of the scene in one.
    if (std::ranges::find(side.generators, "source plane") == side.generators.end())
      continue;
    EXPECT_EQ(side.kind, ShadowSideKind::Facet);
    EXPECT_GE(side.generators.size(), 3U);
  }
  EXPECT_EQ(volumes.at(at(3, 0, 3)), ShadowClass::Lit) << "the side before the lamp";
  EXPECT_EQ(volumes.at(at(5, 0, 3)), ShadowClass::Umbra) << "the side away from it";
}

TEST(ShadowVolumes, SheetEdgeOnAndSheetOnTheSource) {
  PolygonSoup soup = lamp_over_ground(1);
  add_polygons(soup, "solid", {{{0, -1, 0}, {0, 1, 0}, {0, 1, 2}, {0, -1, 2}}});
  const ShadowVolumes volumes = volumes_of(soup);
  EXPECT_EQ(volumes.umbra().volume, 0) << "half of the lamp is on either side";
  EXPECT_GT(volumes.penumbra_volume(), 0);
  EXPECT_EQ(volumes.at(at(0, 2, 0)), ShadowClass::Lit) << "sees it edge-on";
  EXPECT_EQ(volumes.at(at(0.25, 0, 0)), ShadowClass::Penumbra);
  PolygonSoup on_lamp = lamp_over_ground(1);
  add_polygons(on_lamp, "solid", {square(0.5, 4)});
  EXPECT_EQ(volumes_of(on_lamp).shadow().volume, 0);
}

TEST(ShadowVolumes, ClosedSource) {
  PolygonSoup soup;
  add_box(soup, "lamp", {-1, -1, 4}, {1, 1, 5});
  add_box(soup, "solid", {-1.5, -1.5, 1}, {1.5, 1.5, 2});
  add_polygons(soup, "ground", {square(8, 0)});
  const ShadowVolumes volumes = volumes_of(soup);
  // t below the box umbra is a square of side 3 + t / 3: points beside the lamp see its
  // sides up to the top.
  EXPECT_NEAR(volumes.umbra().volume, std::pow(11.0 / 3, 3) - 27, 1e-12);
  EXPECT_NEAR(volumes.shadow().volume, (512 - 27) / 7.5, 1e-12) << "by its underside";
  EXPECT_EQ(volumes.away_volume(), 4) << "inside the lamp";
  EXPECT_EQ(volumes.at(at(0, 0, 4.5)), ShadowClass::Umbra);
  EXPECT_EQ(volumes.at(at(0, 0, 5.5)), ShadowClass::Lit);
}

TEST(ShadowVolumes, ASourceOfSeveralPolygonsAndASolidOfTriangles) {
  PolygonSoup soup;
  add_polygons(soup, "lamp",
               {{{-1, -1, 4}, {-1, 1, 4}, {0, 1, 4}, {0, -1, 4}},
                {{0, 0, 4}, {0, 1, 4}, {1, 1, 4}, {1, 0, 4}},
                {{0, -1, 4}, {0, 0.5, 4}, {1, 0.5, 4}, {1, -1, 4}}});
  add_polygons(soup, "ground", {square(8, 0)});
  add_polygons(soup, "solid",
               {{{-1.5, -1.5, 2}, {1.5, -1.5, 2}, {1.5, 1.5, 2}},
                {{-1.5, -1.5, 2}, {1.5, 1.5, 2}, {-1.5, 1.5, 2}}});
  EXPECT_NEAR(volumes_of(soup).penumbra_volume(), 40, 1e-12);
}

TEST(ShadowVolumes, WhatIsNotConvexIsRefused) {
  PolygonSoup soup = lamp_over_ground(1);
  add_polygons(soup, "solid", {square(1, 1), square(1, 2)});
  EXPECT_NE(why_refused(soup).find("the solid: its faces"), std::string::npos);
  soup = lamp_over_ground(1);
  add_polygons(soup, "solid",
               {{{0, 0, 2}, {2, 0, 2}, {2, 1, 2}, {1, 1, 2}, {1, 2, 2}, {0, 2, 2}}});
  EXPECT_NE(why_refused(soup).find("'solid' are no convex polygon"), std::string::npos)
      << why_refused(soup);
  soup = lamp_over_ground(1);
  add_box(soup, "solid", {-0.5, -0.5, 3}, {0.5, 0.5, 5});
  EXPECT_NE(why_refused(soup).find("cuts the source"), std::string::npos);
  soup = lamp_over_ground(1);
  PolygonSoup::Group solid{"solid", {}};
  add_box(soup, "a", {-1, -1, 1}, {1, 1, 2});
  add_box(soup, "b", {-1, -1, 2}, {0, 1, 3});
  soup.groups.pop_back();
  soup.groups.back() = {"solid", {2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13}};
  EXPECT_NE(why_refused(soup).find("'solid' is not convex"), std::string::npos)
      << why_refused(soup);
  PolygonSoup two;
  add_polygons(two, "lamp", {square(1, 4, true), square(1, 5, true)});
  add_box(two, "solid", {-1, -1, 1}, {1, 1, 2});
  EXPECT_NE(why_refused(two).find("the source: "), std::string::npos);
}

// ---- laws -----------------------------------------------------------------------------

TEST(ShadowVolumes, ClassesAreThoseOfTwoOtherWays) {
  VolumeCounts counts;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const auto difference = volume_difference(seed, 60, counts);
    EXPECT_FALSE(difference) << *difference;
  }
  EXPECT_LT(counts.refused, 30);
  EXPECT_GT(counts.umbra, 300);
  EXPECT_GT(counts.penumbra, 300);
  EXPECT_GT(counts.lit, 300);
}

TEST(ShadowVolumes, AreClosedPolyhedraAndAddUpToTheBox) {
  int bodies = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Scene scene(volume_scene(seed));
    std::optional<ShadowVolumes> volumes;
    try {
      volumes.emplace(volumes_of(scene));
    } catch (const InvalidInput&) {
      continue;
    }
    for (const ShadowVolume* v : {&volumes->umbra(), &volumes->shadow()}) {
      std::set<std::array<int, 2>> sides;
      for (const ShadowVolume::Side& side : v->sides) {
        EXPECT_GE(side.corners.size(), 3U);
        EXPECT_FALSE(side.generators.empty());
        for (std::size_t k = 0; k < side.corners.size(); ++k) {
          EXPECT_TRUE(
              sides.insert({side.corners[k], side.corners[(k + 1) % side.corners.size()]})
                  .second);
        }
      }
      for (const auto& [p, q] : sides) EXPECT_TRUE(sides.contains({q, p}));
      if (v->sides.empty()) continue;
      ++bodies;
      EXPECT_EQ(v->vertices.size() + v->sides.size(), sides.size() / 2 + 2) << seed;
    }
    const Point size = scene.bounds()[1] - scene.bounds()[0];
    EXPECT_NEAR(volumes->umbra().volume + volumes->penumbra_volume() +
                    volumes->lit_volume() + volumes->away_volume(),
                size.prod(), 1e-12 * size.prod());
    EXPECT_NEAR(volumes->umbra().volume + volumes->penumbra_volume(),
                volumes->shadow().volume, 1e-12 * size.prod());
  }
  EXPECT_GT(bodies, 80);
}

// Counted from what BackprojectionIndex says of random points.
TEST(ShadowVolumes, VolumesAreThoseOfCountedPoints) {
  const std::vector<std::string> far{"far"};
  constexpr int kPoints = 4000;
  for (const std::uint64_t seed : {2U, 4U, 5U, 8U, 12U}) {
    const Scene whole(volume_scene(seed));
    std::optional<ShadowVolumes> volumes;
    try {
      volumes.emplace(volumes_of(whole));
    } catch (const InvalidInput&) {
      continue;
    }
    const Scene scene = scene_without(whole, far);
    const BackprojectionIndex index(scene, light_source(scene, kLamp));
    RandomGeometry random(seed);
    std::array<int, 3> counts{};
    const auto& [low, high] = whole.bounds();
    for (int i = 0; i < kPoints; ++i) {
      Point p;
      for (int k = 0; k < 3; ++k) p[k] = random.uniform(low[k], high[k]);
      ++counts[static_cast<int>(index.from(shadow_point(p)).shadow)];
    }
    const double box = (high - low).prod();
    const auto expect = [&](ShadowClass shadow, double volume) {
      const double share = volume / box;
      const double deviation = std::sqrt(share * (1 - share) / kPoints);
      EXPECT_NEAR(counts[static_cast<int>(shadow)] / double{kPoints}, share,
                  5 * deviation + 1e-3)
          << seed;
    };
    expect(ShadowClass::Umbra, volumes->umbra().volume + volumes->away_volume());
    expect(ShadowClass::Penumbra, volumes->penumbra_volume());
    expect(ShadowClass::Lit, volumes->lit_volume());
  }
}

TEST(ShadowVolumes, SameUnderOrderAxesPowersOfTwoAndTriangles) {
  int compared = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const PolygonSoup soup = volume_scene(seed);
    std::optional<ShadowVolumes> volumes;
    try {
      volumes.emplace(volumes_of(soup));
    } catch (const InvalidInput&) {
      continue;
    }
    const auto same = [&](const PolygonSoup& other, double factor) {
      const ShadowVolumes its = volumes_of(other);
      EXPECT_EQ(its.umbra().volume, factor * volumes->umbra().volume) << seed;
      EXPECT_EQ(its.penumbra_volume(), factor * volumes->penumbra_volume()) << seed;
      EXPECT_EQ(its.lit_volume(), factor * volumes->lit_volume()) << seed;
      EXPECT_EQ(its.umbra().vertices.size(), volumes->umbra().vertices.size()) << seed;
      EXPECT_EQ(kinds(its.shadow()), kinds(volumes->shadow())) << seed;
    };
    PolygonSoup other = soup;
    for (Point& p : other.vertices) p = Point(p.y(), p.z(), p.x());
    same(other, 1);
    other = soup;
    for (Point& p : other.vertices) p *= 8;
    same(other, 512);
    other = soup;
    for (auto& polygon : other.polygons)
      std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
    std::ranges::reverse(other.vertices);
    for (auto& polygon : other.polygons) {
      for (int& v : polygon) v = static_cast<int>(other.vertices.size()) - 1 - v;
    }
    same(other, 1);
    ++compared;
  }
  EXPECT_GT(compared, 20);
}

}  // namespace
}  // namespace sightline::testing
