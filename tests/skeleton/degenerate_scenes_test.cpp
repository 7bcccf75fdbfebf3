// Scenes where everything lines up: a line is one node whatever found it, every node of
// general position ends as many arcs as there, and sets of lines that meet four edges all
// along are defined (docs/degenerate_scenes.md).

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "linespace/scene.h"
#include "skeleton/build.h"
#include "tests/support/generators.h"
#include "tests/support/library_skeleton.h"

namespace sightline {
namespace {

std::vector<int> ends_at(const Skeleton& skeleton) {
  std::vector<int> ends(skeleton.nodes.size());
  for (const SkeletonArc& arc : skeleton.eee()) {
    for (const std::uint32_t node : arc.nodes) ++ends[node];
  }
  return ends;
}

// Before lines were named by all their contacts, 333 EEEE nodes of the grid of 300 ended
// one arc, 234 EVE nodes none.
TEST(DegenerateScenes, NodesOfGeneralPositionInGridsEndTwoArcs) {
  std::map<NodeKind, int> counts;
  for (const auto& [seed, polygons] : {std::pair(1, 100), {2, 150}, {1, 240}}) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed << ", " << polygons);
    const Scene scene(testing::grid_city(seed, polygons));
    const Skeleton skeleton = build_skeleton(scene);
    const std::vector<int> ends = ends_at(skeleton);
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const SkeletonNode& node = skeleton.nodes[i];
      if (node.kind != NodeKind::EEEE && node.kind != NodeKind::EVE &&
          node.kind != NodeKind::VEE && node.kind != NodeKind::FEE) {
        continue;
      }
      ++counts[node.kind];
      EXPECT_EQ(ends[i], node.end ? 1 : 2) << testing::node_name(node.kind);
    }
  }
  EXPECT_GT(counts[NodeKind::EEEE], 500);
  EXPECT_GT(counts[NodeKind::EVE], 200);
  EXPECT_GT(counts[NodeKind::VEE], 1000);
  EXPECT_GT(counts[NodeKind::FEE], 100);
}

// No two nodes with the same contacts, but for the two lines through the same edges and
// for lines that end on one side.
TEST(DegenerateScenes, NoLineIsTwoNodes) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const Scene scene(testing::grid_city(seed, 120));
    const Skeleton skeleton = build_skeleton(scene);
    std::map<std::pair<std::vector<Generator>, int>, std::size_t> known;
    int irrational = 0;
    for (std::size_t i = 0; i < skeleton.nodes.size(); ++i) {
      const SkeletonNode& node = skeleton.nodes[i];
      const auto g = skeleton.generators(node);
      std::vector<Generator> key(g.begin(), g.end());
      key = std::min(key, std::vector<Generator>(key.rbegin(), key.rend()));
      const int which = 4 * node.end + 2 * node.second + (node.kind == NodeKind::EEEE);
      EXPECT_TRUE(known.try_emplace({key, which}, i).second)
          << testing::node_name(node.kind) << " of " << g.size() << " generators";
      irrational += node.kind == NodeKind::Degenerate && node.second;
    }
    EXPECT_GT(known.size(), 1000u);
    std::printf("%d of the second line through five edges or more\n", irrational);
  }
}

/// A bar with an edge from `from` to `to`, above it.
void add_bar(PolygonSoup& soup, const Point& from, const Point& to) {
  const int n = static_cast<int>(soup.vertices.size());
  for (const Point& p : {from, to}) {
    soup.vertices.push_back(p);
    soup.vertices.push_back(p + Point(0, -0.125, 8));
    soup.vertices.push_back(p + Point(0, 0.125, 8));
  }
  const int first = static_cast<int>(soup.polygons.size());
  for (const std::vector<int>& f : std::vector<std::vector<int>>{
           {0, 1, 2}, {3, 5, 4}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}}) {
    std::vector<int> face;
    for (const int v : f) face.push_back(n + v);
    soup.polygons.push_back(face);
  }
  PolygonSoup::Group group{"bar" + std::to_string(soup.groups.size()), {}};
  for (int k = 0; k < 5; ++k) group.faces.push_back(first + k);
  soup.groups.push_back(group);
}

// With the solids in another order.
PolygonSoup shuffled(const PolygonSoup& soup, std::uint64_t seed) {
  testing::Random random(seed);
  std::vector<PolygonSoup::Group> groups = soup.groups;
  random.shuffle(groups);
  PolygonSoup out = soup;
  out.polygons.clear();
  out.groups.clear();
  for (PolygonSoup::Group& group : groups) {
    for (int& f : group.faces) {
      out.polygons.push_back(soup.polygons[f]);
      f = static_cast<int>(out.polygons.size()) - 1;
    }
    out.groups.push_back(group);
  }
  return out;
}

