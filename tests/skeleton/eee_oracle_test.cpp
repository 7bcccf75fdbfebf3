// The EEE arcs and their nodes against a naive oracle, arc by arc and node by node, and
// what holds for them in every scene: two ends, the same whatever the order, the axes,
// the scale and the number of threads.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>

#include "linespace/scene.h"
#include "skeleton/build.h"
#include "tests/support/eee_scenes.h"
#include "tests/support/library_skeleton.h"
#include "tests/support/naive_eee.h"
#include "tests/support/naive_ev.h"

namespace sightline {
namespace {

using testing::CanonicalSkeleton;

Skeleton eee_skeleton(const Scene& scene, int threads = 0) {
  SkeletonRequest request;
  request.ev = false;
  request.threads = threads;
  return build_skeleton(scene, request);
}

TEST(EeeOracle, EveryArcAndNodeInGeneralPosition) {
  std::map<std::string, int> totals;
  int scenes = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const PolygonSoup soup = testing::eee_scene(seed);
    CanonicalSkeleton naive;
    try {
      naive = testing::naive_eee(soup);
    } catch (const testing::NotGeneral&) {
      continue;
    }
    ++scenes;
    const Scene scene(soup);
    const CanonicalSkeleton ours = testing::canonical(scene, eee_skeleton(scene));
    EXPECT_EQ(ours.counts(), naive.counts());
    EXPECT_EQ(testing::difference(ours, "the skeleton", naive, "the oracle"), "");
    for (const auto& [kind, count] : naive.counts()) totals[kind] += count;
    if (HasFailure()) break;
  }
  EXPECT_GE(scenes, 36) << "too many seeds are not in general position";
  for (const char* kind : {"VEE", "EVE", "EEEE", "FEE", "EEE"}) {
    std::printf("%s %d  ", kind, totals[kind]);
    EXPECT_GT(totals[kind], 100) << kind;
  }
  std::printf("in %d scenes\n", scenes);
}

/// Number of EEE arcs that end at each node.
std::vector<int> ends_at(const Skeleton& skeleton) {
  std::vector<int> ends(skeleton.nodes.size());
  for (const SkeletonArc& arc : skeleton.eee()) {
    for (const std::uint32_t node : arc.nodes) ++ends[node];
  }
  return ends;
}

bool ends_eee(NodeKind kind) {
  return kind == NodeKind::VEE || kind == NodeKind::EVE || kind == NodeKind::EEEE ||
         kind == NodeKind::FEE;
}

TEST(EeeOracle, EveryNodeOfLargerScenesEndsTwoArcs) {
  for (const int count : {20, 60}) {
    const Scene scene(testing::random_polytopes(count, count, {.density = 0.2}));
    const Skeleton skeleton = build_skeleton(scene);
    const std::vector<int> ends = ends_at(skeleton);
    std::size_t nodes = 0;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const bool should = ends_eee(skeleton.nodes[i].kind);
      nodes += should;
      EXPECT_EQ(ends[i], should ? 2 : 0) << testing::node_name(skeleton.nodes[i].kind);
      if (HasFailure()) return;
    }
    EXPECT_EQ(skeleton.eee().size(), nodes);
    EXPECT_GT(nodes, 1000u);
  }
}

// Buildings on a slab: walls parallel to each other, feet on the ground.  VEE nodes whose
// line ends at the foot of a building end one arc.
TEST(EeeOracle, EveryEeeeNodeOfACityEndsTwoArcs) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const Scene scene(testing::city(seed, 240));
    const Skeleton skeleton = build_skeleton(scene);
    const std::vector<int> ends = ends_at(skeleton);
    std::map<NodeKind, int> counts;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const SkeletonNode& node = skeleton.nodes[i];
      if (node.kind != NodeKind::EEEE && node.kind != NodeKind::EVE &&
          node.kind != NodeKind::VEE) {
        continue;
      }
      ++counts[node.kind];
      EXPECT_EQ(ends[i], node.end ? 1 : 2) << testing::node_name(node.kind);
      if (HasFailure()) return;
    }
    EXPECT_GT(counts[NodeKind::EEEE], 500);
    EXPECT_GT(counts[NodeKind::VEE], 1000);
  }
}

PolygonSoup moved(PolygonSoup soup, const testing::PointMap& map, bool mirrored) {
  for (Point& p : soup.vertices) p = map(p);
  if (mirrored) {
    for (auto& polygon : soup.polygons) std::reverse(polygon.begin(), polygon.end());
  }
  return soup;
}

