// Clipping against a box: laws on seeded polygons and segments, touching cases by hand.

#include "viewers/clip.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>

namespace sightline::viewers {
namespace {

using Box = std::array<Point, 2>;
using Polygon = std::vector<Point>;

const Box kUnit{Point(0, 0, 0), Point(1, 1, 1)};

bool is_inside(const Point& p, const Box& box) {
  return (p.array() >= box[0].array()).all() && (p.array() <= box[1].array()).all();
}

double area(std::span<const Point> polygon) {
  Point twice = Point::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    twice += (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  }
  return 0.5 * twice.norm();
}

/// Coordinates in [-1, 2], every other one on a grid of halves, to hit faces of the box.
Point random_point(std::mt19937& random) {
  std::uniform_real_distribution<double> real(-1, 2);
  std::uniform_int_distribution<int> half(-2, 4), coin(0, 1);
  Point p;
  for (int axis = 0; axis < 3; ++axis) {
    p[axis] = coin(random) == 0 ? real(random) : 0.5 * half(random);
  }
  return p;
}

TEST(ClipPolygon, CutsACornerOff) {
  // The triangle x + y <= 1.5 of the plane z = 0.5.
  const Polygon triangle{{0, 0, 0.5}, {1.5, 0, 0.5}, {0, 1.5, 0.5}};
  const Polygon kept = clip_polygon(triangle, kUnit);
  EXPECT_EQ(kept.size(), 5U);
  EXPECT_DOUBLE_EQ(area(kept), 0.875);
}

TEST(ClipPolygon, KeepsOrderAndOrientation) {
  const Polygon large{{-1, -1, 0.5}, {2, -1, 0.5}, {2, 2, 0.5}, {-1, 2, 0.5}};
  const Polygon kept = clip_polygon(large, kUnit);
  ASSERT_EQ(kept.size(), 4U);
  EXPECT_GT((kept[1] - kept[0]).cross(kept[2] - kept[0]).z(), 0);
  EXPECT_DOUBLE_EQ(area(kept), 1);
}

TEST(ClipPolygon, InsideComesBackAsItIs) {
  const Polygon inside{{0, 0, 0}, {1, 0.25, 0}, {0.1, 0.7, 1}};
  EXPECT_EQ(clip_polygon(inside, kUnit), inside);
}

TEST(ClipPolygon, InAFaceOfTheBoxIsInside) {
  const Polygon large{{-1, -1, 1}, {3, -1, 1}, {-1, 3, 1}};
  EXPECT_DOUBLE_EQ(area(clip_polygon(large, kUnit)), 1);
}

TEST(ClipPolygon, NothingIsLeftOfWhatIsOutside) {
  EXPECT_TRUE(clip_polygon(Polygon{}, kUnit).empty());
  EXPECT_TRUE(clip_polygon(Polygon{{2, 0, 0}, {3, 0, 0}, {2, 1, 0}}, kUnit).empty());
  // Past the box's corner, overlapping it in every coordinate.
  EXPECT_TRUE(
      clip_polygon(Polygon{{2.5, 0, 0.5}, {0, 2.5, 0.5}, {2, 2, 0.5}}, kUnit).empty());
}

TEST(ClipPolygon, NothingIsLeftOfWhatOnlyTouches) {
  // With a side, a corner, a side along an edge of the box, the middle of a side.
  EXPECT_TRUE(clip_polygon(Polygon{{1, 0, 0}, {1, 1, 0}, {2, 0, 0.5}}, kUnit).empty());
  EXPECT_TRUE(clip_polygon(Polygon{{1, 1, 1}, {2, 1, 1}, {1, 2, 2}}, kUnit).empty());
  EXPECT_TRUE(clip_polygon(Polygon{{1, 1, -1}, {1, 1, 2}, {2, 2, 0}}, kUnit).empty());
  EXPECT_TRUE(clip_polygon(Polygon{{0, 2, 1}, {2, 0, 1}, {2, 2, 3}}, kUnit).empty());
}

TEST(ClipPolygon, PartsOnBothSidesMakeTheWhole) {
  std::mt19937 random(1);
  int cut = 0;
  for (int i = 0; i < 5000; ++i) {
    const Polygon triangle{random_point(random), random_point(random),
                           random_point(random)};
    const Box large{Point::Constant(-1), Point::Constant(2)};
    // Two halves of the large box, left and right of x = 0.5.
    Box left = large, right = large;
    left[1].x() = right[0].x() = 0.5;
    const Polygon a = clip_polygon(triangle, left), b = clip_polygon(triangle, right);
    cut += !a.empty() && !b.empty();
    if (std::ranges::all_of(triangle, [](const Point& p) { return p.x() == 0.5; })) {
      continue;  // in the plane between: inside both
    }
    EXPECT_NEAR(area(a) + area(b), area(triangle), 1e-12);
  }
  EXPECT_GT(cut, 1000);
}

TEST(ClipPolygon, NoPointLeavesTheBox) {
  std::mt19937 random(2);
  int cut = 0;
  for (int i = 0; i < 20000; ++i) {
    const Box box{Point(0.1, 0.2, 0.3) / (1 + i % 7), Point(0.7, 0.9, 1.1)};
    const Polygon triangle{random_point(random), random_point(random),
                           random_point(random)};
    const Polygon kept = clip_polygon(triangle, box);
    EXPECT_TRUE(kept.empty() || kept.size() >= 3);
    EXPECT_LE(kept.size(), 9U);
    for (const Point& p : kept) EXPECT_TRUE(is_inside(p, box));
    EXPECT_LE(area(kept), area(triangle) + 1e-12);
    cut += !kept.empty();
  }
  EXPECT_GT(cut, 2000);
}

TEST(ClipSegment, CutAtBothEnds) {
  const auto kept = clip_segment({Point(-1, 0.5, 0.25), Point(3, 0.5, 0.25)}, kUnit);
  ASSERT_TRUE(kept);
  EXPECT_EQ((*kept)[0], Point(0, 0.5, 0.25));
  EXPECT_EQ((*kept)[1], Point(1, 0.5, 0.25));
}

TEST(ClipSegment, InsideComesBackAsItIs) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> real(0, 1);
  for (int i = 0; i < 100; ++i) {
    const Box inside{Point(real(random), real(random), real(random)),
                     Point(1, 0, real(random))};
    EXPECT_EQ(clip_segment(inside, kUnit), inside);
  }
  // In an edge of the box, the other way round.
  const Box along{Point(1, 1, 0.9), Point(1, 1, 0)};
  EXPECT_EQ(clip_segment(along, kUnit), along);
}

TEST(ClipSegment, NothingIsLeftOfWhatIsOutsideOrOnlyTouches) {
  EXPECT_FALSE(clip_segment({Point(2, 0, 0), Point(3, 0, 0)}, kUnit));
  EXPECT_FALSE(clip_segment({Point(0, 2, 0), Point(1, 2, 1)}, kUnit));
  EXPECT_FALSE(clip_segment({Point(2.5, 0, 0.5), Point(0, 2.5, 0.5)}, kUnit));
  EXPECT_FALSE(clip_segment({Point(1, 1, 1), Point(2, 2, 2)}, kUnit));      // an end
  EXPECT_FALSE(clip_segment({Point(2, 0, 0.5), Point(0, 2, 0.5)}, kUnit));  // an edge
  EXPECT_FALSE(clip_segment({Point(0.5, 0.5, 0.5), Point(0.5, 0.5, 0.5)}, kUnit));
}

TEST(ClipSegment, AgreesWithSamplesOfTheSegment) {
  std::mt19937 random(3);
  int cut = 0;
  for (int i = 0; i < 20000; ++i) {
    const Box segment{random_point(random), random_point(random)};
    const auto kept = clip_segment(segment, kUnit);
    const Point along = segment[1] - segment[0];
    double from = 2, to = -1;
    if (kept) {
      EXPECT_TRUE(is_inside((*kept)[0], kUnit) && is_inside((*kept)[1], kUnit));
      from = ((*kept)[0] - segment[0]).dot(along) / along.squaredNorm();
      to = ((*kept)[1] - segment[0]).dot(along) / along.squaredNorm();
      EXPECT_LT(from, to);
      ++cut;
    }
    for (int k = 0; k <= 20; ++k) {
      const double t = k / 20.0;
      // Strictly inside or outside, so that rounding does not matter.
      const double depth = std::min((segment[0] + t * along).minCoeff(),
                                    1 - (segment[0] + t * along).maxCoeff());
      if (std::abs(depth) < 1e-9) continue;
      EXPECT_EQ(depth > 0, from <= t && t <= to);
    }
  }
  EXPECT_GT(cut, 3000);
}

TEST(ClipDrawing, EveryKindIsCutAndKeepsItsLook) {
  Drawing drawing;
  const std::array<Point, 3> large{Point(-3, -3, 0.5), Point(5, -3, 0.5),
                                   Point(-3, 5, 0.5)};
  drawing.triangles = {{large, {1, 0, 0}, true, 7}};
  drawing.veils = {{large, {0, 1, 0}, 0.25F}};
  drawing.strokes = {{{Point(-1, 0.5, 0.5), Point(2, 0.5, 0.5)}, {0, 0, 1}, 3, 1, 0.5F},
                     {{Point(-1, 2, 0.5), Point(2, 2, 0.5)}, {0, 0, 1}, 3, 1, 0.5F}};
  const Drawing inside = clipped(drawing, kUnit);
  ASSERT_FALSE(inside.triangles.empty());
  double painted = 0, veiled = 0;
  for (const PaintedTriangle& t : inside.triangles) {
    EXPECT_EQ(t.id, 7);
    EXPECT_TRUE(t.cull_back);
    painted += area(t.points);
  }
  for (const VeilTriangle& t : inside.veils) {
    EXPECT_EQ(t.opacity, 0.25F);
    veiled += area(t.points);
  }
  EXPECT_DOUBLE_EQ(painted, 1);
  EXPECT_DOUBLE_EQ(veiled, 1);
  ASSERT_EQ(inside.strokes.size(), 1U);
  EXPECT_EQ(inside.strokes[0].points[1], Point(1, 0.5, 0.5));
  EXPECT_EQ(inside.strokes[0].hidden_opacity, 0.5F);
  EXPECT_FALSE(is_empty(inside));
  EXPECT_TRUE(is_empty(clipped(drawing, {Point(9, 9, 9), Point(10, 10, 10)})));
}

}  // namespace
}  // namespace sightline::viewers
