// Events on many random paths.

#include <gtest/gtest.h>

#include <iostream>

#include "tests/support/path_comparison.h"

namespace sightline::testing {
namespace {

TEST(ViewPathSoak, ViewsAndChangesOfRandomPaths) {
  const PathReport report = compare_paths({.paths = 130, .seed = 1000});
  for (const std::string& d : report.differences) ADD_FAILURE() << d;
  std::cout << report.paths << " paths, " << report.changes << " changes, "
            << report.events << " events, " << report.views << " views\n";
}

}  // namespace
}  // namespace sightline::testing
