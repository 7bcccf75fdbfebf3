// Events on the way of an eye, told by hand on small scenes and checked on random ones.

#include "linespace/view_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <set>

#include "tests/support/generators.h"
#include "tests/support/path_comparison.h"
#include "tests/support/view_scenes.h"

namespace sightline {
namespace {

// Polygons, each an object of its own.
Scene sheets(const std::vector<std::vector<Point>>& polygons) {
  PolygonSoup soup;
  for (const std::vector<Point>& polygon : polygons) {
    const auto n = static_cast<int>(soup.polygons.size());
    soup.groups.push_back({"sheet" + std::to_string(n), {n}});
    soup.polygons.emplace_back();
    for (const Point& p : polygon) {
      soup.polygons.back().push_back(static_cast<int>(soup.vertices.size()));
      soup.vertices.push_back(p);
    }
  }
  return Scene(std::move(soup));
}

std::vector<Viewpoint> eyes(const std::vector<Point>& points) {
  std::vector<Viewpoint> path;
  for (const Point& p : points) path.push_back(eye_at(p));
  return path;
}

ViewPath walk(const Scene& scene, const std::vector<Viewpoint>& path) {
  return view_path(PointViewIndex(scene), path);
}

Generator vertex(int id) { return {GeneratorKind::Vertex, id}; }
Generator edge(int id) { return {GeneratorKind::Edge, id}; }
Generator face(int id) { return {GeneratorKind::Face, id}; }

// The edge between two points.
int edge_between(const Scene& scene, const Point& a, const Point& b) {
  for (int e = 0; e < static_cast<int>(scene.edges().size()); ++e) {
    const auto [p, q] = scene.edges()[e].points;
    if ((scene.point(p) == a && scene.point(q) == b) ||
        (scene.point(p) == b && scene.point(q) == a)) {
      return e;
    }
  }
  return -1;
}

int point_at(const Scene& scene, const Point& p) {
  const auto& points = scene.points();
  return static_cast<int>(std::ranges::find(points, p) - points.begin());
}

Scene cube() { return Scene(testing::boxes_soup({{{0, 0, 0}, {1, 1, 1}}})); }

TEST(ViewPath, RoundACube) {
  const ViewPath found =
      walk(cube(),
           eyes({{3, 3, 0.5}, {-2, 3, 0.5}, {-2, -2, 0.5}, {3, -2, 0.5}, {3, 3, 0.5}}));
  EXPECT_TRUE(found.complete);
  ASSERT_EQ(found.changes.size(), 8U);
  for (int i = 0; i < 8; ++i) {
    const PathChange& c = found.changes[i];
    EXPECT_EQ(c.segment, i / 2);
    EXPECT_DOUBLE_EQ(c.u,
                     i % 4 < 2 ? (i % 2 == 0 ? 0.4 : 0.6) : (i % 2 == 0 ? 0.4 : 0.6));
    ASSERT_EQ(c.events.size(), 1U);
    EXPECT_EQ(c.events[0].kind, PathEventKind::F);
    // One facet goes, then another comes.
    EXPECT_EQ(c.vanishes.size(), i % 2 == 0 ? 1U : 0U);
    EXPECT_EQ(c.appears.size(), i % 2 == 0 ? 0U : 1U);
    const auto& facet = i % 2 == 0 ? c.vanishes : c.appears;
    EXPECT_EQ(c.events[0].generators, std::vector{face(facet.at(0))});
    EXPECT_EQ(c.difference.regions, i % 2 == 0 ? -1 : 1);
    EXPECT_EQ(c.difference.edges, i % 2 == 0 ? -3 : 3);
    EXPECT_EQ(c.difference.corners, i % 2 == 0 ? -2 : 2);
  }
  EXPECT_EQ(found.stretches.size(), 12U);
}

// The planes of a cube cut space into 26 cells around it, each with another view.
TEST(ViewPath, AllCellsOfACube) {
  const std::array<double, 3> at{-1, 0.5, 2};
  std::vector<Point> points;
  for (int z = 0; z < 3; ++z) {
    for (int i = 0; i < 3; ++i) {
      const int y = z % 2 == 0 ? i : 2 - i;
      for (int j = 0; j < 3; ++j) {
        const int x = (3 * z + i) % 2 == 0 ? j : 2 - j;
        points.emplace_back(at[x], at[y], at[z]);
      }
    }
  }
  const ViewPath found = walk(cube(), eyes(points));
  std::set<std::string> structures;
  for (const PathStretch& s : found.stretches) {
    EXPECT_TRUE(s.view->general);
    structures.insert(s.view->structure);
  }
  EXPECT_EQ(structures.size(), 27U);
  ASSERT_EQ(found.changes.size(), 26U);
  int through = 0;
  for (const PathChange& c : found.changes) {
    ASSERT_EQ(c.events.size(), 1U);
    EXPECT_EQ(c.events[0].generators.size(), 1U);
    EXPECT_EQ(c.events[0].generators[0].kind, GeneratorKind::Face);
    through += c.events[0].kind == PathEventKind::Through ? 1 : 0;
    EXPECT_TRUE(c.events[0].kind == PathEventKind::Through ||
                c.events[0].kind == PathEventKind::F);
  }
  EXPECT_EQ(through, 2);
}

TEST(ViewPath, DirectionsOfACube) {
  // The great circle through (3, 2, 1) and (-3, 2, 1) passes x = 0 only.
  const ViewPath found =
      walk(cube(), {eye_far_along({3, 2, 1}), eye_far_along({-6, 4, 2})});
  ASSERT_EQ(found.changes.size(), 1U);
  EXPECT_DOUBLE_EQ(found.changes[0].u, 1.0 / 3);
  // Seen edge-on are both.
  EXPECT_EQ(found.changes[0].events.size(), 2U);
  EXPECT_EQ(found.changes[0].appears.size(), 1U);
  EXPECT_EQ(found.changes[0].vanishes.size(), 1U);
  EXPECT_EQ(found.changes[0].difference, MapCounts{});
}

// A triangle comes out behind a wall, its corner first.
TEST(ViewPath, ACornerBehindAnEdge) {
  const Scene scene = sheets({{{0, 0, -10}, {10, 0, -10}, {10, 0, 10}, {0, 0, 10}},
                              {{-1, 5, 0}, {1, 5, 1}, {1, 5, -1}}});
  const ViewPath found = walk(scene, eyes({{3, -5, 0.25}, {0, -5, 0.25}}));
  ASSERT_EQ(found.changes.size(), 1U);
  const PathChange& c = found.changes[0];
  EXPECT_DOUBLE_EQ(c.u, 2.0 / 3);
  ASSERT_EQ(c.events.size(), 1U);
  EXPECT_EQ(c.events[0].kind, PathEventKind::EV);
  const std::vector<Generator> expected{
      vertex(point_at(scene, {-1, 5, 0})),
      edge(edge_between(scene, {0, 0, -10}, {0, 0, 10}))};
  EXPECT_EQ(c.events[0].generators, expected);
  EXPECT_EQ(c.appears, std::vector{1});
  EXPECT_TRUE(c.vanishes.empty());
  // The corner and two T; four more edges, one more region.
  EXPECT_EQ(c.difference,
            (MapCounts{.corners = 1, .t_vertices = 2, .edges = 4, .regions = 1}));
}

// Upright walls at y = 0 (below z = 0), y = 2 (x > 0) and y = 4 (x + z > 1).
Scene three_walls() {
  return sheets({{{-30, 0, -30}, {30, 0, -30}, {30, 0, 0}, {-30, 0, 0}},
                 {{0, 2, -20}, {20, 2, -20}, {20, 2, 20}, {0, 2, 20}},
                 {{11, 4, -10}, {11, 4, 10}, {-9, 4, 10}}});
}

std::vector<Generator> wall_edges(const Scene& scene) {
  std::vector<Generator> edges{edge(edge_between(scene, {-30, 0, 0}, {30, 0, 0})),
                               edge(edge_between(scene, {0, 2, -20}, {0, 2, 20})),
                               edge(edge_between(scene, {11, 4, -10}, {-9, 4, 10}))};
  std::ranges::sort(edges);
  return edges;
}

// Moved along the direction (s, -1, 0) onto y = 0 their edges are z = 0, x = 2 s and
// x + z = 1 + 4 s, which meet where s = -1/2.
TEST(ViewPath, ThreeEdgesFromADirection) {
  const Scene scene = three_walls();
  const ViewPath found =
      walk(scene, {eye_far_along({0, -1, 0}), eye_far_along({-1, -1, 0})});
  ASSERT_EQ(found.changes.size(), 1U);
  EXPECT_DOUBLE_EQ(found.changes[0].u, 0.5);
  ASSERT_EQ(found.changes[0].events.size(), 1U);
  EXPECT_EQ(found.changes[0].events[0].kind, PathEventKind::EEE);
  EXPECT_EQ(found.changes[0].events[0].generators, wall_edges(scene));
}

// From the eye (-3/2, -h, -1/10) they meet where h^2 - 7/5 h - 4/5 = 0.
TEST(ViewPath, ThreeEdgesAtAnIrrationalPosition) {
  const Scene scene = three_walls();
  const auto eye = [](const std::string& y) {
    return viewpoint(Viewpoint::Kind::Eye, {"-3/2", y, "-1/10"});
  };
  const ViewPath found = walk(scene, {eye("-1"), eye("-3")});
  const double h = (1.4 + std::sqrt(1.96 + 3.2)) / 2;
  const auto change = std::ranges::find_if(found.changes, [&](const PathChange& c) {
    return c.events[0].kind == PathEventKind::EEE;
  });
  ASSERT_NE(change, found.changes.end());
  EXPECT_NEAR(change->u, (h - 1) / 2, 1e-15);
  ASSERT_EQ(change->events.size(), 1U);
  EXPECT_EQ(change->events[0].generators, wall_edges(scene));
}

TEST(ViewPath, ThroughASheet) {
  const Scene scene = sheets({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}});
  const ViewPath found = walk(scene, eyes({{0.25, 0.375, 1}, {0.25, 0.375, -3}}));
  ASSERT_EQ(found.changes.size(), 1U);
  const PathChange& c = found.changes[0];
  EXPECT_EQ(c.u, 0.25);
  EXPECT_EQ(c.events, (std::vector<PathEvent>{{PathEventKind::Through, {face(0)}}}));
  // Its front goes, and its back comes.
  EXPECT_EQ(c.appears, std::vector{0});
  EXPECT_EQ(c.vanishes, std::vector{0});
}

TEST(ViewPath, ThroughACornerOfASheet) {
  const Scene scene = sheets({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}});
  const ViewPath found = walk(scene, eyes({{1, 1, 1}, {1, 1, -1}}));
  ASSERT_EQ(found.changes.size(), 1U);
  EXPECT_EQ(found.changes[0].events,
            (std::vector<PathEvent>{
                {PathEventKind::Through, {vertex(point_at(scene, {1, 1, 0}))}}}));
}

