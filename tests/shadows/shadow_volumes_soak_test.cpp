// Classes of shadow volumes against two other ways on very many points.  From the
// environment: SIGHTLINE_VOLUME_POINTS, SIGHTLINE_VOLUME_SEED.

#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "tests/shadows/volume_scenes.h"

namespace sightline::testing {
namespace {

int setting(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atoi(text);
}

TEST(ShadowVolumesSoak, ClassesAreThoseOfTwoOtherWays) {
  const int points = setting("SIGHTLINE_VOLUME_POINTS", 100'000);
  const std::uint64_t first = 1000 * setting("SIGHTLINE_VOLUME_SEED", 1);
  VolumeCounts counts;
  for (std::uint64_t seed = first; counts.points < points; ++seed) {
    const auto difference = volume_difference(seed, 250, counts);
    EXPECT_FALSE(difference) << *difference;
  }
  std::cout << counts.points << " points of " << counts.scenes << " scenes ("
            << counts.refused << " refused, the solid cuts the source): " << counts.umbra
            << " umbra, " << counts.penumbra << " penumbra, " << counts.lit << " lit\n";
}

}  // namespace
}  // namespace sightline::testing
