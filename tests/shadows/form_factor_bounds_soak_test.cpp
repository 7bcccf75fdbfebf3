// Bounds of form factors on 2,000 random pairs; and what is 0, and what is not.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "shadows/factors/exchange_area.h"
#include "shadows/form_factors.h"
#include "shadows/polygon_form_factor.h"
#include "tests/shadows/random_pairs.h"
#include "tests/support/add_polygons.h"
#include "tests/support/naive_free_lines.h"

namespace sightline {
namespace {

using internal::ExchangeArea;
using testing::Corners;
using testing::random_pair;
using testing::RandomPair;

constexpr int kPairs = 2000;

ExchangeArea exchange(const RandomPair& pair, double tolerance) {
  const std::vector<std::span<const Point>> spans(pair.blockers.begin(),
                                                  pair.blockers.end());
  return internal::exchange_area(pair.from, pair.to, spans, tolerance);
}

double area_of(const Corners& p) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 2; i < p.size(); ++i) {
    sum += (p[i - 1] - p[0]).cross(p[i] - p[0]);
  }
  return 0.5 * sum.norm();
}

/// How often the bound was so many times the error: below 1, up to 10, 100, ...
using Distribution = std::array<int, 8>;

void count(double bound, double error, double noise, Distribution& d) {
  if (error <= noise) {
    ++d.back();
    return;
  }
  const double ratio = bound / error;
  const int decade = ratio < 1 ? 0 : 1 + static_cast<int>(std::log10(ratio));
  ++d[std::min<std::size_t>(decade, d.size() - 2)];
}

// Errors are those to the answer at 1e-11.  Prints the table of docs/form_factors.md.
TEST(FormFactorBounds, HoldOnTwoThousandPairs) {
  constexpr std::array kAsked{1e-4, 1e-6, 1e-8};
  std::array<Distribution, kAsked.size()> found{};
  for (int seed = 0; seed < kPairs; ++seed) {
    const RandomPair pair = random_pair(seed);
    const ExchangeArea best = exchange(pair, 1e-11);
    EXPECT_LE(best.error, 1e-11) << seed;
    for (std::size_t k = 0; k < kAsked.size(); ++k) {
      const ExchangeArea e = exchange(pair, kAsked[k]);
      const double error = std::abs(e.value - best.value);
      EXPECT_LE(e.error, kAsked[k]) << seed;
      EXPECT_LE(error, e.error + best.error) << seed;
      count(e.error, error, best.error, found[k]);
    }
  }
  std::printf(
      "asked   below 1  1-10  10-100  to 1e3  to 1e4  to 1e5  above  error<1e-11\n");
  for (std::size_t k = 0; k < kAsked.size(); ++k) {
    const Distribution& d = found[k];
    EXPECT_EQ(d[0], 0) << kAsked[k];
    std::printf("%.0e   %5d  %5d   %5d   %5d   %5d   %5d  %5d   %5d\n", kAsked[k], d[0],
                d[1], d[2], d[3], d[4], d[5], d[6], d[7]);
  }
}

// 0 <= A F <= A F open <= min(A), to rounding.
TEST(FormFactorBounds, BetweenNothingAndOpen) {
  for (int seed = 0; seed < kPairs; ++seed) {
    const RandomPair pair = random_pair(seed);
    const ExchangeArea e = exchange(pair, 1e-10);
    const double open =
        polygon_form_factor(pair.from, pair.to).factor * area_of(pair.from);
    const double least = std::min(area_of(pair.from), area_of(pair.to));
    EXPECT_GE(e.value, -e.error) << seed;
    EXPECT_LE(e.value, open + e.error + 1e-13) << seed;
    EXPECT_LE(open, least) << seed;
  }
}

// By all that a scene does with a pair: covered ones are exactly 0, those with free lines
// are not, and neither ever leaves [0, open].
TEST(FormFactorBounds, ZeroIffHidden) {
  int hidden = 0, seen = 0;
  for (int seed = 0; seed < 120; ++seed) {
    RandomPair pair = random_pair(seed);
    if (seed % 3 == 2) continue;  // squares alone lie wholly before each other
    if (seed % 4 == 1) {
      // Two sheets that meet along a line, or leave a slit of 2^-20.
      const double gap = seed % 8 == 1 ? std::ldexp(1, -20) : 0;
      pair.blockers.push_back(
          {{-1, -1, 0.5}, {0.5, -1, 0.5}, {0.5, 2, 0.5}, {-1, 2, 0.5}});
      pair.blockers.push_back(
          {{0.5 + gap, -1, 0.5}, {2, -1, 0.5}, {2, 2, 0.5}, {0.5 + gap, 2, 0.5}});
    }
    PolygonSoup soup;
    testing::add_polygons(soup, "from", {pair.from});
    testing::add_polygons(soup, "to", {pair.to});
    testing::add_polygons(soup, "between", pair.blockers);
    const Scene scene(soup);
    FormFactorRequest request;
    request.threads = 1;
    const FormFactors f = form_factors(
        scene, surfaces_of(scene, {.groups = {"from", "to"}, .both_sides = {}}), request);
    std::vector<testing::FreeBlocker> blockers;
    for (std::size_t k = 0; k < pair.blockers.size(); ++k) {
      const int face = static_cast<int>(k) + 2;
      blockers.push_back({pair.blockers[k], scene.solid_behind(face)});
    }
    const double free = testing::free_lines(pair.from, pair.to, blockers, 1e-6).exchange;
    const double open = polygon_form_factor(pair.from, pair.to).factor;
    const double got = f.at(0, 1);
    EXPECT_GE(got, 0) << seed;
    EXPECT_LE(got, open + 1e-10) << seed;
    EXPECT_NEAR(got, free, 1e-5) << seed;
    EXPECT_EQ(got > 0, free > 1e-14) << seed;
    ++(free > 0 ? seen : hidden);
  }
  EXPECT_GE(hidden, 10);
  EXPECT_GE(seen, 50);
}

}  // namespace
}  // namespace sightline
