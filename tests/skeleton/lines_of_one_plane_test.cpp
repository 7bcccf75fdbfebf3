// EEE arcs whose lines lie in one plane, and edges that run through solids, on scenes
// whose answers are known by hand.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "linespace/scene.h"
#include "skeleton/build.h"
#include "tests/support/add_box.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

// The edge between two points.
int edge_between(const Scene& scene, const Point& p, const Point& q) {
  const auto edges = scene.edges();
  const auto found = std::find_if(edges.begin(), edges.end(), [&](const Edge& e) {
    const Point& e0 = scene.point(e.points[0]);
    const Point& e1 = scene.point(e.points[1]);
    return (e0 == p && e1 == q) || (e0 == q && e1 == p);
  });
  return found == edges.end() ? -1 : static_cast<int>(found - edges.begin());
}

int arcs_with(const Skeleton& skeleton, int a, int b) {
  return static_cast<int>(std::count_if(
      skeleton.eee().begin(), skeleton.eee().end(), [&](const SkeletonArc& arc) {
        const auto has = [&](int e) {
          return std::find(arc.edges().begin(), arc.edges().end(), e) !=
                 arc.edges().end();
        };
        return has(a) && has(b);
      }));
}

// All lines of the curve are one: along the edge of `near`, over the edges of `roof`,
// past the wall of `front`, then in the wall of `back`, against which `pressed` leans.
// The lines lie in the plane of the roofs, and in that of the walls.
TEST(LinesOfOnePlane, AreNotFreeBetweenWallsThatTouchInAnotherOne) {
  PolygonSoup soup;
  testing::add_box(soup, "near", {14, 12, 0}, {16, 13, 3});
  testing::add_box(soup, "roof", {13, 15, 0}, {16, 16, 3});
  testing::add_box(soup, "front", {14, 20, 0}, {16, 21, 4});
  testing::add_box(soup, "back", {11, 22, 0}, {14, 25, 4});
  testing::add_box(soup, "pressed", {14, 23, 0}, {16, 24, 4});
  const Scene scene(soup);
  const Skeleton skeleton = build_skeleton(scene, {});
  const int near = edge_between(scene, {14, 12, 3}, {14, 13, 3});
  const int before = edge_between(scene, {14, 22, 0}, {14, 22, 4});
  const int behind = edge_between(scene, {14, 25, 0}, {14, 25, 4});
  ASSERT_TRUE(near >= 0 && before >= 0 && behind >= 0);
  EXPECT_EQ(arcs_with(skeleton, near, behind), 0);
  EXPECT_GT(arcs_with(skeleton, near, before), 0);
}

// Lines in the plane x = 14 from an edge of `near` past one of `next` to an edge of `bar`
// that crosses the plane.  Between them a wall leans on the plane from one side, or two
// from both.
TEST(LinesOfOnePlane, AreHiddenBetweenSolidsThatTouchInThePlane) {
  for (const bool both : {false, true}) {
    PolygonSoup soup;
    testing::add_box(soup, "near", {14, 0, 0}, {16, 1, 3});
    testing::add_box(soup, "next", {14, 5, 0}, {16, 6, 2});
    testing::add_box(soup, "front", {14, 10, -1}, {16, 12, 4});
    if (both) testing::add_box(soup, "back", {12, 10, -1}, {14, 12, 4});
    testing::add_box(soup, "bar", {10, 20, 1}, {18, 21, 2});
    const Scene scene(soup);
    const Skeleton skeleton = build_skeleton(scene, {});
    const int near = edge_between(scene, {14, 1, 0}, {14, 1, 3});
    const int bar = edge_between(scene, {10, 20, 1}, {18, 20, 1});
    ASSERT_TRUE(near >= 0 && bar >= 0);
    EXPECT_EQ(arcs_with(skeleton, near, bar) > 0, !both);
  }
}

// Two rows of boxes in one line, a wall between the rows: each line along a row is one
// node on either side of the wall.
TEST(KnownLines, AreToldPartByPart) {
  PolygonSoup soup;
  for (const double x : {0.0, 4.0, 8.0, 16.0, 20.0, 24.0}) {
    testing::add_box(soup, "box", {x, 0, 0}, {x + 1, 1, 1});
  }
  testing::add_box(soup, "wall", {12, -30, -30}, {13, 30, 30});
  const Scene scene(soup);
  const Skeleton skeleton = build_skeleton(scene, {});
  int in_line = 0;
  for (const SkeletonNode& node : skeleton.nodes) {
    int before = 0;
    int behind = 0;
    for (const Generator& x : skeleton.generators(node)) {
      if (x.kind != GeneratorKind::Vertex) continue;
      (scene.point(x.id)[0] < 12 ? before : behind) += 1;
    }
    in_line += before >= 6 || behind >= 6 ? 1 : 0;
    EXPECT_TRUE(before == 0 || behind == 0 || node.kind != NodeKind::Degenerate);
  }
  EXPECT_EQ(in_line, 8);
}

// A box in which the lower half of a swarm of polytopes is buried.
TEST(BuriedStretches, HaveNoArcs) {
  for (const std::uint64_t seed : {1, 2}) {
    PolygonSoup soup = testing::random_polytopes(seed, 24, {.density = 0.1});
    const std::array<Point, 2> bounds = Scene(soup).bounds();
    const double ground = 0.5 * (bounds[0][2] + bounds[1][2]);
    const Point low = bounds[0] - Point::Ones();
    const Point high(bounds[1][0] + 1, bounds[1][1] + 1, ground);
    testing::add_box(soup, "ground", low, high);
    for (const EventMode events : {EventMode::Solid, EventMode::Polygon}) {
      SkeletonRequest request;
      request.events = events;
      const Scene scene(soup);
      const Skeleton skeleton = build_skeleton(scene, request);
      const std::span<const SkeletonArc> arcs = skeleton.eee();
      EXPECT_GT(arcs.size(), 50u);
      const auto buried = [&](const SkeletonArc& arc) {
        const auto& ends = scene.edges()[arc.edges()[0]].points;
        const double z0 = scene.point(ends[0])[2];
        const double z1 = scene.point(ends[1])[2];
        const double z = z0 + 0.5 * (arc.range[0] + arc.range[1]) * (z1 - z0);
        return low[2] < z && z < ground;
      };
      EXPECT_EQ(std::count_if(arcs.begin(), arcs.end(), buried), 0) << seed;
    }
  }
}

}  // namespace
}  // namespace sightline
