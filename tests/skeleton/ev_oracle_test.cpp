// The EV skeleton against naive oracles: every node and arc of small scenes in general
// position, and sampled lines, one by one, of boxes that line up, touch and stack.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>
#include <string>

#include "linespace/occlusion.h"
#include "linespace/scene.h"
#include "skeleton/graph.h"
#include "tests/support/ev_skeleton.h"
#include "tests/support/generators.h"
#include "tests/support/library_skeleton.h"
#include "tests/support/naive_boxes.h"
#include "tests/support/naive_ev.h"

namespace sightline {
namespace {

using testing::CanonicalSkeleton;

/// General position, 2 to 6 convex polyhedra of 4 to 12 vertices, by seed.
PolygonSoup small_scene(std::uint64_t seed) {
  const int count = 2 + static_cast<int>(seed % 5);
  switch (seed / 5 % 4) {
    case 0:
      return testing::random_polytopes(seed, count, {.max_vertices = 8, .density = 0.25});
    case 1:
      return testing::random_polytopes(
          seed, count, {.min_vertices = 8, .max_vertices = 12, .density = 0.3});
    case 2:
      return testing::random_parallelepipeds(seed, count, {.density = 0.25});
    default:  // slim and flat ones of very different size
      return testing::random_polytopes(seed, count,
                                       {.min_vertices = 4,
                                        .max_vertices = 5,
                                        .min_radius = 0.1,
                                        .max_radius = 2,
                                        .density = 0.3});
  }
}

void expect_identity(const CanonicalSkeleton& skeleton) {
  auto n = skeleton.counts();
  EXPECT_EQ(2 * n["EV"], 4 * n["VV"] + n["VEE"] + n["FvE"]);
}

TEST(EvOracle, EveryNodeAndArcInGeneralPosition) {
  int scenes = 0;
  std::map<std::string, int> totals;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const PolygonSoup soup = small_scene(seed);
    CanonicalSkeleton naive;
    try {
      naive = testing::naive_ev(soup);
    } catch (const testing::NotGeneral&) {
      continue;
    }
    ++scenes;
    const Scene scene(soup);
    const CanonicalSkeleton ours =
        testing::canonical(scene, testing::build_ev_skeleton(scene));
    EXPECT_EQ(ours.counts(), naive.counts());
    EXPECT_EQ(testing::difference(ours, "the skeleton", naive, "the oracle"), "");
    for (const auto& [kind, count] : naive.counts()) totals[kind] += count;
    if (HasFailure()) break;
  }
  EXPECT_GE(scenes, 36) << "too many seeds are not in general position";
  for (const auto& [kind, count] : totals) {
    std::printf("%s %d  ", kind.c_str(), count);
    EXPECT_GT(count, 100) << kind;
  }
  std::printf("in %d scenes\n", scenes);
}

TEST(EvOracle, IdentityInLargerScenes) {
  for (const int count : {20, 40}) {
    const Scene scene(testing::random_polytopes(count, count, {.density = 0.2}));
    const CanonicalSkeleton ours =
        testing::canonical(scene, testing::build_ev_skeleton(scene));
    expect_identity(ours);
    EXPECT_EQ(ours.counts().count("Degenerate"), 0u);
  }
}

// Quads of a rotated box fold by an ulp; their diagonals are declared flat.
TEST(EvOracle, IdentityForRotatedBoxes) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const Scene scene(testing::rotated_boxes(seed, 6));
    const CanonicalSkeleton ours =
        testing::canonical(scene, testing::build_ev_skeleton(scene));
    expect_identity(ours);
    for (const auto& [kind, count] : ours.counts()) {
      EXPECT_TRUE(kind == "VV" || kind == "VEE" || kind == "EVE" || kind == "FvE" ||
                  kind == "EV")
          << kind << " " << count;
    }
  }
}

/// Lines sampled from every corner to every edge of different boxes, each judged twice.
struct Comparison {
  int in_both = 0, in_none = 0;
  /// Free lines in the plane of a face that they touch, in both.
  int edge_on_in = 0;
  /// Free lines in such a plane through a point or edge at which touching boxes go on
  /// flush, so that their union has no corner or ridge there: a box's own corner and edge
  /// may make an arc of them or not.
  int seams = 0;
  int wrong = 0;
  std::string first_wrong;
};

// Coinciding edges of several objects are one generator: the one with the smallest id.
int first_like(const Scene& scene, int edge) {
  while (edge > 0 && scene.edges()[edge - 1].points == scene.edges()[edge].points) --edge;
  return edge;
}

