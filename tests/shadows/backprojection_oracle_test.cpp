// What points see of area lights, against the naive answer.  backprojection_oracle_soak
// asks a million points.

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace sightline::testing
