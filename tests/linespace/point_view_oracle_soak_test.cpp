// The exact view from a point against the naive one on many eyes.
//
// SIGHTLINE_VIEW_EYES: eyes a scene, to run a share of these, or more;
// SIGHTLINE_VIEW_SEED: another choice of them.

#include <gtest/gtest.h>

#include "tests/support/setting.h"
#include "tests/support/view_comparison.h"

namespace sightline::testing {
namespace {

void expect_equal(ViewRun run) {
  run.eyes = setting("SIGHTLINE_VIEW_EYES", run.eyes);
  run.seed = static_cast<std::uint64_t>(
      setting("SIGHTLINE_VIEW_SEED", static_cast<int>(run.seed)));
  for (const std::string& report : compare_views(run)) ADD_FAILURE() << report;
}

TEST(PointViewOracleSoak, ViewsEqualTheNaiveOnes) {
  expect_equal({.eyes = 1000, .seed = 1000, .general = false});
}

TEST(PointViewOracleSoak, BarelyOffPlanes) {
  expect_equal({.eyes = 100, .seed = 4000, .general = false, .barely_off = true});
}

TEST(PointViewOracleSoak, LargeScenes) {
  expect_equal({.eyes = 300, .seed = 3000, .general = false, .large = true});
}

TEST(PointViewOracleSoak, GeneralViewsAndStructures) {
  expect_equal({.eyes = 50, .seed = 2000, .general = true});
}

}  // namespace
}  // namespace sightline::testing
