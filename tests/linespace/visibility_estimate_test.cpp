// Estimates against closed forms, against exact answers sample by sample, and against
// themselves on other numbers of threads.

#include "linespace/visibility_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "linespace/line_sampling.h"
#include "linespace/predicates.h"
#include "linespace/sight/occlusion.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

using internal::Certainty;
using internal::FaceSegment;
using internal::kPacket;
using internal::OcclusionAccess;

// Axis-aligned rectangle at height z, up or down.
void add_rectangle(PolygonSoup& soup, double x0, double y0, double x1, double y1,
                   double z) {
  const int v = static_cast<int>(soup.vertices.size());
  for (const Point& p :
       {Point(x0, y0, z), Point(x1, y0, z), Point(x1, y1, z), Point(x0, y1, z)}) {
    soup.vertices.push_back(p);
  }
  soup.polygons.push_back({v, v + 1, v + 2, v + 3});
}

// Opposite unit squares at distance 1, faces 0 and 1, and a blocker at height z.
Scene squares_with_blocker(double low, double high, double z) {
  PolygonSoup soup;
  add_rectangle(soup, 0, 0, 1, 1, 0);
  add_rectangle(soup, 0, 0, 1, 1, 1);
  add_rectangle(soup, low, low, high, high, z);
  return Scene(std::move(soup));
}

Request on_threads(int threads) {
  Request request;
  request.threads = threads;
  return request;
}

VisibilityEstimate estimate(const OcclusionIndex& index, int a, int b,
                            const EstimateOptions& options = {},
                            const Request& request = {}) {
  return estimate_visibility(index, std::vector{a}, std::vector{b}, options, request);
}

void expect_close(const Estimate& e, double truth) {
  EXPECT_LT(std::abs(e.value - truth), 5 * e.standard_error) << e.value;
  EXPECT_LT(e.standard_error, 0.01);
}

