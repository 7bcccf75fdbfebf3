// Events on the way of an eye, told by hand on small scenes and checked on random ones.

#include "linespace/view_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "tests/support/path_comparison.h"

namespace sightline {
namespace {

TEST(ViewPathOracle, ViewsAndChangesOfRandomPaths) {
  const testing::PathReport report = testing::compare_paths({.paths = 2, .seed = 1});
  for (const std::string& d : report.differences) ADD_FAILURE() << d;
  std::cout << report.paths << " paths, " << report.changes << " changes, "
            << report.events << " events, " << report.views << " views\n";
}

}  // namespace
}  // namespace sightline