TEST(EeeOracle, AxesSignsAndPowersOfTwoChangeNothing) {
  struct Motion {
    const char* name;
    testing::PointMap there, back;
    bool mirrored;
  };
  const Motion motions[] = {
      {"axes turned", [](const Point& p) { return Point(p[1], p[2], p[0]); },
       [](const Point& p) { return Point(p[2], p[0], p[1]); }, false},
      {"axes exchanged", [](const Point& p) { return Point(p[1], p[0], p[2]); },
       [](const Point& p) { return Point(p[1], p[0], p[2]); }, true},
      {"sign", [](const Point& p) { return Point(p[0], p[1], -p[2]); },
       [](const Point& p) { return Point(p[0], p[1], -p[2]); }, true},
      {"scale", [](const Point& p) { return Point(p * 0x1p-40); },
       [](const Point& p) { return Point(p * 0x1p40); }, false}};
  for (const bool aligned : {false, true}) {
    const PolygonSoup soup = aligned ? testing::city(7, 120) : testing::eee_scene(17);
    const Scene scene(soup);
    const CanonicalSkeleton here = testing::canonical(scene, build_skeleton(scene));
    for (const Motion& motion : motions) {
      SCOPED_TRACE(motion.name);
      const Scene other(moved(soup, motion.there, motion.mirrored));
      EXPECT_EQ(
          testing::difference(
              here, "here", testing::canonical(other, build_skeleton(other), motion.back),
              "there"),
          "");
    }
    // Vertices, polygons and groups in reverse.
    PolygonSoup reversed;
    reversed.vertices.assign(soup.vertices.rbegin(), soup.vertices.rend());
    const int last = static_cast<int>(soup.vertices.size()) - 1;
    reversed.polygons.assign(soup.polygons.rbegin(), soup.polygons.rend());
    for (auto& polygon : reversed.polygons) {
      for (int& v : polygon) v = last - v;
    }
    const int last_polygon = static_cast<int>(soup.polygons.size()) - 1;
    for (auto group = soup.groups.rbegin(); group != soup.groups.rend(); ++group) {
      reversed.groups.push_back(
          {group->name, {group->faces.rbegin(), group->faces.rend()}});
      for (int& f : reversed.groups.back().faces) f = last_polygon - f;
    }
    const Scene other(reversed);
    EXPECT_EQ(
        testing::difference(here, "here",
                            testing::canonical(other, build_skeleton(other)), "reversed"),
        "");
  }
}

TEST(EeeOracle, ThreadsChangeNothing) {
  const Scene scene(testing::eee_scene(5));
  const Skeleton one = eee_skeleton(scene, 1), four = eee_skeleton(scene, 4);
  ASSERT_EQ(one.eee().size(), four.eee().size());
  for (std::size_t i = 0; i < one.eee().size(); ++i) {
    EXPECT_EQ(one.eee()[i].generators, four.eee()[i].generators);
    EXPECT_EQ(one.eee()[i].range, four.eee()[i].range);
    EXPECT_EQ(one.eee()[i].nodes, four.eee()[i].nodes);
  }
}

// What is asked for between some objects is that part of the whole.
TEST(EeeOracle, APartIsThatPartOfTheWhole) {
  const Scene scene(
      testing::random_polytopes(3, 12, {.max_vertices = 8, .density = 0.25}));
  const Skeleton whole = eee_skeleton(scene);
  const auto object = [&](std::int32_t e) { return scene.edges()[e].object; };
  const auto described = [&](const SkeletonArc& a) {
    return std::tuple(a.edges(), a.range[0], a.range[1]);
  };
  SkeletonRequest between;
  between.ev = false;
  between.part.outer_objects = {std::vector<int>{1, 2}, std::vector<int>{5, 7}};
  SkeletonRequest through;
  through.ev = false;
  through.part.through_objects = {4};
  std::vector<std::tuple<std::array<std::int32_t, 3>, double, double>> expected[2];
  const auto in = [](int o, std::initializer_list<int> set) {
    return std::find(set.begin(), set.end(), o) != set.end();
  };
  for (const SkeletonArc& a : whole.eee()) {
    const int first = object(a.edges()[0]), last = object(a.edges()[2]);
    if ((in(first, {1, 2}) && in(last, {5, 7})) ||
        (in(last, {1, 2}) && in(first, {5, 7}))) {
      expected[0].push_back(described(a));
    }
    if (first == 4 || object(a.edges()[1]) == 4 || last == 4) {
      expected[1].push_back(described(a));
    }
  }
  EXPECT_GT(expected[0].size(), 10u);
  EXPECT_GT(expected[1].size(), 100u);
  int k = 0;
  for (const SkeletonRequest& request : {between, through}) {
    std::vector<std::tuple<std::array<std::int32_t, 3>, double, double>> found;
    const Skeleton part = build_skeleton(scene, request);
    for (const SkeletonArc& a : part.eee()) {
      found.push_back(described(a));
    }
    EXPECT_EQ(found, expected[k++]);
  }
}

}  // namespace
}  // namespace sightline
