// Random lines against the exact matrix: unbiased, with the errors they tell.

#include "shadows/form_factor_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/add_box.h"
#include "tests/support/add_polygons.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

using sightline::testing::add_box;
using sightline::testing::add_polygons;

const SurfaceWish kEachFace{{}, {}, true};

FormFactorLines by_lines(const Scene& scene, const SurfaceWish& wish, std::int64_t lines,
                         std::uint64_t seed = 1, int threads = 1) {
  FormFactorLinesRequest request;
  request.lines = lines;
  request.seed = seed;
  request.threads = threads;
  request.up = Eigen::Vector3d(0, 0.25, 1);
  return form_factors_by_lines(scene, surfaces_of(scene, wish), request);
}

/// A numbered share of row i: entries, then the rest.
double share(const FormFactors& f, int i, int j) {
  const int n = static_cast<int>(f.names.size());
  const FormFactorRow& row = f.rows[i];
  if (j < n) return f.at(i, j);
  return std::vector{row.others, row.outside, row.backs, row.sky}[j - n];
}
double share_error(const FormFactorLines& f, int i, int j) {
  const int n = static_cast<int>(f.factors.names.size());
  const FormFactorErrors& errors = f.errors[i];
  if (j >= n) {
    return std::vector{errors.others, errors.outside, errors.backs, errors.sky}[j - n];
  }
  const std::vector<int>& to = f.factors.rows[i].to;
  const auto it = std::ranges::lower_bound(to, j);
  return it != to.end() && *it == j ? errors.factor[it - to.begin()] : 0;
}

/// Every share is within five deviations of the exact one; the deviations told are those
/// that the exact shares make; what is exactly 0 is not found.
void expect_agreement(const PolygonSoup& soup, const SurfaceWish& wish,
                      std::int64_t lines) {
  const Scene scene(soup);
  const auto surfaces = surfaces_of(scene, wish);
  FormFactorRequest request;
  request.accuracy = 1e-8;
  request.up = Eigen::Vector3d(0, 0.25, 1);
  const FormFactors exact = form_factors(scene, surfaces, request);
  const FormFactorLines f = by_lines(scene, wish, lines);
  ASSERT_EQ(f.factors.areas, exact.areas);
  EXPECT_EQ(f.factors.coincident_area, exact.coincident_area);
  EXPECT_TRUE(f.factors.complete);
  EXPECT_EQ(f.lines, lines);
  const int n = static_cast<int>(surfaces.size());
  double squares = 0;
  int shares = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n + 4; ++j) {
      const std::string where = exact.names[i] + " to " + std::to_string(j);
      const double value = share(f.factors, i, j), truth = share(exact, i, j);
      if (truth < 1e-7) {
        EXPECT_EQ(value, 0) << where;
        continue;
      }
      // A line counts for a share at most twice here.
      const double unit = f.area_per_line / exact.areas[i];
      const double deviation = std::sqrt(truth * unit);
      EXPECT_LE(std::abs(value - truth), 7 * deviation + 12 * unit) << where;
      if (truth < 100 * unit) continue;
      EXPECT_NEAR(share_error(f, i, j), deviation, 0.45 * deviation) << where;
      squares += std::pow((value - truth) / share_error(f, i, j), 2);
      ++shares;
    }
  }
  ASSERT_GT(shares, 10);
  EXPECT_NEAR(squares / shares, 1, 6 * std::sqrt(2.0 / shares));
}

TEST(FormFactorLines, Enclosure) {
  expect_agreement(testing::enclosure(3, 2, 5), kEachFace, 400'000);
}

TEST(FormFactorLines, CityUnderTheSky) {
  expect_agreement(testing::street_city(2, 40), kEachFace, 400'000);
  expect_agreement(testing::street_city(2, 40), {}, 200'000);
}

// A box that stands on the floor, one let into it, a sheet laid on it, one hung back to
// back with another: which of faces in one plane count, and what is in the material.
TEST(FormFactorLines, FacesOnOneAnother) {
  PolygonSoup soup;
  add_box(soup, "floor", {-1, -1, -0.5}, {3, 3, 0});
  add_box(soup, "standing", {0, 0, 0}, {1, 1, 1});
  add_box(soup, "sunk", {1.5, 0, -0.25}, {2, 1, 0.5});
  add_polygons(soup, "laid", {{{0, 1.5, 0}, {1, 1.5, 0}, {1, 2.5, 0}, {0, 2.5, 0}}});
  add_polygons(soup, "turned", {{{2, 2, 0}, {2, 2.5, 0}, {2.5, 2.5, 0}, {2.5, 2, 0}}});
  add_polygons(soup, "hung",
               {{{1, 2, 1}, {1, 3, 1}, {2, 3, 1}, {2, 2, 1}},
                {{1, 2, 1}, {2, 2, 1}, {2, 3, 1}, {1, 3, 1}}});
  expect_agreement(soup, kEachFace, 400'000);
  expect_agreement(soup, {{"floor", "turned", "hung"}, {"turned"}, false}, 400'000);
}

TEST(FormFactorLines, SymmetricAndTheSameOnAnyNumberOfThreads) {
  const Scene scene(testing::enclosure(1, 2, 3));
  const FormFactorLines one = by_lines(scene, kEachFace, 30'001, 7, 1);
  const FormFactorLines two = by_lines(scene, kEachFace, 30'001, 7, 2);
  const FormFactorLines other = by_lines(scene, kEachFace, 30'001, 8, 1);
  bool differs = false;
  for (std::size_t i = 0; i < one.factors.rows.size(); ++i) {
    const FormFactorRow& row = one.factors.rows[i];
    EXPECT_EQ(row.to, two.factors.rows[i].to);
    EXPECT_EQ(row.factor, two.factors.rows[i].factor);
    EXPECT_EQ(one.errors[i].factor, two.errors[i].factor);
    differs = differs || row.factor != other.factors.rows[i].factor;
    for (std::size_t k = 0; k < row.to.size(); ++k) {
      const double sent = one.factors.areas[i] * row.factor[k];
      EXPECT_NEAR(
          sent,
          one.factors.areas[row.to[k]] * one.factors.at(row.to[k], static_cast<int>(i)),
          1e-15 * sent);
    }
  }
  EXPECT_TRUE(differs);
}

TEST(FormFactorLines, ABudgetLeavesFewerLines) {
  const Scene scene(testing::enclosure(1, 4, 3));
  const auto surfaces = surfaces_of(scene, kEachFace);
  FormFactorLinesRequest request;
  request.lines = std::int64_t{1} << 40;
  request.budget_seconds = 0.5;
  request.threads = 1;
  const FormFactorLines f = form_factors_by_lines(scene, surfaces, request);
  EXPECT_FALSE(f.factors.complete);
  EXPECT_GE(f.lines, 2);
  EXPECT_LT(f.lines, request.lines);
  EXPECT_EQ(f.factors.rows.size(), surfaces.size());
  double sum = 0;
  for (const double x : f.factors.rows[0].factor) sum += x;
  EXPECT_NEAR(sum + f.factors.rows[0].backs, 1, 0.3) << "of the lines that were drawn";
}

TEST(FormFactorLines, RefusesFewerThanTwoLines) {
  const Scene scene(testing::lamp_and_ground());
  FormFactorLinesRequest request;
  request.lines = 1;
  EXPECT_THROW((void)form_factors_by_lines(scene, surfaces_of(scene, {}), request),
               InvalidInput);
}

}  // namespace
}  // namespace sightline
