#include "aspect/views/estimate.h"

#include <gtest/gtest.h>

#include <random>
#include <unordered_map>

namespace sightline::internal {
namespace {

// Labels of unequal weights, of which many are rare: the unseen share is known.
TEST(Estimate, IntervalsHoldTheUnseenShare) {
  std::vector<double> weights;
  for (int i = 1; i <= 400; ++i) weights.push_back(1.0 / (i * i));
  double all = 0;
  for (const double w : weights) all += w;
  for (const int samples : {100, 1000, 10000}) {
    int held = 0;
    for (unsigned seed = 1; seed <= 100; ++seed) {
      std::mt19937 random(seed);
      std::discrete_distribution<int> draw(weights.begin(), weights.end());
      std::unordered_map<int, int> seen;
      for (int k = 0; k < samples; ++k) ++seen[draw(random)];
      double unseen = 0;
      for (std::size_t i = 0; i < weights.size(); ++i) {
        if (!seen.contains(static_cast<int>(i))) unseen += weights[i] / all;
      }
      std::vector<int> times;
      for (const auto& [label, n] : seen) times.push_back(n);
      const AspectEstimate e = estimate_of(times);
      held += e.unseen_interval[0] <= unseen && unseen <= e.unseen_interval[1] ? 1 : 0;
      EXPECT_LE(e.distinct_interval[0], e.distinct_total);
      EXPECT_LE(e.distinct_total, e.distinct_interval[1]);
      EXPECT_GE(e.distinct_interval[0], static_cast<double>(seen.size()));
    }
    EXPECT_GE(held, 90) << samples;
  }
}

// Clopper and Pearson's table: 0 of 10 and 5 of 10.
TEST(Estimate, ShareInterval) {
  EXPECT_NEAR(share_interval(0, 10)[1], 0.3085, 1e-4);
  EXPECT_NEAR(share_interval(5, 10)[0], 0.1871, 1e-4);
  EXPECT_NEAR(share_interval(5, 10)[1], 0.8129, 1e-4);
  EXPECT_EQ(share_interval(0, 10)[0], 0);
  EXPECT_EQ(share_interval(10, 10)[1], 1);
}

}  // namespace
}  // namespace sightline::internal
