// Random lines against what integral geometry says of uniform ones.  Seeds are fixed and
// every claim is within 5 standard deviations of its closed form.

#include "linespace/line_sampling.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "linespace/predicates.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

using Numbers4 = std::array<std::uint64_t, 4>;
using Polygon = std::vector<Point>;

constexpr double kPi = std::numbers::pi;
constexpr int kSamples = 200'000;

// The mean of something over samples, and whether it is what it should be.
class Mean {
 public:
  void add(double x) {
    ++n_;
    sum_ += x;
    squares_ += x * x;
  }
  [[nodiscard]] double value() const { return sum_ / n_; }
  [[nodiscard]] double error() const {
    return std::sqrt((squares_ / n_ - value() * value()) / (n_ - 1));
  }
  void expect(double truth) const {
    EXPECT_LT(std::abs(value() - truth), 5 * error()) << value() << " for " << truth;
    EXPECT_LT(error(), 0.02 * std::abs(truth) + 0.01);  // there is something to see
  }

 private:
  double n_ = 0, sum_ = 0, squares_ = 0;
};

// A convex body by its faces, counter-clockwise seen from outside.
struct Body {
  std::vector<Polygon> faces;
  double surface = 0, volume = 0;

  explicit Body(std::vector<Polygon> polygons) : faces(std::move(polygons)) {
    for (const Polygon& f : faces) {
      for (std::size_t i = 1; i + 1 < f.size(); ++i) {
        surface += (f[i] - f[0]).cross(f[i + 1] - f[0]).norm() / 2;
        volume += f[0].dot(f[i].cross(f[i + 1])) / 6;
      }
    }
  }

  // By clipping with the planes of the faces.
  [[nodiscard]] bool is_met_by(const Chord& line) const {
    const Point d = line.to - line.from;
    double low = -std::numeric_limits<double>::infinity(), high = -low;
    for (const Polygon& f : faces) {
      const Point n = (f[1] - f[0]).cross(f[2] - f[0]);
      const double slope = n.dot(d), t = n.dot(f[0] - line.from) / slope;
      (slope < 0 ? low : high) = slope < 0 ? std::max(low, t) : std::min(high, t);
    }
    return low < high;
  }
};

Body box(const Point& low, const Point& high) {
  const PolygonSoup soup = testing::boxes_soup(
      {{{low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}}});
  std::vector<Polygon> faces;
  for (const auto& polygon : soup.polygons) {
    auto& face = faces.emplace_back();
    for (const int v : polygon) face.push_back(soup.vertices[v]);
  }
  return Body(std::move(faces));
}

// Corners a, b, c counter-clockwise seen from d's far side.
Body tetrahedron(const Point& a, const Point& b, const Point& c, const Point& d) {
  Body body({{a, b, c}, {a, d, b}, {b, d, c}, {c, d, a}});
  return body.volume > 0 ? body : Body({{a, c, b}, {a, b, d}, {b, c, d}, {c, a, d}});
}

// All within the ball of radius 2 around (1, 2, 3).
const Ball kBall{{1, 2, 3}, 2};
std::vector<Body> bodies() {
  return {box({0, 1, 2}, {2, 3, 4}), box({1.5, 1, 2.9}, {2, 3, 3}),
          box({0.5, 2.5, 3}, {0.75, 2.75, 3.25}),
          tetrahedron({0, 2, 3}, {2, 1, 2.5}, {2, 3, 2}, {1, 2, 4.5}),
          tetrahedron({1, 2, 1.25}, {1.1, 2, 1.5}, {1, 3, 4}, {2, 2, 2})};
}

Polygon square(double z) { return {{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}}; }
PolygonSampler sampler(const Polygon& polygon) {
  return PolygonSampler(std::vector<Polygon>{polygon});
}

