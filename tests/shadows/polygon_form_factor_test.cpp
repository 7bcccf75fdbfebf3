#include "shadows/polygon_form_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "shadows/factors/adaptive_integral.h"
#include "shadows/point_form_factor.h"
#include "shadows/radiometry/dilogarithm.h"
#include "shadows/radiometry/segment_pair.h"

namespace sightline {
namespace {

using Corners = std::vector<Point>;

Corners square(double side, double height, bool up) {
  Corners p{{0, 0, height}, {side, 0, height}, {side, side, height}, {0, side, height}};
  if (!up) std::ranges::reverse(p);
  return p;
}
/// Stands on the y axis and faces along x.
Corners wall(double width, double height) {
  return {{0, 0, 0}, {0, width, 0}, {0, width, height}, {0, 0, height}};
}
double area(const Corners& t) { return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm(); }
double factor(const Corners& from, const Corners& to) {
  return polygon_form_factor(from, to).factor;
}

// REFERENCES: open.
TEST(PolygonFormFactor, OppositeSquares) {
  const Corners floor = square(1, 0, true);
  EXPECT_NEAR(factor(floor, square(1, 1, false)), 0.199824895698387, 1e-14);
  EXPECT_NEAR(factor(floor, square(1, 0.5, false)), 0.415253283577147, 1e-14);
  EXPECT_NEAR(factor(floor, square(1, 2, false)), 0.068589588818553, 1e-14);
  EXPECT_NEAR(factor(floor, square(1, 0.1, false)), 0.826994522397256, 1e-14);
}

TEST(PolygonFormFactor, SquaresThatShareAnEdge) {
  const Corners floor = square(1, 0, true);
  EXPECT_NEAR(factor(floor, wall(1, 1)), 0.200043776075403, 1e-14);
  EXPECT_NEAR(factor(floor, wall(1, 2)), 0.232852602795362, 1e-14);
  EXPECT_NEAR(factor(floor, square(1, 1, false)) + 4 * factor(floor, wall(1, 1)), 1,
              1e-14);
}

// REFERENCES, EnergyPlus 1868: a plenum 1/100 as high as wide.
TEST(PolygonFormFactor, FlatPlenum) {
  const Corners floor = square(100, 0, true);
  EXPECT_NEAR(factor(floor, square(100, 1, false)), 0.980416602925973, 1e-13);
  EXPECT_NEAR(factor(floor, wall(100, 1)), 0.00489584926850667, 1e-13);
}

TEST(PolygonFormFactor, NothingBehindAndNothingInOnePlane) {
  const Corners floor = square(1, 0, true);
  EXPECT_EQ(factor(floor, square(1, 1, true)), 0);
  EXPECT_EQ(factor(floor, square(1, -1, false)), 0);
  EXPECT_EQ(factor(floor, {{2, 0, 0}, {3, 0, 0}, {3, 1, 0}, {2, 1, 0}}), 0);
  EXPECT_THROW((void)factor(floor, {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}), InvalidInput);
}

// Of a wall that stands half below the floor only the upper half counts; and of a floor
// only what lies before the wall.
TEST(PolygonFormFactor, PartsBehindDoNotCount) {
  const Corners floor = square(1, 0, true);
  const Corners sunk{{0, 0, -1}, {0, 1, -1}, {0, 1, 1}, {0, 0, 1}};
  EXPECT_NEAR(factor(floor, sunk), 0.200043776075403, 1e-14);
  const Corners both{{-1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 1, 0}};
  EXPECT_NEAR(factor(both, sunk), 0.200043776075403 / 2, 1e-14);
}

// An L-shaped ceiling is as much as its two halves.
TEST(PolygonFormFactor, PolygonsThatAreNotConvex) {
  const Corners floor = square(1, 0, true);
  const Corners l{{0, 0, 1}, {0, 2, 1}, {1, 2, 1}, {1, 1, 1}, {2, 1, 1}, {2, 0, 1}};
  const Corners low{{0, 0, 1}, {0, 1, 1}, {2, 1, 1}, {2, 0, 1}};
  const Corners high{{0, 1, 1}, {0, 2, 1}, {1, 2, 1}, {1, 1, 1}};
  EXPECT_NEAR(factor(floor, l), factor(floor, low) + factor(floor, high), 1e-14);
}

/// Over the triangle, of the form factor of its points: product of Kronrod's rules.
double by_quadrature(const Corners& from, const Corners& to) {
  const Eigen::Vector3d normal = (from[1] - from[0]).cross(from[2] - from[0]);
  return 2 * internal::kronrod(internal::kKronrod15, 0, 1, [&](double u) {
               return u * internal::kronrod(internal::kKronrod15, 0, 1, [&](double v) {
                            const Point p = from[0] + u * (from[1] - from[0]) +
                                            u * v * (from[2] - from[1]);
                            Corners seen = to;
                            return std::abs(point_form_factor(p, normal, seen));
                          }).value;
             }).value;
}

TEST(PolygonFormFactor, AgreesWithQuadratureOfPoints) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int k = 0; k < 300; ++k) {
    const double height = k % 3 == 0 ? 2 : k % 3 == 1 ? 20 : 2000;
    const auto point = [&](double z) {
      return Point{unit(random), unit(random), z + 0.2 * unit(random)};
    };
    Corners from{point(0), point(0), point(0)};
    Corners to{point(height), point(height), point(height)};
    if ((from[1] - from[0]).cross(from[2] - from[0]).z() < 0) std::swap(from[0], from[1]);
    if ((to[1] - to[0]).cross(to[2] - to[0]).z() > 0) std::swap(to[0], to[1]);
    // All of both before the other's plane, so that nothing is clipped.
    const auto before = [](const Corners& a, const Corners& b) {
      const Eigen::Vector3d n = (a[1] - a[0]).cross(a[2] - a[0]);
      return std::ranges::all_of(b, [&](const Point& p) { return n.dot(p - a[0]) > 0; });
    };
    if (!before(from, to) || !before(to, from)) continue;
    const PolygonFormFactor f = polygon_form_factor(from, to);
    EXPECT_NEAR(f.factor, by_quadrature(from, to), 1e-12) << k;
    EXPECT_LT(f.error_bound, 1e-11) << k;
    EXPECT_NEAR(f.factor * area(from), factor(to, from) * area(to), 1e-13) << k;
  }
}