// At height z the segment from p to q is at (1 - z) p + z q, each coordinate on its own:
// at 1/2 triangular, at 1/4 a trapezoid, so that the blocked share is a square of
// elementary areas.  The form factors are those of REFERENCES ("Shapiro's case").
TEST(VisibilityEstimate, OppositeSquaresWithBlocker) {
  const struct {
    double low, high, z, fraction, form_factor;
  } cases[] = {{0.25, 0.75, 0.25, 1 - 4.0 / 9, 0.115620602132415},
               {0.25, 0.75, 0.5, 1 - 9.0 / 16, 0.099506294598985},
               {0, 0.5, 0.5, 3.0 / 4, 0.149868671773791},
               {5, 6, 0.5, 1, 0.199824895698387}};
  for (const auto& c : cases) {
    const Scene scene = squares_with_blocker(c.low, c.high, c.z);
    const OcclusionIndex index(scene);
    const VisibilityEstimate e = estimate(index, 0, 1, {.samples = 200'000});
    EXPECT_TRUE(e.complete);
    EXPECT_EQ(e.samples, 200'000);
    EXPECT_EQ(e.doubtful, 0);
    if (c.fraction == 1) {
      EXPECT_EQ(e.free, e.samples);
    } else {
      expect_close(e.fraction, c.fraction);
    }
    expect_close({e.line_measure.value / std::numbers::pi,
                  e.line_measure.standard_error / std::numbers::pi},
                 c.form_factor);
    ASSERT_TRUE(e.candidate);
    EXPECT_EQ(e.candidate->face_a, 0);
    EXPECT_EQ(e.candidate->face_b, 1);
    EXPECT_TRUE(index.is_free(e.candidate->a, e.candidate->b));  // ends exactly on faces
  }
}

// How often the interval holds the truth, and how large errors are beside what is said.
TEST(VisibilityEstimate, ErrorsAreAsLargeAsTold) {
  const Scene scene = squares_with_blocker(0.25, 0.75, 0.5);
  const OcclusionIndex index(scene);
  constexpr int kRuns = 1000;
  int held = 0;
  double fraction = 0, measure = 0;
  for (int seed = 0; seed < kRuns; ++seed) {
    const VisibilityEstimate e =
        estimate(index, 0, 1, {.samples = 200, .seed = static_cast<std::uint64_t>(seed)});
    held += e.interval[0] <= 0.4375 && 0.4375 <= e.interval[1];
    fraction += std::pow((e.fraction.value - 0.4375) / e.fraction.standard_error, 2);
    measure += std::pow((e.line_measure.value - std::numbers::pi * 0.099506294598985) /
                            e.line_measure.standard_error,
                        2);
  }
  // Standard deviations: 0.007 for the share; 0.045 for means of squared normals.
  EXPECT_NEAR(held / double{kRuns}, 0.95, 0.035);
  EXPECT_NEAR(fraction / kRuns, 1, 0.25);
  EXPECT_NEAR(measure / kRuns, 1, 0.25);
}

// Free with the two faces left out, by exact contacts; contact_test checks these.
bool sees_exactly(const Scene& scene, const FaceSegment& s) {
  std::vector<int> faces;
  for (int f = 0; f < static_cast<int>(scene.faces().size()); ++f) {
    if (f != s.face_a && f != s.face_b) faces.push_back(f);
  }
  return OcclusionAccess::is_free_of(scene, faces, s.a, s.b);
}

// The same from predicates alone, but where an end is in the plane of some face.
bool sees(const Scene& scene, const FaceSegment& s) {
  for (int f = 0; f < static_cast<int>(scene.faces().size()); ++f) {
    if (f == s.face_a || f == s.face_b) continue;
    const auto ids = scene.face_points(f);
    for (std::size_t i = 1; i + 1 < ids.size(); ++i) {
      const Point &p = scene.point(ids[0]), &q = scene.point(ids[i]),
                  &r = scene.point(ids[i + 1]);
      const Sign at_a = orient3d(p, q, r, s.a), at_b = orient3d(p, q, r, s.b);
      if (at_a == Sign::Zero || at_b == Sign::Zero) return sees_exactly(scene, s);
      if (at_a == at_b) continue;
      const Sign side = orient3d(s.a, s.b, p, q);
      if (side == orient3d(s.a, s.b, q, r) && side == orient3d(s.a, s.b, r, p)) {
        return false;
      }
    }
  }
  return true;
}

TEST(VisibilityEstimate, EverySampleAsByPredicates) {
  int some = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const Scene scene(seed % 3 == 0   ? testing::city(seed, 240)
                      : seed % 3 == 1 ? testing::random_polytopes(seed, 20)
                                      : testing::rotated_boxes(seed, 20));
    const OcclusionIndex index(scene);
    testing::Random random(seed);
    std::vector<int> a, b;
    const int faces = static_cast<int>(scene.faces().size());
    for (int i = 0; i < 5; ++i) {
      a.push_back(random.integer(0, faces - 1));
      b.push_back(random.integer(0, faces - 1));
    }
    const EstimateOptions options{.samples = 501, .seed = seed};
    const VisibilityEstimate e = estimate_visibility(index, a, b, options);
    const PolygonSampler from(scene, a), to(scene, b);
    std::int64_t free = 0, first = -1;
    for (std::int64_t i = 0; i < options.samples; ++i) {
      SampleNumbers numbers(seed, static_cast<std::uint64_t>(i));
      const PairSegment s = segment_between(from, to, numbers);
      if (!sees(scene, {s.a.point, s.b.point, a[s.a.polygon], b[s.b.polygon]})) continue;
      if (first < 0) first = i;
      ++free;
    }
    EXPECT_EQ(e.free, free);
    EXPECT_EQ(e.candidate ? e.candidate->sample : -1, first);
    some += free > 0 && free < options.samples;
  }
  EXPECT_GT(some, 10);
}

// The packets alone, no face left out: is_free, on generic and on touching segments.
TEST(AskPacket, AsIsFree) {
  int free = 0, blocked = 0, doubtful = 0;
  const std::vector<PolygonSoup> soups = {testing::city(1, 600),
                                          testing::grid_city(2, 240),
                                          testing::random_polytopes(3, 30)};
  for (const PolygonSoup& soup : soups) {
    const Scene scene(soup);
    const OcclusionIndex index(scene);
    testing::Random random(5);
    const auto [low, high] = scene.bounds();
    const auto point = [&]() -> Point {
      if (random.one_in(2)) {
        return scene.point(
            random.integer(0, static_cast<int>(scene.points().size()) - 1));
      }
      return {random.uniform(low.x(), high.x()), random.uniform(low.y(), high.y()),
              random.uniform(low.z(), high.z())};
    };
    for (int n = 0; n < 500; ++n) {
      std::vector<FaceSegment> segments(random.integer(0, kPacket));
      for (FaceSegment& s : segments) {
        s = {point(), point(), -1, -1};
        while (s.a == s.b) s.b = point();
      }
      std::array<Certainty, kPacket> answers;
      std::array<std::vector<int>, kPacket> faces;
      OcclusionAccess::ask_packet(index, segments, answers, faces);
      for (std::size_t i = 0; i < segments.size(); ++i) {
        const auto& [a, b, face_a, face_b] = segments[i];
        const bool expected = index.is_free(a, b);
        if (answers[i] == Certainty::Doubtful) {
          ++doubtful;
          EXPECT_EQ(OcclusionAccess::is_free_of(scene, faces[i], a, b), expected);
        } else {
          EXPECT_EQ(answers[i] == Certainty::Free, expected);
          ++(expected ? free : blocked);
        }
      }
    }
  }
  EXPECT_GT(free, 500);
  EXPECT_GT(blocked, 500);
  EXPECT_GT(doubtful, 500);
}

TEST(VisibilityEstimate, EndFacesDoNotBlock) {
  const Scene scene(
      testing::boxes_soup({{{0, 0, 0}, {1, 1, 1}}, {{0, 0, 3}, {1, 1, 4}}}));
  const OcclusionIndex index(scene);
  // Faces by the height of their corners.
  const auto horizontal = [&](double z) {
    for (int f = 0; f < 12; ++f) {
      bool all = true;
      for (const int p : scene.face_points(f)) all = all && scene.point(p).z() == z;
      if (all) return f;
    }
    return -1;
  };
  const int bottom = horizontal(0), top = horizontal(1), above = horizontal(3);
  // Across a box's inside, and across the gap.
  EXPECT_EQ(estimate(index, bottom, top).fraction.value, 1);
  EXPECT_EQ(estimate(index, bottom, top).doubtful, 0);  // not even looked at
  EXPECT_EQ(estimate(index, top, above).fraction.value, 1);
  // Through the top; nothing found is not proved, and the interval says so.
  const VisibilityEstimate e = estimate(index, bottom, above);
  EXPECT_EQ(e.free, 0);
  EXPECT_FALSE(e.candidate);
  EXPECT_EQ(e.interval[0], 0);
  EXPECT_NEAR(e.interval[1], 3.84 / 10'000, 1e-5);
}

// In one plane with a third square between: all segments lie in that plane, graze, and
// are decided exactly; double arithmetic alone cannot.
TEST(VisibilityEstimate, PairsInOnePlane) {
  PolygonSoup soup;
  for (const int i : {0, 1, 2}) add_rectangle(soup, i, 0, i + 1, 1, 0.5);
  const Scene scene(std::move(soup));
  const OcclusionIndex index(scene);
  const VisibilityEstimate e = estimate(index, 0, 2, {.samples = 500});
  EXPECT_EQ(e.doubtful, 500);
  EXPECT_EQ(e.free, 500);
  EXPECT_EQ(e.line_measure.value, 0);
  Request in_double;
  in_double.precision = Precision::Double;
  const VisibilityEstimate rough = estimate(index, 0, 2, {.samples = 500}, in_double);
  EXPECT_EQ(rough.doubtful, 500);
  EXPECT_EQ(rough.free, 0);
}

void expect_equal(const VisibilityEstimate& a, const VisibilityEstimate& b) {
  EXPECT_EQ(a.samples, b.samples);
  EXPECT_EQ(a.free, b.free);
  EXPECT_EQ(a.doubtful, b.doubtful);
  EXPECT_EQ(a.interval, b.interval);
  EXPECT_EQ(a.fraction.value, b.fraction.value);
  EXPECT_EQ(a.fraction.standard_error, b.fraction.standard_error);
  EXPECT_EQ(a.line_measure.value, b.line_measure.value);
  EXPECT_EQ(a.line_measure.standard_error, b.line_measure.standard_error);
  ASSERT_EQ(a.candidate.has_value(), b.candidate.has_value());
  if (!a.candidate) return;
  EXPECT_EQ(a.candidate->sample, b.candidate->sample);
  EXPECT_EQ(a.candidate->a, b.candidate->a);
  EXPECT_EQ(a.candidate->b, b.candidate->b);
}

TEST(VisibilityEstimate, SameOnAnyNumberOfThreads) {
  const Scene scene(testing::city(4, 600));
  const OcclusionIndex index(scene);
  const std::vector<int> ground = scene.faces_named("ground"),
                         tower = scene.faces_named("building3");
  const EstimateOptions options{.samples = 50'001, .seed = 3};
  const auto one = estimate_visibility(index, ground, tower, options, on_threads(1));
  EXPECT_GT(one.free, 0);
  EXPECT_LT(one.free, one.samples);
  for (const int threads : {2, 3, 8}) {
    expect_equal(one,
                 estimate_visibility(index, ground, tower, options, on_threads(threads)));
  }
  const auto other = estimate_visibility(index, ground, tower, {50'001, 4});
  EXPECT_NE(other.line_measure.value, one.line_measure.value);
}

// A stop leaves the first samples, as if no more had been asked for.
TEST(VisibilityEstimate, StopsWithAPrefix) {
  const Scene scene = squares_with_blocker(0.25, 0.75, 0.5);
  const OcclusionIndex index(scene);
  for (const int threads : {1, 2}) {
    std::stop_source stop;
    double last = 0;
    Request request = on_threads(threads);
    request.stop = stop.get_token();
    request.progress = [&](std::string_view, double done) {
      EXPECT_GT(done, last);
      last = done;
      if (done > 0.3) stop.request_stop();
    };
    const VisibilityEstimate e = estimate(index, 0, 1, {.samples = 100'000}, request);
    EXPECT_FALSE(e.complete);
    EXPECT_GT(e.samples, 30'000);
    EXPECT_LT(e.samples, 60'000);
    expect_equal(e, estimate(index, 0, 1, {.samples = e.samples}));
  }
}

TEST(VisibilityEstimate, NoTimeNoAnswer) {
  const Scene scene = squares_with_blocker(0.25, 0.75, 0.5);
  const OcclusionIndex index(scene);
  Request request;
  request.budget_seconds = 0;
  const VisibilityEstimate e = estimate(index, 0, 1, {}, request);
  EXPECT_FALSE(e.complete);
  EXPECT_EQ(e.samples, 0);
  EXPECT_FALSE(e.candidate);
  EXPECT_EQ(e.interval, (std::array<double, 2>{0, 1}));
  EXPECT_TRUE(std::isinf(e.fraction.standard_error));
}

TEST(VisibilityEstimate, RefusesBadQuestions) {
  const Scene scene = squares_with_blocker(0.25, 0.75, 0.5);
  const OcclusionIndex index(scene);
  const std::vector<int> one = {0}, none = {}, bad = {0, 3}, negative = {-1};
  EXPECT_THROW((void)estimate_visibility(index, one, none), InvalidInput);
  EXPECT_THROW((void)estimate_visibility(index, none, one), InvalidInput);
  EXPECT_THROW((void)estimate_visibility(index, bad, one), InvalidInput);
  EXPECT_THROW((void)estimate_visibility(index, one, negative), InvalidInput);
  EXPECT_THROW((void)estimate_visibility(index, one, one, {.samples = 0}), InvalidInput);
}

}  // namespace
}  // namespace sightline