// Random123's known answers (Salmon et al. 2011): zeros, ones, and digits of pi.
TEST(SampleNumbers, PhiloxAsItsAuthors) {
  constexpr std::uint64_t kOnes = ~std::uint64_t{0};
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}),
            (Numbers4{0x16554d9eca36314c, 0xdb20fe9d672d0fdc, 0xd7e772cee186176b,
                      0x7e68b68aec7ba23b}));
  EXPECT_EQ(philox({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (Numbers4{0x87b092c3013fe90b, 0x438c3c67be8d0224, 0x9cc7d7c69cd777b6,
                      0xa09caebf594f0ba0}));
  EXPECT_EQ(philox({0x243f6a8885a308d3, 0x13198a2e03707344, 0xa4093822299f31d0,
                    0x082efa98ec4e6c89},
                   {0x452821e638d01377, 0xbe5466cf34e90c6c}),
            (Numbers4{0xa528f45403e61d95, 0x38c72dbd566e9788, 0xa5a1610e72fd18b5,
                      0x57bd43b5e52b7fe6}));
}

TEST(SampleNumbers, AreTheBlocksOfTheirSampleInOrder) {
  SampleNumbers numbers(7, 9);
  for (std::uint64_t block = 0; block < 3; ++block) {
    for (const std::uint64_t expected : philox({block, 9, 0, 0}, {7, 0})) {
      EXPECT_EQ(numbers.bits(), expected);
    }
  }
  EXPECT_NE(SampleNumbers(7, 10).bits(), SampleNumbers(7, 9).bits());
  EXPECT_NE(SampleNumbers(8, 9).bits(), SampleNumbers(7, 9).bits());
}

TEST(LinesOfBall, EndOnTheSphere) {
  for (const auto& line : {line_by_two_points, line_by_direction}) {
    for (std::uint64_t i = 0; i < 1000; ++i) {
      SampleNumbers numbers(1, i);
      const Chord c = line(kBall, numbers);
      EXPECT_NEAR((c.from - kBall.centre).norm(), kBall.radius, 1e-14);
      EXPECT_NEAR((c.to - kBall.centre).norm(), kBall.radius, 1e-14);
    }
  }
}

// Cauchy and Crofton: the chance to meet a convex body is its share of the surface.
TEST(LinesOfBall, MeetConvexBodiesInProportionToSurface) {
  for (const auto& line : {line_by_two_points, line_by_direction}) {
    for (const Body& body : bodies()) {
      Mean met;
      for (std::uint64_t i = 0; i < kSamples; ++i) {
        SampleNumbers numbers(2, i);
        met.add(body.is_met_by(line(kBall, numbers)));
      }
      met.expect(body.surface / (4 * kPi * kBall.radius * kBall.radius));
    }
  }
}

// 4 V / S = 4 R / 3, and the directions have no preference: E(x^2) = 1/3.
TEST(LinesOfBall, ChordsAndDirections) {
  for (const auto& line : {line_by_two_points, line_by_direction}) {
    Mean length, x, xx, yz;
    for (std::uint64_t i = 0; i < kSamples; ++i) {
      SampleNumbers numbers(3, i);
      const Chord c = line(kBall, numbers);
      const Point d = (c.to - c.from).normalized();
      length.add((c.to - c.from).norm());
      x.add(d.x());
      xx.add(d.x() * d.x());
      yz.add(d.y() * d.z());
    }
    length.expect(4 * kBall.radius / 3);
    x.expect(0);
    xx.expect(1.0 / 3);
    yz.expect(0);
  }
}

TEST(ConvexBodyLines, MeanChordIsFourVolumesPerSurface) {
  for (const Body& body : bodies()) {
    const ConvexBodyLines lines(body.faces);
    EXPECT_NEAR(lines.surface(), body.surface, 1e-13);
    Mean length;
    for (std::uint64_t i = 0; i < kSamples; ++i) {
      SampleNumbers numbers(4, i);
      const Chord c = lines.line(numbers);
      length.add((c.to - c.from).norm());
    }
    length.expect(4 * body.volume / body.surface);
  }
}

TEST(ConvexBodyLines, MeetBodiesInsideInProportionToSurface) {
  const Point low(-1, 0.1, 1), high(3, 3.9, 5);  // holds all bodies
  const ConvexBodyLines lines(low, high);
  EXPECT_NEAR(lines.surface(), box(low, high).surface, 1e-13);
  for (const Body& body : bodies()) {
    Mean met;
    for (std::uint64_t i = 0; i < kSamples; ++i) {
      SampleNumbers numbers(5, i);
      met.add(body.is_met_by(lines.line(numbers)));
    }
    met.expect(body.surface / lines.surface());
  }
}

TEST(ConvexBodyLines, EndOnTheBoundary) {
  const Point low(-1, 0, 1), high(2, 2, 3);
  const ConvexBodyLines lines(low, high);
  for (std::uint64_t i = 0; i < 1000; ++i) {
    SampleNumbers numbers(6, i);
    const Chord c = lines.line(numbers);
    for (const Point& p : {c.from, c.to}) {
      const double inside = std::min((p - low).minCoeff(), (high - p).minCoeff());
      EXPECT_NEAR(inside, 0, 1e-14);
    }
  }
}

// A hexagon's triangles differ in area; so do two polygons.
TEST(PolygonSampler, IsUniformByArea) {
  const std::vector<Polygon> polygons = {
      {{2, 0, 1}, {4, 0, 1}, {5, 1, 1}, {4, 3, 1}, {2, 3, 1}, {1, 1, 1}},
      {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}},  // nothing
      {{0, 0, 3}, {0, 2, 3}, {0, 0, 4}}};
  const double areas[2] = {9, 1};
  const PolygonSampler polygon_sampler(polygons);
  EXPECT_DOUBLE_EQ(polygon_sampler.area(), 10);
  Mean first, x, y, below, z;
  for (std::uint64_t i = 0; i < kSamples; ++i) {
    SampleNumbers numbers(7, i);
    const auto s = polygon_sampler.point(numbers);
    ASSERT_NE(s.polygon, 1);
    first.add(s.polygon == 0);
    if (s.polygon == 0) {
      EXPECT_EQ(s.normal, Point(0, 0, 1));
      EXPECT_EQ(s.point.z(), 1);
      x.add(s.point.x());
      y.add(s.point.y());
      below.add(s.point.y() < 1);
    } else {
      EXPECT_EQ(s.normal, Point(1, 0, 0));
      z.add(s.point.z());
    }
  }
  first.expect(areas[0] / (areas[0] + areas[1]));
  x.expect(3);
  y.expect(13.0 / 9);  // widths 2, 4, 2 at y = 0, 1, 3
  below.expect(3.0 / 9);
  z.expect(3 + 1.0 / 3);
}

