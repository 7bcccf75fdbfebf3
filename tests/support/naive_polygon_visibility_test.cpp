// The naive decision of polygon-to-polygon visibility on cases by hand, and against
// random segments.

#include "tests/support/naive_polygon_visibility.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/support/generators.h"

namespace sightline::testing {
namespace {

using Corners = std::vector<Point>;

Corners square(double z, double x0, double y0, double x1, double y1) {
  return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}
Vec3 point(const Rational& x, const Rational& y, const Rational& z) { return {x, y, z}; }

NaiveAnswer answer(const VisibilityInstance& instance) {
  const NaiveVisibility result = naive_visibility(instance);
  EXPECT_EQ(result.witness.has_value(), result.answer == NaiveAnswer::Visible);
  if (result.witness) {
    EXPECT_TRUE(is_free(instance, result.witness->from, result.witness->to));
  }
  return result.answer;
}

TEST(IsFree, EndsAreStrictlyInside) {
  const VisibilityInstance open{square(0, 0, 0, 1, 1), square(1, 0, 0, 1, 1), {}};
  const Rational half = Rational(1) / 2;
  const Rational tiny = Rational(1) / 1000000000;
  EXPECT_TRUE(is_free(open, point(half, half, 0), point(tiny * tiny, half, 1)));
  EXPECT_FALSE(is_free(open, point(half, half, 0), point(0, half, 1)));
  EXPECT_FALSE(is_free(open, point(half, half, 0), point(1, 1, 1)));
  EXPECT_FALSE(is_free(open, point(half, half, tiny * tiny), point(half, half, 1)));
  EXPECT_FALSE(is_free(open, point(half, -half, 0), point(half, half, 1)));
}

TEST(IsFree, ClosedAndDegenerateOccludersBlock) {
  const Corners a = square(0, -1, -1, 1, 1), b = square(2, -1, -1, 1, 1);
  const Vec3 p = point(0, 0, 0), q = point(0, 0, 2);
  const auto free = [&](const Corners& o) { return is_free({a, b, {o}}, p, q); };
  EXPECT_FALSE(free(square(1, -1, -1, 1, 1)));
  EXPECT_FALSE(free(square(1, 0, -1, 1, 1))) << "through an edge";
  EXPECT_FALSE(free(square(1, 0, 0, 1, 1))) << "through a corner";
  EXPECT_TRUE(free(square(1, 0x1p-1000, -1, 1, 1)));
  EXPECT_TRUE(free(square(3, -1, -1, 1, 1))) << "beyond the end";
  EXPECT_FALSE(free(square(2, 0, 0, 1, 1))) << "at the end, in the plane of b";
  // In the plane x = 0 of the segment.
  const auto upright = [](double y0, double y1, double z0, double z1) {
    return Corners{{0, y0, z0}, {0, y1, z0}, {0, y1, z1}, {0, y0, z1}};
  };
  EXPECT_FALSE(free(upright(-1, 1, 0.5, 1)));
  EXPECT_FALSE(free(upright(0, 1, 0.5, 1))) << "along an edge";
  EXPECT_TRUE(free(upright(0.25, 1, 0.5, 1)));
  EXPECT_TRUE(free(upright(-1, 1, 2.5, 3)));
  EXPECT_FALSE(free(upright(-1, 1, 2, 3))) << "at its end";
  // Segments and points.
  EXPECT_FALSE(free({{-1, 0, 1}, {0, 0, 1}, {1, 0, 1}}));
  EXPECT_TRUE(free({{-1, 1, 1}, {0, 0.5, 1}, {1, 0, 1}}));
  EXPECT_FALSE(free({{0, 0, 1.5}, {0, 0, 3}, {0, 0, 3}}));
  EXPECT_TRUE(free({{0, 0, 2.5}, {0, 0, 3}, {0, 0, 3}}));
  EXPECT_FALSE(free({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}));
  EXPECT_TRUE(free({{0, 0.125, 1}, {0, 0.125, 1}, {0, 0.125, 1}}));
}

TEST(NaiveVisibility, OneWall) {
  const Corners a = square(0, 0, 0, 4, 4), b = square(2, 0, 0, 4, 4);
  EXPECT_EQ(answer({a, b, {}}), NaiveAnswer::Visible);
  EXPECT_EQ(answer({a, b, {square(1, 0, 0, 4, 4)}}), NaiveAnswer::Hidden);
  EXPECT_EQ(answer({a, b, {square(1, -1, -1, 5, 5)}}), NaiveAnswer::Hidden);
  EXPECT_EQ(answer({a, b, {square(1, 0x1p-40, 0, 4, 4)}}), NaiveAnswer::Visible);
  // Half way between parallel polygons that are no squares: the mean of the two hides.
  const Corners c = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}},
                d = {{0, 0, 2}, {4, 4, 2}, {0, 4, 2}};
  const Corners mean = {{0, 0, 1}, {2, 0, 1}, {4, 2, 1}, {2, 4, 1}, {0, 4, 1}};
  EXPECT_EQ(answer({c, d, {mean}}), NaiveAnswer::Hidden);
  Corners less = mean;
  less[2] = {std::nextafter(4.0, 0.0), 2, 1};
  EXPECT_EQ(answer({c, d, {less}}), NaiveAnswer::Visible);
}

