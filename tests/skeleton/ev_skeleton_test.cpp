// The EV skeleton and its lines on small scenes whose answers are known by hand.

#include "tests/support/ev_skeleton.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "skeleton/graph.h"
#include "skeleton/request.h"
#include "skeleton/skeleton_lines.h"
#include "tests/support/add_box.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

// Two tetrahedra, a corner of each in the plane x = 0, and between them a wall of two
// boxes with a slit of width `gap`.
PolygonSoup slit_scene(double gap) {
  PolygonSoup soup;
  testing::add_box(soup, "left", {-5, -0.1, -5}, {-gap / 2, 0.1, 5});
  testing::add_box(soup, "right", {gap / 2, -0.1, -5}, {5, 0.1, 5});
  const auto add_tetrahedron = [&](const char* name, const Point& at) {
    const int v = static_cast<int>(soup.vertices.size());
    const int f = static_cast<int>(soup.polygons.size());
    for (const Point& p : {Point(-0.31, 0.02, -0.27), Point(0.29, -0.03, -0.21),
                           Point(0.03, 0.33, -0.11), Point(0, 0.07, 0.37)}) {
      soup.vertices.push_back(at + p);
    }
    for (const auto& t : {std::array{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}) {
      soup.polygons.push_back({v + t[0], v + t[1], v + t[2]});
    }
    soup.groups.push_back({name, {f, f + 1, f + 2, f + 3}});
  };
  add_tetrahedron("near", {0, -2, 0});
  add_tetrahedron("far", {0, 2, 0});
  return soup;
}

int arcs_between(const Scene& scene, const char* a, const char* b) {
  SkeletonRequest request;
  request.part.vertex_objects = {scene.object_named(a)};
  request.part.edge_objects = {scene.object_named(b)};
  return static_cast<int>(testing::build_ev_skeleton(scene, request).arcs.size());
}

TEST(EvSkeleton, FindsAnOpeningOfAMillionthOfTheScene) {
  // Scene of size 10: a slit of 1e-5, then of 1e-9, no ray would find.
  for (const double gap : {1e-5, 1e-9}) {
    const Scene scene(slit_scene(gap));
    EXPECT_GT(arcs_between(scene, "near", "far"), 0) << gap;
    EXPECT_GT(arcs_between(scene, "far", "near"), 0) << gap;
  }
}

TEST(EvSkeleton, ClosedSlitShowsNothing) {
  const Scene scene(slit_scene(0));
  EXPECT_EQ(arcs_between(scene, "near", "far"), 0);
  EXPECT_EQ(arcs_between(scene, "far", "near"), 0);
}

TEST(EvSkeleton, PartsAreThoseOfTheWhole) {
  const Scene scene(testing::random_polytopes(11, 6, {.density = 0.2}));
  const Skeleton whole = testing::build_ev_skeleton(scene);
  SkeletonRequest request;
  request.part.vertex_objects = {2};
  request.part.edge_objects = {0, 4};
  const Skeleton part = testing::build_ev_skeleton(scene, request);
  const auto on = [&](int point, int object) {
    const auto faces = scene.faces_at(point);
    return std::any_of(faces.begin(), faces.end(),
                       [&](int f) { return scene.faces()[f].object == object; });
  };
  std::vector<SkeletonArc> expected;
  for (const SkeletonArc& a : whole.ev()) {
    const int object = scene.edges()[a.edge()].object;
    if (on(a.vertex(), 2) && (object == 0 || object == 4)) expected.push_back(a);
  }
  ASSERT_EQ(part.ev().size(), expected.size());
  ASSERT_GT(expected.size(), 0U);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(part.ev()[i].generators, expected[i].generators);
    EXPECT_EQ(part.ev()[i].range, expected[i].range);
  }
}

TEST(EvSkeleton, StopsWhenAsked) {
  const Scene scene(testing::random_polytopes(12, 6, {.density = 0.2}));
  SkeletonRequest request;
  std::stop_source source;
  source.request_stop();
  request.stop = source.get_token();
  const Skeleton none = testing::build_ev_skeleton(scene, request);
  EXPECT_FALSE(none.complete);
  EXPECT_EQ(none.vertices_done, 0U);
  EXPECT_EQ(none.vertices_asked, scene.corners().size());
}

// Every arc's line is free between vertex and edge, grazes at both, and its pieces tile
// the arc; beyond a piece's end the face named there is met.
TEST(SkeletonLines, ContactsAndPiecesOfEveryArc) {
  const Scene scene(testing::random_polytopes(13, 5, {.density = 0.3}));
  const Skeleton skeleton = testing::build_ev_skeleton(scene);
  const SkeletonLines lines(scene);
  int pieces_in_all = 0, stopped = 0;
  for (const SkeletonArc& arc : skeleton.ev()) {
    const double middle = 0.5 * (arc.range[0] + arc.range[1]);
    const FreeSegment line = lines.line(arc, middle).value();
    EXPECT_LT(line.from, 0);
    EXPECT_GT(line.to, 1);
    ASSERT_GE(line.contacts.size(), 2U);
    const auto at = [&](double position) {
      return std::count_if(line.contacts.begin(), line.contacts.end(),
                           [&](const Contact& c) { return c.from == position; });
    };
    EXPECT_EQ(at(0), 1);
    EXPECT_EQ(at(1), 1);
    for (const Contact& c : line.contacts) EXPECT_FALSE(c.blocked);

    const auto pieces = lines.pieces(arc);
    ASSERT_FALSE(pieces.empty());
    EXPECT_EQ(pieces.front().range[0], arc.range[0]);
    EXPECT_EQ(pieces.back().range[1], arc.range[1]);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (i > 0) {
        EXPECT_EQ(pieces[i - 1].range[1], pieces[i].range[0]);
        EXPECT_FALSE(pieces[i - 1].line.from_faces == pieces[i].line.from_faces &&
                     pieces[i - 1].line.to_faces == pieces[i].line.to_faces);
      }
      // The same line asked for on its own.
      const double s =
          pieces[i].range[0] + 0.3 * (pieces[i].range[1] - pieces[i].range[0]);
      const FreeSegment again = lines.line(arc, s).value();
      EXPECT_EQ(again.from_faces, pieces[i].line.from_faces);
      EXPECT_EQ(again.to_faces, pieces[i].line.to_faces);
      stopped += again.to_faces.empty() ? 0 : 1;
    }
    pieces_in_all += static_cast<int>(pieces.size());
  }
  EXPECT_GT(pieces_in_all, static_cast<int>(skeleton.ev().size()));
  EXPECT_GT(stopped, 0);
}

TEST(SkeletonLines, NodesHaveTheContactsOfTheirKind) {
  const Scene scene(testing::random_polytopes(14, 5, {.density = 0.3}));
  const Skeleton skeleton = testing::build_ev_skeleton(scene);
  const SkeletonLines lines(scene);
  std::array<int, 4> seen{};
  for (const SkeletonNode& node : skeleton.nodes) {
    const auto line = lines.line(skeleton, node);
    ASSERT_TRUE(line.has_value());
    const std::size_t contacts =
        node.kind == NodeKind::VEE || node.kind == NodeKind::EVE ? 3 : 2;
    EXPECT_EQ(line->contacts.size(), contacts);
    EXPECT_LT(line->from, 0);
    EXPECT_GT(line->to, 1);
    ++seen[static_cast<std::size_t>(node.kind)];
  }
  for (const int n : seen) EXPECT_GT(n, 0);
}

}  // namespace
}  // namespace sightline
