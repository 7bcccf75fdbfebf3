// Boxes sunk into a slab make the same union as boxes that stand on it.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "linespace/scene.h"
#include "skeleton/skeleton.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

// The corner, the edge's two ends with feet at height 0, and where the arc ends.
using Arc = std::array<double, 15>;

// EV arcs, sorted, but for those whose lines lie in the plane of the slab's top.
std::vector<Arc> arcs_off_the_ground(const PolygonSoup& soup) {
  const Scene scene(soup);
  const Skeleton skeleton = build_ev_skeleton(scene);
  std::vector<Arc> arcs;
  for (const SkeletonArc& a : skeleton.arcs) {
    const auto& ends = scene.edges()[a.edge].points;
    const Point& v = scene.point(a.vertex);
    Point e0 = scene.point(ends[0]);
    Point e1 = scene.point(ends[1]);
    if (v[2] == 0 && e0[2] == 0 && e1[2] == 0) continue;
    std::array<Point, 2> at{e0 + a.range[0] * (e1 - e0), e0 + a.range[1] * (e1 - e0)};
    for (Point* p : {&e0, &e1}) {
      if ((*p)[2] == -1) (*p)[2] = 0;
    }
    const auto before = [](const Point& p, const Point& q) {
      return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
    };
    if (before(e1, e0)) std::swap(e0, e1), std::swap(at[0], at[1]);
    Arc arc;
    auto next = arc.begin();
    for (const Point& p : {v, e0, e1, at[0], at[1]}) {
      next = std::copy(p.begin(), p.end(), next);
    }
    arcs.push_back(arc);
  }
  std::sort(arcs.begin(), arcs.end());
  return arcs;
}

TEST(SunkBoxes, HaveTheArcsOfStandingOnesOffTheGround) {
  for (const bool square : {false, true}) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      const auto arcs = [&](double bottom) {
        return arcs_off_the_ground(
            testing::street_city(seed, 60, {.square = square, .bottom = bottom}));
      };
      const std::vector<Arc> standing = arcs(0);
      const std::vector<Arc> sunk = arcs(-1);
      EXPECT_GT(standing.size(), 500u);
      ASSERT_EQ(standing.size(), sunk.size()) << square << " " << seed;
      for (std::size_t i = 0; i < sunk.size(); ++i) {
        for (std::size_t k = 0; k < sunk[i].size(); ++k) {
          // Parameters are off by kRangeError at most, coordinates are below 64.
          ASSERT_NEAR(standing[i][k], sunk[i][k], 64 * 2 * kRangeError);
        }
      }
    }
  }
}

}  // namespace
}  // namespace sightline