TEST(NaiveVisibility, TouchingWallsLeaveNoGap) {
  const Corners a = square(0, 0, 0, 4, 4), b = square(2, 0, 0, 4, 4);
  const auto two = [&](double right, double left) {
    return answer({a, b, {square(1, -1, -1, right, 5), square(1, left, -1, 5, 5)}});
  };
  EXPECT_EQ(two(2, 2), NaiveAnswer::Hidden);
  EXPECT_EQ(two(2, 2.5), NaiveAnswer::Visible);
  EXPECT_EQ(two(2, 2 + 0x1p-51), NaiveAnswer::Visible);
  EXPECT_EQ(two(2, 1.5), NaiveAnswer::Hidden);
  // A step: one in front of the other.
  const auto step = [&](double right, double left) {
    return answer({a, b, {square(0.75, -1, -1, right, 5), square(1.25, left, -1, 5, 5)}});
  };
  EXPECT_EQ(step(2, 2), NaiveAnswer::Visible);
  // Rising through x <= right at 3/4 and x >= left at 5/4, from x >= 0 to x <= 4: the
  // steepest line falls from (4, 0) to (0, 2), or rises the other way.
  EXPECT_EQ(step(2.5, 1.5), NaiveAnswer::Hidden);
  EXPECT_EQ(step(2.5, 1.5 + 0x1p-40), NaiveAnswer::Visible);
  EXPECT_EQ(step(2.5 - 0x1p-40, 1.5), NaiveAnswer::Visible);
}

TEST(NaiveVisibility, OccludersAtTheEnds) {
  const Corners a = square(0, 0, 0, 4, 4), b = square(2, 0, 0, 4, 4);
  EXPECT_EQ(answer({a, b, {square(0, 0, 0, 4, 4)}}), NaiveAnswer::Hidden);
  EXPECT_EQ(answer({a, b, {square(0, 0, 0, 2, 4), square(0, 2, 0, 4, 4)}}),
            NaiveAnswer::Hidden);
  EXPECT_EQ(answer({a, b, {square(0, 0, 0, 2, 4), square(0, 2 + 0x1p-51, 0, 4, 4)}}),
            NaiveAnswer::Visible);
  // What is left of a is a strip, which a wall hides.
  EXPECT_EQ(answer({a, b, {square(0, 0, 0, 3, 4), square(1, 1.5, 0, 4, 4)}}),
            NaiveAnswer::Hidden);
  EXPECT_EQ(answer({a, b, {square(0, 0, 0, 3, 4), square(1, 1.5625, 0, 4, 4)}}),
            NaiveAnswer::Visible);
  // Across a, square to it: on either side something is left.
  const Corners across = {{2, -1, -1}, {2, 5, -1}, {2, 5, 1}, {2, -1, 1}};
  EXPECT_EQ(answer({a, b, {across}}), NaiveAnswer::Visible);
  // And a roof on it: a T, whose roof hides b from the right half.
  EXPECT_EQ(answer({a, b, {across, square(1, 0, 0, 2, 4)}}), NaiveAnswer::Visible);
  EXPECT_EQ(answer({a, b, {across, square(1, 0, 0, 4, 4)}}), NaiveAnswer::Hidden);
}

