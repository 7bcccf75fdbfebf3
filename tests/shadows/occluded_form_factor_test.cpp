// The exchange area of two surfaces among blockers.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "shadows/factors/exchange_area.h"
#include "shadows/polygon_form_factor.h"
#include "tests/shadows/random_pairs.h"

namespace sightline {
namespace {

using internal::ExchangeArea;
using testing::box_faces;
using testing::Corners;
using testing::random_pair;
using testing::RandomPair;

/// In a plane z = height.
struct Rectangle {
  double x0, y0, x1, y1;
  [[nodiscard]] Corners at(double height, bool up) const {
    Corners p{{x0, y0, height}, {x1, y0, height}, {x1, y1, height}, {x0, y1, height}};
    if (!up) std::ranges::reverse(p);
    return p;
  }
};
constexpr Rectangle kUnit{0, 0, 1, 1};

ExchangeArea exchange(const Corners& from, const Corners& to,
                      const std::vector<Corners>& blockers, double tolerance = 1e-12) {
  const std::vector<std::span<const Point>> spans(blockers.begin(), blockers.end());
  return internal::exchange_area(from, to, spans, tolerance);
}

// REFERENCES: occluded.
TEST(OccludedFormFactor, SquareBlockerBetweenSquares) {
  const Corners floor = kUnit.at(0, true), ceiling = kUnit.at(1, false);
  const Rectangle middle{0.25, 0.25, 0.75, 0.75};
  const auto value = [&](const Rectangle& r, double height) {
    const ExchangeArea e = exchange(floor, ceiling, {r.at(height, true)});
    EXPECT_LT(e.error, 1e-12);
    return e.value;
  };
  EXPECT_NEAR(value(middle, 0.25), 0.115620602132415, 1e-14) << "Shapiro's case";
  EXPECT_NEAR(value(middle, 0.75), 0.115620602132415, 1e-14);
  EXPECT_NEAR(value(middle, 0.5), 0.099506294598985, 1e-14);
  EXPECT_NEAR(value({0, 0, 0.5, 0.5}, 0.5), 0.149868671773791, 1e-14);
}

/// The second way: the area of free lines of each direction, integrated over directions.
/// Between parallel planes at distance 1 lines of direction (u, v, 1) carry
/// du dv / (pi (1 + u^2 + v^2)^2), and those that start in the sender, pass no rectangle
/// and end in the target fill an area that is a sum of products of lengths.
class FreeLines {
 public:
  /// Blockers in one plane, not overlapping.
  FreeLines(const Rectangle& from, const Rectangle& to, double height,
            std::vector<Rectangle> blockers)
      : from_(from), to_(to), height_(height), blockers_(std::move(blockers)) {}

  [[nodiscard]] double exchange() const {
    const std::vector<double> us = breaks(&Rectangle::x0, &Rectangle::x1);
    const std::vector<double> vs = breaks(&Rectangle::y0, &Rectangle::y1);
    double sum = 0;
    for (std::size_t i = 1; i < us.size(); ++i) {
      for (std::size_t j = 1; j < vs.size(); ++j)
        sum += cell(us[i - 1], us[i], vs[j - 1], vs[j]);
    }
    return sum;
  }

 private:
  /// Of positions on the floor in [a0, a1], shifted by s in [b0, b1], by w s in [c0, c1].
  static double length(double a0, double a1, double b0, double b1, double s) {
    return std::min(a1, b1 - s) - std::max(a0, b0 - s);
  }
  static double length(double a0, double a1, double b0, double b1, double s, double c0,
                       double c1, double w) {
    return std::min({a1, b1 - s, c1 - w * s}) - std::max({a0, b0 - s, c0 - w * s});
  }
  /// Shifts at which some two ends fall together.
  [[nodiscard]] std::vector<double> breaks(double Rectangle::*low,
                                           double Rectangle::*high) const {
    struct End {
      double at, height;
    };
    std::vector<End> ends{
        {from_.*low, 0}, {from_.*high, 0}, {to_.*low, 1}, {to_.*high, 1}};
    for (const Rectangle& b : blockers_) {
      ends.push_back({b.*low, height_});
      ends.push_back({b.*high, height_});
    }
    const double least = to_.*low - from_.*high, most = to_.*high - from_.*low;
    std::vector<double> result{least, most};
    for (const End& a : ends) {
      for (const End& b : ends) {
        if (a.height == b.height) continue;
        const double s = (b.at - a.at) / (b.height - a.height);
        if (s > least && s < most) result.push_back(s);
      }
    }
    std::ranges::sort(result);
    // Cells are cut once more, so that eight nodes a side are enough.
    std::vector<double> finer;
    for (std::size_t i = 0; i < result.size(); ++i) {
      finer.push_back(result[i]);
      if (i + 1 == result.size()) break;
      for (int k = 1; k < 4; ++k) {
        finer.push_back(result[i] + 0.25 * k * (result[i + 1] - result[i]));
      }
    }
    return finer;
  }
  [[nodiscard]] double cell(double u0, double u1, double v0, double v1) const {
    static constexpr double kNodes[4] = {0.183434642495649805, 0.525532409916328986,
                                         0.796666477413626740, 0.960289856497536232};
    static constexpr double kWeights[4] = {0.362683783378361983, 0.313706645877887287,
                                           0.222381034453374471, 0.101228536290376259};
    double sum = 0;
    for (int i = 0; i < 8; ++i) {
      for (int j = 0; j < 8; ++j) {
        const double u = 0.5 * (u0 + u1 + (i < 4 ? 1 : -1) * kNodes[i % 4] * (u1 - u0));
        const double v = 0.5 * (v0 + v1 + (j < 4 ? 1 : -1) * kNodes[j % 4] * (v1 - v0));
        const double r = 1 + u * u + v * v;
        sum += kWeights[i % 4] * kWeights[j % 4] * free_area(u, v) / (r * r);
      }
    }
    return sum * 0.25 * (u1 - u0) * (v1 - v0) / std::numbers::pi;
  }
  [[nodiscard]] double free_area(double u, double v) const {
    double area = length(from_.x0, from_.x1, to_.x0, to_.x1, u) *
                  length(from_.y0, from_.y1, to_.y0, to_.y1, v);
    for (const Rectangle& b : blockers_) {
      const double x = length(from_.x0, from_.x1, to_.x0, to_.x1, u, b.x0, b.x1, height_);
      const double y = length(from_.y0, from_.y1, to_.y0, to_.y1, v, b.y0, b.y1, height_);
      if (x > 0 && y > 0) area -= x * y;
    }
    return area;
  }