// REFERENCES: closed forms of the form factor.
TEST(SegmentBetween, MeanMeasureIsPiAreaFormFactor) {
  const struct {
    Polygon a, b;
    double form_factor;
  } cases[] = {{square(0), square(1), 0.199824895698387},
               {square(0), square(0.5), 0.415253283577147},
               {square(2), square(0), 0.068589588818553}};
  for (const auto& [a, b, form_factor] : cases) {
    const PolygonSampler from = sampler(a), to = sampler(b);
    Mean measure;
    for (std::uint64_t i = 0; i < kSamples; ++i) {
      SampleNumbers numbers(8, i);
      measure.add(segment_between(from, to, numbers).measure);
    }
    measure.expect(kPi * from.area() * form_factor);
  }
}

TEST(SegmentBetween, ScalesWithBothAreas) {
  Polygon a = square(0), b = square(1);
  for (Point& p : a) p *= 3;
  for (Point& p : b) p *= 3;
  const PolygonSampler from = sampler(a), to = sampler(b);
  SampleNumbers numbers(8, 1), same(8, 1);
  EXPECT_NEAR(segment_between(from, to, numbers).measure,
              9 * segment_between(sampler(square(0)), sampler(square(1)), same).measure,
              1e-13);
}

// A line through A, either way, then meets B with half the form factor.
TEST(LineThrough, SucceedsAsOftenAsTheFormFactorSays) {
  const PolygonSampler a = sampler(square(0));
  Mean met;
  for (std::uint64_t i = 0; i < kSamples; ++i) {
    SampleNumbers numbers(9, i);
    met.add(line_through(a, square(1), numbers, 1).has_value());
  }
  met.expect(0.199824895698387 / 2);
}

// Averages over uniform lines are weighted averages over point pairs.
TEST(LineThrough, AgreesWithWeightedPointPairs) {
  const Polygon b = {{2, 0, 0.25}, {2, 1, 0}, {2.5, 0.5, 1.5}};
  const PolygonSampler from = sampler(square(0)), to = sampler(b);
  Mean length, measure;
  double weighted = 0, squares = 0;
  for (std::uint64_t i = 0; i < kSamples; ++i) {
    SampleNumbers numbers(10, i);
    const PairSegment pair = segment_between(from, to, numbers);
    const double r = (pair.b.point - pair.a.point).norm();
    measure.add(pair.measure);
    weighted += pair.measure * r;
    squares += r;
    if (i % 10 != 0) continue;
    const auto line = line_through(from, b, numbers);
    ASSERT_TRUE(line);
    length.add((line->to - line->from).norm());
  }
  const double expected = weighted / (measure.value() * kSamples);
  EXPECT_GT(std::abs(squares / kSamples - expected), 20 * length.error());  // they differ
  EXPECT_LT(std::abs(length.value() - expected), 6 * length.error());
}

TEST(LineThrough, GivesUp) {
  SampleNumbers numbers(11, 0);
  const Polygon coplanar = {{2, 0, 0}, {3, 0, 0}, {2, 1, 0}};
  EXPECT_FALSE(line_through(sampler(square(0)), coplanar, numbers, 1000));
}

TEST(PolygonSampler, RefusesWhatHasNoArea) {
  EXPECT_THROW(PolygonSampler(std::vector<Polygon>{}), InvalidInput);
  EXPECT_THROW(sampler({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}), InvalidInput);
  EXPECT_THROW(sampler({{0, 0, 0}, {1e200, 0, 0}, {0, 1e200, 0}}), InvalidInput);
}

// 2^-140 is the smallest coordinate that predicates take.
TEST(PolygonSampler, PointsSuitPredicates) {
  const double tiny = 0x1p-139;
  const PolygonSampler s = sampler({{0, 0, 0}, {tiny, 0, 0}, {0, 1, 0}});
  int zero = 0;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    SampleNumbers numbers(12, i);
    const double x = s.point(numbers).point.x();
    EXPECT_TRUE(is_admissible(x));
    zero += x == 0;
  }
  EXPECT_GT(zero, 500);
  EXPECT_LT(zero, 1000);
}

}  // namespace
}  // namespace sightline
