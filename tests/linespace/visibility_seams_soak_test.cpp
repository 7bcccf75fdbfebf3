// Ten thousand seams, from overlap to a gap of 2^-20, at any angle and scale: right, and
// each in a bounded time.

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

TEST(VisibilitySeamsSoak, TenThousandEndAndAreRight) {
  std::vector<double> times;
  int visible = 0, hidden_by_oracle = 0;
  for (std::uint64_t seed = 0; seed < 10'000; ++seed) {
    const SeamQuestion q = seam_question(seed);
    const double before = processor_milliseconds();
    const VisibilityAnswer answer =
        polygon_visibility({q.instance.a, q.instance.b, q.instance.occluders});
    times.push_back(processor_milliseconds() - before);
    ASSERT_NE(answer.verdict, Verdict::Undecided) << seed;
    const bool is_visible = answer.verdict == Verdict::Visible;
    visible += is_visible;
    if (q.visible) {
      EXPECT_EQ(is_visible, *q.visible) << seed;
    }
    if (is_visible) {
      const auto& [from, to] = *answer.witness;
      EXPECT_TRUE(is_free(q.instance, exact(from), exact(to))) << seed;
    } else if (!q.visible) {
      ++hidden_by_oracle;
      EXPECT_EQ(naive_visibility(q.instance).answer, NaiveAnswer::Hidden) << seed;
    }
  }
  std::ranges::sort(times);
  std::cout << visible << " visible, " << hidden_by_oracle
            << " hidden by the oracle too; processor time, ms: median "
            << times[times.size() / 2] << ", worst " << times.back() << "\n";
  EXPECT_LT(times.back(), 5000);
}

}  // namespace
}  // namespace sightline::testing
