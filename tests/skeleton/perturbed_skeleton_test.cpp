// A perturbed copy of a degenerate scene has the same arcs up to the size of the
// perturbation, but for seams: lines that touch more than their generators all along.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <vector>

#include "linespace/perturb.h"
#include "linespace/scene.h"
#include "skeleton/build.h"
#include "skeleton/skeleton_lines.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

using Range = std::array<double, 2>;
/// Vertex and edge, or three edges; ranges on the edge, or on the first of the three.
using Ranges = std::map<std::vector<int>, std::vector<Range>>;

Point on_edge(const Scene& scene, int edge, double s) {
  const auto& p = scene.edges()[edge].points;
  return scene.point(p[0]) + s * (scene.point(p[1]) - scene.point(p[0]));
}

/// Where the line through edges[0] at s and edges[1] meets edges[2].
double at_last(const Scene& scene, const std::array<std::int32_t, 3>& edges, double s) {
  const Point p = on_edge(scene, edges[0], s);
  const Point n =
      (on_edge(scene, edges[1], 0) - p).cross(on_edge(scene, edges[1], 1) - p);
  const double a = n.dot(on_edge(scene, edges[2], 0) - p);
  const double b = n.dot(on_edge(scene, edges[2], 1) - p);
  return std::clamp(a / (a - b), 0.0, 1.0);
}

Ranges ranges_of(const Scene& scene, const Skeleton& skeleton) {
  Ranges ranges;
  for (const SkeletonArc& a : skeleton.ev()) {
    ranges[{a.vertex(), a.edge()}].push_back(a.range);
  }
  for (const SkeletonArc& a : skeleton.eee()) {
    const auto& e = a.edges();
    ranges[{e[0], e[1], e[2]}].push_back(a.range);
    // Told on the other outer edge, too, just inside its ends.
    const double inset = 1e-7 * (a.range[1] - a.range[0]);
    const double t0 = at_last(scene, e, a.range[0] + inset);
    const double t1 = at_last(scene, e, a.range[1] - inset);
    ranges[{e[2], e[1], e[0]}].push_back({std::min(t0, t1), std::max(t0, t1)});
  }
  for (auto& [key, list] : ranges) std::ranges::sort(list);
  return ranges;
}

/// The parts of `range`, longer than `least`, that none of the others covers.
std::vector<Range> gaps(const Range& range, const std::vector<Range>& others,
                        double least) {
  std::vector<Range> found;
  double at = range[0];
  const auto until = [&](double x) {
    if (std::min(x, range[1]) - at > least) found.push_back({at, std::min(x, range[1])});
  };
  for (const Range& other : others) {
    if (other[1] <= at) continue;
    until(other[0]);
    at = std::max(at, other[1]);
  }
  until(range[1]);
  return found;
}

/// From position 0 to 1 the line touches more than `count` points.
bool is_seam(const std::optional<FreeSegment>& line, int count) {
  if (!line) return true;
  constexpr double kRounding = 1e-12;
  int met = 0;
  for (const Contact& c : line->contacts) {
    if (c.to < -kRounding || c.from > 1 + kRounding) continue;
    ++met;
    if (c.to - c.from > kRounding) return true;
  }
  return met > count;
}

TEST(PerturbedSkeleton, HasEveryArcUpToTheSizeButForSeams) {
  constexpr double kSize = 0x1p-10;
  // Of the parameter: edges are 1 to 5 long, distances up to 25; measured: below 2.
  constexpr double kOff = 4 * kSize;
  int ev = 0, eee = 0, seams = 0, missing = 0, fresh = 0, copied = 0;
  for (const int kind : {0, 1}) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      SCOPED_TRACE(::testing::Message() << "kind " << kind << " seed " << seed);
      const PolygonSoup soup =
          kind == 0
              ? testing::random_boxes(seed, 8, {.grid = 12, .min_size = 1, .max_size = 3})
              : testing::random_boxes(seed, 8,
                                      {.grid = 24, .min_size = 2, .max_size = 5});
      const Scene scene(soup);
      const Scene copy(perturbed(scene, kSize, seed + 100));
      ASSERT_EQ(copy.edges().size(), scene.edges().size());
      for (std::size_t e = 0; e < scene.edges().size(); ++e) {
        ASSERT_EQ(copy.edges()[e].points, scene.edges()[e].points);
      }
      const Skeleton here = build_skeleton(scene);
      const Skeleton there = build_skeleton(copy);
      const SkeletonLines lines(scene);
      const Ranges in_scene = ranges_of(scene, here);
      const Ranges in_copy = ranges_of(copy, there);
      const auto look = [&](const auto& arc, const std::vector<int>& key, int contacts) {
        const auto at = in_copy.find(key);
        for (const Range& gap :
             gaps(arc.range, at == in_copy.end() ? std::vector<Range>{} : at->second,
                  kOff)) {
          const bool seam = is_seam(lines.line(arc, 0.5 * (gap[0] + gap[1])), contacts);
          ++(seam ? seams : missing);
          EXPECT_TRUE(seam) << "lost from " << gap[0] << " to " << gap[1];
        }
      };
      for (const SkeletonArc& a : here.ev()) look(a, {a.vertex(), a.edge()}, 2);
      for (const SkeletonArc& a : here.eee()) {
        look(a, {a.edges()[0], a.edges()[1], a.edges()[2]}, 3);
      }
      ev += static_cast<int>(here.ev_count());
      eee += static_cast<int>(here.eee().size());
      // The other way: what only the copy has.
      const auto look_back = [&](const Range& range, const std::vector<int>& key) {
        ++copied;
        const auto at = in_scene.find(key);
        fresh +=
            !gaps(range, at == in_scene.end() ? std::vector<Range>{} : at->second, kOff)
                 .empty();
      };
      for (const SkeletonArc& a : there.ev()) look_back(a.range, {a.vertex(), a.edge()});
      for (const SkeletonArc& a : there.eee()) {
        look_back(a.range, {a.edges()[0], a.edges()[1], a.edges()[2]});
      }
    }
  }
  std::printf(
      "%d EV and %d EEE arcs: %d parts are seams that the copy lacks, %d others; "
      "%d of the copies' %d arcs are new\n",
      ev, eee, seams, missing, fresh, copied);
  EXPECT_GT(ev, 5000);
  EXPECT_GT(eee, 200);
  EXPECT_GT(seams, 100);
  EXPECT_LT(fresh, copied / 20);
}

}  // namespace
}  // namespace sightline
