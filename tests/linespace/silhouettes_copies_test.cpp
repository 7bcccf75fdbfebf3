// What setting up a scene's ridges and corners costs where objects are equal, or many
// faces share an edge: counted in predicates, which do not depend on the machine.

#include <gtest/gtest.h>

#include <cmath>

#include "linespace/silhouettes/silhouettes.h"
#include "tests/support/generators.h"

namespace sightline::internal {
namespace {

// Predicates of all stages that setting up takes.
double cost_of(const Scene& scene, EventMode events) {
  const StageCounts before = thread_stage_counts();
  Request request;
  request.threads = 1;
  const Silhouettes silhouettes(scene, events, request);
  const StageCounts& after = thread_stage_counts();
  return static_cast<double>(after.by_double - before.by_double + after.by_interval -
                             before.by_interval + after.by_exact - before.by_exact);
}

Scene copies_of_a_box(int count) {
  const testing::AlignedBox box{{0, 0, 0}, {1, 1, 1}};
  return Scene(testing::boxes_soup(std::vector(static_cast<std::size_t>(count), box)));
}

constexpr EventMode kModes[] = {EventMode::Solid, EventMode::Polygon};

TEST(SilhouettesOfCopies, CostGrowsWithTheirNumber) {
  const Scene few = copies_of_a_box(100), many = copies_of_a_box(400);
  for (const EventMode mode : kModes) {
    const double factor = cost_of(many, mode) / cost_of(few, mode);
    EXPECT_LT(factor, 8) << static_cast<int>(mode);
  }
}

// Edges that several objects share are one ridge each, however many these are.
TEST(SilhouettesOfCopies, HaveTheRidgesOfTwo) {
  for (const EventMode mode : kModes) {
    const Scene two_boxes = copies_of_a_box(2), many_boxes = copies_of_a_box(9);
    const Silhouettes two(two_boxes, mode), many(many_boxes, mode);
    ASSERT_EQ(two.ridges().size(), 12U);
    ASSERT_EQ(many.ridges().size(), 12U);
    for (std::size_t i = 0; i < 12; ++i) {
      const Ridge& x = two.ridges()[i];
      const Ridge& y = many.ridges()[i];
      EXPECT_EQ(y.points, x.points);
      EXPECT_EQ(y.objects.size(), 9U);
      EXPECT_TRUE(x.touched && y.touched);
      EXPECT_EQ(y.can_graze(), x.can_graze());
      EXPECT_EQ(y.ends_in_front, x.ends_in_front);
      EXPECT_EQ(y.ends_behind, x.ends_behind);
    }
  }
}

}  // namespace
}  // namespace sightline::internal
