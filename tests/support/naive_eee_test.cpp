// The naive EEE skeleton against counts worked out by hand, and the laws it must keep.

#include "tests/support/naive_eee.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <string>

#include "tests/support/eee_scenes.h"
#include "tests/support/generators.h"
#include "tests/support/naive_ev.h"

namespace sightline::testing {
namespace {

void add_solid(PolygonSoup& soup, const std::vector<Point>& points,
               const std::vector<std::vector<int>>& faces) {
  const int first = static_cast<int>(soup.vertices.size());
  soup.vertices.insert(soup.vertices.end(), points.begin(), points.end());
  PolygonSoup::Group group{"solid" + std::to_string(soup.groups.size()), {}};
  for (std::vector<int> face : faces) {
    for (int& v : face) v += first;
    group.faces.push_back(static_cast<int>(soup.polygons.size()));
    soup.polygons.push_back(std::move(face));
  }
  soup.groups.push_back(std::move(group));
}

/// A thin triangular prism with a long axis from p to q.  Coordinates in multiples of
/// 2^-12, so that its quads are planar.
void add_bar(PolygonSoup& soup, const Point& p, const Point& q, Random& random) {
  const auto fine = [](Point x) -> Point {
    return (x * 0x1p12).array().round().matrix() * 0x1p-12;
  };
  const Point axis = fine(q - p);
  Point u = axis.cross(random.direction());
  u *= 0.02 / u.norm();
  const Point v = axis.cross(u) / axis.norm();
  std::vector<Point> points = {fine(p + u), fine(p - u / 2 + v), fine(p - u / 2 - v)};
  for (int i = 0; i < 3; ++i) points.push_back(points[i] + axis);
  add_solid(soup, points,
            {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}});
}

/// Four bars, each across the x axis at one end, if it reaches so far, and across the
/// line { x = 0, z = 4 } at the other.  No other line meets all four axes: of the four
/// points on either line the cross ratios are 10/7 and 1/6, so the axes are not on one
/// regulus.  Heights z = 4 h; a bar reaches from h = low to h = high.
PolygonSoup four_bars(std::array<double, 4> low, std::array<double, 4> high) {
  const std::array x = {-3.0, -1.0, 1.0, 4.0}, y = {2.0, -3.0, 1.0, -1.0};
  PolygonSoup soup;
  Random random(1);
  for (int i = 0; i < 4; ++i) {
    const auto at = [&](double h) { return Point(x[i] * (1 - h), y[i] * h, 4 * h); };
    add_bar(soup, at(low[i]), at(high[i]), random);
  }
  return soup;
}

/// Nodes of a kind by the groups (by number) along the line, in the smaller order.
std::map<std::vector<int>, int> by_groups(const PolygonSoup& soup,
                                          const CanonicalSkeleton& skeleton,
                                          const std::string& kind) {
  std::map<Coordinates, int> group_of;
  for (std::size_t g = 0; g < soup.groups.size(); ++g) {
    for (const int f : soup.groups[g].faces) {
      for (const int v : soup.polygons[f]) {
        const Point& p = soup.vertices[v];
        group_of[{p[0] + 0.0, p[1] + 0.0, p[2] + 0.0}] = static_cast<int>(g);
      }
    }
  }
  std::map<std::vector<int>, int> result;
  for (const NodeKey& node : skeleton.nodes) {
    if (node.kind != kind) continue;
    std::vector<int> groups;
    for (const GeneratorKey& g : node.generators) groups.push_back(group_of[g.points[0]]);
    const std::vector<int> reversed(groups.rbegin(), groups.rend());
    ++result[std::min(groups, reversed)];
  }
  return result;
}
using Counts = std::map<std::vector<int>, int>;

// Near a line that meets four thin bars there is, for each choice of one side of each
// bar, one line that touches all four on these sides: sixteen.
TEST(NaiveEee, SixteenLinesTouchFourBarsAroundEachLineThatMeetsThem) {
  const double a = -0.2, b = 1.2;  // across both lines
  const PolygonSoup both = four_bars({a, a, a, a}, {b, b, b, b});
  EXPECT_EQ(by_groups(both, naive_eee(both), "EEEE"),
            (Counts{{{0, 1, 2, 3}, 16}, {{0, 2, 3, 1}, 16}}));
  // One bar does not reach the second line, or the first.
  const PolygonSoup first = four_bars({a, a, a, a}, {b, 0.8, b, b});
  EXPECT_EQ(by_groups(first, naive_eee(first), "EEEE"), (Counts{{{0, 1, 2, 3}, 16}}));
  const PolygonSoup second = four_bars({a, 0.2, a, a}, {b, b, b, b});
  EXPECT_EQ(by_groups(second, naive_eee(second), "EEEE"), (Counts{{{0, 2, 3, 1}, 16}}));
  const PolygonSoup none = four_bars({a, 0.2, a, a}, {b, b, 0.8, b});
  EXPECT_EQ(by_groups(none, naive_eee(none), "EEEE"), Counts{});
}

// A plate across the first line takes its sixteen lines away if it stands between the
// outer contacts, and none of them if it stands beyond.
TEST(NaiveEee, LinesAreFreeBetweenTheirOuterContacts) {
  for (const double x : {-5.0, -2.0, 0.1, 2.0, 6.0}) {
    PolygonSoup soup = four_bars({-0.2, -0.2, -0.2, -0.2}, {1.2, 1.2, 1.2, 1.2});
    add_solid(soup,
              {{x, 0.5, -0.375},
               {x, -0.375, -0.4375},
               {x + 0.0625, 0.125, 0.4375},
               {x + 0.125, 0.0625, -0.125}},
              {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}});
    Counts counts = by_groups(soup, naive_eee(soup), "EEEE");
    EXPECT_EQ((counts[{0, 1, 2, 3}]), x < -3 || x > 4 ? 16 : 0) << x;
    EXPECT_EQ((counts[{0, 2, 3, 1}]), 16) << x;
  }
}

