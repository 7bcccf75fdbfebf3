// OcclusionIndex against naive exact answers, and its own answers against each other.

#include "linespace/occlusion.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <thread>
#include <vector>

#include "linespace/contacts/contact.h"
#include "linespace/sight/occlusion.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

using internal::LineScan;
using internal::Rational;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<int> all_faces(const Scene& scene) {
  std::vector<int> out(scene.faces().size());
  std::iota(out.begin(), out.end(), 0);
  return out;
}

// Exactly, from all faces; contact_test checks LineScan itself.
bool naive_is_free(const Scene& scene, const Point& a, const Point& b) {
  const LineScan scan(scene, all_faces(scene), a, b);
  for (int c = 0; c < scan.size(); ++c) {
    if (scan.to(c) > 0 && scan.from(c) < 1 && scan.blocked_between(c, 0, 1)) return false;
  }
  return true;
}

// From predicates alone, for segments in general position.
bool crosses_some_triangle(const Scene& scene, const Point& a, const Point& b) {
  for (const int f : all_faces(scene)) {
    const auto ids = scene.face_points(f);
    for (std::size_t i = 1; i + 1 < ids.size(); ++i) {
      const Point &p = scene.point(ids[0]), &q = scene.point(ids[i]),
                  &r = scene.point(ids[i + 1]);
      if (orient3d(p, q, r, a) == orient3d(p, q, r, b)) continue;
      const Sign s = orient3d(a, b, p, q);
      if (s == orient3d(a, b, q, r) && s == orient3d(a, b, r, p)) return true;
    }
  }
  return false;
}

Point random_point(testing::Random& random, const std::array<Point, 2>& bounds,
                   double margin = 0) {
  Point p;
  for (int i = 0; i < 3; ++i) {
    const double grow = margin * (bounds[1][i] - bounds[0][i]);
    p[i] = random.uniform(bounds[0][i] - grow, bounds[1][i] + grow);
  }
  return p;
}

PolygonSoup one_quad() {
  PolygonSoup soup;
  soup.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  soup.polygons = {{0, 1, 2, 3}};
  return soup;
}

// A room open above: a floor between four walls that reach below it.
PolygonSoup room() {
  PolygonSoup soup;
  soup.vertices = {{0, 0, 0},  {8, 0, 0},  {8, 8, 0}, {0, 8, 0}, {0, 0, -1}, {8, 0, -1},
                   {8, 8, -1}, {0, 8, -1}, {0, 0, 4}, {8, 0, 4}, {8, 8, 4},  {0, 8, 4}};
  soup.polygons = {
      {0, 1, 2, 3}, {4, 5, 9, 8}, {5, 6, 10, 9}, {6, 7, 11, 10}, {7, 4, 8, 11}};
  return soup;
}

TEST(IsFree, GenericSegmentsAsByPredicates) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const Scene scene(seed % 3 == 0   ? testing::city(seed, 600)
                      : seed % 3 == 1 ? testing::random_polytopes(seed, 30)
                                      : testing::rotated_boxes(seed, 40));
    const OcclusionIndex index(scene);
    testing::Random random(seed);
    int free = 0;
    for (int i = 0; i < 1000; ++i) {
      const double margin = i % 4 == 0 ? 100 : i % 4 == 1 ? 1 : 0;
      const Point a = random_point(random, scene.bounds(), margin);
      Point b = random_point(random, scene.bounds(), margin);
      if (i % 2 == 1) b = a + std::ldexp(1.0, random.integer(-30, 0)) * (b - a);
      const bool expected = !crosses_some_triangle(scene, a, b);
      ASSERT_EQ(index.is_free(a, b), expected);
      ASSERT_EQ(index.is_free(b, a), expected);
      ASSERT_EQ(!index.first_blocker(a, b), expected);
      free += expected;
    }
    EXPECT_GT(free, 100);
    EXPECT_LT(free, 950);
  }
}

