// The FF nodes against brute force, and what facets of several faces, of several
// intervals, coplanar and touching ones give.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "linespace/scene.h"
#include "skeleton/build.h"
#include "skeleton/skeleton_index.h"
#include "tests/support/eee_scenes.h"
#include "tests/support/library_skeleton.h"
#include "tests/support/naive_ev.h"
#include "tests/support/naive_ff.h"

namespace sightline {
namespace {

using testing::NodeKey;

SkeletonRequest only_ff() {
  SkeletonRequest request;
  request.ev = request.eee = false;
  request.ff = true;
  return request;
}

std::vector<NodeKey> ff_nodes(const PolygonSoup& soup) {
  const Scene scene(soup);
  auto nodes = testing::canonical(scene, build_skeleton(scene, only_ff())).nodes;
  std::erase_if(nodes, [](const NodeKey& n) { return n.kind != "FF"; });
  return nodes;
}

/// `count` equal ones of these nodes?  Told by kind and number only.
int count_of(const Skeleton& skeleton, NodeKind kind) {
  return static_cast<int>(std::ranges::count(skeleton.nodes, kind, &SkeletonNode::kind));
}

TEST(FacePairs, AllOfRandomPolytopes) {
  std::size_t total = 0;
  int scenes = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const PolygonSoup soup = testing::eee_scene(seed);
    std::vector<NodeKey> naive;
    try {
      naive = testing::naive_ff(soup);
    } catch (const testing::NotGeneral&) {
      continue;
    }
    ++scenes;
    EXPECT_TRUE(ff_nodes(soup) == naive);
    total += naive.size();
  }
  std::printf("%zu FF nodes in %d scenes\n", total, scenes);
  EXPECT_GE(scenes, 38);
  EXPECT_GT(total, 400u);
}

TEST(FacePairs, AllOfCities) {
  std::size_t total = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const PolygonSoup soup = testing::city(seed, 120);
    const std::vector<NodeKey> naive = testing::naive_ff(soup);
    EXPECT_TRUE(ff_nodes(soup) == naive);
    total += naive.size();
  }
  std::printf("%zu FF nodes\n", total);
  EXPECT_GT(total, 20u);
}

TEST(FacePairs, EndNoArcs) {
  const Scene scene(testing::eee_scene(4));
  SkeletonRequest request;
  request.ff = true;
  const Skeleton skeleton = build_skeleton(scene, request);
  EXPECT_GT(count_of(skeleton, NodeKind::FF), 0);
  EXPECT_TRUE(SkeletonIndex(scene, skeleton).check_invariants().empty());
}

TEST(FacePairs, ThreadsChangeNothing) {
  const Scene scene(testing::eee_scene(11));
  SkeletonRequest request = only_ff();
  request.threads = 1;
  const Skeleton one = build_skeleton(scene, request);
  request.threads = 4;
  const Skeleton four = build_skeleton(scene, request);
  ASSERT_GT(one.nodes.size(), 0u);
  EXPECT_EQ(one.generator_pool, four.generator_pool);
}

/// A wall in the plane z = 0 as a union of rectangles, two triangles each, and a vertical
/// wall x = 1 far below it whose plane cuts the first.
PolygonSoup two_walls(const std::vector<std::array<double, 4>>& rectangles) {
  PolygonSoup soup;
  PolygonSoup::Group flat{"flat", {}}, upright{"upright", {}};
  const auto add = [&](PolygonSoup::Group& group, const std::vector<Point>& points) {
    std::vector<int> polygon;
    for (const Point& p : points) {
      polygon.push_back(static_cast<int>(soup.vertices.size()));
      soup.vertices.push_back(p);
    }
    group.faces.push_back(static_cast<int>(soup.polygons.size()));
    soup.polygons.push_back(polygon);
  };
  for (const auto& [x0, y0, x1, y1] : rectangles) {
    add(flat, {{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}});
    add(flat, {{x0, y0, 0}, {x1, y1, 0}, {x0, y1, 0}});
  }
  add(upright, {{1, -9, -1}, {1, -8, -1}, {1, -8, 1}, {1, -9, 1}});
  soup.groups = {flat, upright};
  return soup;
}