// Level with the floor of a cube all views are accidents.
TEST(ViewPath, InThePlaneOfAFacet) {
  const ViewPath found = walk(cube(), eyes({{-3, -2, 0}, {5, -2, 0}}));
  ASSERT_EQ(found.stretches.size(), 3U);
  for (const PathStretch& s : found.stretches) EXPECT_FALSE(s.view->general);
  ASSERT_EQ(found.changes.size(), 2U);
  for (int i = 0; i < 2; ++i) {
    EXPECT_DOUBLE_EQ(found.changes[i].u, i == 0 ? 3.0 / 8 : 0.5);
    ASSERT_EQ(found.changes[i].events.size(), 1U);
    EXPECT_EQ(found.changes[i].events[0].kind, PathEventKind::F);
  }
}

// On the top of a cube, over its side and on.
TEST(ViewPath, OnAFacet) {
  const Scene scene = cube();
  const ViewPath found = walk(scene, eyes({{0.5, 0.25, 1}, {2.5, 0.25, 1}}));
  ASSERT_EQ(found.stretches.size(), 2U);
  EXPECT_EQ(found.stretches[0].view->place, EyePlace::Facet);
  EXPECT_EQ(found.stretches[1].view->place, EyePlace::Free);
  ASSERT_EQ(found.changes.size(), 1U);
  EXPECT_EQ(found.changes[0].u, 0.25);
  const int side = edge_between(scene, {1, 0, 1}, {1, 1, 1});
  EXPECT_EQ(found.changes[0].events,
            (std::vector<PathEvent>{{PathEventKind::Through, {edge(side)}}}));
}