Comparison compare_line_by_line(const PolygonSoup& soup, int samples_per_edge) {
  const Scene scene(soup);
  const Skeleton skeleton = testing::build_ev_skeleton(scene);
  const testing::BoxUnion boxes(soup);
  std::map<std::pair<int, int>, std::vector<std::array<double, 2>>> arcs;
  for (const SkeletonArc& arc : skeleton.ev()) {
    arcs[{arc.vertex(), arc.edge()}].push_back(arc.range);
  }
  testing::Random random(1);
  Comparison result;
  for (const int v : scene.corners()) {
    const Point& from = scene.point(v);
    for (std::size_t e = 0; e < scene.edges().size(); ++e) {
      const Edge& edge = scene.edges()[e];
      // Two contacts on one object are no event of convex solids.
      const auto at_v = scene.faces_at(v);
      if (std::ranges::any_of(
              at_v, [&](int f) { return scene.faces()[f].object == edge.object; })) {
        continue;
      }
      const Point& a = scene.point(edge.points[0]);
      const Point& b = scene.point(edge.points[1]);
      if (collinear(from, a, b)) continue;  // one line, no family
      int axis;
      (b - a).cwiseAbs().maxCoeff(&axis);
      for (int k = 0; k < samples_per_edge; ++k) {
        // Twelve bits: the point on the edge is exact.  Odd, so never a corner.
        const double s = (2 * random.integer(0, 2047) + 1) * 0x1p-12;
        const Point to = a + s * (b - a);
        bool ours = false, at_end = false;
        std::string ranges;
        for (const auto& [lo, hi] : arcs[{v, first_like(scene, static_cast<int>(e))}]) {
          ours = ours || (lo < s && s < hi);
          at_end = at_end || std::abs(s - lo) < 1e-12 || std::abs(s - hi) < 1e-12;
          ranges += " [" + std::to_string(lo) + ", " + std::to_string(hi) + "]";
        }
        if (at_end) continue;
        const auto [free, edge_on] = boxes.judge(from, to);
        // Generators are those of the single solids, contacts those of their union: a
        // corner or edge that a touching solid smooths over may keep free lines.
        const bool generators = boxes.is_corner(from) && boxes.is_ridge(to, axis);
        if (!generators && (free || edge_on)) {
          ++result.seams;
        } else if (ours != free) {
          ++result.wrong;
          if (result.wrong > 3) continue;
          result.first_wrong +=
              (::testing::Message()
               << soup.source << ": vertex (" << from.transpose() << "), edge ("
               << a.transpose() << ") - (" << b.transpose() << ") at " << s
               << (free ? " is free" : " is not free") << (edge_on ? ", edge-on" : "")
               << (generators ? "" : ", no generators") << "; arcs:" << ranges << "\n")
                  .GetString();
        } else if (free && edge_on) {
          ++result.edge_on_in;
        } else {
          ++(ours ? result.in_both : result.in_none);
        }
      }
    }
  }
  return result;
}

// The same oracle against the contact test alone, on lines through lattice points in
// directions of small integers: in planes of faces, along edges, through corners.
TEST(EvOracle, SegmentsAreFreeWhereNearbyLinesAre) {
  std::vector<PolygonSoup> soups;
  for (const testing::Touching kind : testing::all_touching()) {
    soups.push_back(testing::touching_boxes(kind));
  }
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    soups.push_back(testing::random_boxes(
        seed, 6, {.grid = 4, .may_touch = true, .min_size = 1, .max_size = 3}));
  }
  int free_count = 0, edge_on_count = 0, wrong = 0;
  for (const PolygonSoup& soup : soups) {
    SCOPED_TRACE(soup.source);
    const Scene scene(soup);
    const OcclusionIndex index(scene);
    const testing::BoxUnion boxes(soup);
    testing::Random random(2);
    for (int k = 0; k < 150; ++k) {
      Point at, direction;
      for (double& x : at) x = random.integer(0, 10) / 2.0;
      for (double& x : direction) x = random.integer(-2, 2);
      if (direction.isZero()) continue;
      const Point a = at - 16 * direction, b = at + 16 * direction;
      const auto [free, edge_on] = boxes.judge(a, b);
      free_count += free;
      edge_on_count += free && edge_on;
      if (index.is_free(a, b) == free) continue;
      if (++wrong <= 10) {
        ADD_FAILURE() << "through (" << at.transpose() << ") along ("
                      << direction.transpose() << "): nearby lines "
                      << (free ? "pass" : "are blocked");
      }
    }
  }
  EXPECT_EQ(wrong, 0);
  std::printf("free %d, of these edge-on %d, wrong %d\n", free_count, edge_on_count,
              wrong);
  EXPECT_GT(edge_on_count, 100);
}

TEST(EvOracle, LineByLineForTouchingBoxes) {
  for (const testing::Touching kind : testing::all_touching()) {
    SCOPED_TRACE(testing::name(kind));
    const Comparison c = compare_line_by_line(testing::touching_boxes(kind), 3);
    EXPECT_EQ(c.wrong, 0) << c.first_wrong;
    std::printf("%-16s in %d, edge-on %d, out %d, seams %d, wrong %d\n",
                testing::name(kind).c_str(), c.in_both, c.edge_on_in, c.in_none, c.seams,
                c.wrong);
  }
}

TEST(EvOracle, LineByLineForBoxesOnAGrid) {
  Comparison total;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const bool may_touch = seed % 3 != 0;
    const PolygonSoup soup = testing::random_boxes(seed, 4 + static_cast<int>(seed % 4),
                                                   {.grid = may_touch ? 4 : 7,
                                                    .may_touch = may_touch,
                                                    .min_size = 1,
                                                    .max_size = 3});
    const Comparison c = compare_line_by_line(soup, 3);
    EXPECT_EQ(c.wrong, 0) << c.first_wrong;
    total.in_both += c.in_both;
    total.edge_on_in += c.edge_on_in;
    total.in_none += c.in_none;
    total.seams += c.seams;
    total.wrong += c.wrong;
  }
  std::printf("in %d, edge-on %d, out %d, seams %d, wrong %d\n", total.in_both,
              total.edge_on_in, total.in_none, total.seams, total.wrong);
  EXPECT_GT(total.in_both, 200);
}

}  // namespace
}  // namespace sightline
