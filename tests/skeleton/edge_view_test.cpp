// What an edge's view calls hidden is blocked, line by line and exactly; what the tree of
// directions leaves out is not in line.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <vector>

#include "skeleton/edge_cuts_internal.h"
#include "skeleton/edge_view_internal.h"
#include "skeleton/node_contacts_internal.h"
#include "skeleton/opposite_edges_internal.h"
#include "tests/support/generators.h"

namespace sightline::internal {
namespace {

std::array<Point, 2> ends_of(const Scene& scene, const Ridge& r) {
  return {scene.point(r.points[0]), scene.point(r.points[1])};
}

// Some of the lines between inner points of two edges is free.
bool some_free(const Generators& g, const std::array<Point, 2>& first,
               const std::array<Point, 2>& last) {
  for (const int s : {1, 8, 15}) {
    for (const int t : {1, 7, 15}) {
      const ExactPoint p =
          along(exact_point(first[0]), exact_point(first[1]), Rational(s) / 16);
      const ExactPoint q =
          along(exact_point(last[0]), exact_point(last[1]), Rational(t) / 16);
      if (is_free(
              LineScan(g.scene(), faces_near_line(g, rounded(p), rounded(q)), p, q))) {
        return true;
      }
    }
  }
  return false;
}

struct Hidden {
  int edges = 0, groups = 0;
};

// Every edge is held against every third, by all occluders and by groups.
Hidden check_hidden(const PolygonSoup& soup, std::size_t step) {
  const Scene scene(soup);
  const Generators g(scene, 1);
  std::vector<std::int32_t> faces(scene.faces().size());
  std::iota(faces.begin(), faces.end(), 0);
  EdgeView view(g);
  Hidden count;
  const auto ridges = g.ridges();
  for (std::size_t i = 0; i < ridges.size(); i += step) {
    view.begin(static_cast<int>(i));
    const auto first = ends_of(scene, ridges[i]);
    for (std::size_t j = 0; j < ridges.size(); ++j) {
      const auto last = ends_of(scene, ridges[j]);
      if (!view.occluders().hide(faces, last[0], last[1])) continue;
      ++count.edges;
      EXPECT_FALSE(some_free(g, first, last)) << "edges " << i << " and " << j;
    }
    for (const Bvh::Node& node : g.ridge_tree().nodes()) {
      if (node.count == 0 || !view.occluders().hide(node.box)) continue;
      ++count.groups;
      for (std::uint32_t k = 0; k < node.count; ++k) {
        const std::uint32_t j = g.ridge_tree().items()[node.first + k];
        EXPECT_FALSE(some_free(g, first, ends_of(scene, ridges[j])))
            << "edges " << i << " and " << j << " of a group";
      }
    }
  }
  return count;
}

TEST(EdgeView, WhatIsHiddenIsBlocked) {
  const Hidden city = check_hidden(testing::city(3, 240), 9);
  EXPECT_GT(city.edges, 500);
  EXPECT_GT(city.groups, 100);
  const Hidden grid = check_hidden(testing::grid_city(3, 120), 5);
  EXPECT_GT(grid.edges, 200);
  const Hidden polytopes =
      check_hidden(testing::random_polytopes(3, 40, {.density = 0.3}), 19);
  EXPECT_GT(polytopes.edges, 20);
}

// Between two boxes on a slab a third of the same width: lines along the slab only touch
// it.
TEST(EdgeView, WhatTouchesAnOccluderAllAlongIsNotHidden) {
  const Scene scene(testing::boxes_soup(
      {{{0, 0, 0}, {1, 1, 2}}, {{2, 0, 0}, {3, 1, 2}}, {{4, 0, 0}, {5, 1, 2}}}));
  const Generators g(scene, 1);
  EdgeView view(g);
  std::vector<std::int32_t> faces(scene.faces().size());
  std::iota(faces.begin(), faces.end(), 0);
  const auto hidden = [&](const std::array<Point, 2>& first,
                          const std::array<Point, 2>& last) {
    for (std::size_t i = 0; i < g.ridges().size(); ++i) {
      if (ends_of(scene, g.ridges()[i]) != first) continue;
      view.begin(static_cast<int>(i));
      return view.occluders().hide(faces, last[0], last[1]);
    }
    ADD_FAILURE() << "no such edge";
    return false;
  };
  const Point up{0, 0, 2};
  const Point across{0, 1, 0};
  const Point a{1, 0, 0};
  const Point b{4, 0, 0};
  // Lower edges across: all lines between them are in the middle box's lower plane.
  EXPECT_FALSE(hidden({a, a + across}, {b, b + across}));
  // Edges of one side, upright: in the plane of the middle box's side.
  EXPECT_FALSE(hidden({a, a + up}, {b, b + up}));
  // From the upright edge of one side to that of the other: through it.
  EXPECT_TRUE(hidden({a, a + up}, {b + across, b + across + up}));
  // From a lower edge to an upper one: through it but for the ends.
  EXPECT_TRUE(hidden({a, a + across}, {b + up, b + up + across}));
}

TEST(OppositeEdges, LeavesOutNoneInLine) {
  const Scene scene(testing::random_polytopes(5, 25, {.density = 0.2}));
  std::vector<std::array<Point, 2>> edges;
  for (const Edge& e : scene.edges()) {
    edges.push_back({scene.point(e.points[0]), scene.point(e.points[1])});
  }
  int in_line = 0;
  std::size_t proposed = 0, pairs = 0;
  std::vector<std::uint32_t> found;
  for (std::size_t v = 0; v < scene.points().size(); v += 7) {
    const Point& at = scene.point(static_cast<int>(v));
    const OppositeEdges opposite(at, edges);
    for (std::size_t i = 0; i < edges.size(); i += 5) {
      opposite.above(i, found);
      proposed += found.size();
      for (std::size_t j = i + 1; j < edges.size(); ++j) {
        ++pairs;
        const auto& [e0, e1] = edges[i];
        const auto& [f0, f1] = edges[j];
        // The planes of the viewpoint and each part the other, and the common line meets
        // them before and behind it.
        const Sign s = orient3d(at, e0, e1, f0);
        const Sign t = orient3d(at, f0, f1, e0);
        if (s == Sign::Zero || t == Sign::Zero) continue;
        if (orient3d(at, e0, e1, f1) != -s || orient3d(at, f0, f1, e1) != -t) continue;
        if (s * t != Sign::Positive) continue;
        ++in_line;
        EXPECT_TRUE(std::binary_search(found.begin(), found.end(),
                                       static_cast<std::uint32_t>(j)));
      }
    }
  }
  EXPECT_GT(in_line, 100);
  // And not everything.
  EXPECT_LT(proposed, pairs / 8);
}

}  // namespace
}  // namespace sightline::internal
