// Facets seen edge-on: through narrow gaps, past what lies in their plane, and against
// lines to many points of their sides.

#include "linespace/swaths/edge_on_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "linespace/sight/line_probe.h"
#include "linespace/swaths/edge_cuts.h"
#include "skeleton/build.h"
#include "skeleton/nodes/node_contacts.h"
#include "skeleton/view_events.h"
#include "tests/support/eee_scenes.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

using internal::ExactPoint;
using internal::Rational;

/// The roof z = 1 of the first box, [0, 4]^2, and what else stands around; seen from
/// (2, -10, 1).
bool roof_is_seen(std::vector<testing::AlignedBox> others) {
  others.insert(others.begin(), testing::AlignedBox{{0, 0, 0}, {4, 4, 1}});
  const Scene scene(testing::boxes_soup(others));
  const Skeleton skeleton = build_skeleton(scene);
  const EndIndex ends(scene, skeleton);
  const ViewEvents events(scene, skeleton, ends);
  const auto found = events.crossed({2, -10, 0.5}, {2, -10, 1.5});
  return std::ranges::any_of(found, [&](const ViewEvent& e) {
    if (e.kind != EventKind::F) return false;
    const Facet& facet = scene.facets()[e.id];
    const auto corners = scene.face_points(facet.faces.front());
    return facet.object == 0 &&
           std::ranges::all_of(corners, [&](int p) { return scene.point(p).z() == 1; });
  });
}

TEST(EdgeOnView, FindsAPartBetweenTheMiddleAndACorner) {
  const testing::AlignedBox left{{-10, -5, 0}, {1.2, -4, 2}};
  EXPECT_TRUE(roof_is_seen({}));
  // Of the side y = 0 only x from 0.67 to 1.4 shows: no corner, and not the middle.
  EXPECT_TRUE(roof_is_seen({left, {{1.7, -5, 0}, {20, -4, 2}}}));
  EXPECT_FALSE(roof_is_seen({left, {{1.0, -6, 0}, {20, -5.5, 2}}}));
}

TEST(EdgeOnView, OfNoWidthIsNone) {
  // The line to (0.75, 0) grazes a corner of each, on different sides.
  const testing::AlignedBox left{{-10, -5, 0}, {1.25, -4, 2}};
  EXPECT_FALSE(roof_is_seen({left, {{1.5, -6, 0}, {20, -5.5, 2}}}));
  EXPECT_TRUE(roof_is_seen({left, {{1.5 + 0x1p-40, -6, 0}, {20, -5.5, 2}}}));
}

TEST(EdgeOnView, GoesPastWhatLiesInThePlane) {
  // A lower roof in the same plane; a box that stands on the plane, or hangs below it.
  EXPECT_TRUE(roof_is_seen({{{-10, -5, 0}, {20, -4, 1}}}));
  EXPECT_TRUE(roof_is_seen({{{-10, -5, 1}, {20, -4, 2}}}));
  // Both, one upon the other: their common face closes the plane.
  EXPECT_FALSE(roof_is_seen({{{-10, -5, 0}, {20, -4, 1}}, {{-10, -5, 1}, {20, -4, 2}}}));
  // Side by side, one below and one above: a line between them rises.
  EXPECT_TRUE(roof_is_seen({{{-10, -5, 0}, {20, -4, 1}}, {{-10, -8, 1}, {20, -7, 2}}}));
  // Crossed by a wall that stands on the roof's own side.
  EXPECT_FALSE(roof_is_seen({{{-10, -1, 0}, {20, 0, 2}}}));
  EXPECT_TRUE(roof_is_seen({{{-10, -1, 0}, {3, 0, 2}}}));
  // Before a wall.
  EXPECT_TRUE(roof_is_seen({{{-20, 4, 0}, {20, 5, 2}}}));
}

/// No contact at all on the way to some of many points of the facet's sides.
bool any_sample_is_seen(const internal::Silhouettes& g, int facet,
                        const PlaneThrough& plane, const Point& a, const Point& b) {
  const Scene& scene = g.scene();
  const auto value = [&](const Point& p) {
    return internal::exact_orient(
        internal::exact_point(plane.a), internal::exact_point(plane.b),
        internal::exact_point(plane.c), internal::exact_point(p));
  };
  const Rational at_a = value(a);
  const Rational at_b = value(b);
  const ExactPoint x = internal::along(internal::exact_point(a), internal::exact_point(b),
                                       Rational(at_a / (at_a - at_b)));
  constexpr int kSamples = 61;
  for (const int f : scene.facets()[facet].faces) {
    const auto corners = scene.face_points(f);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const ExactPoint p = internal::exact_point(scene.point(corners[k]));
      const ExactPoint q =
          internal::exact_point(scene.point(corners[(k + 1) % corners.size()]));
      for (int i = 1; i < kSamples; ++i) {
        const ExactPoint w = internal::along(p, q, Rational(i) / kSamples);
        const internal::LineScan scan(
            scene,
            internal::faces_near_line(g, internal::rounded(x), internal::rounded(w)), x,
            w);
        bool met = false;
        for (int c = 0; c < scan.size(); ++c) {
          met |= scan.to(c) > 0 && scan.from(c) < 1;
        }
        if (!met) return true;
      }
    }
  }
  return false;
}

TEST(EdgeOnView, AgreesWithLinesToManyPoints) {
  int seen = 0;
  int hidden = 0;
  int more = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const bool aligned = seed % 3 == 0;
    const Scene scene(aligned ? testing::random_boxes(seed, 14, {.grid = 6})
                              : testing::random_polytopes(
                                    seed, 9, {.max_vertices = 7, .density = 0.4}));
    const internal::Silhouettes g(scene);
    testing::Random random(seed);
    const auto point = [&] {
      Point p;
      for (int i = 0; i < 3; ++i) {
        const double low = scene.bounds()[0][i];
        const double high = scene.bounds()[1][i];
        p[i] = std::round(64 * random.uniform(2 * low - high, 2 * high - low)) / 64;
      }
      return p;
    };
    for (int k = 0; k < 60; ++k) {
      const auto facet = static_cast<int>(
          random.uniform(0, static_cast<double>(scene.facets().size()) - 0.01));
      const PlaneThrough plane =
          internal::face_plane_through(scene, scene.facets()[facet].faces.front());
      const Point a = point();
      const Point b = point();
      const Sign at_a = orient3d(plane.a, plane.b, plane.c, a);
      if (at_a == Sign::Zero || orient3d(plane.a, plane.b, plane.c, b) != -at_a) continue;
      const bool exact = internal::sees_edge_on(g, facet, plane, a, b);
      const bool sampled = any_sample_is_seen(g, facet, plane, a, b);
      EXPECT_TRUE(exact || !sampled) << seed << " facet " << facet;
      seen += static_cast<int>(exact);
      hidden += static_cast<int>(!exact);
      more += static_cast<int>(exact && !sampled);
    }
  }
  EXPECT_GT(seen, 200);
  EXPECT_GT(hidden, 10);
  // Seen past what is grazed, or narrowly.
  EXPECT_LT(more, seen / 4);
  std::printf("%d seen, %d hidden, %d seen by none of the samples\n", seen, hidden, more);
}

}  // namespace
}  // namespace sightline
