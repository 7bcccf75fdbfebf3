// Viewpoints: values against closed forms, bounds against random views, covers against
// exhaustive search and rooms whose covers are known.

#include "aspect/viewpoints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "aspect/choice/apart.h"
#include "aspect/choice/seen_parts.h"
#include "aspect/choice/set_cover.h"
#include "aspect/views/labels.h"
#include "tests/support/add_box.h"
#include "tests/support/aspect_scenes.h"

namespace sightline {
namespace {

using internal::least_cover;
using internal::seen_parts;
using internal::SeenParts;
using testing::add_box;
using testing::letter;
using testing::two_boxes;

constexpr double kPi = std::numbers::pi;

Scene cube() {
  PolygonSoup soup;
  add_box(soup, "cube", {0, 0, 0}, {1, 1, 1});
  return Scene(soup);
}

constexpr double kDepth = 6, kPitch = 3, kRoom = 2, kHeight = 1;

// A room in a block, with niches 1 wide and 6 deep side by side in its wall y = 0.
// Nobody in the room or a niche sees the ends of two of them: what sees the end of a
// niche lies, in the room, within 1/3 of the niche's width.
Scene room_with_niches(int niches) {
  const double width = kPitch * niches;
  std::vector<std::array<double, 2>> outline{{width, kRoom}, {0, kRoom}, {0, 0}};
  for (int i = 0; i < niches; ++i) {
    const double x = kPitch * i + 1;
    for (const auto& [dx, y] :
         {std::array{0.0, 0.0}, {0.0, -kDepth}, {1.0, -kDepth}, {1.0, 0.0}})
      outline.push_back({x + dx, y});
  }
  outline.push_back({width, 0});
  std::vector<std::vector<Point>> faces = testing::prism(outline, 0, kHeight);
  for (auto& face : faces) std::ranges::reverse(face);  // it is a hollow
  PolygonSoup soup;
  add_box(soup, "outside", {-1, -kDepth - 1, -1}, {width + 1, kRoom + 1, kHeight + 1});
  for (std::vector<Point>& face : faces) {
    soup.groups[0].faces.push_back(static_cast<int>(soup.polygons.size()));
    soup.polygons.emplace_back();
    for (const Point& p : face) {
      soup.polygons.back().push_back(static_cast<int>(soup.vertices.size()));
      soup.vertices.push_back(p);
    }
  }
  return Scene(soup);
}

ViewpointRequest in_room(int niches) {
  ViewpointRequest request;
  request.projection = Projection::Perspective;
  request.bounds = {Point(0, -kDepth, 0), Point(kPitch * niches, kRoom, kHeight)};
  return request;
}

ViewpointRequest of(Projection projection) {
  ViewpointRequest request;
  request.projection = projection;
  return request;
}

// ---- the best -------------------------------------------------------------------------

TEST(BestViews, OfACube) {
  const Scene scene = cube();
  for (const Projection p : {Projection::Orthographic, Projection::Perspective}) {
    for (const ViewMeasure m : {ViewMeasure::Faces, ViewMeasure::Area}) {
      const BestViews best = best_views(scene, of(p), m, 2);
      ASSERT_EQ(best.views.size(), 2u);
      EXPECT_TRUE(best.certified);
      EXPECT_NEAR(best.views[0].value, 3, 1e-12);
      EXPECT_NEAR(best.bound, 3, 1e-9);
      EXPECT_NE(best.views[0].facets, best.views[1].facets);
    }
  }
  // Corners of a cube look largest along its diagonal.
  const BestViews far =
      best_views(scene, of(Projection::Orthographic), ViewMeasure::SolidAngle, 1);
  EXPECT_NEAR(far.views[0].value, std::sqrt(3), 1e-6);
  EXPECT_LE(far.views[0].value, far.bound);
  EXPECT_LT(far.bound, 1.01 * std::sqrt(3));
  const BestViews entropy =
      best_views(scene, of(Projection::Perspective), ViewMeasure::Entropy, 1);
  EXPECT_LE(entropy.views[0].value, entropy.bound);
  EXPECT_NEAR(entropy.bound, 1 + std::log2(3) / 2, 1e-9);
  const BestViews near =
      best_views(scene, of(Projection::Perspective), ViewMeasure::SolidAngle, 1);
  EXPECT_DOUBLE_EQ(near.bound, 2 * kPi);
  EXPECT_GT(near.views[0].value, 0.9 * near.bound);
}

TEST(BestViews, OfAnL) {
  const BestViews best =
      best_views(letter(), of(Projection::Orthographic), ViewMeasure::Faces, 3);
  EXPECT_EQ(best.views[0].value, 5);
  EXPECT_EQ(best.bound, 5);
  EXPECT_FALSE(best.certified);
}

// Areas of views that hide nothing: those of the sides that face the eye.
TEST(BestViews, TwoBoxesFacesAndArea) {
  const Scene scene = two_boxes();
  const auto far = of(Projection::Orthographic);
  EXPECT_EQ(best_views(scene, far, ViewMeasure::Faces, 1).bound, 6);
  EXPECT_EQ(best_views(scene, far, ViewMeasure::Faces, 1).views[0].value, 6);
  const BestViews area = best_views(scene, far, ViewMeasure::Area, 1);
  const double most = 3 + 1.2 * 1.5 + 1.5 + 1.2;
  EXPECT_NEAR(area.bound, most, 1e-9);
  EXPECT_NEAR(area.views[0].value, most, 1e-9);
}

int soak_views() {
  const char* text = std::getenv("SIGHTLINE_RANDOM_VIEWS");
  return text == nullptr ? 1'500 : std::atoi(text);
}

// No random view beats a bound, nor the best by more than 1 %.
void expect_none_better(const Scene& scene, const ViewpointRequest& request, int views) {
  const PointViewIndex index(scene);
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const bool far = request.projection == Projection::Orthographic;
  const Point middle = (scene.bounds()[0] + scene.bounds()[1]) / 2;
  const double size = (scene.bounds()[1] - scene.bounds()[0]).norm();
  std::array<double, 5> most{};
  for (int i = 0; i < views; ++i) {
    Point p(normal(random), normal(random), normal(random));
    if (!far) p = middle + size * p;
    const auto view =
        seen_parts(index, internal::viewpoint_at(p, request.projection), request);
    if (!view) continue;
    for (std::size_t m = 0; m < most.size(); ++m)
      most[m] = std::max(most[m], view->value[m]);
  }
  for (std::size_t m = 0; m < most.size(); ++m) {
    const auto measure = static_cast<ViewMeasure>(m);
    if (far && measure == ViewMeasure::Entropy) continue;
    const BestViews best = best_views(scene, request, measure, 1);
    EXPECT_LE(most[m], best.bound * (1 + 1e-12)) << m;
    EXPECT_LE(best.views[0].value, best.bound * (1 + 1e-12)) << m;
    EXPECT_LE(most[m], best.views[0].value * 1.01) << m;
  }
}

TEST(BestViews, NoRandomViewIsBetter) {
  for (const Projection p : {Projection::Orthographic, Projection::Perspective}) {
    expect_none_better(cube(), of(p), soak_views());
    expect_none_better(letter(), of(p), soak_views());
    expect_none_better(two_boxes(), of(p), soak_views());
  }
}

TEST(BestViews, OfAGroup) {
  const Scene scene = two_boxes();
  auto request = of(Projection::Orthographic);
  request.of = scene.faces_named("a");
  const BestViews best = best_views(scene, request, ViewMeasure::Faces, 1);
  EXPECT_EQ(best.views[0].value, 3);
  EXPECT_EQ(best.bound, 3);
}

// From no direction are both of two sides seen that face each other.
TEST(BestViews, OfTwoSidesThatFaceEachOther) {
  const Scene scene = two_boxes();
  auto request = of(Projection::Orthographic);
  for (int f = 0; f < static_cast<int>(scene.faces().size()); ++f) {
    const double x = scene.point(scene.face_points(f)[0])[0];
    const bool across = std::ranges::all_of(
        scene.face_points(f), [&](int p) { return scene.point(p)[0] == x; });
    if (across && (x == 1 || x == 2)) request.of.push_back(f);
  }
  ASSERT_EQ(request.of.size(), 2u);
  EXPECT_EQ(best_views(scene, request, ViewMeasure::Faces, 1).bound, 1);
  request.projection = Projection::Perspective;
  EXPECT_EQ(best_views(scene, request, ViewMeasure::Faces, 1).views[0].value, 2);
}

TEST(BestViews, Refusals) {
  EXPECT_THROW((void)best_views(cube(), {}, ViewMeasure::Entropy, 1), InvalidInput);
  EXPECT_THROW((void)best_views(cube(), {}, ViewMeasure::Faces, 0), InvalidInput);
  EXPECT_THROW((void)cover_views(cube(), {}, CoverGoal::Parts, 1.5), InvalidInput);
  EXPECT_THROW((void)cover_views(cube(), {}, CoverGoal::Parts, 0.0), InvalidInput);
  auto flat = of(Projection::Perspective);
  flat.bounds = {Point(0, 0, 0), Point(1, 1, 0)};
  EXPECT_THROW((void)best_views(cube(), flat, ViewMeasure::Faces, 1), InvalidInput);
}

TEST(NextView, AddsTheOtherSidesOfACube) {
  const Viewpoint corner = eye_far_along({1, 1.1, 1.2});
  const BestViews next =
      next_view(cube(), of(Projection::Orthographic), std::array{corner});
  ASSERT_EQ(next.views.size(), 1u);
  EXPECT_EQ(next.views[0].value, 3);
  EXPECT_EQ(next.bound, 3);
  const BestViews none = next_view(cube(), of(Projection::Orthographic),
                                   std::array{corner, eye_far_along({-1, -1, -1})});
  EXPECT_TRUE(none.views.empty());
  EXPECT_EQ(none.bound, 0);
}

// ---- covers ---------------------------------------------------------------------------

TEST(CoverViews, OfACubeAndAnL) {
  for (const Projection p : {Projection::Orthographic, Projection::Perspective}) {
    for (const CoverGoal goal : {CoverGoal::Parts, CoverGoal::Whole}) {
      for (const Scene& scene : {cube(), letter()}) {
        const ViewCover cover = cover_views(scene, of(p), goal);
        EXPECT_EQ(cover.views.size(), 2u);
        EXPECT_EQ(cover.lower_bound, 2);
        EXPECT_TRUE(cover.optimal);
        EXPECT_TRUE(cover.never_seen.empty());
        EXPECT_TRUE(cover.unsettled.empty());
        EXPECT_TRUE(cover.short_of.empty());
      }
    }
  }
}

// A post hides the middle of one box's side from the middle of others, and not all of it.
TEST(SightProofs, NothingThatSomeViewShowsIsProvedUnseen) {
  PolygonSoup soup;
  add_box(soup, "a", {0, 0, 0}, {1, 1, 1});
  add_box(soup, "post", {1.6, 0.3, -1}, {1.7, 0.7, 2});
  add_box(soup, "b", {2.5, 0, 0}, {3.5, 1, 1});
  const Scene scene(soup);
  ViewpointRequest request = of(Projection::Perspective);
  request.bounds = {Point(1.75, 0.2, 0.2), Point(2.2, 0.8, 0.8)};
  const PointViewIndex index(scene);
  const auto sides = internal::patch_sides(index, request);
  const internal::ViewSpace space(scene, request);
  const internal::SightProofs proofs(scene, space, sides);
  std::set<std::array<int, 2>> together;  // patches
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> share;
  for (int i = 0; i < 300; ++i) {
    Point p;
    for (int k = 0; k < 3; ++k) {
      const double at = share(random);
      p[k] = (1 - at) * (*request.bounds)[0][k] + at * (*request.bounds)[1][k];
    }
    const auto view = seen_parts(index, eye_at(p), request);
    if (!view) continue;
    for (const int a : view->patches) {
      for (const int b : view->patches) together.insert({a, b});
    }
  }
  int proved = 0;
  const int n = static_cast<int>(sides.size());
  for (int a = 0; a < n; ++a) {
    for (int b = a; b < n; ++b) {
      if (!proofs.never_both(a, b, 200)) continue;
      ++proved;
      EXPECT_FALSE(together.contains({sides[a].patch, sides[b].patch})) << a << ' ' << b;
    }
  }
  EXPECT_GT(proved, 20);
  EXPECT_GT(together.size(), 3u);
}

TEST(LeastCover, EqualsExhaustiveSearch) {
  std::mt19937 random(5);
  for (int round = 0; round < 400; ++round) {
    const int elements = 1 + static_cast<int>(random() % 9);
    const int count = 1 + static_cast<int>(random() % 11);
    std::vector<std::vector<int>> sets(count);
    std::vector<unsigned> masks(count, 0);
    unsigned all = 0;
    for (int s = 0; s < count; ++s) {
      for (int e = 0; e < elements; ++e) {
        // Each element is in some set.
        if (random() % 3 != 0 && e % count != s) continue;
        sets[s].push_back(e);
        masks[s] |= 1U << e;
      }
      all |= masks[s];
    }
    ASSERT_EQ(all, (1U << elements) - 1);
    int fewest = count;
    for (unsigned choice = 1; choice < (1U << count); ++choice) {
      unsigned held = 0;
      for (int s = 0; s < count; ++s) held |= (choice >> s & 1U) != 0 ? masks[s] : 0;
      if (held == all) fewest = std::min(fewest, std::popcount(choice));
    }
    const auto cover = least_cover(sets, elements, 1, 1'000'000);
    EXPECT_TRUE(cover.finished);
    EXPECT_EQ(static_cast<int>(cover.sets.size()), fewest) << round;
    unsigned held = 0;
    for (const int s : cover.sets) held |= masks[s];
    EXPECT_EQ(held, all);
  }
}

TEST(CoverViews, RoomWithDeepNiches) {
  for (int niches = 1; niches <= 5; ++niches) {
    const Scene scene = room_with_niches(niches);
    for (const CoverGoal goal : {CoverGoal::Parts, CoverGoal::Whole}) {
      const ViewCover cover = cover_views(scene, in_room(niches), goal);
      EXPECT_EQ(cover.views.size(), static_cast<std::size_t>(niches));
      EXPECT_EQ(cover.lower_bound, niches);
      EXPECT_TRUE(cover.optimal);
      EXPECT_EQ(cover.apart.size(), static_cast<std::size_t>(niches));
      EXPECT_TRUE(cover.short_of.empty());
      // The outer box has six sides, and nobody sees them from within.
      EXPECT_EQ(cover.never_seen.size(), 6u);
      EXPECT_TRUE(cover.unsettled.empty());
    }
  }
}

// Two boxes glued together: what they touch with is seen from nowhere.
TEST(CoverViews, NamesWhatNobodySees) {
  PolygonSoup soup;
  add_box(soup, "a", {0, 0, 0}, {1, 1, 1});
  add_box(soup, "b", {1, 0, 0}, {2, 1, 1});
  const Scene scene(soup);
  const ViewCover cover =
      cover_views(scene, of(Projection::Orthographic), CoverGoal::Parts);
  EXPECT_EQ(cover.never_seen.size(), 2u);
  EXPECT_EQ(cover.patches, 6u);
  EXPECT_EQ(cover.views.size(), 2u);
}

// A low wall before a high one: no single eye has to see half of it, two together do.
TEST(CoverViews, ShareIsThatOfAllViewsTogether) {
  const Scene scene = two_boxes();
  const ViewCover some =
      cover_views(scene, of(Projection::Orthographic), CoverGoal::Parts);
  const ViewCover half =
      cover_views(scene, of(Projection::Orthographic), CoverGoal::Parts, 0.5);
  const ViewCover whole =
      cover_views(scene, of(Projection::Orthographic), CoverGoal::Whole);
  EXPECT_EQ(some.views.size(), 2u);
  EXPECT_LE(some.views.size(), half.views.size());
  EXPECT_LE(half.views.size(), whole.views.size());
  EXPECT_TRUE(half.short_of.empty());
  EXPECT_TRUE(whole.short_of.empty());
}

}  // namespace
}  // namespace sightline