// The line x = 1, z = 0 crosses both prongs of a U and the gap between: one node.
TEST(FacePairs, AFacetCrossedTwiceIsOneNode) {
  const PolygonSoup soup =
      two_walls({{0, 0, 1, 1}, {1, 0, 2, 1}, {0, 1, 1, 2}, {0, 2, 1, 3}, {1, 2, 2, 3}});
  // Along the seam between the left column, which goes through, and the prongs.
  const Scene seam(soup);
  const Skeleton at_seam = build_skeleton(seam, only_ff());
  ASSERT_EQ(at_seam.nodes.size(), 1u);
  EXPECT_EQ(at_seam.nodes[0].kind, NodeKind::Degenerate);  // along an edge of the U too
  PolygonSoup moved = soup;
  for (Point& p : moved.vertices) {
    if (p[1] < -5) p[0] = 1.5;
  }
  const Scene scene(moved);
  const Skeleton skeleton = build_skeleton(scene, only_ff());
  ASSERT_EQ(skeleton.nodes.size(), 1u);
  EXPECT_EQ(skeleton.nodes[0].kind, NodeKind::FF);
  EXPECT_FALSE(skeleton.nodes[0].self);
  EXPECT_EQ(skeleton.generators(skeleton.nodes[0]).size(), 2u);
  EXPECT_EQ(std::minmax(skeleton.nodes[0].segment[0][1], skeleton.nodes[0].segment[1][1]),
            std::minmax(-9.0, 3.0));
}

// Along the flat edge between two triangles of a facet: its inside all the same.
TEST(FacePairs, AFlatEdgeIsInside) {
  const Scene scene(two_walls({{0, 0, 1, 1}, {1, 0, 2, 1}}));
  const Skeleton skeleton = build_skeleton(scene, only_ff());
  ASSERT_EQ(skeleton.nodes.size(), 1u);
  EXPECT_EQ(skeleton.nodes[0].kind, NodeKind::FF);
}

// Along the facet's boundary: not across its inside.
TEST(FacePairs, ABoundaryIsNotInside) {
  const Scene scene(two_walls({{1, 0, 2, 1}}));
  EXPECT_TRUE(build_skeleton(scene, only_ff()).nodes.empty());
}

TEST(FacePairs, CoplanarAndParallelFacetsHaveNone) {
  const Scene scene(testing::boxes_soup(
      {{{0, 0, 0}, {1, 1, 1}}, {{3, 0, 0}, {4, 1, 1}}, {{6, 0, 0}, {7, 1, 1}}}));
  EXPECT_TRUE(build_skeleton(scene, only_ff()).nodes.empty());
}

// A tall box on a wide slab: lines in the slab's sides cross no wall, those in a wall
// that come down end at the slab.  Another box above decides only lines that stand free.
TEST(FacePairs, LinesThatEnterASolidAtAFootAreNone) {
  const PolygonSoup soup = testing::boxes_soup(
      {{{0, 0, 0}, {9, 9, 1}}, {{2, 2, 1}, {3, 3, 4}}, {{5, 2.5, 5}, {6, 3.5, 6}}});
  // The plane y = 2.5 of the upper box crosses the lower box's walls x = 2 and x = 3 in
  // lines that come down to the slab.
  EXPECT_EQ(ff_nodes(soup), testing::naive_ff(soup));
  for (const NodeKey& node : ff_nodes(soup)) {
    for (const auto& face : node.generators) {
      EXPECT_FALSE(std::ranges::all_of(face.points, [](const auto& p) {
        return p[0] == 2 && p[2] <= 4;
      })) << "a line down the wall x = 2";
    }
  }
}

}  // namespace
}  // namespace sightline
