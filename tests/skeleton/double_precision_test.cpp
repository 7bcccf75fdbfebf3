// Signs left to rounding may be wrong, and contradict each other: the skeleton may then
// be wrong too, but it is told, and nothing divides by zero.

#include <gtest/gtest.h>

#include "linespace/mesh_io.h"
#include "skeleton/skeleton.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

void expect_told(const PolygonSoup& soup, EventMode mode) {
  const Scene scene(soup);
  SkeletonRequest request;
  request.precision = Precision::Double;
  request.events = mode;
  request.eee = request.ff = true;
  EXPECT_NO_THROW({
    const Skeleton skeleton = build_skeleton(scene, request);
    EXPECT_TRUE(skeleton.complete);
    for (const SkeletonArc& arc : skeleton.arcs) {
      EXPECT_TRUE(0 <= arc.range[0] && arc.range[0] <= arc.range[1] && arc.range[1] <= 1);
    }
    for (const EeeArc& arc : skeleton.eee_arcs) {
      EXPECT_TRUE(0 <= arc.range[0] && arc.range[0] <= arc.range[1] && arc.range[1] <= 1);
    }
  });
}

// An outside program died of SIGFPE in it.
TEST(DoublePrecision, TellsTheSampleScenes) {
  for (const char* name : {"cornell.obj", "room.obj"}) {
    SCOPED_TRACE(name);
    const PolygonSoup soup =
        read_mesh(std::string(SIGHTLINE_EXAMPLES) + "/scenes/" + name);
    expect_told(soup, EventMode::Solid);
    if (name == std::string("cornell.obj")) expect_told(soup, EventMode::Polygon);
  }
}

// Scenes in which much is degenerate, so that rounding decides often and wrongly.
TEST(DoublePrecision, TellsWhatLinesUp) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    testing::Random random(seed);
    PolygonSoup soup = testing::random_boxes(seed, 3, {.grid = 4, .may_touch = true});
    if (seed % 4 == 1) soup = testing::grid_city(seed, 18, {.may_touch = true});
    if (seed % 4 == 2) soup = testing::rotated_boxes(seed, 3);
    if (seed % 4 == 3) soup = testing::triangle_soup(seed, 8);
    // Thirds and a turn: nothing is exact any more, and all is nearly so.
    for (Point& p : soup.vertices) {
      p = Point(0.8 * p.x() - 0.6 * p.y(), 0.6 * p.x() + 0.8 * p.y(), p.z()) / 3;
    }
    expect_told(soup, random.one_in(2) ? EventMode::Solid : EventMode::Polygon);
  }
}

}  // namespace
}  // namespace sightline
