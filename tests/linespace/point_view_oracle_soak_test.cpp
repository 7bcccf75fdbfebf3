// The exact view from a point against the naive one on many eyes.

#include <gtest/gtest.h>

#include "tests/support/view_comparison.h"

namespace sightline::testing {
namespace {

TEST(PointViewOracleSoak, ViewsEqualTheNaiveOnes) {
  for (const std::string& report :
       compare_views({.eyes = 1000, .seed = 1000, .general = false})) {
    ADD_FAILURE() << report;
  }
}

TEST(PointViewOracleSoak, LargeScenes) {
  for (const std::string& report :
       compare_views({.eyes = 300, .seed = 3000, .general = false, .large = true})) {
    ADD_FAILURE() << report;
  }
}

TEST(PointViewOracleSoak, GeneralViewsAndStructures) {
  for (const std::string& report :
       compare_views({.eyes = 50, .seed = 2000, .general = true})) {
    ADD_FAILURE() << report;
  }
}

}  // namespace
}  // namespace sightline::testing
