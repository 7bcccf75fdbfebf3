// The faces at both far ends of arcs, piece by piece, against the contacts of exact
// lines.

#include <gtest/gtest.h>

#include <algorithm>

#include "linespace/mesh_io.h"
#include "linespace/scene.h"
#include "skeleton/build.h"
#include "skeleton/skeleton_lines.h"
#include "tests/support/eee_scenes.h"
#include "tests/support/generators.h"
#include "tests/support/invariant_scenes.h"

namespace sightline {
namespace {

FreeSegment line_at(const SkeletonLines& lines, const SkeletonArc& arc, double s) {
  return lines.line(arc, s).value();
}

struct Tally {
  int arcs = 0, pieces = 0, lines = 0, wrong = 0, changing = 0;
};

// Pieces tile the range, neighbours differ, and `samples` random lines end as told.
void check_arc(const SkeletonLines& lines, const SkeletonArc& arc, int samples,
               testing::Random& random, Tally& tally) {
  constexpr double kTooClose = 0x1p-37;
  if (arc.range[1] - arc.range[0] < 64 * kTooClose) return;
  const auto ends = lines.ends(arc);
  ASSERT_FALSE(ends.empty());
  ++tally.arcs;
  tally.pieces += static_cast<int>(ends.size());
  tally.changing += static_cast<int>(ends.size() > 1);
  EXPECT_EQ(ends.front().range[0], arc.range[0]);
  EXPECT_EQ(ends.back().range[1], arc.range[1]);
  for (std::size_t i = 1; i < ends.size(); ++i) {
    EXPECT_EQ(ends[i - 1].range[1], ends[i].range[0]);
    EXPECT_NE(ends[i - 1].faces, ends[i].faces);
  }
  const auto ask = [&](std::size_t i, double s) {
    const FreeSegment line = line_at(lines, arc, s);
    ++tally.lines;
    const std::array<std::vector<int>, 2> found{line.from_faces, line.to_faces};
    if (found == ends[i].faces) return;
    ++tally.wrong;
    if (tally.wrong > 3) return;
    ADD_FAILURE() << "at " << s << " in [" << ends[i].range[0] << ", " << ends[i].range[1]
                  << "]: " << ::testing::PrintToString(found) << " instead of "
                  << ::testing::PrintToString(ends[i].faces);
  };
  for (int k = 0; k < samples; ++k) {
    const double s = random.uniform(arc.range[0], arc.range[1]);
    std::size_t i = 0;
    while (i + 1 < ends.size() && s > ends[i].range[1]) ++i;
    if (s - ends[i].range[0] < kTooClose || ends[i].range[1] - s < kTooClose) continue;
    ask(i, s);
  }
  // Close to both ends of every piece.
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const auto [a, b] = ends[i].range;
    if (b - a < 4 * kTooClose) continue;
    ask(i, a + kTooClose);
    ask(i, b - kTooClose);
  }
}

void check_scene(const Scene& scene, std::uint64_t seed, int samples, int chosen,
                 int chosen_samples, Tally& ev, Tally& eee) {
  const Skeleton skeleton = build_skeleton(scene);
  const SkeletonLines lines(scene);
  testing::Random random(seed);
  const auto check_kind = [&](const auto& arcs, Tally& tally) {
    const int every = std::max(1, static_cast<int>(arcs.size()) / std::max(1, chosen));
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      const bool closely = chosen > 0 && static_cast<int>(i) % every == 0;
      check_arc(lines, arcs[i], closely ? chosen_samples : samples, random, tally);
    }
  };
  check_kind(skeleton.ev(), ev);
  check_kind(skeleton.eee(), eee);
}

TEST(FarPieces, EndWhereExactLinesDo) {
  Tally ev, eee;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    check_scene(Scene(testing::eee_scene(seed)), seed, 1, 6, 1000, ev, eee);
  }
  for (const Tally& t : {ev, eee}) {
    EXPECT_EQ(t.wrong, 0) << t.lines;
    EXPECT_GT(t.lines, 200000);
    EXPECT_GT(t.changing, 400);
    std::printf("%d arcs, %d pieces, %d lines\n", t.arcs, t.pieces, t.lines);
  }
}

TEST(FarPieces, HoldInDenseAndInAlignedScenes) {
  Tally ev, eee;
  const auto check = [&](const char* name, const PolygonSoup& soup) {
    SCOPED_TRACE(name);
    check_scene(Scene(soup), 5, 0, 200, 20, ev, eee);
  };
  check("dense", testing::random_polytopes(5, 30, {.density = 0.3}));
  check("soup", testing::triangle_soup(3, 12));
  check("city", testing::city(2, 30));
  check("grid", testing::grid_city(4, 30));
  for (const Tally& t : {ev, eee}) {
    EXPECT_EQ(t.wrong, 0) << t.lines;
    EXPECT_GT(t.changing, 500);
    std::printf("%d arcs, %d pieces, %d lines\n", t.arcs, t.pieces, t.lines);
  }
}

// What two faces that cross each other end changes where a line meets both.
TEST(FarPieces, HoldWhereFacesOfSolidsCross) {
  Tally ev, eee;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(seed);
    const PolygonSoup soup = testing::crowded_scene(testing::Crowd::Overlapping, seed);
    check_scene(Scene(soup), 1, 0, 200, 20, ev, eee);
  }
  for (const Tally& t : {ev, eee}) {
    EXPECT_EQ(t.wrong, 0) << t.lines;
    EXPECT_GT(t.changing, 50);
    std::printf("%d arcs, %d pieces, %d lines\n", t.arcs, t.pieces, t.lines);
  }
}

TEST(FarPieces, AreThoseThatTheContactTestFinds) {
  const Scene scene(testing::random_polytopes(7, 12, {.density = 0.25}));
  const Skeleton skeleton = build_skeleton(scene);
  const SkeletonLines lines(scene);
  for (std::size_t i = 0; i < skeleton.ev().size(); i += 5) {
    const auto expected = lines.pieces(skeleton.ev()[i]);
    const auto found = lines.ends(skeleton.ev()[i]);
    ASSERT_EQ(found.size(), expected.size()) << i;
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_NEAR(found[k].range[0], expected[k].range[0], 1e-11);
      EXPECT_EQ(found[k].faces[0], expected[k].line.from_faces);
      EXPECT_EQ(found[k].faces[1], expected[k].line.to_faces);
    }
  }
}

}  // namespace
}  // namespace sightline
