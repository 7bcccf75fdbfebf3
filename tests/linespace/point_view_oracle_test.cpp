// The exact view from a point against the naive one, on seeded scenes and eyes.

#include <gtest/gtest.h>

#include "tests/support/setting.h"
#include "tests/support/view_comparison.h"

namespace sightline::testing {
namespace {

void expect_equal(const ViewRun& run) {
  for (const std::string& report : compare_views(run)) ADD_FAILURE() << report;
}

// SIGHTLINE_VIEW_EYES: eyes a scene; SIGHTLINE_VIEW_SEED: another choice of them;
// SIGHTLINE_VIEW_ON_SCENE=0 leaves out those on facets, edges and corners.
TEST(PointViewOracle, ViewsEqualTheNaiveOnes) {
  expect_equal({.eyes = setting("SIGHTLINE_VIEW_EYES", 2),
                .seed = static_cast<std::uint64_t>(setting("SIGHTLINE_VIEW_SEED", 0)),
                .general = false,
                .on_scene = setting("SIGHTLINE_VIEW_ON_SCENE", 1) != 0,
                .most_reports = setting("SIGHTLINE_VIEW_REPORTS", 10)});
}

TEST(PointViewOracle, LargeScenes) {
  expect_equal({.eyes = setting("SIGHTLINE_VIEW_EYES", 1),
                .seed = static_cast<std::uint64_t>(setting("SIGHTLINE_VIEW_SEED", 0)),
                .general = false,
                .large = true,
                .on_scene = setting("SIGHTLINE_VIEW_ON_SCENE", 1) != 0});
}

// From as near a plane, a line or a point as numbers come, and nearer.
TEST(PointViewOracle, EyesAndDirectionsBarelyOffPlanes) {
  expect_equal({.eyes = setting("SIGHTLINE_VIEW_EYES", 3),
                .seed = static_cast<std::uint64_t>(setting("SIGHTLINE_VIEW_SEED", 4)),
                .general = false,
                .every = setting("SIGHTLINE_VIEW_EVERY", 2),
                .barely_off = true,
                .most_reports = setting("SIGHTLINE_VIEW_REPORTS", 10)});
}

// SIGHTLINE_VIEW_EVERY: of how many scenes one.
TEST(PointViewOracle, GeneralViewsStructuresAndGradientsAreTheNaiveOnes) {
  expect_equal({.eyes = setting("SIGHTLINE_VIEW_EYES", 1),
                .seed = static_cast<std::uint64_t>(setting("SIGHTLINE_VIEW_SEED", 0)),
                .general = true,
                .every = setting("SIGHTLINE_VIEW_EVERY", 8),
                .on_scene = false,
                .most_reports = setting("SIGHTLINE_VIEW_REPORTS", 10)});
}

}  // namespace
}  // namespace sightline::testing
