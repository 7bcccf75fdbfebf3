#include "shadows/point_form_factor.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace sightline {
namespace {

// Seen from below: clockwise as seen from above.
std::array<Point, 4> ceiling(double height) {
  return {Point{-1, -1, height}, {-1, 1, height}, {1, 1, height}, {1, -1, height}};
}

TEST(PointFormFactor, SquareOverItsCentre) {
  // REFERENCES: a square of side 2 above its centre.
  EXPECT_NEAR(point_form_factor({0, 0, 0}, {0, 0, 1}, ceiling(1)), 0.554126423979572,
              1e-14);
  EXPECT_NEAR(point_form_factor({0, 0, 0}, {0, 0, 5}, ceiling(2)), 0.239456470461, 1e-12);
}

TEST(PointFormFactor, SidesAddUp) {
  // A box without a floor, from its middle: the ceiling and what is seen of four walls.
  double sum = point_form_factor({0, 0, 0}, {0, 0, 1}, ceiling(1));
  for (int wall = 0; wall < 4; ++wall) {
    const double angle = wall * std::numbers::pi / 2;
    const auto turned = [&](double x, double y, double z) {
      return Point{std::cos(angle) * x - std::sin(angle) * y,
                   std::sin(angle) * x + std::cos(angle) * y, z};
    };
    const std::array<Point, 4> polygon{turned(1, -1, -1), turned(1, -1, 1),
                                       turned(1, 1, 1), turned(1, 1, -1)};
    sum += point_form_factor({0, 0, 0}, {0, 0, 1}, polygon);
  }
  EXPECT_NEAR(sum, 1, 1e-14);
}

TEST(PointFormFactor, SignIsThatOfTheSideSeen) {
  const std::array<Point, 4> down = ceiling(1);
  const std::array<Point, 4> up{down[3], down[2], down[1], down[0]};
  const Point p{0.25, 0.5, -2};
  EXPECT_GT(point_form_factor(p, {1, 0, 2}, down), 0);
  EXPECT_EQ(point_form_factor(p, {1, 0, 2}, down), -point_form_factor(p, {1, 0, 2}, up));
  EXPECT_EQ(point_form_factor({0.25, 0.5, 1}, {0, 0, 1}, down), 0);
  EXPECT_EQ(point_form_factor(p, {0, 0, -1}, down), 0);
}

}  // namespace
}  // namespace sightline
