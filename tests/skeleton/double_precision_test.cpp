// Signs left to rounding may be wrong, and contradict each other: the skeleton may then
// be wrong too, but it is told, and nothing divides by zero.

#include <gtest/gtest.h>

#include "linespace/mesh_io.h"
#include "skeleton/build.h"
#include "skeleton/end_index.h"
#include "skeleton/view_events.h"
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
    for (const SkeletonArc& arc : skeleton.ev()) {
      EXPECT_TRUE(0 <= arc.range[0] && arc.range[0] <= arc.range[1] && arc.range[1] <= 1);
    }
    for (const SkeletonArc& arc : skeleton.eee()) {
      EXPECT_TRUE(0 <= arc.range[0] && arc.range[0] <= arc.range[1] && arc.range[1] <= 1);
    }
  });
}

// Events on random paths, which ask for far ends and for edges seen edge-on.
void expect_events_told(const PolygonSoup& soup, std::uint64_t seed) {
  const PrecisionScope precision(Precision::Double);
  const Scene scene(soup);
  SkeletonRequest request;
  request.precision = Precision::Double;
  EXPECT_NO_THROW({
    const Skeleton skeleton = build_skeleton(scene, request);
    const EndIndex ends(scene, skeleton);
    const ViewEvents events(scene, skeleton, ends);
    testing::Random random(seed);
    for (int path = 0; path < 10; ++path) {
      const Point a = testing::grid_point(random, scene, 0.3);
      const Point b = testing::grid_point(random, scene, 0.3);
      if (a != b) (void)events.crossed(a, b);
    }
  });
}

// `sightline skeleton cornell.obj --precision double` died of SIGFPE.
TEST(DoublePrecision, TellsTheSampleScenes) {
  for (const char* name : {"cornell.obj", "room.obj"}) {
    SCOPED_TRACE(name);
    const PolygonSoup soup =
        read_mesh(std::string(SIGHTLINE_EXAMPLES) + "/scenes/" + name);
    expect_told(soup, EventMode::Solid);
    if (name == std::string("cornell.obj")) {
      expect_told(soup, EventMode::Polygon);
      expect_events_told(soup, 1);
    }
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
    if (seed % 2 == 0) expect_events_told(soup, seed);
  }
}

}  // namespace
}  // namespace sightline
