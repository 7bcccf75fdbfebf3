// Events on 10^4 random paths.
//
// SIGHTLINE_PATHS: paths a scene and test, to run a share of these, or more;
// SIGHTLINE_PATH_SEED: added to the seeds.

#include <gtest/gtest.h>

#include <iostream>

#include "tests/support/path_comparison.h"
#include "tests/support/setting.h"

namespace sightline::testing {
namespace {

void expect_right(PathRun run) {
  run.paths = setting("SIGHTLINE_PATHS", run.paths);
  run.seed += static_cast<std::uint64_t>(setting("SIGHTLINE_PATH_SEED", 0));
  const PathReport report = compare_paths(run);
  for (const std::string& d : report.differences) ADD_FAILURE() << d;
  std::cout << report.paths << " paths, " << report.changes << " changes, "
            << report.events << " events, " << report.views << " views\n";
}

TEST(ViewPathSoak, RandomPaths1) { expect_right({.paths = 32, .seed = 1000}); }
TEST(ViewPathSoak, RandomPaths2) { expect_right({.paths = 32, .seed = 2000}); }
TEST(ViewPathSoak, RandomPaths3) { expect_right({.paths = 32, .seed = 3000}); }
TEST(ViewPathSoak, RandomPaths4) { expect_right({.paths = 32, .seed = 4000}); }

TEST(ViewPathSoak, WhereFacesCross) {
  expect_right({.paths = 20, .seed = 5000, .crossing = true});
}

}  // namespace
}  // namespace sightline::testing
