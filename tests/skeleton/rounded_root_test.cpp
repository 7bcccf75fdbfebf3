// Positions rounded from double-double coefficients are those that exact ones give.

#include "linespace/lines/rounded_root.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "linespace/numbers/predicates.h"
#include "linespace/numbers/surd.h"
#include "linespace/swaths/edge_cuts.h"
#include "linespace/swaths/eee_curve.h"
#include "tests/support/generators.h"

namespace sightline::internal {
namespace {

BallNumber ball(double x) { return {x, 0, 0}; }

TEST(RoundedRoot, OfLinearPolynomialsIsTheExactOne) {
  testing::Random random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    const double scale = std::ldexp(1.0, random.integer(-60, 60));
    const double x = -random.uniform(0, 1) * scale;
    const double y = random.uniform(0, 1) * scale;
    const auto s = rounded_root(ball(x), ball(y));
    ASSERT_TRUE(s);
    const Rational exact = Rational(x) / (Rational(x) - Rational(y));
    EXPECT_LE(std::abs((Rational(*s) - exact).convert_to<double>()), kRangeError);
  }
}

// a (s - u) (s - v): at the larger root it rises iff a > 0.
TEST(RoundedRoot, OfQuadraticPolynomialsIsTheOneThatRisesOrFalls) {
  testing::Random random(2);
  int found = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    // On a grid, so that the coefficients are exact.
    const double u = random.integer(0, 4096) / 4096.0;
    const double v = random.integer(-20000, 20000) / 4096.0;
    const double a = random.integer(1, 8) * (random.one_in(2) ? 1 : -1);
    if (u == v) continue;
    const auto at = [&](double s) { return a * (s - u) * (s - v); };
    const Quadratic<BallNumber> h{ball(at(0)), ball(a * (2 * u * v - u - v)),
                                  ball(at(1))};
    const auto rising = rounded_root(h, true);
    const auto falling = rounded_root(h, false);
    ASSERT_TRUE(rising && falling);
    const double larger = std::max(u, v);
    const double smaller = std::min(u, v);
    EXPECT_NEAR(*rising, a > 0 ? larger : smaller, kRangeError);
    EXPECT_NEAR(*falling, a > 0 ? smaller : larger, kRangeError);
    ++found;
  }
  EXPECT_GT(found, 1900);
}

TEST(RoundedRoot, IsNotGivenWhereCoefficientsAreNotKnownWellEnough) {
  EXPECT_FALSE(rounded_root(BallNumber{-1, 0, 0x1p-30}, ball(1)));
  EXPECT_TRUE(rounded_root(BallNumber{-1, 0, 0x1p-50}, ball(1)));
  EXPECT_FALSE(rounded_root(ball(0), ball(0)));
  // (s - 1/2)^2: a double root, or none.
  EXPECT_FALSE(rounded_root(Quadratic<BallNumber>{ball(1), ball(-2), ball(1)}, true));
  EXPECT_FALSE(rounded_root(Quadratic<BallNumber>{ball(1), ball(0), ball(1)}, true));
}

// Scenes so far from the origin that doubles do not tell positions well.
TEST(RoundedRoot, OfAPlaneAndAnEdgeIsTheExactPosition) {
  PolygonSoup soup = testing::random_polytopes(3, 12, {.density = 0.2});
  for (Point& p : soup.vertices) p += Point(1 << 20, -(1 << 18), 1 << 19);
  const Scene scene(soup);
  testing::Random random(3);
  const int last = static_cast<int>(scene.points().size()) - 1;
  int wide = 0;
  for (int trial = 0; trial < 20000 && wide < 300; ++trial) {
    const Edge& edge =
        scene.edges()[random.integer(0, static_cast<int>(scene.edges().size()) - 1)];
    const LineThrough line{scene.point(edge.points[0]), scene.point(edge.points[1])};
    const std::array<std::int32_t, 3> plane{
        random.integer(0, last), random.integer(0, last), random.integer(0, last)};
    const auto value = [&](const Point& p) {
      return orient3d_value(scene.point(plane[0]), scene.point(plane[1]),
                            scene.point(plane[2]), p);
    };
    const auto sign = [&](const Point& p) {
      return orient3d(scene.point(plane[0]), scene.point(plane[1]), scene.point(plane[2]),
                      p);
    };
    if (sign(line.from) != -sign(line.to) || sign(line.from) == Sign::Zero) continue;
    Cut cut = make_cut(CutKind::Side, -1, plane, value(line.from), value(line.to));
    cut.lo = 0;  // as if nothing were known
    cut.hi = 1;
    ++wide;
    const double exact = exact_parameter(scene, line, cut).convert_to<double>();
    EXPECT_NEAR(rounded_parameter(scene, line, cut), exact, kRangeError);
    const auto at = [&](const Point& p) {
      return ball_orient3d(scene.point(plane[0]), scene.point(plane[1]),
                           scene.point(plane[2]), p);
    };
    EXPECT_TRUE(rounded_root(at(line.from), at(line.to)));
  }
  EXPECT_GE(wide, 300);
}

}  // namespace
}  // namespace sightline::internal