// The lines of the degenerate nodes, from the lower end.
std::vector<std::array<testing::Coordinates, 2>> degenerate_lines(
    const Skeleton& skeleton) {
  std::vector<std::array<testing::Coordinates, 2>> lines;
  for (const SkeletonNode& node : skeleton.nodes) {
    if (node.kind != NodeKind::Degenerate) continue;
    std::array<testing::Coordinates, 2> line;
    for (int k = 0; k < 2; ++k) {
      const Point& p = node.segment[k];
      line[k] = {p[0] + 0.0, p[1] + 0.0, p[2] + 0.0};  // no -0
    }
    std::ranges::sort(line);
    lines.push_back(line);
  }
  std::ranges::sort(lines);
  return lines;
}

// Solids that share walls, edges and corners: every line is one node, every pencil in a
// wall's plane an arc between the same two lines, however the solids are listed.  (Where
// edges of two solids cross lines were two nodes or one, two lines of a pencil that make
// the same contacts one or two, and arcs missed an end at a crossing of sides.)
TEST(DegenerateScenes, TouchingSolidsHaveTheSameSkeletonInAnyOrder) {
  std::vector<PolygonSoup> soups;
  for (const std::uint64_t seed : {0, 4, 14, 18}) {
    soups.push_back(testing::grid_city(seed, 48, {.may_touch = true}));
  }
  for (const std::uint64_t seed : {3, 4, 7, 14, 22}) {
    soups.push_back(testing::random_boxes(
        seed, 10, {.grid = 8, .may_touch = true, .min_size = 1, .max_size = 4}));
  }
  for (const PolygonSoup& soup : soups) {
    for (const EventMode events : {EventMode::Solid, EventMode::Polygon}) {
      SCOPED_TRACE(::testing::Message()
                   << soup.source
                   << (events == EventMode::Solid ? "" : ", polygon mode"));
      SkeletonRequest request;
      request.events = events;
      const auto of = [&](const PolygonSoup& given) {
        const Scene scene(given);
        const Skeleton skeleton = build_skeleton(scene, request);
        return std::pair(testing::canonical(scene, skeleton), degenerate_lines(skeleton));
      };
      const auto [first, first_lines] = of(soup);
      for (const std::uint64_t order : {2, 3, 4}) {
        const auto [now, lines] = of(shuffled(soup, order));
        EXPECT_EQ(testing::difference(first, "as given", now, "in another order"), "")
            << "order " << order;
        EXPECT_TRUE(lines == first_lines) << "order " << order;
      }
    }
  }
}

// Four edges of one ruled surface: the lines of its other family meet all four.  They are
// an arc of each triple, once each, and end together.
TEST(DegenerateScenes, BarsOnARegulus) {
  for (const bool reversed : {false, true}) {
    PolygonSoup soup;
    for (int k = 0; k < 4; ++k) {
      const double c = reversed ? 3 - k : k;
      // A ruling y = c of the saddle z = x y; below them those with x constant.
      const double reach = 1 + 0.25 * c;
      add_bar(soup, {-reach, c, -reach * c}, {reach, c, reach * c});
    }
    const Scene scene(soup);
    const auto ruling = [&](int edge) {  // c of a ruling, -1 for other edges
      const auto& p = scene.edges()[edge].points;
      const Point& a = scene.point(p[0]);
      const Point& b = scene.point(p[1]);
      if (a[1] != b[1] || a[2] != a[0] * a[1] || b[2] != b[0] * b[1]) return -1;
      return static_cast<int>(a[1]);
    };
    const Skeleton skeleton = build_skeleton(scene);
    std::map<std::array<int, 3>, std::vector<double>> arcs;
    std::map<std::uint32_t, int> ends;
    for (const SkeletonArc& arc : skeleton.eee()) {
      std::array<int, 3> c{};
      for (int k = 0; k < 3; ++k) c[k] = ruling(arc.edges()[k]);
      if (*std::min_element(c.begin(), c.end()) < 0) continue;
      const double reach = 1 + 0.25 * c[0];
      const auto& p = scene.edges()[arc.edges()[0]].points;
      const double x0 = scene.point(p[0])[0];
      const double x1 = scene.point(p[1])[0];
      EXPECT_EQ(std::abs(x0), reach);
      if (c[0] > c[2]) std::swap(c[0], c[2]);
      for (const double s : arc.range) arcs[c].push_back(x0 + s * (x1 - x0));
      for (const std::uint32_t node : arc.nodes) ++ends[node];
    }
    // Each triple's lines reach as far as its shortest edge, past ends of others.
    ASSERT_EQ(arcs.size(), 4u);
    for (auto& [c, x] : arcs) {
      SCOPED_TRACE(::testing::Message() << c[0] << c[1] << c[2]);
      std::sort(x.begin(), x.end());
      const double reach = 1 + 0.25 * c[0];
      ASSERT_EQ(x.size(), 2u);
      EXPECT_NEAR(x[0], -reach, 1e-12);
      EXPECT_NEAR(x[1], reach, 1e-12);
    }
    // Three arcs end at x = 1 and at x = -1: lines through a corner of the shortest bar
    // that meet the three others.
    int together = 0;
    for (const auto& [node, count] : ends) {
      if (count != 3) continue;
      ++together;
      EXPECT_EQ(skeleton.nodes[node].kind, NodeKind::Degenerate);
      EXPECT_EQ(skeleton.nodes[node].generator_count, 4u);
    }
    EXPECT_EQ(together, 2);
  }
}