TEST(NaiveVisibility, PolygonsThatCrossOrTouchEachOthersPlanes) {
  const Corners a = square(0, 0, 0, 4, 4);
  const Corners upright = {{0, 2, -1}, {4, 2, -1}, {4, 2, 3}, {0, 2, 3}};
  EXPECT_EQ(answer({a, upright, {}}), NaiveAnswer::Visible);
  const Corners corner = {{0, 4, 0}, {4, 4, 0}, {4, 4, 3}, {0, 4, 3}};
  EXPECT_EQ(answer({a, corner, {}}), NaiveAnswer::Visible);
  // The roof of the wedge between them.
  const Corners roof = {{-1, 0, 0}, {5, 0, 0}, {5, 4, 3}, {-1, 4, 3}};
  EXPECT_EQ(answer({a, corner, {roof}}), NaiveAnswer::Visible);
  const Corners wall = {{-1, 5, -1}, {5, 5, -1}, {5, 3, 1}, {-1, 3, 1}};
  EXPECT_EQ(answer({a, corner, {wall}}), NaiveAnswer::Visible);
  const Corners bisector = {{-1, 4, 0}, {5, 4, 0}, {5, 0, 4}, {-1, 0, 4}};
  EXPECT_EQ(answer({a, corner, {bisector}}), NaiveAnswer::Hidden);
}

TEST(NaiveVisibility, OnlyWhatIsBetweenBlocks) {
  const Corners a = square(0, 0, 0, 4, 4), b = square(2, 0, 0, 4, 4);
  const Corners left = square(1, -1, -1, 2, 5);
  const Corners right = square(1, 2 + 0x1p-40, -1, 5, 5);
  // z = (x - 5) / 8: from beside a, above its plane, to below all of it; every line
  // through the slit meets it there.  And likewise above b.
  const Corners under_a = {
      {6, -99, 0.125}, {6, 99, 0.125}, {-59, 99, -8}, {-59, -99, -8}};
  const Corners above_b = {
      {6, -99, 1.875}, {6, 99, 1.875}, {-59, 99, 10}, {-59, -99, 10}};
  EXPECT_EQ(answer({a, b, {left, right, under_a, above_b}}), NaiveAnswer::Visible);
  const Corners over_a = {{6, -99, 0.125}, {6, 99, 0.125}, {-59, 99, 8}, {-59, -99, 8}};
  EXPECT_EQ(answer({a, b, {left, right, over_a}}), NaiveAnswer::Hidden);
}

