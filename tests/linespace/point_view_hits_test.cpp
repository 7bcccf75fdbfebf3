// Views against exact first hits of lines of sight, which OcclusionIndex finds another
// way.
//
// SIGHTLINE_VIEW_RAYS: rays in all (default 200,000).

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include "linespace/occlusion.h"
#include "linespace/point_view.h"
#include "tests/support/generators.h"
#include "tests/support/view_comparison.h"
#include "tests/support/view_scenes.h"

namespace sightline {
namespace {

struct Hits {
  std::map<int, int> by_facet;
  int background = 0;
};

// Where lines of sight from an eye off the scene first meet the inside of faces.
Hits first_hits(const OcclusionIndex& index, const Point& eye, int rays,
                testing::Random& random) {
  const Scene& scene = index.scene();
  const double far = 8 * ((scene.bounds()[1] - scene.bounds()[0]).norm() +
                          (eye - scene.bounds()[0]).norm());
  Hits hits;
  for (int i = 0; i < rays; ++i) {
    const auto contacts = index.contacts(eye, eye + far * random.direction());
    if (contacts.empty()) {
      ++hits.background;
      continue;
    }
    const Contact& first = contacts.front();
    // Facets that coincide are hit together.
    if (!std::ranges::all_of(first.touches, [](const Touch& t) {
          return t.kind == TouchKind::Interior;
        })) {
      continue;
    }
    std::set<int> facets;
    for (const Touch& t : first.touches) facets.insert(scene.faces()[t.face].facet);
    for (const int f : facets) ++hits.by_facet[f];
  }
  return hits;
}

TEST(PointViewHits, WhatIsHitIsSeenAndAsOftenAsItIsLarge) {
  const char* const setting = std::getenv("SIGHTLINE_VIEW_RAYS");
  const int all = setting == nullptr ? 200'000 : std::atoi(setting);
  const auto scenes = testing::view_scenes();
  constexpr int kEyes = 3;
  const int rays = all / (kEyes * static_cast<int>(scenes.size()));
  testing::Random random(21);
  long hit = 0;
  for (const testing::ViewScene& s : scenes) {
    SCOPED_TRACE(s.name);
    const Scene scene(s.soup);
    const PointViewIndex views(scene);
    const OcclusionIndex index(scene);
    for (int i = 0; i < kEyes; ++i) {
      const Point eye = testing::grid_point(random, scene, 0.5);
      const PointView view = views.view(eye_at(eye));
      if (view.place != EyePlace::Free && view.place != EyePlace::Inside) continue;
      const Hits hits = first_hits(index, eye, rays, random);
      for (const auto& [facet, count] : hits.by_facet) {
        hit += count;
        const auto seen = std::ranges::find(view.facets, facet, &SeenFacet::facet);
        ASSERT_NE(seen, view.facets.end()) << "facet " << facet << " is hit " << count;
        // Within five standard deviations.
        const double share = seen->measure / (4 * std::numbers::pi);
        EXPECT_NEAR(count, rays * share, 5 * std::sqrt(rays * share) + 5)
            << "facet " << facet;
      }
      EXPECT_TRUE(hits.background == 0 || view.background_pieces > 0);
    }
  }
  EXPECT_GT(hit, all / 10);
}

}  // namespace
}  // namespace sightline