TEST(IsFree, GenericSegmentsNeedNoExactNumbers) {
  constexpr int kSegments = 20000;
  const std::vector<PolygonSoup> soups = {testing::city(3, 2000),
                                          testing::triangle_soup(5, 2000)};
  for (const PolygonSoup& soup : soups) {
    const Scene scene(soup);
    const OcclusionIndex index(scene);
    testing::Random random(17);
    const StageCounts before = thread_stage_counts();
    int free = 0;
    for (int i = 0; i < kSegments; ++i) {
      const Point a = random_point(random, scene.bounds());
      Point b = random_point(random, scene.bounds());
      if (i % 2 == 1) b = a + random.uniform(0, 1) * (b - a);
      free += index.is_free(a, b);
    }
    EXPECT_GT(free, 1000);
    EXPECT_LT(free, kSegments - 1000);
    const StageCounts& after = thread_stage_counts();
    EXPECT_EQ(after.by_exact, before.by_exact);
    EXPECT_EQ(after.by_double, before.by_double + kSegments);
  }
}

// Were the count above always 0, it would say nothing.
TEST(IsFree, SegmentsThroughSidesCountAsExact) {
  const Scene scene(one_quad());
  const OcclusionIndex index(scene);
  const StageCounts before = thread_stage_counts();
  EXPECT_TRUE(index.is_free(Point(4, 2, -1), Point(4, 2, 1)));
  EXPECT_FALSE(index.is_free(Point(2, 2, -1), Point(2, 2, 1)));
  EXPECT_EQ(thread_stage_counts().by_exact, before.by_exact + 1);
  EXPECT_EQ(thread_stage_counts().by_double, before.by_double + 1);
}

// Between vertices, midpoints of sides and centres of faces: touching everywhere.
TEST(IsFree, SegmentsBetweenFeaturesAsNaive) {
  std::vector<PolygonSoup> soups = {testing::grid_city(1, 120), testing::city(2, 120),
                                    testing::random_polytopes(3, 8),
                                    testing::rotated_boxes(4, 8)};
  for (const testing::Touching kind : testing::all_touching()) {
    soups.push_back(testing::touching_boxes(kind));
  }
  int free = 0, blocked = 0;
  for (std::size_t n = 0; n < soups.size(); ++n) {
    SCOPED_TRACE(::testing::Message() << "scene " << n);
    const Scene scene(soups[n]);
    const OcclusionIndex index(scene);
    testing::Random random(n + 1);
    std::vector<Point> features;
    for (int f = 0; f < static_cast<int>(scene.faces().size()); ++f) {
      const auto ids = scene.face_points(f);
      Point center(0, 0, 0);
      for (std::size_t i = 0; i < ids.size(); ++i) {
        const Point &p = scene.point(ids[i]), &q = scene.point(ids[(i + 1) % ids.size()]);
        features.push_back(p);
        features.push_back((p + q) / 2);
        center += p / static_cast<double>(ids.size());
      }
      features.push_back(center);
    }
    const int last = static_cast<int>(features.size()) - 1;
    for (int i = 0; i < 300; ++i) {
      const Point& a = features[random.integer(0, last)];
      const Point& b = features[random.integer(0, last)];
      if (a == b) continue;
      const bool expected = naive_is_free(scene, a, b);
      ASSERT_EQ(index.is_free(a, b), expected)
          << a.transpose() << " to " << b.transpose();
      ASSERT_EQ(index.is_free(b, a), expected);
      (expected ? free : blocked)++;
      // The same contacts as from all faces.
      const LineScan scan(scene, all_faces(scene), a, b);
      std::size_t within = 0;
      for (int c = 0; c < scan.size(); ++c) {
        within += scan.to(c) >= 0 && scan.from(c) <= 1;
      }
      const auto contacts = index.contacts(a, b);
      ASSERT_EQ(contacts.size(), within);
      // The maximal free segment contains the segment, is free, and cannot grow.
      const auto maximal = index.maximal_free_segment(a, b);
      ASSERT_EQ(maximal.has_value(), expected);
      if (!maximal) continue;
      ASSERT_LE(maximal->from, 0);
      ASSERT_GE(maximal->to, 1);
      ASSERT_EQ(maximal->from == -kInfinity, maximal->from_faces.empty());
      ASSERT_EQ(maximal->to == kInfinity, maximal->to_faces.empty());
      for (const Contact& c : maximal->contacts) ASSERT_FALSE(c.blocked);
    }
  }
  EXPECT_GT(free, 200);
  EXPECT_GT(blocked, 200);
}