// Between two boxes nothing is seen, and then all at once.
TEST(ViewPath, OutOfAContact) {
  const Scene scene(
      testing::boxes_soup({{{0, 0, 0}, {1, 1, 1}}, {{0, 0, 1}, {1, 1, 2}}}));
  const ViewPath found = walk(scene, eyes({{0.5, 0.25, 1}, {2.5, 0.25, 1}}));
  ASSERT_EQ(found.stretches.size(), 2U);
  EXPECT_TRUE(found.stretches[0].view->edges.empty());
  EXPECT_FALSE(found.stretches[1].view->edges.empty());
  EXPECT_EQ(found.stretches[1].u_from, 0.25);
}

// A box juts out over the side of a floor; where its lower edge crosses the floor's, no
// corner is, and it comes out behind a wall.
TEST(ViewPath, ATouchBehindAnEdge) {
  PolygonSoup soup = testing::boxes_soup({{{1, 4, 0}, {4, 6, 1}}});
  const auto add = [&](const char* name, const std::vector<Point>& corners) {
    const auto n = static_cast<int>(soup.polygons.size());
    soup.groups.push_back({name, {n}});
    soup.polygons.emplace_back();
    for (const Point& p : corners) {
      soup.polygons.back().push_back(static_cast<int>(soup.vertices.size()));
      soup.vertices.push_back(p);
    }
  };
  add("floor", {{-20, 3, 0}, {2, 3, 0}, {2, 7, 0}, {-20, 7, 0}});
  add("wall", {{0, 0, -10}, {0, 0, 10}, {-10, 0, 10}, {-10, 0, -10}});
  const Scene scene(std::move(soup));
  // In line with (0, 0) and (2, 4).
  const ViewPath found = walk(scene, eyes({{-1.25, -2, 3}, {-0.75, -2, 3}}));
  ASSERT_EQ(found.changes.size(), 1U);
  EXPECT_DOUBLE_EQ(found.changes[0].u, 0.5);
  std::vector<Generator> edges{edge(edge_between(scene, {1, 4, 0}, {4, 4, 0})),
                               edge(edge_between(scene, {2, 3, 0}, {2, 7, 0})),
                               edge(edge_between(scene, {0, 0, -10}, {0, 0, 10}))};
  std::ranges::sort(edges);
  EXPECT_EQ(found.changes[0].events,
            (std::vector<PathEvent>{{PathEventKind::EV, edges}}));
  EXPECT_EQ(std::abs(found.changes[0].difference.touches), 1);
}