  Rectangle from_, to_;
  double height_;
  std::vector<Rectangle> blockers_;
};

double deviation(const Rectangle& from, const Rectangle& to, double height,
                 const std::vector<Rectangle>& blockers) {
  std::vector<Corners> polygons;
  for (const Rectangle& b : blockers) polygons.push_back(b.at(height, true));
  const ExchangeArea e = exchange(from.at(0, true), to.at(1, false), polygons);
  return std::abs(e.value - FreeLines(from, to, height, blockers).exchange());
}

TEST(OccludedFormFactor, AgreesWithFreeLinesOfEachDirection) {
  EXPECT_LT(deviation(kUnit, kUnit, 0.25, {{0.25, 0.25, 0.75, 0.75}}), 1e-12);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto ordered = [&] {
    double a = unit(random), b = unit(random);
    return std::array{std::min(a, b), std::max(a, b)};
  };
  for (int k = 0; k < 40; ++k) {
    // Two blockers side by side, one of integers now and then, slivers too.
    const auto [y0, y1] = ordered();
    const double middle = k % 4 == 0 ? 0.5 : 0.3 + 0.7 * unit(random);
    const double thin = k % 5 == 0 ? 1e-6 : 1;
    const std::vector<Rectangle> blockers{{0.25 * (1 - thin), y0, middle, y1},
                                          {middle, 0, middle + 0.3 * thin, 1}};
    const Rectangle to{k % 3 == 0 ? 0 : unit(random), 0, 1.5, 1};
    EXPECT_LT(deviation(kUnit, to, 0.125 + 0.75 * unit(random), blockers), 1e-12) << k;
  }
}

// Two sheets that leave a slit of 2^-20 over the whole width.
TEST(OccludedFormFactor, SlitOfTwoToTheMinusTwenty) {
  const double slit = std::ldexp(1, -20);
  const std::vector<Rectangle> sheets{{-2, -2, 0.5, 3}, {0.5 + slit, -2, 3, 3}};
  EXPECT_LT(deviation(kUnit, kUnit, 0.5, sheets), 1e-15);
  const ExchangeArea e = exchange(kUnit.at(0, true), kUnit.at(1, false),
                                  {sheets[0].at(0.5, true), sheets[1].at(0.5, true)});
  EXPECT_NEAR(e.value / slit, 0.5, 0.2);
}

// Fins on an edge or a corner of a surface, boxes that stand on it, and what touches: the
// same from both sides, where all is integrated over other lines.
TEST(OccludedFormFactor, ReciprocalWhereBlockersTouch) {
  const Corners floor = kUnit.at(0, true), ceiling = kUnit.at(1, false);
  const Corners wall{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}};
  const auto fin = [](double x, double y0, double y1, double z0, double z1) {
    return Corners{{x, y0, z0}, {x, y1, z0}, {x, y1, z1}, {x, y0, z1}};
  };
  const std::vector<std::vector<Corners>> cases{
      {fin(0.5, 0, 1, 0, 0.5)},
      {fin(1, 0, 1, 0, 0.5)},
      {fin(0.5, 0.3, 0.7, 0.3, 1)},
      {fin(0.5, 0, 1, -0.5, 1.5)},
      {{{0, 0, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}}},
      box_faces({0.3, 0.3, 0}, {0.6, 0.7, 0.5}),
      box_faces({0, 0.3, 0}, {0.6, 0.7, 0.5}),
      box_faces({0, 0, 0}, {0.5, 0.5, 0.5}),
      box_faces({0.3, 0.3, 0.5}, {0.6, 0.7, 1}),
      box_faces({-1, 0.4, 0.2}, {2, 0.6, 0.6})};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (const Corners& other : {ceiling, wall}) {
      const ExchangeArea there = exchange(floor, other, cases[i]);
      const ExchangeArea back = exchange(other, floor, cases[i]);
      EXPECT_NEAR(there.value, back.value, there.error + back.error) << i;
      EXPECT_LT(there.error, 1e-11) << i;
      EXPECT_GE(there.value, 0) << i;
      EXPECT_LE(there.value, polygon_form_factor(floor, other).factor + 1e-12) << i;
    }
  }
}