TEST(IsFree, ContactsAtTheEndsDoNotCount) {
  const Scene scene(room());
  const OcclusionIndex index(scene);
  EXPECT_TRUE(index.is_free({0, 4, 2}, {8, 4, 2}));    // wall to wall
  EXPECT_TRUE(index.is_free({0, 4, 0}, {8, 4, 0}));    // the same along the floor
  EXPECT_TRUE(index.is_free({1, 1, 0}, {7, 6, 0}));    // from floor to floor
  EXPECT_TRUE(index.is_free({0, 0, 0}, {8, 8, 0}));    // corner to corner
  EXPECT_TRUE(index.is_free({0, 0, 0}, {8, 0, 0}));    // along a valley
  EXPECT_FALSE(index.is_free({-1, 4, 0}, {7, 4, 0}));  // through a wall's foot
  EXPECT_FALSE(index.is_free({-1, 4, 2}, {7, 4, 2}));  // through a wall
  EXPECT_TRUE(index.is_free({-1, 4, 4}, {9, 4, 4}));   // over the walls
  EXPECT_TRUE(index.is_free({4, 4, 0}, {4, 4, -9}));   // from the floor, downwards
  EXPECT_FALSE(index.is_free({4, 4, 1}, {4, 4, -9}));
  EXPECT_TRUE(index.is_free({4, 4, 1}, {4, 4, 1}));  // no segment at all
}

TEST(Contacts, InOrderWithKinds) {
  const Scene scene(room());
  const OcclusionIndex index(scene);
  const auto contacts = index.contacts({-1, 4, 2}, {9, 4, 2});
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_DOUBLE_EQ(contacts[0].from, 0.1);
  EXPECT_DOUBLE_EQ(contacts[0].to, 0.1);
  EXPECT_TRUE(contacts[0].blocked);
  ASSERT_EQ(contacts[0].touches.size(), 1u);
  EXPECT_EQ(contacts[0].touches[0].kind, TouchKind::Interior);
  EXPECT_DOUBLE_EQ(contacts[1].from, 0.9);

  // Cut to the segment: the floor from its middle to the wall, which is at the end.
  const auto floor = index.contacts({4, 4, 0}, {8, 4, 0});
  ASSERT_EQ(floor.size(), 1u);
  EXPECT_EQ(floor[0].from, 0);
  EXPECT_EQ(floor[0].to, 1);
  EXPECT_FALSE(floor[0].blocked);

  const auto blocker = index.first_blocker({-1, 4, 2}, {9, 4, 2});
  ASSERT_TRUE(blocker);
  EXPECT_DOUBLE_EQ(blocker->from, 0.1);
}

TEST(MaximalFreeSegment, EndsAtWallsOrOutside) {
  const Scene scene(room());
  const OcclusionIndex index(scene);
  const auto across = index.maximal_free_segment({2, 4, 2}, {4, 4, 2});
  ASSERT_TRUE(across);
  EXPECT_EQ(across->from, -1);
  EXPECT_EQ(across->to, 3);
  EXPECT_EQ(across->from_faces, (std::vector<int>{4}));
  EXPECT_EQ(across->to_faces, (std::vector<int>{2}));

  // Along the floor: the contact is one with the walls, but only they block.
  const auto along = index.maximal_free_segment({2, 4, 0}, {4, 4, 0});
  ASSERT_TRUE(along);
  EXPECT_EQ(along->from, -1);
  EXPECT_EQ(along->to, 3);
  EXPECT_EQ(along->to_faces, (std::vector<int>{0, 2}));
  ASSERT_EQ(along->contacts.size(), 1u);

  const auto up = index.maximal_free_segment({4, 4, 1}, {4, 4, 2});
  ASSERT_TRUE(up);
  EXPECT_EQ(up->from, -1);
  EXPECT_EQ(up->to, kInfinity);
  EXPECT_TRUE(up->to_faces.empty());

  const auto over = index.maximal_free_segment({1, 4, 4}, {2, 4, 4});
  ASSERT_TRUE(over);
  EXPECT_EQ(over->from, -kInfinity);
  EXPECT_EQ(over->to, kInfinity);
  EXPECT_EQ(over->contacts.size(), 2u);

  EXPECT_FALSE(index.maximal_free_segment({-1, 4, 2}, {2, 4, 2}));
}

