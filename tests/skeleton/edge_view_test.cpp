// What an edge's view calls hidden is blocked, line by line and exactly; pieces of long
// edges change no events; what the tree of directions leaves out is not in line.

#include "linespace/blockers/edge_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <vector>

#include "linespace/sight/line_probe.h"
#include "linespace/space/opposite_edges.h"
#include "linespace/swaths/edge_cuts.h"
#include "skeleton/build.h"
#include "skeleton/nodes/node_contacts.h"
#include "tests/support/generators.h"

namespace sightline::internal {
namespace {

std::array<Point, 2> ends_of(const Scene& scene, const Ridge& r) {
  return {scene.point(r.points[0]), scene.point(r.points[1])};
}

// Some of the lines between inner points of a part of an edge and of another edge is
// free.
bool some_free(const Silhouettes& g, const std::array<Point, 2>& first,
               const std::array<Point, 2>& last, double from = 0, double to = 1) {
  for (const int s : {1, 8, 15}) {
    const Rational at = Rational(from) + (Rational(to) - Rational(from)) * s / 16;
    for (const int t : {1, 7, 15}) {
      const ExactPoint p = along(exact_point(first[0]), exact_point(first[1]), at);
      const ExactPoint q =
          along(exact_point(last[0]), exact_point(last[1]), Rational(t) / 16);
      if (is_free(
              g, LineScan(g.scene(), faces_near_line(g, rounded(p), rounded(q)), p, q))) {
        return true;
      }
    }
  }
  return false;
}

struct Hidden {
  int edges = 0, groups = 0;              // from a whole edge
  int piece_edges = 0, piece_groups = 0;  // from a piece of one
};

// Every edge of some and all long ones are held against others, and against groups by
// what hid edges before.
Hidden check_hidden(const PolygonSoup& soup, std::size_t step,
                    std::size_t other_step = 1) {
  const Scene scene(soup);
  const Silhouettes g(scene);
  EdgeView view(g);
  Hidden count;
  std::vector<EdgeView::Part> parts;
  std::vector<std::int32_t> faces;
  const auto ridges = g.ridges();
  for (std::size_t i = 0; i < ridges.size(); ++i) {
    view.begin(static_cast<int>(i));
    if (i % step != 0 && view.pieces() == 0) continue;
    const auto first = ends_of(scene, ridges[i]);
    const int pieces = std::popcount(view.pieces());
    for (std::size_t j = 0; j < ridges.size(); j += other_step) {
      if (j == i) continue;
      const auto last = ends_of(scene, ridges[j]);
      view.look_at(box_of(last), view.pieces());
      const bool open = view.look(view.pieces(), last[0], last[1], parts, faces);
      view.look_away();
      EXPECT_EQ(open, std::any_of(parts.begin(), parts.end(),
                                  [](const auto& part) { return part.hidden_by < 0; }));
      EXPECT_EQ(parts.front().from, 0);
      EXPECT_EQ(parts.back().to, 1);
      for (const EdgeView::Part& part : parts) {
        if (part.hidden_by < 0) continue;
        ++(parts.size() == 1 ? count.edges : count.piece_edges);
        EXPECT_FALSE(some_free(g, first, last, part.from, part.to))
            << "edge " << i << " from " << part.from << " to " << part.to << " and edge "
            << j;
      }
    }
    for (const Bvh::Node& node : g.ridge_tree().nodes()) {
      if (node.count == 0) continue;
      const bool hidden = view.hides(node.box);
      count.groups += hidden ? 1 : 0;
      view.look_at(node.box, view.pieces());
      EXPECT_EQ(view.hides(node.box), hidden) << "only what hides nothing is not asked";
      view.look_away();
      const EdgeView::Pieces open = view.open(view.pieces(), node.box);
      count.piece_groups += pieces - std::popcount(open);
      for (std::uint32_t k = 0; k < node.count; ++k) {
        const auto last = ends_of(scene, ridges[g.ridge_tree().items()[node.first + k]]);
        EXPECT_FALSE(hidden && some_free(g, first, last)) << "edge " << i;
        for (int piece = 0; piece < pieces; ++piece) {
          if ((open >> piece & 1u) != 0) continue;
          EXPECT_FALSE(some_free(g, first, last, static_cast<double>(piece) / pieces,
                                 static_cast<double>(piece + 1) / pieces))
              << "edge " << i << ", piece " << piece;
        }
      }
    }
  }
  return count;
}

// Turned by a rotation with rational entries, five times as large: exact on integers.
PolygonSoup turned(PolygonSoup soup, int axis) {
  const int j = (axis + 1) % 3;
  const int k = (axis + 2) % 3;
  for (Point& p : soup.vertices) {
    const Point q = p;
    p[axis] = 5 * q[axis];
    p[j] = 4 * q[j] - 3 * q[k];
    p[k] = 3 * q[j] + 4 * q[k];
  }
  return soup;
}

TEST(EdgeView, WhatIsHiddenIsBlocked) {
  const Hidden city = check_hidden(testing::city(3, 240), 9);
  EXPECT_GT(city.edges, 500);
  EXPECT_GT(city.groups, 100);
  EXPECT_GT(city.piece_edges, 500);
  EXPECT_GT(city.piece_groups, 200);
  const Hidden grid = check_hidden(testing::grid_city(3, 120), 5);
  EXPECT_GT(grid.edges, 200);
  const Hidden polytopes =
      check_hidden(testing::random_polytopes(3, 40, {.density = 0.3}), 19);
  EXPECT_GT(polytopes.edges, 20);
}

// The ends of their pieces are boxes, in the ground's plane and not.
TEST(EdgeView, WhatIsHiddenFromPiecesOfObliqueEdgesIsBlocked) {
  const PolygonSoup flat = turned(testing::grid_city(3, 240), 2);
  const Hidden city = check_hidden(flat, 1000, 5);
  EXPECT_GT(city.piece_edges, 500);
  const Hidden oblique = check_hidden(turned(flat, 0), 1000, 5);
  EXPECT_GT(oblique.piece_edges, 500);
}

TEST(EdgePieces, HoldTheirPartOfTheEdge) {
  testing::Random random(7);
  int points = 0;
  for (int i = 0; i < 300; ++i) {
    Point p0, p1;
    for (int k = 0; k < 3; ++k) {
      p0[k] = random.uniform(-1, 1) * (random.one_in(3) ? 0x1p-40 : 1);
      p1[k] = random.one_in(2) ? p0[k] : random.uniform(-1000, 1000);
    }
    if (p0 == p1) continue;
    const EdgePiece piece = piece_of(p0, p1, 17.0 / 64, 18.0 / 64);
    const ExactPoint e0 = exact_point(p0);
    const ExactPoint e1 = exact_point(p1);
    std::vector<Rational> at(2);  // of ends that are points
    for (int k = 0; k < 2; ++k) {
      const ExactPoint end = along(e0, e1, Rational(17 + k) / 64);
      bool is_point = true;
      for (int c = 0; c < 3; ++c) {
        is_point &= piece.ends[k].min[c] == piece.ends[k].max[c];
      }
      for (int c = 0; c < 3; ++c) {
        const Rational low(piece.ends[k].min[c]);
        const Rational high(piece.ends[k].max[c]);
        if (!is_point) {
          EXPECT_LE(low, end[c]);
          EXPECT_GE(high, end[c]);
        } else if (p0[c] != p1[c]) {
          // On the edge, not after the first end, not before the second.
          ++points;
          const Rational beyond = (low - end[c]) * (p0[c] < p1[c] ? 1 : -1);
          EXPECT_TRUE(k == 0 ? beyond <= 0 : beyond >= 0);
        } else {
          EXPECT_EQ(low, end[c]);
        }
        EXPECT_LT((high - low), Rational(1e-12));
        EXPECT_LE(high, Rational(piece.point(k)[c]) + Rational(piece.pad()[c]));
      }
    }
  }
  EXPECT_GT(points, 100);
}

TEST(EdgePieces, ShaftsAreAsWideAsTheirEnds) {
  const Point p0{0, 0, 0}, p1{0, 1, 0}, q0{8, 0, 1}, q1{8, 1, 1};
  const auto at = [](double x, double y, double z) { return Box{{x, y, z}, {x, y, z}}; };
  const Box far{{8, 0, 1}, {8, 1, 1}};
  const Shaft::Pad pad{0.1, 0.1, 0.1};
  for (const double off : {-0.1, 0.1}) {
    const Box box = at(0, 0.5, off);
    EXPECT_FALSE(Shaft(p0, p1, q0, q1).may_meet(box));
    EXPECT_FALSE(Shaft(p0, p1, far).may_meet(box));
    EXPECT_TRUE(Shaft(p0, p1, q0, q1, pad).may_meet(box));
    EXPECT_TRUE(Shaft(p0, p1, far, pad).may_meet(box));
  }
  // And no wider than twice that.
  EXPECT_FALSE(Shaft(p0, p1, q0, q1, pad).may_meet(at(4, 0.5, 0.5 + 0.45)));
}

// The same events among the same edges whether long ones are cut or not: they are not
// when many others are as long.
TEST(EdgePieces, ChangeNoEvents) {
  for (const PolygonSoup& soup :
       {testing::city(2, 240), turned(turned(testing::grid_city(3, 200), 2), 0)}) {
    const Scene scene(soup);
    const Silhouettes g(scene);
    const auto cut_edges = [](const Silhouettes& silhouettes, std::size_t ridges) {
      EdgeView view(silhouettes);
      int cut = 0;
      for (std::size_t i = 0; i < ridges; ++i) {
        view.begin(static_cast<int>(i));
        cut += view.pieces() != 0 ? 1 : 0;
      }
      return cut;
    };
    EXPECT_GE(cut_edges(g, g.ridges().size()), 4);
    const Box box = box_of(soup.vertices);
    const Point low{box.min[0], box.min[1], box.min[2]};
    const Point high{box.max[0], box.max[1], box.max[2]};
    const double size = (high - low).norm();
    std::vector<testing::AlignedBox> large;
    for (int i = 0; i < 40; ++i) {
      const double x = high[0] + 10 * size + 4 * i * size;
      large.push_back({{x, 0, 0}, {x + 2 * size, 2 * size, 2 * size}});
    }
    const PolygonSoup more = testing::boxes_soup(large);
    PolygonSoup both = soup;
    const auto points = static_cast<int>(both.vertices.size());
    const auto polygons = static_cast<int>(both.polygons.size());
    both.vertices.insert(both.vertices.end(), more.vertices.begin(), more.vertices.end());
    for (std::vector<int> polygon : more.polygons) {
      for (int& p : polygon) p += points;
      both.polygons.push_back(polygon);
    }
    for (PolygonSoup::Group group : more.groups) {
      for (int& f : group.faces) f += polygons;
      both.groups.push_back(group);
    }
    const Scene larger(both);
    const Silhouettes uncut(larger);
    EXPECT_EQ(cut_edges(uncut, g.ridges().size()), 0);
    SkeletonRequest request;
    request.ev = false;
    request.part.region = {low, high};
    const Skeleton pieces = build_skeleton(scene, request);
    const Skeleton whole = build_skeleton(larger, request);
    ASSERT_EQ(pieces.eee().size(), whole.eee().size());
    EXPECT_GT(pieces.eee().size(), 1000);
    for (std::size_t i = 0; i < whole.eee().size(); ++i) {
      EXPECT_EQ(pieces.eee()[i].generators, whole.eee()[i].generators);
      // Rounded from one of several equal cuts.
      for (int k = 0; k < 2; ++k) {
        EXPECT_NEAR(pieces.eee()[i].range[k], whole.eee()[i].range[k], 1e-14);
      }
      EXPECT_EQ(pieces.eee()[i].nodes, whole.eee()[i].nodes);
    }
  }
}

// Between two boxes on a slab a third of the same width: lines along the slab only touch
// it.
TEST(EdgeView, WhatTouchesAnOccluderAllAlongIsNotHidden) {
  const Scene scene(testing::boxes_soup(
      {{{0, 0, 0}, {1, 1, 2}}, {{2, 0, 0}, {3, 1, 2}}, {{4, 0, 0}, {5, 1, 2}}}));
  const Silhouettes g(scene);
  EdgeView view(g);
  std::vector<EdgeView::Part> parts;
  std::vector<std::int32_t> faces;
  const auto hidden = [&](const std::array<Point, 2>& first,
                          const std::array<Point, 2>& last) {
    for (std::size_t i = 0; i < g.ridges().size(); ++i) {
      if (ends_of(scene, g.ridges()[i]) != first) continue;
      view.begin(static_cast<int>(i));
      view.look_at(box_of(last), view.pieces());
      return !view.look(view.pieces(), last[0], last[1], parts, faces);
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
  for (std::size_t v = 0; v < scene.points().size(); v += 7) {
    const Point& at = scene.point(static_cast<int>(v));
    const auto found = opposite_edges(at, edges);
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
    EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
    proposed += found.size();
    for (std::uint32_t i = 0; i < edges.size(); ++i) {
      for (std::uint32_t j = i + 1; j < edges.size(); ++j) {
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
        EXPECT_TRUE(std::binary_search(found.begin(), found.end(), std::pair(i, j)));
      }
    }
  }
  EXPECT_GT(in_line, 100);
  // And not everything: few more.
  EXPECT_LT(proposed, pairs / 50);
}

}  // namespace
}  // namespace sightline::internal
