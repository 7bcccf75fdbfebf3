// As invariances_test.cpp, on 1,000 scenes: 250 of each crowd under every variant.

#include <gtest/gtest.h>

#include <tuple>

#include "tests/support/answers.h"

namespace sightline {
namespace {

using testing::Crowd;

// An object of two boxes, one inside the other, with faces in one plane: docs/
// degenerate_scenes.md, "What is invariant".
constexpr std::tuple kKnownToDiffer{Crowd::NonManifold, std::uint64_t{119}};

class ThousandScenes : public ::testing::TestWithParam<std::tuple<Crowd, std::uint64_t>> {
};

TEST_P(ThousandScenes, AreTheSameInEveryWriting) {
  const auto [crowd, tens] = GetParam();
  int alike = 0;
  int expected = 0;
  for (std::uint64_t seed = 10 * tens; seed < 10 * tens + 10; ++seed) {
    if (std::tuple(crowd, seed) == kKnownToDiffer) continue;
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