// What doubles certify is what exact numbers say, to the last bit: in general position,
// where boxes stand on each other or touch, and where points lie on a grid.
TEST(MaximalFreeSegment, CertifiedAsByExactNumbers) {
  const std::vector<PolygonSoup> scenes{
      testing::city(5, 900), testing::triangle_soup(3, 300),
      testing::grid_city(2, 400, {.may_touch = true}), testing::street_city(1, 498, {})};
  std::int64_t certified = 0, asked = 0;
  for (const PolygonSoup& soup : scenes) {
    for (const double scale : {1.0, 0x1p-30, 0x1p40}) {
      PolygonSoup scaled = soup;
      for (Point& p : scaled.vertices) p *= scale;
      const Scene scene(scaled);
      const OcclusionIndex index(scene);
      testing::Random random(11);
      for (int i = 0; i < 400; ++i) {
        Point a = random_point(random, scene.bounds());
        Point b = random_point(random, scene.bounds());
        if (i % 2 == 0) {
          for (Point* p : {&a, &b}) {
            for (double& x : *p) x = scale * std::round(x / scale);
          }
        }
        b = a + std::ldexp(1.0, -random.integer(0, 4)) * (b - a);
        if (a == b) continue;
        const StageCounts before = thread_stage_counts();
        const auto m = index.maximal_free_segment(a, b);
        certified += thread_stage_counts().by_exact == before.by_exact;
        ++asked;
        const auto n = internal::OcclusionAccess::maximal_exactly(index, a, b);
        ASSERT_EQ(m.has_value(), n.has_value());
        if (!m) continue;
        ASSERT_EQ(m->from, n->from);
        ASSERT_EQ(m->to, n->to);
        ASSERT_EQ(m->from_faces, n->from_faces);
        ASSERT_EQ(m->to_faces, n->to_faces);
        ASSERT_EQ(m->contacts.size(), n->contacts.size());
      }
    }
  }
  EXPECT_GT(certified, asked / 2);
  EXPECT_LT(certified, asked);
}

// The segment lies in the box of a slanted face, which the line crosses behind it.
TEST(MaximalFreeSegment, InTheBoxOfAFaceBehind) {
  PolygonSoup soup;
  soup.vertices = {{10, 0, 0}, {0, 10, 0}, {0, 0, 10}};
  soup.polygons = {{0, 1, 2}};
  const Scene scene(soup);
  const OcclusionIndex index(scene);
  const auto m = index.maximal_free_segment({4, 4, 4}, {4.5, 4.5, 4.5});
  ASSERT_TRUE(m);
  EXPECT_EQ(m->from, (Rational(10) / 3 - 4).convert_to<double>() * 2);
  EXPECT_EQ(m->to, kInfinity);
  EXPECT_EQ(m->from_faces, std::vector{0});
  EXPECT_TRUE(m->to_faces.empty());
}

TEST(MaximalFreeSegment, GenericAsByIsFree) {
  const Scene scene(testing::city(5, 900));
  const OcclusionIndex index(scene);
  testing::Random random(5);
  int bounded = 0;
  for (int i = 0; i < 1000; ++i) {
    const Point a = random_point(random, scene.bounds());
    const Point b = a + std::ldexp(1.0, -random.integer(1, 12)) *
                            (random_point(random, scene.bounds()) - a);
    const auto m = index.maximal_free_segment(a, b);
    ASSERT_EQ(m.has_value(), index.is_free(a, b));
    if (!m) continue;
    const double low = std::max(m->from, -1e4), high = std::min(m->to, 1e4);
    const auto at = [&](double t) -> Point { return a + t * (b - a); };
    const double step = 1e-9 * (high - low);
    ASSERT_TRUE(index.is_free(at(low + step), at(high - step)));
    if (m->to < kInfinity) {
      ++bounded;
      ASSERT_FALSE(index.is_free(a, at(m->to + step)));
      ASSERT_GE(m->to_faces.size(), 1u);  // 2 where a building stands on the slab
    }
    if (m->from > -kInfinity) {
      ASSERT_FALSE(index.is_free(at(m->from - step), b));
    }
  }
  EXPECT_GT(bounded, 300);
}

