// The view from a corner and the corner's EV arcs in polygon mode are two ways to one
// thing.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "linespace/point_view.h"
#include "skeleton/build.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

// Stretches of an edge, from 0 to 1; joined where they touch.
using Stretches = std::vector<std::pair<double, double>>;

Stretches joined(Stretches s) {
  std::ranges::sort(s);
  Stretches all;
  for (const auto& x : s) {
    if (!all.empty() && x.first <= all.back().second + 1e-9) {
      all.back().second = std::max(all.back().second, x.second);
    } else {
      all.push_back(x);
    }
  }
  return all;
}

double position(const Scene& scene, int edge, const Point& p) {
  const Point &a = scene.point(scene.edges()[edge].points[0]),
              &b = scene.point(scene.edges()[edge].points[1]);
  return (p - a).dot(b - a) / (b - a).squaredNorm();
}

// Aligned: where an edge is seen along a nearer one, the map shows the nearer alone, and
// both have arcs; so what is seen is a part of the arcs.
void compare(const PolygonSoup& soup, bool aligned) {
  const Scene scene(soup);
  const PointViewIndex index(scene);
  SkeletonRequest request;
  request.eee = false;
  request.events = EventMode::Polygon;
  const Skeleton skeleton = build_skeleton(scene, request);
  std::map<std::pair<int, int>, Stretches> arcs, seen;
  for (const SkeletonArc& arc : skeleton.ev())
    arcs[{arc.vertex(), arc.edge()}].emplace_back(arc.range[0], arc.range[1]);
  for (const int corner : scene.corners()) {
    const PointView view = index.view(eye_at(scene.point(corner)));
    EXPECT_EQ(view.place, EyePlace::Corner);
    for (const MapEdge& e : view.edges) {
      // The horizon of the corner's own facets is no event.
      if (e.left < 0 || e.right < 0 || e.line.edge < 0) continue;
      const double from = position(scene, e.line.edge, e.segment[0]);
      const double to = position(scene, e.line.edge, e.segment[1]);
      seen[{corner, e.line.edge}].emplace_back(std::min(from, to), std::max(from, to));
    }
  }
  int compared = 0;
  for (const auto& [pair, stretches] : seen) {
    const Stretches a = joined(stretches), b = joined(arcs[pair]);
    compared += static_cast<int>(a.size());
    if (aligned) {
      for (const auto& [from, to] : a) {
        EXPECT_TRUE(std::ranges::any_of(b,
                                        [&](const auto& arc) {
                                          return arc.first <= from + 1e-9 &&
                                                 to <= arc.second + 1e-9;
                                        }))
            << "vertex " << pair.first << " edge " << pair.second;
      }
      continue;
    }
    ASSERT_EQ(a.size(), b.size()) << "vertex " << pair.first << " edge " << pair.second;
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_NEAR(a[i].first, b[i].first, 1e-9);
      EXPECT_NEAR(a[i].second, b[i].second, 1e-9);
    }
  }
  EXPECT_GT(compared, 50);
  if (aligned) return;
  for (const auto& [pair, stretches] : arcs) {
    // The corner's own edges and those in its own facets are seen end-on or edge-on.
    const auto own = scene.faces_at(pair.first);
    const bool beside = std::ranges::any_of(
        scene.edges()[pair.second].sides,
        [&](const Edge::Side& s) { return std::ranges::find(own, s.face) != own.end(); });
    if (beside) continue;
    EXPECT_TRUE(seen.contains(pair))
        << "vertex " << pair.first << " edge " << pair.second;
  }
}

TEST(CornerViewsAndArcs, ParallelepipedsInGeneralPosition) {
  for (const int seed : {1, 2, 3})
    compare(testing::random_parallelepipeds(seed, 6), false);
}

TEST(CornerViewsAndArcs, Polytopes) {
  for (const int seed : {4, 5}) compare(testing::random_polytopes(seed, 6), false);
}

TEST(CornerViewsAndArcs, Aligned) {
  for (const int seed : {4, 5, 6}) {
    compare(testing::random_boxes(seed, 8, {.grid = 8}), true);
    compare(testing::grid_city(seed, 40), true);
  }
}

}  // namespace
}  // namespace sightline