// Two boxes on one another look like one, and cuts are no edges.
TEST(ViewPath, SeamsChangeNothing) {
  const Scene boxes(
      testing::boxes_soup({{{0, 0, 0}, {1, 1, 1}}, {{0, 0, 1}, {1, 1, 2}}}));
  EXPECT_TRUE(walk(boxes, eyes({{3, 3.25, 0.5}, {3, 3.25, 1.5}})).changes.empty());
  const Scene halves = sheets({{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}},
                               {{1, 0, 0}, {2, 0, 0}, {2, 0, 1}, {1, 0, 1}}});
  EXPECT_TRUE(walk(halves, eyes({{-1, -1, 0.5}, {3, -2, 3}})).changes.empty());
}

// The edge of a nearer sheet passes the seam of a wall, so that one half goes out of
// sight without an event, and then all of the wall.
TEST(ViewPath, ChangesAreThoseOfTheViewsThatAreTold) {
  const Scene scene = sheets({{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}},
                              {{1, 0, 0}, {2, 0, 0}, {2, 0, 1}, {1, 0, 1}},
                              {{-9, -1, -9}, {1, -1, -9}, {1, -1, 9}, {-9, -1, 9}}});
  const ViewPath found = walk(scene, eyes({{1.75, -2, 0.5}, {-0.5, -2, 0.5}}));
  ASSERT_EQ(found.changes.size(), 1U);
  ASSERT_EQ(found.stretches.size(), 2U);
  EXPECT_EQ(found.stretches[0].view->facets.size(), 3U);
  EXPECT_EQ(found.stretches[1].view->facets.size(), 1U);
  EXPECT_EQ(found.changes[0].vanishes, (std::vector{0, 1}));
}

// On the ceiling of a room the eye passes the line of sight along the top of a column,
// beside which nothing lies behind, to the room's corner.
TEST(ViewPath, OnACeiling) {
  const auto scenes = testing::view_scenes();
  const auto house = std::ranges::find(scenes, "house 4", &testing::ViewScene::name);
  ASSERT_NE(house, scenes.end());
  const Scene scene(house->soup);
  const Point from{1, 7, 3}, to{2, 2, 3};
  const PathEvent corners{
      PathEventKind::EV,
      {vertex(point_at(scene, {0, 0, 3})), vertex(point_at(scene, {1, 2, 3}))}};
  for (const double start : {0.0, 0.25, 0.7}) {
    const ViewPath found = walk(scene, eyes({Point(from + start * (to - from)), to}));
    int told = 0;
    for (const PathChange& c : found.changes) {
      if (std::ranges::find(c.events, corners) == c.events.end()) continue;
      ++told;
      EXPECT_NEAR(start + c.u * (1 - start), 5.0 / 7, 1e-12);
    }
    EXPECT_EQ(told, 1) << start;
  }
}