TEST(Occlusion, SameAnswersForScaledMirroredAndFarScenes) {
  const PolygonSoup soup = testing::grid_city(7, 150);
  const Scene scene(soup);
  const OcclusionIndex index(scene);
  for (int variant = 0; variant < 6; ++variant) {
    SCOPED_TRACE(::testing::Message() << "variant " << variant);
    const auto moved = [&](const Point& p) -> Point {
      switch (variant) {
        case 0:
          return p * 0x1p100;
        case 1:
          return p * 0x1p-100;
        case 2:
          return {p[2], p[0], p[1]};
        case 3:
          return {-p[1], p[0], -p[2]};
        case 4:
          return p + Point(0x1p40, 0, -0x1p40);
        default:
          return p * -0x1p-20;
      }
    };
    PolygonSoup copy = soup;
    for (Point& p : copy.vertices) p = moved(p);
    const Scene other(copy);
    const OcclusionIndex other_index(other);
    testing::Random random(3);
    for (int i = 0; i < 1500; ++i) {
      const auto corner = [&] {
        const auto points = scene.points();
        return points[random.integer(0, static_cast<int>(points.size()) - 1)];
      };
      const Point a = corner(), b = corner();
      if (a == b) continue;
      ASSERT_EQ(other_index.is_free(moved(a), moved(b)), index.is_free(a, b));
      const auto m = index.maximal_free_segment(a, b);
      const auto n = other_index.maximal_free_segment(moved(a), moved(b));
      ASSERT_EQ(m.has_value(), n.has_value());
      if (!m) continue;
      ASSERT_EQ(m->from, n->from);
      ASSERT_EQ(m->to, n->to);
      ASSERT_EQ(m->contacts.size(), n->contacts.size());
    }
  }
}

TEST(Occlusion, EndsVeryFarAway) {
  const Scene scene(one_quad());
  const OcclusionIndex index(scene);
  for (const double far : {10.0, 1e6, 1e12, 1e30}) {
    EXPECT_FALSE(index.is_free({1, 2, far}, {1, 2, -far}));
    EXPECT_FALSE(index.is_free({1, 2, far}, {1, 2, -1}));
    EXPECT_TRUE(index.is_free({5, 2, far}, {5, 2, -far}));
    EXPECT_TRUE(index.is_free({0, 2, far}, {0, 2, -far}));
    EXPECT_TRUE(index.is_free({far, 2, 0}, {-far, 2, 0}));
    EXPECT_TRUE(index.is_free({far, far, 1}, {far, -far, 2}));
    const auto m = index.maximal_free_segment({1, 2, far}, {1, 2, far / 2});
    ASSERT_TRUE(m);
    EXPECT_EQ(m->from, -kInfinity);
    EXPECT_EQ(m->to, 2);
  }
}

TEST(Occlusion, ThreadsAgree) {
  const Scene scene(testing::city(9, 600));
  const OcclusionIndex index(scene);
  const auto answers = [&] {
    testing::Random random(1);
    std::vector<bool> out;
    for (int i = 0; i < 2000; ++i) {
      const Point a = random_point(random, scene.bounds());
      const auto points = scene.points();
      out.push_back(index.is_free(
          a, points[random.integer(0, static_cast<int>(points.size()) - 1)]));
    }
    return out;
  };
  const auto expected = answers();
  std::vector<bool> other;
  std::thread thread([&] { other = answers(); });
  EXPECT_EQ(answers(), expected);
  thread.join();
  EXPECT_EQ(other, expected);
}

// ---- Faces that meet a triangle. ----