TEST(NaiveVisibility, InOnePlane) {
  const Corners a = square(0, 0, 0, 4, 4), b = square(0, 6, 0, 10, 4);
  const auto wall = [](double y0, double y1, double z0 = -1) {
    return Corners{{5, y0, z0}, {5, y1, z0}, {5, y1, 1}, {5, y0, 1}};
  };
  EXPECT_EQ(answer({a, b, {}}), NaiveAnswer::Visible);
  EXPECT_EQ(answer({a, b, {wall(0, 4)}}), NaiveAnswer::Hidden);
  EXPECT_EQ(answer({a, b, {wall(0x1p-40, 4)}}), NaiveAnswer::Visible);
  EXPECT_EQ(answer({a, b, {wall(0, 4, 0)}}), NaiveAnswer::Hidden) << "touches the plane";
  EXPECT_EQ(answer({a, b, {wall(0, 4, 0x1p-40)}}), NaiveAnswer::Visible);
  EXPECT_EQ(answer({a, b, {wall(0, 2), wall(2, 4)}}), NaiveAnswer::Hidden);
  EXPECT_EQ(answer({a, b, {wall(0, 2), wall(2 + 0x1p-40, 4)}}), NaiveAnswer::Visible);
  EXPECT_EQ(answer({a, b, {square(0, 5, -1, 5.5, 5)}}), NaiveAnswer::Hidden);
  // Seen edge-on along the x axis, and in the way only of that one line.
  EXPECT_EQ(answer({a, b, {{{4.5, 2, -1}, {5, 2, -1}, {5, 2, 1}}}}),
            NaiveAnswer::Visible);
  // A slot along it is left open, or closed at its end.
  const std::vector<Corners> slot = {square(0, 4.25, -1, 5.75, 2),
                                     square(0, 4.25, 2.0 + 0x1p-40, 5.75, 5)};
  EXPECT_EQ(answer({a, b, slot}), NaiveAnswer::Visible);
  EXPECT_EQ(answer({a, b, {slot[0], slot[1], wall(2, 2.5)}}), NaiveAnswer::Hidden);
  // Overlapping, and what both share.
  const Corners c = square(0, 3, 0, 7, 4);
  EXPECT_EQ(answer({a, c, {}}), NaiveAnswer::Visible);
  EXPECT_EQ(answer({a, c, {square(0, 2, -1, 5, 5)}}), NaiveAnswer::Hidden);
  EXPECT_EQ(answer({a, c, {square(0, 2, -1, 3.5, 5)}}), NaiveAnswer::Visible);
  EXPECT_EQ(answer({a, a, {square(0, 0, 0, 4, 4)}}), NaiveAnswer::Hidden);
  EXPECT_EQ(answer({a, a, {square(0, 0, 0x1p-40, 4, 4)}}), NaiveAnswer::Visible);
}

// Thousands of small sets: no Hidden contradicted by a segment of a longer search, and
// both answers occur.
TEST(NaiveVisibility, AgreesWithRandomSegments) {
  int hidden = 0, visible = 0, undecided = 0;
  for (int seed = 0; seed < 400; ++seed) {
    Random random(seed);
    const bool grid = seed % 2 == 1;
    const auto corner = [&](double z_min, double z_max) {
      if (grid) {
        return Point(random.integer(0, 3), random.integer(0, 3),
                     random.integer(static_cast<int>(z_min), static_cast<int>(z_max)));
      }
      return Point(random.uniform(-1, 4), random.uniform(-1, 4),
                   random.uniform(z_min, z_max));
    };
    const auto triangle = [&](double z_min, double z_max) {
      while (true) {
        const Corners t = {corner(z_min, z_max), corner(z_min, z_max),
                           corner(z_min, z_max)};
        if ((t[1] - t[0]).cross(t[2] - t[0]).norm() > 0) return t;
      }
    };
    VisibilityInstance instance{triangle(0, 0), triangle(3, 3), {}};
    const int n = random.integer(1, 3);
    for (int i = 0; i < n; ++i) instance.occluders.push_back(triangle(1, 2));
    if (random.one_in(2)) {
      // A large one with a corner less: often hides almost everything.
      const double z = random.integer(1, 2);
      instance.occluders.push_back({{-1, -1, z}, {5, -1, z}, {-1, 5, z}});
    }
    const NaiveVisibility result = naive_visibility(instance);
    if (result.answer == NaiveAnswer::Hidden) {
      ++hidden;
      EXPECT_FALSE(find_free_segment(instance, seed, 200)) << seed;
    }
    visible += result.answer == NaiveAnswer::Visible;
    undecided += result.answer == NaiveAnswer::Undecided;
  }
  EXPECT_GT(hidden, 30);
  EXPECT_GT(visible, 100);
  EXPECT_EQ(undecided, 0);
}

}  // namespace
}  // namespace sightline::testing