// A fin that parts the floor: each half sees what it sees alone.
TEST(OccludedFormFactor, AWallThatPartsTheRoom) {
  const Corners floor = kUnit.at(0, true), ceiling = kUnit.at(1, false);
  const Corners partition{{0.5, 0, 0}, {0.5, 1, 0}, {0.5, 1, 1}, {0.5, 0, 1}};
  const Rectangle left{0, 0, 0.5, 1};
  const double half =
      0.5 * polygon_form_factor(left.at(0, true), left.at(1, false)).factor;
  EXPECT_NEAR(exchange(floor, ceiling, {partition}).value, 2 * half, 1e-14);
}

// The bound that is told holds, and is not above what was asked.
TEST(OccludedFormFactor, BoundsHoldOnRandomPairs) {
  for (int seed = 0; seed < 300; ++seed) {
    const RandomPair pair = random_pair(seed);
    const ExchangeArea exact = exchange(pair.from, pair.to, pair.blockers, 1e-12);
    const ExchangeArea back = exchange(pair.to, pair.from, pair.blockers, 1e-12);
    EXPECT_NEAR(exact.value, back.value, std::max(exact.error + back.error, 2e-13))
        << seed;
    for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
      const ExchangeArea e = exchange(pair.from, pair.to, pair.blockers, tolerance);
      EXPECT_LE(e.error, tolerance) << seed;
      EXPECT_NEAR(e.value, exact.value, e.error + exact.error) << seed;
    }
  }
}

// A part of the built-in room's floor and a face of its pyramid: rounding has laid the
// floor's first side now on this, now on that side of the face's plane.  A blocker that
// hides nothing once made thirty times as much of it.
TEST(OccludedFormFactor, SideInThePlaneOfTheTarget) {
  const Corners floor{{3.2378472222222219, 0, 4.5},
                      {2.0677595964566935, 0, 2.2434024360236227},
                      {1.88671875, 0, 2.1679687500000004},
                      {0.9150390625, 0, 4.5}};
  const Corners face{
      {1.546875, 1.140625, 0.890625}, {1.171875, 0, 0.515625}, {1.609375, 0, 1.359375}};
  const Corners table{{2, 0.71875, 1.5},
                      {3.5, 0.71875, 2.125},
                      {3.1875, 0.71875, 2.875},
                      {1.6875, 0.71875, 2.25}};
  const ExchangeArea open = exchange(floor, face, {}, 1e-9);
  const ExchangeArea partly = exchange(floor, face, {table}, 1e-9);
  EXPECT_LT(partly.value, open.value);
  EXPECT_GT(partly.value, 0.99 * open.value);
  EXPECT_NEAR(open.value, 0.0021458, 1e-7);
}

// Hairs that lie on a side of the target with their short ends, and hide nothing.  A line
// is less well known by a short stretch of it, and a plane by a narrow polygon in it:
// each in its turn, the hair's end counted as crossing the side, and the side as leaving
// the hair's plane, so that the stretch was left out or counted twice.
TEST(OccludedFormFactor, HairsThatEndAtASideOfTheTarget) {
  const double hair = std::ldexp(1, -20);
  const Corners leaning{{0.5, 0.25, 0.25}, {0.5 + hair, 0.5, 0.25}, {0.75, 0.75, 0.5}};
  const Corners window{{0, 0, 0}, {0, 0, 1}, {1 + hair, 0, 1}, {1 + hair, 0, 0}};
  const Corners below{{0.5625, 0, 0}, {0.5625 + hair, 0, 0}, {0.5625, 1, 0}};
  const Corners beside{
      {1, 1, 0.75}, {1 + hair, 1, 0.75}, {1 + hair, 0, 0.75}, {1, 0, 0.75}};
  const double open = exchange(leaning, window, {}).value;
  EXPECT_NEAR(open, 0.003004910194909, 1e-13);
  for (const Corners& blocker : {below, beside}) {
    EXPECT_NEAR(exchange(leaning, window, {blocker}).value, open, 1e-13);
    EXPECT_NEAR(exchange(window, leaning, {blocker}).value, open, 1e-13);
  }
}

}  // namespace
}  // namespace sightline
