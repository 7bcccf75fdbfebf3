// As invariances_test.cpp, on 1,000 scenes: 250 of each crowd under every variant.

#include <gtest/gtest.h>

#include <tuple>

#include "tests/support/answers.h"

namespace sightline {
namespace {

using testing::Crowd;

class ThousandScenes : public ::testing::TestWithParam<std::tuple<Crowd, std::uint64_t>> {
};

TEST_P(ThousandScenes, AreTheSameInEveryWriting) {
  const auto [crowd, tens] = GetParam();
  int alike = 0;
  int expected = 0;
  for (std::uint64_t seed = 10 * tens; seed < 10 * tens + 10; ++seed) {
    alike += testing::count_alike(crowd, seed);
    expected += 10;
  }
  EXPECT_EQ(alike, expected);
}

INSTANTIATE_TEST_SUITE_P(
    Invariances, ThousandScenes,
    ::testing::Combine(::testing::Values(Crowd::Overlapping, Crowd::Touching,
                                         Crowd::RepeatedFaces, Crowd::NonManifold),
                       ::testing::Range<std::uint64_t>(0, 25)));

}  // namespace
}  // namespace sightline
