// What points see of area lights, against the naive answer, on very many points.  From
// the environment: SIGHTLINE_SHADOW_POINTS, random points in all;
// SIGHTLINE_SHADOW_EVENTS, points on events; SIGHTLINE_SHADOW_SEED.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>

#include "tests/shadows/backprojection_comparison.h"

namespace sightline::testing {
namespace {

int setting(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atoi(text);
}

void add(ComparisonCounts& sum, const ComparisonCounts& more) {
  sum.points += more.points;
  sum.umbra += more.umbra;
  sum.penumbra += more.penumbra;
  sum.lit += more.lit;
  sum.gradients += more.gradients;
  sum.structures += more.structures;
  sum.sides += more.sides;
  sum.in_line += more.in_line;
  sum.fraction = std::max(sum.fraction, more.fraction);
  sum.form_factor = std::max(sum.form_factor, more.form_factor);
  sum.gradient = std::max(sum.gradient, more.gradient);
}

void print(const ComparisonCounts& counts) {
  std::cout << counts.points << " points (" << counts.umbra << " umbra, "
            << counts.penumbra << " penumbra, " << counts.lit
            << " lit): fractions differ by at most " << counts.fraction
            << ", form factors by " << counts.form_factor << "; " << counts.gradients
            << " gradients by " << counts.gradient << "; " << counts.structures
            << " structures, " << counts.sides << " names of sides, " << counts.in_line
            << " sides of several in line\n";
}

/// How many points differ, at most five a scene.  Every 40th point is asked with its
/// structure, every 80th with its gradient.
int differences(bool events, int count) {
  const auto scenes = shadow_scenes();
  const int each = count / static_cast<int>(scenes.size()) + 1;
  ComparisonCounts sum;
  int all = 0;
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    BackprojectionComparison comparison(scenes[s]);
    const std::uint64_t seed = 1000 * setting("SIGHTLINE_SHADOW_SEED", 1) + s;
    const auto points = events ? event_asked_points(comparison.scene(), seed, each)
                               : random_asked_points(comparison.scene(), seed, each);
    int failures = 0;
    for (std::size_t i = 0; i < points.size() && failures < 5; ++i) {
      const ComparedParts parts{.gradient = !events && i % 80 < 2,
                                .structure = !events && i % 40 < 2};
      if (const auto difference = comparison.difference(points[i], parts)) {
        ADD_FAILURE() << *difference;
        ++failures;
      }
    }
    all += failures;
    add(sum, comparison.counts());
  }
  print(sum);
  return all;
}

TEST(BackprojectionOracleSoak, RandomPoints) {
  EXPECT_EQ(differences(false, setting("SIGHTLINE_SHADOW_POINTS", 1'000'000)), 0);
}

TEST(BackprojectionOracleSoak, PointsOnEvents) {
  EXPECT_EQ(differences(true, setting("SIGHTLINE_SHADOW_EVENTS", 100'000)), 0);
}

}  // namespace
}  // namespace sightline::testing
