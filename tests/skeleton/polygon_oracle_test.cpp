// Polygon mode against naive oracles: every node and arc of seeded scenes in general
// position, with which contacts graze and which end.  Takes minutes: the oracles look at
// every three edges.

#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "linespace/scene.h"
#include "skeleton/build.h"
#include "tests/support/eee_scenes.h"
#include "tests/support/library_skeleton.h"
#include "tests/support/naive_eee.h"
#include "tests/support/naive_ev.h"

namespace sightline {
namespace {

using testing::CanonicalSkeleton;

Skeleton polygon_skeleton(const Scene& scene, bool ev, bool eee) {
  SkeletonRequest request;
  request.events = EventMode::Polygon;
  request.ev = ev;
  request.eee = eee;
  return build_skeleton(scene, request);
}

using Totals = std::map<std::string, int>;

void add(const CanonicalSkeleton& skeleton, Totals& totals) {
  for (const auto& [kind, count] : skeleton.counts()) totals[kind] += count;
}

void expect_and_print(Totals totals, const std::vector<std::string>& kinds) {
  for (const std::string& kind : kinds) {
    std::printf("%s %d  ", kind.c_str(), totals[kind]);
    EXPECT_GT(totals[kind], 100) << kind;
  }
  std::printf("\n");
}

// Scene by scene against one of the naive enumerations; `ev`, `eee`: what it enumerates.
void compare_with(CanonicalSkeleton (*enumerate)(const PolygonSoup&, bool), bool ev,
                  bool eee, const std::vector<std::string>& kinds) {
  Totals totals;
  int scenes = 0;
  for (std::uint64_t seed = 1; seed <= 44; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const PolygonSoup soup = testing::eee_scene(seed);
    CanonicalSkeleton naive;
    try {
      naive = enumerate(soup, true);
    } catch (const testing::NotGeneral&) {
      continue;
    }
    ++scenes;
    const Scene scene(soup);
    const CanonicalSkeleton ours =
        testing::canonical(scene, polygon_skeleton(scene, ev, eee));
    EXPECT_EQ(ours.counts(), naive.counts());
    EXPECT_EQ(testing::difference(ours, "the skeleton", naive, "the oracle"), "");
    add(naive, totals);
    if (::testing::Test::HasFailure()) break;
  }
  EXPECT_GE(scenes, 40) << "too many seeds are not in general position";
  std::printf("in %d scenes: ", scenes);
  expect_and_print(totals, kinds);
}

TEST(PolygonOracle, EveryEvArcAndNodeInGeneralPosition) {
  compare_with(testing::naive_ev, true, false,
               {"EV", "EV_end", "VV", "VV_end", "VEE", "VEE_end", "EVE", "EVE_end", "FvE",
                "FvE_end"});
}

TEST(PolygonOracle, EverySkeletonArcAndNodeInGeneralPosition) {
  compare_with(testing::naive_eee, false, true,
               {"EEE", "EEE_end", "VEE", "VEE_end", "EVE", "EVE_end", "EEEE", "EEEE_end",
                "FEE", "FEE_end"});
}

}  // namespace
}  // namespace sightline
