// Perturbed copies of scenes that line up: how far points move, and what stays.

#include "linespace/perturb.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "linespace/predicates.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

std::vector<PolygonSoup> scenes() {
  return {testing::grid_city(1, 120), testing::grid_city(2, 72, {.may_touch = true}),
          testing::random_boxes(5, 8), testing::random_polytopes(3, 8),
          testing::random_parallelepipeds(4, 6)};
}

TEST(Perturb, MovesEveryPointButNotFarther) {
  for (const PolygonSoup& soup : scenes()) {
    SCOPED_TRACE(soup.source);
    const Scene scene(soup);
    for (const double size : {1e-3, 0.0625}) {
      const PolygonSoup moved = perturbed(scene, size, 7);
      ASSERT_EQ(moved.polygons.size(), soup.polygons.size());
      double most = 0;
      for (std::size_t k = 0; k < soup.polygons.size(); ++k) {
        ASSERT_EQ(moved.polygons[k].size(), soup.polygons[k].size());
        for (std::size_t i = 0; i < soup.polygons[k].size(); ++i) {
          const double d =
              (moved.vertices[moved.polygons[k][i]] - soup.vertices[soup.polygons[k][i]])
                  .norm();
          EXPECT_LE(d, size);
          EXPECT_GT(d, 0);
          most = std::max(most, d);
        }
      }
      EXPECT_GT(most, 0.25 * size);
    }
  }
}

TEST(Perturb, KeepsFacesEdgesAndSolids) {
  for (const PolygonSoup& soup : scenes()) {
    SCOPED_TRACE(soup.source);
    const Scene scene(soup);
    const double size = 1e-3;
    const Scene moved(perturbed(scene, size, 3));
    // Slanted quads may fold on the coarser grid.
    if (soup.source.find("parallel") != std::string::npos) continue;
    EXPECT_EQ(moved.faces().size(), scene.faces().size());
    EXPECT_EQ(moved.edges().size(), scene.edges().size());
    EXPECT_EQ(moved.solids(), scene.solids());
    ASSERT_EQ(moved.objects().size(), scene.objects().size());
    for (std::size_t o = 0; o < scene.objects().size(); ++o) {
      EXPECT_EQ(moved.objects()[o].name, scene.objects()[o].name);
      EXPECT_EQ(moved.objects()[o].convex, scene.objects()[o].convex);
    }
  }
}

// Of edges of different boxes, none are coplanar any more.
TEST(Perturb, NothingLinesUpAcrossObjects) {
  const Scene scene(testing::grid_city(1, 72));
  const auto coplanar_pairs = [](const Scene& s) {
    int count = 0;
    for (const Edge& e : s.edges()) {
      for (const Edge& f : s.edges()) {
        if (e.object >= f.object) continue;
        count += orient3d(s.point(e.points[0]), s.point(e.points[1]),
                          s.point(f.points[0]), s.point(f.points[1])) == Sign::Zero;
      }
    }
    return count;
  };
  EXPECT_GT(coplanar_pairs(scene), 1000);
  EXPECT_EQ(coplanar_pairs(Scene(perturbed(scene, 1e-3, 1))), 0);
}

TEST(Perturb, SeedsTellCopiesApart) {
  const Scene scene(testing::grid_city(1, 72));
  const PolygonSoup a = perturbed(scene, 1e-3, 1);
  EXPECT_EQ(a.vertices, perturbed(scene, 1e-3, 1).vertices);
  EXPECT_NE(a.vertices, perturbed(scene, 1e-3, 2).vertices);
}

TEST(Perturb, RefusesSizesThatDoublesCannotHold) {
  const Scene scene(testing::grid_city(1, 72));
  for (const double size : {0.0, -1.0, 1e-9, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW((void)perturbed(scene, size, 1), InvalidInput);
  }
}

}  // namespace
}  // namespace sightline