TEST(ViewPath, WhereSegmentsMeet) {
  // In the plane of a facet, and on; and back again.
  const ViewPath on = walk(cube(), eyes({{2, -2, 0.5}, {1, -2, 0.5}, {0.5, -3, 0.5}}));
  ASSERT_EQ(on.changes.size(), 1U);
  EXPECT_EQ(on.changes[0].segment, 0);
  EXPECT_EQ(on.changes[0].u, 1);
  EXPECT_EQ(on.changes[0].events.size(), 1U);
  EXPECT_EQ(on.changes[0].events[0].kind, PathEventKind::F);
  EXPECT_TRUE(
      walk(cube(), eyes({{2, -2, 0.5}, {1, -2, 0.5}, {2, -3, 0.5}})).changes.empty());
  // Level with the floor, and then below it.
  const ViewPath below =
      walk(cube(), eyes({{0.25, -2, 0}, {0.75, -2, 0}, {0.5, -2, -1}}));
  ASSERT_EQ(below.changes.size(), 1U);
  EXPECT_EQ(below.changes[0].segment, 0);
  EXPECT_EQ(below.changes[0].u, 1);
  ASSERT_EQ(below.changes[0].events.size(), 1U);
  EXPECT_EQ(below.changes[0].events[0].kind, PathEventKind::F);
  EXPECT_EQ(below.changes[0].appears.size(), 1U);
  // The path begins and ends in planes.
  EXPECT_TRUE(walk(cube(), eyes({{0, -2, 0.5}, {1, -2, 0.5}})).changes.empty());
}

TEST(ViewPath, PathsWithoutLength) {
  EXPECT_TRUE(walk(cube(), {}).stretches.empty());
  EXPECT_TRUE(walk(cube(), eyes({{3, 3, 3}})).stretches.empty());
  const ViewPath standing = walk(cube(), eyes({{3, 3, 3}, {3, 3, 3}}));
  EXPECT_EQ(standing.stretches.size(), 1U);
  EXPECT_TRUE(standing.changes.empty());
}

TEST(ViewPath, WithoutViews) {
  const Scene scene = cube();
  const PointViewIndex index(scene);
  const ViewPath found = view_path(index, eyes({{3, 3, 0.5}, {-2, 3, 0.5}}), false);
  EXPECT_EQ(found.changes.size(), 2U);
  for (const PathStretch& s : found.stretches) EXPECT_FALSE(s.view.has_value());
}

TEST(ViewPath, Refusals) {
  EXPECT_THROW((void)walk(cube(), {eye_at({3, 3, 3}), eye_far_along({1, 0, 0})}),
               InvalidInput);
  EXPECT_THROW((void)walk(cube(), {eye_far_along({1, 2, 0}), eye_far_along({-2, -4, 0})}),
               InvalidInput);
  EXPECT_NO_THROW(
      (void)walk(cube(), {eye_far_along({1, 2, 0}), eye_far_along({2, 4, 0})}));
  EXPECT_THROW((void)walk(cube(), eyes({{3, 3, 3}, {3, 3, 1e300}})), InvalidInput);
}

TEST(ViewPath, ABudgetEndsItEarly) {
  const Scene scene = cube();
  const PointViewIndex index(scene);
  Request request;
  request.budget_seconds = 0;
  EXPECT_FALSE(
      view_path(index, eyes({{3, 3, 0.5}, {-2, 3, 0.5}}), true, request).complete);
}

TEST(ViewPathOracle, WhereFacesCross) {
  const testing::PathReport report =
      testing::compare_paths({.paths = 1, .seed = 2, .every = 2, .crossing = true});
  for (const std::string& d : report.differences) ADD_FAILURE() << d;
  std::cout << report.paths << " paths, " << report.changes << " changes, "
            << report.events << " events, " << report.views << " views\n";
}

TEST(ViewPathOracle, ViewsAndChangesOfRandomPaths) {
  const testing::PathReport report =
      testing::compare_paths({.paths = 1, .seed = 1, .every = 2});
  for (const std::string& d : report.differences) ADD_FAILURE() << d;
  std::cout << report.paths << " paths, " << report.changes << " changes, "
            << report.events << " events, " << report.views << " views\n";
  EXPECT_GT(report.changes, 300);
}

}  // namespace
}  // namespace sightline
