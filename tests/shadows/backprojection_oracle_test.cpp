// What points see of area lights, against the naive answer.  backprojection_oracle_soak
// asks a million points.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/shadows/backprojection_comparison.h"

namespace sightline::testing {
namespace {

TEST(BackprojectionOracle, RandomPoints) {
  ComparisonCounts sum;
  for (const ShadowScene& lit : shadow_scenes()) {
    BackprojectionComparison comparison(lit);
    for (const AskedPoint& p : random_asked_points(comparison.scene(), 1, 30)) {
      const auto difference =
          comparison.difference(p, {.gradient = true, .structure = true});
      EXPECT_FALSE(difference) << *difference;
    }
    sum.penumbra += comparison.counts().penumbra;
    sum.gradients += comparison.counts().gradients;
    sum.sides += comparison.counts().sides;
  }
  EXPECT_GT(sum.penumbra, 300);
  EXPECT_GT(sum.gradients, 1000);
  EXPECT_GT(sum.sides, 3000);
}

TEST(BackprojectionOracle, PointsOnEvents) {
  for (const ShadowScene& lit : shadow_scenes()) {
    BackprojectionComparison comparison(lit);
    for (const AskedPoint& p : event_asked_points(comparison.scene(), 1, 60)) {
      const auto difference = comparison.difference(p, {});
      EXPECT_FALSE(difference) << *difference;
    }
  }
}

// 2^52 sizes away, between the planes of the two triangles of a bent light: what bounds
// the cone over one of them was rounded to the other side, and a sheet in the way left
// out.
TEST(BackprojectionOracle, FarAwayBesideABentLight) {
  const AskedPoint p{{Rational("178590273716009759162729530416053323602804488827/"
                               "37649073427752195495588242915328"),
                      Rational("4382162711818948217518224875481669196311078733823/"
                               "451788881133026345947058914983936"),
                      Rational("-359282713501266998933879861254269904865638539373/"
                               "56473610141628293243382364372992")},
                     std::nullopt};
  const auto scenes = shadow_scenes();
  const auto bent = std::ranges::find(scenes, "sheets 2, bent 11", &ShadowScene::name);
  ASSERT_NE(bent, scenes.end());
  const auto difference = BackprojectionComparison(*bent).difference(p, {});
  EXPECT_FALSE(difference) << *difference;
}

}  // namespace
}  // namespace sightline::testing
