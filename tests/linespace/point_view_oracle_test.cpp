// The exact view from a point against the naive one, on seeded scenes and eyes.

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/view_comparison.h"

namespace sightline::testing {
namespace {

/// A number of the environment, for longer runs.
int setting(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atoi(text);
}

// SIGHTLINE_VIEW_EYES: eyes a scene; SIGHTLINE_VIEW_SEED: another choice of them;
// SIGHTLINE_VIEW_GENERAL=0 leaves out `general`, which takes five naive views.
TEST(PointViewOracle, ViewsEqualTheNaiveOnes) {
  const ViewRun run{.eyes = setting("SIGHTLINE_VIEW_EYES", 1),
                    .seed = static_cast<std::uint64_t>(setting("SIGHTLINE_VIEW_SEED", 0)),
                    .general = setting("SIGHTLINE_VIEW_GENERAL", 1) != 0,
                    .on_scene = setting("SIGHTLINE_VIEW_ON_SCENE", 1) != 0,
                    .most_reports = setting("SIGHTLINE_VIEW_REPORTS", 10)};
  for (const std::string& report : compare_views(run)) ADD_FAILURE() << report;
}

}  // namespace
}  // namespace sightline::testing
