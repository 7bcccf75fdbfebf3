// Form factors by a second way: all small scenes, and 200 entries of an enclosure.

#include <cstdio>
#include <random>

#include "tests/shadows/free_lines_comparison.h"

namespace sightline {
namespace {

class FreeLinesOnScenes : public ::testing::TestWithParam<int> {};

TEST_P(FreeLinesOnScenes, AgreesWithFormFactors) {
  const auto scenes = testing::form_factor_scenes();
  // The second way is not quite there: it is off by up to 8e-10 by upright sheets.
  testing::expect_two_ways_agree(scenes.at(GetParam()), 6, 2e-9);
}
INSTANTIATE_TEST_SUITE_P(Scenes, FreeLinesOnScenes, ::testing::Range(0, 56));

// A unit cube, each wall 10 x 10 squares, with 8 boxes: 648 surfaces.
TEST(FreeLinesSoak, EntriesOfAnEnclosure) {
  const PolygonSoup soup = testing::enclosure_with_boxes(10, 8, 1);
  const Scene scene(soup);
  const auto surfaces =
      surfaces_of(scene, {.groups = {}, .both_sides = {}, .each_face = true});
  ASSERT_EQ(surfaces.size(), 648u);
  FormFactorRequest request;
  request.accuracy = 1e-7;
  request.threads = 1;
  const FormFactors f = form_factors(scene, surfaces, request);
  EXPECT_LE(f.error_bound, 1e-7);
  for (int i = 0; i < 648; ++i) {
    const FormFactorRow& row = f.rows[i];
    EXPECT_NEAR(f.row_sum(i) + row.others + row.outside + row.backs, 1, 1e-6)
        << f.names[i];
  }
  const auto faces = testing::free_blockers(scene, soup);
  std::mt19937 random(7);
  int entries = 0;
  double worst = 0;
  while (entries < 200) {
    const int i = static_cast<int>(random() % 648), j = static_cast<int>(random() % 648);
    if (i == j) continue;
    const auto both = testing::two_ways(f, surfaces, soup, faces, i, j, 2e-8);
    if (both.library == 0 && both.free_lines == 0) continue;
    ++entries;
    worst = std::max(worst, std::abs(both.library - both.free_lines));
    EXPECT_NEAR(both.library, both.free_lines, 2e-7) << f.names[i] << " " << f.names[j];
  }
  std::printf("200 entries, worst difference %.2e\n", worst);
}

}  // namespace
}  // namespace sightline
