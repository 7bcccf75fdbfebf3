// Ten thousand seams, from overlap to a gap of 2^-20, at any angle and scale: right, and
// each in a bounded time; in batches, so that they can be shared out (GTEST_TOTAL_SHARDS,
// GTEST_SHARD_INDEX).

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <iostream>

#include "linespace/polygon_visibility.h"
#include "tests/support/seam_questions.h"

namespace sightline::testing {
namespace {

Vec3 exact(const ExactPosition& p) {
  return {Rational(p.exact[0]), Rational(p.exact[1]), Rational(p.exact[2])};
}

double processor_milliseconds() {
  return 1000.0 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

constexpr std::uint64_t kBatch = 500;

class VisibilitySeamsSoak : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(VisibilitySeamsSoak, EndAndAreRight) {
  std::vector<double> times;
  int visible = 0, hidden = 0;
  int asked_of_oracle = 0;  // hidden ones that are not so by construction
  const std::uint64_t first = GetParam() * kBatch;
  for (std::uint64_t seed = first; seed < first + kBatch; ++seed) {
    const SeamQuestion q = seam_question(seed);
    const double before = processor_milliseconds();
    const VisibilityAnswer answer =
        polygon_visibility({q.instance.a, q.instance.b, q.instance.occluders});
    times.push_back(processor_milliseconds() - before);
    ASSERT_NE(answer.verdict, Verdict::Undecided) << seed;
    const bool is_visible = answer.verdict == Verdict::Visible;
    ++(is_visible ? visible : hidden);
    if (q.visible) {
      EXPECT_EQ(is_visible, *q.visible) << seed;
    }
    if (is_visible) {
      const auto& [from, to] = *answer.witness;
      EXPECT_TRUE(is_free(q.instance, exact(from), exact(to))) << seed;
    } else if (!q.visible) {
      ++asked_of_oracle;
      EXPECT_EQ(naive_visibility(q.instance).answer, NaiveAnswer::Hidden) << seed;
    }
  }
  std::ranges::sort(times);
  std::cout << visible << " visible, " << hidden << " hidden, of these "
            << asked_of_oracle << " by the oracle too; processor time, ms: median "
            << times[times.size() / 2] << ", worst " << times.back() << "\n";
  EXPECT_LT(times.back(), 5000);
}

INSTANTIATE_TEST_SUITE_P(TenThousand, VisibilitySeamsSoak,
                         ::testing::Range<std::uint64_t>(0, 10'000 / kBatch));

}  // namespace
}  // namespace sightline::testing