// That arcs end at nodes found independently, each node ending two, is checked inside;
// every kind must occur for that to mean anything.
TEST(NaiveEee, KeepsItsIdentity) {
  std::map<std::string, int> totals;
  int scenes = 0;
  for (const std::uint64_t seed : {1, 2, 3, 8, 13, 20, 21, 25, 27, 30, 31, 32}) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    CanonicalSkeleton s;
    try {
      s = naive_eee(eee_scene(seed));
    } catch (const NotGeneral&) {
      continue;
    }
    ++scenes;
    auto n = s.counts();
    EXPECT_EQ(n["EEE"], n["VEE"] + n["EVE"] + n["EEEE"] + n["FEE"]);
    for (const auto& [kind, count] : n) totals[kind] += count;
    std::map<NodeKey, int> ends;
    for (const NodeKey& node : s.nodes) ends[node] -= 2;
    for (const ArcKey& arc : s.arcs) {
      EXPECT_EQ(arc.kind, "EEE");
      EXPECT_EQ(arc.generators.size(), 3u);
      for (const NodeKey& node : arc.nodes) ++ends[node];
    }
    for (const auto& [node, missing] : ends) EXPECT_EQ(missing, 0) << node.kind;
  }
  EXPECT_GE(scenes, 11);
  EXPECT_EQ(totals.size(), 5u);
  for (const auto& [kind, count] : totals) EXPECT_GT(count, 20) << kind;
}

TEST(NaiveEee, AgreesWithNaiveEvOnVertexNodes) {
  const PolygonSoup soup = eee_scene(20);
  const auto vertex_nodes = [](const CanonicalSkeleton& s) {
    CanonicalSkeleton result;
    std::ranges::copy_if(s.nodes, std::back_inserter(result.nodes), [](const NodeKey& n) {
      return n.kind == "VEE" || n.kind == "EVE";
    });
    return result;
  };
  EXPECT_EQ(difference(vertex_nodes(naive_eee(soup)), "EEE", vertex_nodes(naive_ev(soup)),
                       "EV"),
            "");
}

/// Axis i of the result is axis (i + turn) % 3 of the soup, mirrored where `mirror`.
PolygonSoup moved(PolygonSoup soup, int turn, bool mirror) {
  for (Point& p : soup.vertices) {
    p = Point(p[turn % 3], p[(turn + 1) % 3], p[(turn + 2) % 3]);
    if (mirror) std::swap(p[0], p[1]);
  }
  if (mirror) {
    for (auto& polygon : soup.polygons) std::ranges::reverse(polygon);
  }
  return soup;
}

CanonicalSkeleton moved_back(CanonicalSkeleton s, int turn, bool mirror) {
  const auto map = [&](GeneratorKey& g) {
    for (Coordinates& p : g.points) {
      if (mirror) std::swap(p[0], p[1]);
      Coordinates original;
      for (int i = 0; i < 3; ++i) original[(i + turn) % 3] = p[i];
      p = original;
    }
    std::ranges::sort(g.points);
  };
  const auto map_node = [&](NodeKey& node) {
    std::ranges::for_each(node.generators, map);
    node = node_key(node.kind, node.generators);
  };
  for (NodeKey& node : s.nodes) map_node(node);
  for (ArcKey& arc : s.arcs) {
    std::ranges::for_each(arc.generators, map);
    std::ranges::for_each(arc.nodes, map_node);
    arc = arc_key(arc.kind, arc.generators, arc.self, arc.nodes);
  }
  s.sort();
  return s;
}

TEST(NaiveEee, DoesNotDependOnAxesOrOrder) {
  for (const std::uint64_t seed : {2, 20, 21}) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const PolygonSoup soup = eee_scene(seed);
    const CanonicalSkeleton original = naive_eee(soup);
    EXPECT_GT(original.counts()["EEEE"], 0);
    for (const auto& [turn, mirror] : {std::pair(1, false), std::pair(2, true)}) {
      const CanonicalSkeleton same =
          moved_back(naive_eee(moved(soup, turn, mirror)), turn, mirror);
      EXPECT_EQ(difference(original, "original", same, "moved"), "");
    }
    // Other edges come first, so that the lines of three are told by another edge.
    PolygonSoup reversed = soup;
    std::ranges::reverse(reversed.groups);
    EXPECT_EQ(difference(original, "original", naive_eee(reversed), "reversed"), "");
  }
}

TEST(NaiveEee, IsDefinedForGeneralPositionOnly) {
  EXPECT_THROW((void)naive_eee(touching_boxes(Touching::Row)), NotGeneral);
  EXPECT_THROW((void)naive_eee(random_boxes(1, 3)), NotGeneral);
}

}  // namespace
}  // namespace sightline::testing
