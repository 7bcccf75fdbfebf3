// The constructed instances have the answers they claim, by the naive decision.

#include "tests/support/visibility_cases.h"

#include <gtest/gtest.h>

#include <chrono>

namespace sightline::testing {
namespace {

TEST(VisibilityCases, KnownAnswers) {
  for (const VisibilityCase& c : known_visibility_cases()) {
    const auto t0 = std::chrono::steady_clock::now();
    const NaiveVisibility naive = naive_visibility(c.instance);
    EXPECT_EQ(naive.answer, *c.visible ? NaiveAnswer::Visible : NaiveAnswer::Hidden)
        << c.name << " " << static_cast<int>(naive.answer);
    printf("%s: %.3f s %ld %ld\n", c.name.c_str(),
           std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count(),
           naive.quadruples, naive.exact_quadruples);
  }
}

}  // namespace
}  // namespace sightline::testing