// The lines (0, a, 2 b) + u (1, b, a) meet x = u, z = u y for u = sqrt 2 and - sqrt 2,
// two irrational lines.  Five such edges: one node on each, whatever four found it.
TEST(DegenerateScenes, IrrationalLinesThroughFiveEdges) {
  for (const double low : {1.0, -2.0}) {
    for (const bool reversed : {false, true}) {
      std::vector<std::array<double, 2>> bars = {
          {0, 0}, {2, 0.25}, {4, -0.25}, {6, 0.5}, {8, 0}};
      if (reversed) std::reverse(bars.begin(), bars.end());
      PolygonSoup soup;
      std::set<std::array<double, 3>> starts;
      for (const auto& [a, b] : bars) {
        const auto at = [&](double u) { return Point(u, a + b * u, 2 * b + a * u); };
        add_bar(soup, at(low), at(2));
        starts.insert({at(2)[0], at(2)[1], at(2)[2]});
      }
      const Scene scene(soup);
      const auto is_bar = [&](const Generator& g) {
        if (g.kind != GeneratorKind::Edge) return false;
        const auto& p = scene.edges()[g.id].points;
        return std::any_of(p.begin(), p.end(), [&](int id) {
          const Point& x = scene.point(id);
          const Point& y = scene.point(p[0] == id ? p[1] : p[0]);
          return starts.contains({x[0], x[1], x[2]}) && y[0] == low;
        });
      };
      const Skeleton skeleton = build_skeleton(scene);
      const std::vector<int> ends = ends_at(skeleton);
      std::vector<std::pair<bool, int>> found;  // which, arcs
      for (std::size_t i = 0; i < ends.size(); ++i) {
        const SkeletonNode& node = skeleton.nodes[i];
        const auto g = skeleton.generators(node);
        if (g.size() < 4 || !std::all_of(g.begin(), g.end(), is_bar)) continue;
        EXPECT_EQ(g.size(), 5u) << testing::node_name(node.kind);
        EXPECT_EQ(node.kind, NodeKind::Degenerate);
        found.emplace_back(node.second, ends[i]);
        for (const Point& p : node.segment) {
          EXPECT_NEAR(std::abs(p[0]), std::sqrt(2), 1e-12);
        }
        std::printf("second %d: %d arcs\n", node.second, ends[i]);
      }
      std::sort(found.begin(), found.end());
      ASSERT_EQ(found.size(), low == 1 ? 1u : 2u);
      EXPECT_TRUE(found.back().first);
      for (const auto& [second, count] : found) EXPECT_GT(count, 2);
      if (found.size() == 2) {
        EXPECT_FALSE(found.front().first);
      }
    }
  }
}

// Edges of which the middle one is coplanar with both others: a line that meets all three
// lies in one plane with them or passes a common point of two, so no arc has them.
TEST(DegenerateScenes, NoArcHasAMiddleEdgeCoplanarWithBothOthers) {
  // A row of boxes of one height, and one shifted up and aside.
  const Scene scene(testing::boxes_soup({{{0, 0, 0}, {4, 1, 1}},
                                         {{0, 3, 0}, {4, 4, 1}},
                                         {{0, 6, 0}, {4, 7, 1}},
                                         {{1, 9, 1}, {5, 10, 2}}}));
  const Skeleton skeleton = build_skeleton(scene);
  const auto coplanar = [&](int e, int f) {
    const auto& p = scene.edges()[e].points;
    const auto& q = scene.edges()[f].points;
    return orient3d(scene.point(p[0]), scene.point(p[1]), scene.point(q[0]),
                    scene.point(q[1])) == Sign::Zero;
  };
  EXPECT_GT(skeleton.eee().size(), 20u);
  std::set<std::pair<std::array<std::int32_t, 3>, double>> known;
  for (const SkeletonArc& arc : skeleton.eee()) {
    EXPECT_FALSE(coplanar(arc.edges()[0], arc.edges()[1]) &&
                 coplanar(arc.edges()[1], arc.edges()[2]));
    EXPECT_TRUE(known.insert({arc.edges(), arc.range[0]}).second) << "twice";
  }
}

}  // namespace
}  // namespace sightline
