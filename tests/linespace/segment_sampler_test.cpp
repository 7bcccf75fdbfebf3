#include "linespace/between/segment_sampler.h"

#include <gtest/gtest.h>

#include "tests/support/visibility_cases.h"

namespace sightline::testing {
namespace {

using internal::SegmentSampler;
using internal::SightPoint;
using internal::SightSpace;
using internal::Triangle;

const Triangle kBelow{Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0)};
const Triangle kAbove{Point(0, 0, 1), Point(1, 0, 1), Point(0, 1, 1)};

const auto kYes = [](const SightPoint&) { return true; };

bool is_inside(const internal::Weights& w) {
  return w[0] > 0 && w[1] > 0 && w[2] > 0 && w[0] + w[1] + w[2] == 1;
}

TEST(SegmentSampler, SegmentsAreStrictlyInside) {
  for (int seed = 0; seed < 100; ++seed) {
    SegmentSampler sampler(kBelow, kAbove, seed);
    int seen = 0;
    EXPECT_FALSE(sampler.spread(32, [&](const SightPoint& s) {
      EXPECT_TRUE(is_inside(s.alpha) && is_inside(s.beta));
      ++seen;
      return false;
    }));
    EXPECT_GE(seen, 30);
    for (const SightPoint& s : sampler.first()) {
      EXPECT_TRUE(is_inside(s.alpha) && is_inside(s.beta));
    }
  }
}

// Of what it proposes, hardly anything is blocked, and of what it does not, hardly
// anything is free: floats err only beside edges.
TEST(SegmentSampler, ProposesWhatNoOccluderBlocks) {
  int proposed = 0, wrong = 0;
  for (int seed = 0; seed < 40; ++seed) {
    const VisibilityInstance instance = slab_instance(seed, 20, 0.4);
    const Triangle a{instance.a[0], instance.a[1], instance.a[2]};
    const Triangle b{instance.b[0], instance.b[1], instance.b[2]};
    SegmentSampler sampler(a, b, seed);
    SightSpace space(a, b);
    for (std::size_t i = 0; i < instance.occluders.size(); ++i) {
      sampler.add(instance.occluders[i]);
      space.add(static_cast<int>(i), {static_cast<int>(i), instance.occluders[i]});
    }
    const auto blocked = [&](const SightPoint& s) {
      return std::ranges::any_of(space.blockers(), [&](const internal::Blocker& blocker) {
        return space.blocks(blocker, s);
      });
    };
    int seen = 0;
    (void)sampler.spread(64, [&](const SightPoint& s) {
      ++seen;
      wrong += blocked(s);
      return false;
    });
    proposed += seen;
    int free = 0;
    for (const SightPoint& s : sampler.first()) free += !blocked(s);
    wrong += std::abs(free - seen);
  }
  EXPECT_GT(proposed, 100);
  EXPECT_LE(wrong, 2);
}

// Where much is hidden, few spread segments are free, but of those that one or two
// occluders block many lie beside an opening.
TEST(SegmentSampler, WalksFindWhatSpreadSegmentsDoNot) {
  int spread = 0, walked = 0;
  for (int seed = 0; seed < 50; ++seed) {
    const VisibilityInstance instance = slab_instance(seed, 200, 0.25);
    SegmentSampler sampler({instance.a[0], instance.a[1], instance.a[2]},
                           {instance.b[0], instance.b[1], instance.b[2]}, seed);
    for (const Polygon& occluder : instance.occluders) sampler.add(occluder);
    if (sampler.spread(512, kYes)) {
      ++spread;
    } else if (sampler.descend(3584, kYes)) {
      ++walked;
    }
    EXPECT_LE(sampler.tried(), 4096);
  }
  EXPECT_LT(spread, 25);
  EXPECT_GT(walked, 20);
}

TEST(SegmentSampler, GivesUpWhereOneOccluderBlocksAll) {
  SegmentSampler sampler(kBelow, kAbove, 1);
  const std::array<Point, 3> small{Point(0.1, 0.1, 0.5), Point(0.2, 0.1, 0.5),
                                   Point(0.1, 0.2, 0.5)};
  const std::array<Point, 3> screen{Point(-9, -9, 0.5), Point(9, -9, 0.5),
                                    Point(0, 9, 0.5)};
  sampler.add(small);
  sampler.add(screen);
  EXPECT_FALSE(sampler.spread(4096, kYes));
  EXPECT_FALSE(sampler.descend(4096, kYes));
  EXPECT_EQ(sampler.tried(), 64);
  EXPECT_EQ(sampler.heavy().front(), 1);
}

}  // namespace
}  // namespace sightline::testing