TEST(PolygonFormFactor, TrianglesThatTouchAreReciprocal) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto point = [&] { return Point{unit(random), unit(random), unit(random)}; };
  for (int k = 0; k < 200; ++k) {
    const Corners from{point(), point(), point()};
    Corners to{from[1], from[0], point()};
    if (k % 2 == 1) to[1] = point();
    const double least = std::min(area(from), area(to));
    EXPECT_NEAR(factor(from, to) * area(from) / least,
                factor(to, from) * area(to) / least, 1e-12)
        << k;
  }
}

// Lewin: Li2(1/2), Li2(-1), Li2(i), and the two functional equations that map the unit
// disc's outside and the half-plane beyond 1/2.
TEST(Dilogarithm, KnownValues) {
  using internal::dilogarithm;
  const double pi = std::numbers::pi, ln2 = std::numbers::ln2;
  EXPECT_NEAR(dilogarithm(0.5).real(), pi * pi / 12 - ln2 * ln2 / 2, 1e-15);
  EXPECT_NEAR(dilogarithm(-1).real(), -pi * pi / 12, 1e-15);
  EXPECT_NEAR(dilogarithm({0, 1}).imag(), 0.915965594177219015, 1e-15);
  EXPECT_NEAR(dilogarithm({0, 1}).real(), -pi * pi / 48, 1e-15);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-3, 3);
  for (int k = 0; k < 1000; ++k) {
    // Its derivative is -ln(1 - z) / z.
    const std::complex<double> z{unit(random), unit(random) + 4}, step{1e-4, 0};
    const auto slope = (dilogarithm(z + step) - dilogarithm(z - step)) / (2. * step);
    EXPECT_LT(std::abs(slope + std::log(1. - z) / z), 1e-8);
  }
}

TEST(KronrodRule, IsOfItsDegree) {
  const auto check = [](const auto& rule, int degree) {
    for (int power = 0; power <= degree; power += 2) {
      const auto estimate =
          internal::kronrod(rule, -1, 1, [&](double x) { return std::pow(x, power); });
      EXPECT_NEAR(estimate.value, 2. / (power + 1), 1e-15) << power;
    }
  };
  check(internal::kKronrod7, 10);
  check(internal::kKronrod15, 22);
}

}  // namespace
}  // namespace sightline
