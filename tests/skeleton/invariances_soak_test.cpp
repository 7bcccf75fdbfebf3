// As invariances_test.cpp, on 1,000 scenes: 250 of each crowd under every variant.

#include <gtest/gtest.h>

#include "tests/support/answers.h"

namespace sightline {
namespace {

using testing::Crowd;

class ThousandScenes : public ::testing::TestWithParam<std::tuple<Crowd, std::uint64_t>> {
};

TEST_P(ThousandScenes, AreTheSameInEveryWriting) {
  const auto [crowd, tens] = GetParam();
  int variants = 0;
  for (std::uint64_t seed = 10 * tens; seed < 10 * tens + 10; ++seed) {
    variants += testing::count_alike(crowd, seed);
  }
  EXPECT_EQ(variants, 100);
}

INSTANTIATE_TEST_SUITE_P(
    Invariances, ThousandScenes,
    ::testing::Combine(::testing::Values(Crowd::Overlapping, Crowd::Touching,
                                         Crowd::RepeatedFaces, Crowd::NonManifold),
                       ::testing::Range<std::uint64_t>(0, 25)));

}  // namespace
}  // namespace sightline