// Two convex planar polygons meet iff a side of one meets the other or they are coplanar
// and one contains the other; here by points of one on either side of the other.
bool naive_meets(const std::vector<Point>& p, const std::vector<Point>& q) {
  using Vector = internal::ExactPoint;
  const auto minus = [](const Vector& a, const Vector& b) -> Vector {
    return {Rational(a[0] - b[0]), Rational(a[1] - b[1]), Rational(a[2] - b[2])};
  };
  const auto cross = [](const Vector& a, const Vector& b) -> Vector {
    return {Rational(a[1] * b[2] - a[2] * b[1]), Rational(a[2] * b[0] - a[0] * b[2]),
            Rational(a[0] * b[1] - a[1] * b[0])};
  };
  const auto dot = [](const Vector& a, const Vector& b) {
    return Rational(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
  };
  std::vector<Vector> a, b;
  for (const Point& x : p) a.push_back(internal::exact_point(x));
  for (const Point& x : q) b.push_back(internal::exact_point(x));
  // Separating directions: the normals, products of sides, and in-plane normals of sides.
  const Vector na = cross(minus(a[1], a[0]), minus(a[2], a[0]));
  const Vector nb = cross(minus(b[1], b[0]), minus(b[2], b[0]));
  std::vector<Vector> directions = {na, nb};
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vector e = minus(a[(i + 1) % a.size()], a[i]);
    directions.push_back(cross(na, e));
    for (std::size_t j = 0; j < b.size(); ++j) {
      directions.push_back(cross(e, minus(b[(j + 1) % b.size()], b[j])));
    }
  }
  for (std::size_t j = 0; j < b.size(); ++j) {
    directions.push_back(cross(nb, minus(b[(j + 1) % b.size()], b[j])));
  }
  for (const Vector& d : directions) {
    Rational a_low = dot(d, a[0]), a_high = a_low, b_low = dot(d, b[0]), b_high = b_low;
    for (const Vector& x : a) {
      a_low = std::min(a_low, dot(d, x));
      a_high = std::max(a_high, dot(d, x));
    }
    for (const Vector& x : b) {
      b_low = std::min(b_low, dot(d, x));
      b_high = std::max(b_high, dot(d, x));
    }
    if (a_high < b_low || b_high < a_low) return false;
  }
  return true;
}

TEST(FacesMeetingTriangle, AsNaive) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const Scene scene(seed % 3 == 0   ? testing::grid_city(seed, 120)
                      : seed % 3 == 1 ? testing::random_polytopes(seed, 10)
                                      : testing::city(seed, 120));
    const OcclusionIndex index(scene);
    testing::Random random(seed);
    const auto point = [&]() -> Point {
      const auto points = scene.points();
      if (random.one_in(2)) {
        return points[random.integer(0, static_cast<int>(points.size()) - 1)];
      }
      return random_point(random, scene.bounds());
    };
    for (int i = 0; i < 40; ++i) {
      const Point a = point();
      const double size = std::ldexp(1.0, -random.integer(0, 5));
      const Point b = random.one_in(2) ? point() : Point(a + size * (point() - a));
      const Point c = random.one_in(2) ? point() : Point(a + size * (point() - a));
      if ((b - a).cross(c - a).norm() == 0) continue;
      std::vector<int> expected;
      for (const int f : all_faces(scene)) {
        std::vector<Point> corners;
        for (const int p : scene.face_points(f)) corners.push_back(scene.point(p));
        if (naive_meets({a, b, c}, corners)) expected.push_back(f);
      }
      ASSERT_EQ(index.faces_meeting_triangle(a, b, c), expected);
    }
  }
}

TEST(FacesMeetingTriangle, DegenerateTriangles) {
  const Scene scene(room());
  const OcclusionIndex index(scene);
  // A segment, given with its middle anywhere in the order, and a point.
  const Point a(-1, 4, 2), b(4, 4, 2), c(9, 4, 2);
  const std::vector<int> walls = {2, 4};
  EXPECT_EQ(index.faces_meeting_triangle(a, b, c), walls);
  EXPECT_EQ(index.faces_meeting_triangle(b, a, c), walls);
  EXPECT_EQ(index.faces_meeting_triangle(c, a, b), walls);
  EXPECT_EQ(index.faces_meeting_triangle(a, a, c), walls);
  EXPECT_TRUE(index.faces_meeting_triangle(b, b, b).empty());
  const Point d(0, 4, 2), e(0, 0, 0);
  EXPECT_EQ(index.faces_meeting_triangle(d, d, d), (std::vector<int>{4}));
  EXPECT_EQ(index.faces_meeting_triangle(e, e, e), (std::vector<int>{0, 1, 4}));
}

}  // namespace
}  // namespace sightline
