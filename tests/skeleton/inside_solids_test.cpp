// No arc has lines through the material of a closed object: points between the outer
// contacts of its lines are asked where they lie, whatever says that the lines are free.

#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "linespace/scene/solid_index.h"
#include "skeleton/build.h"
#include "skeleton/skeleton_lines.h"
#include "tests/support/invariant_scenes.h"

namespace sightline {
namespace {

using internal::ExactPoint;
using internal::Rational;
using testing::Crowd;

ExactPoint exact(const ExactPosition& p) {
  return {Rational(p.exact[0]), Rational(p.exact[1]), Rational(p.exact[2])};
}

// Seven points of the segment, not its ends.
bool passes_material(const internal::SolidIndex& solids,
                     const std::array<ExactPosition, 2>& segment) {
  const ExactPoint a = exact(segment[0]);
  const ExactPoint way = internal::exact_difference(exact(segment[1]), a);
  for (int k = 1; k < 8; ++k) {
    const Rational t(k, 8);
    const ExactPoint p{a[0] + t * way[0], a[1] + t * way[1], a[2] + t * way[2]};
    if (!solids.solids_around(p).empty()) return true;
  }
  return false;
}

// Arcs of which one of three lines passes material.
int count_inside(const internal::SolidIndex& solids, const SkeletonLines& lines,
                 const std::vector<SkeletonArc>& arcs) {
  int count = 0;
  for (const SkeletonArc& arc : arcs) {
    bool inside = false;
    for (const double t : {0.25, 0.5, 0.75}) {
      const double s = arc.range[0] + t * (arc.range[1] - arc.range[0]);
      if (s <= arc.range[0] || s >= arc.range[1]) continue;
      const std::optional<std::array<ExactPosition, 2>> segment = lines.points(arc, s);
      inside = inside || (segment && passes_material(solids, *segment));
    }
    count += inside ? 1 : 0;
  }
  return count;
}

class InsideSolids : public ::testing::TestWithParam<std::tuple<Crowd, std::uint64_t>> {};

TEST_P(InsideSolids, NoArcPasses) {
  const auto [crowd, seed] = GetParam();
  const Scene scene(testing::crowded_scene(crowd, seed));
  const internal::SolidIndex solids(scene);
  const SkeletonLines lines(scene);
  for (const EventMode events : {EventMode::Solid, EventMode::Polygon}) {
    SCOPED_TRACE(events == EventMode::Solid ? "solid" : "polygon");
    SkeletonRequest request;
    request.events = events;
    const Skeleton skeleton = build_skeleton(scene, request);
    EXPECT_FALSE(skeleton.ev().empty());
    EXPECT_EQ(count_inside(solids, lines, skeleton.arcs), 0);
  }
}

std::string label(const ::testing::TestParamInfo<InsideSolids::ParamType>& info) {
  std::string name = testing::name(std::get<0>(info.param));
  std::erase_if(name, [](char c) { return c == ' ' || c == '-'; });
  return name + std::to_string(std::get<1>(info.param));
}

INSTANTIATE_TEST_SUITE_P(
    Seeds, InsideSolids,
    ::testing::Combine(::testing::Values(Crowd::Overlapping, Crowd::Touching,
                                         Crowd::RepeatedFaces, Crowd::NonManifold),
                       ::testing::Range<std::uint64_t>(0, 4)),
    label);
// Each had such arcs: along walls, at the feet of walls, at reflex edges met from inside,
// between shells of one object.
INSTANTIATE_TEST_SUITE_P(Found, InsideSolids,
                         ::testing::Values(std::tuple(Crowd::Overlapping, 5),
                                           std::tuple(Crowd::NonManifold, 5),
                                           std::tuple(Crowd::NonManifold, 6),
                                           std::tuple(Crowd::NonManifold, 13),
                                           std::tuple(Crowd::Overlapping, 16),
                                           std::tuple(Crowd::NonManifold, 19),
                                           std::tuple(Crowd::Overlapping, 25),
                                           std::tuple(Crowd::NonManifold, 29),
                                           std::tuple(Crowd::Overlapping, 49)),
                         label);

}  // namespace
}  // namespace sightline
