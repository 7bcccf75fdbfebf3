// The predicates against rational arithmetic, stage by stage, on points aimed at trouble.

#include "linespace/predicates.h"

#include <CGAL/Exact_rational.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <thread>
#include <vector>

#include "linespace/numbers/exact_numbers.h"
#include "linespace/numbers/predicates.h"
#include "tests/support/random_geometry.h"

namespace sightline {
namespace {

using Eigen::Vector3d;
using testing::kTerrains;
using testing::RandomGeometry;
using testing::Terrain;
using Rational = CGAL::Exact_rational;
using RationalVector = std::array<Rational, 3>;

// ---- the oracle: the definitions, in rational numbers ---------------------------------

RationalVector minus(const Vector3d& p, const Vector3d& q) {
  return {Rational(p[0]) - Rational(q[0]), Rational(p[1]) - Rational(q[1]),
          Rational(p[2]) - Rational(q[2])};
}

Rational determinant(const RationalVector& u, const RationalVector& v,
                     const RationalVector& w) {
  return u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) +
         u[2] * (v[0] * w[1] - v[1] * w[0]);
}

Sign sign_of(const Rational& x) {
  return x > 0 ? Sign::Positive : x < 0 ? Sign::Negative : Sign::Zero;
}

Rational rational_volume(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                         const Vector3d& d) {
  return determinant(minus(b, a), minus(c, a), minus(d, a));
}

// The parameter at which a plane meets the edge's line, by its definition; nullopt when
// it is parallel.
std::optional<Rational> crossing(const LineThrough& edge, const PlaneThrough& p) {
  const Rational at_from = rational_volume(p.a, p.b, p.c, edge.from);
  const Rational at_to = rational_volume(p.a, p.b, p.c, edge.to);
  if (at_from == at_to) return std::nullopt;
  return Rational(at_from / (at_from - at_to));
}

bool rational_collinear(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const auto u = minus(b, a), v = minus(c, a);
  return u[0] * v[1] == u[1] * v[0] && u[1] * v[2] == u[2] * v[1] &&
         u[2] * v[0] == u[0] * v[2];
}

std::uint64_t total(const StageCounts& c) {
  return c.by_double + c.by_interval + c.by_exact;
}

template <class Check>
void for_each_seed(int seeds, Check&& check) {
  for (const Terrain terrain : kTerrains) {
    for (int seed = 1; seed <= seeds; ++seed) {
      SCOPED_TRACE(::testing::Message()
                   << "terrain " << static_cast<int>(terrain) << ", seed " << seed);
      RandomGeometry random(seed);
      check(random, terrain);
      if (::testing::Test::HasFatalFailure()) return;
    }
  }
}

// ---- orient3d and side ----------------------------------------------------------------

TEST(Orient3d, PositiveWhereTheTriangleIsCounterClockwise) {
  const Vector3d a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_EQ(orient3d(a, b, c, {0.2, 0.3, 1}), Sign::Positive);
  EXPECT_EQ(orient3d(a, b, c, {0.2, 0.3, -1}), Sign::Negative);
  EXPECT_EQ(orient3d(a, b, c, {7, -3, 0}), Sign::Zero);
}

TEST(Side, RightHandRule) {
  const LineThrough x_axis{{0, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(side(x_axis, {{0, 0, 1}, {0, -1, 1}}), Sign::Positive);
  EXPECT_EQ(side(x_axis, {{0, 0, 1}, {0, 1, 1}}), Sign::Negative);
}

TEST(Side, ZeroForMeetingAndParallelLines) {
  const LineThrough l{{0.1, 0.2, 0.3}, {0.4, 0.6, 0.9}};
  EXPECT_EQ(side(l, {l.from, {5, 1, 7}}), Sign::Zero);
  EXPECT_EQ(side(l, {{5, 1, 7}, l.to}), Sign::Zero);
  EXPECT_EQ(side(l, l), Sign::Zero);
  EXPECT_EQ(side({{0, 0, 0}, {1, 2, 3}}, {{4, 0, 0}, {6, 4, 6}}), Sign::Zero);
}

TEST(Side, ObeysItsLaws) {
  for_each_seed(2000, [](RandomGeometry& random, Terrain terrain) {
    const auto p = random.quadruple(terrain);
    const LineThrough l{p[0], p[1]}, m{p[2], p[3]};
    const LineThrough l_reversed{p[1], p[0]}, m_reversed{p[3], p[2]};
    const Sign s = side(l, m);
    ASSERT_EQ(s, orient3d(p[0], p[1], p[2], p[3]));
    ASSERT_EQ(s, side(m, l));
    ASSERT_EQ(s, -side(l_reversed, m));
    ASSERT_EQ(s, side(l_reversed, m_reversed));
  });
}

TEST(Orient3d, FollowsThePermutationOfItsPoints) {
  for_each_seed(300, [](RandomGeometry& random, Terrain terrain) {
    const auto p = random.quadruple(terrain);
    const Sign s = orient3d(p[0], p[1], p[2], p[3]);
    std::array<int, 4> order = {0, 1, 2, 3};
    do {
      int inversions = 0;
      for (int i = 0; i < 4; ++i) {
        for (int j = i + 1; j < 4; ++j) inversions += order[i] > order[j];
      }
      ASSERT_EQ(orient3d(p[order[0]], p[order[1]], p[order[2]], p[order[3]]),
                inversions % 2 == 0 ? s : -s);
    } while (std::next_permutation(order.begin(), order.end()));
  });
}

// A stage that answers must agree with rational arithmetic, and every stage must be
// reached by some input that the ones before it leave open.
TEST(Orient3d, StagesAgreeWithRationalsAndAreAllReached) {
  int by_double = 0, by_integer1 = 0, by_interval = 0, by_integer2 = 0, by_integer6 = 0;
  for_each_seed(3000, [&](RandomGeometry& random, Terrain terrain) {
    const auto [a, b, c, d] = random.quadruple(terrain);
    const Sign exact = sign_of(rational_volume(a, b, c, d));
    const auto first = internal::double_orient3d(a, b, c, d);
    const auto interval = internal::interval_orient3d(a, b, c, d);
    const auto integer1 = internal::integer_orient3d<1>(a, b, c, d);
    const auto integer2 = internal::integer_orient3d<2>(a, b, c, d);
    ASSERT_EQ(first.value_or(exact), exact);
    ASSERT_EQ(interval.value_or(exact), exact);
    ASSERT_EQ(integer1.value_or(exact), exact);
    ASSERT_EQ(integer2.value_or(exact), exact);
    ASSERT_EQ(internal::integer_orient3d<6>(a, b, c, d), exact);
    ASSERT_EQ(orient3d(a, b, c, d), exact);
    ++(first      ? by_double
       : integer1 ? by_integer1
       : interval ? by_interval
       : integer2 ? by_integer2
                  : by_integer6);
  });
  RecordProperty("double", by_double);
  RecordProperty("integer1", by_integer1);
  RecordProperty("interval", by_interval);
  RecordProperty("integer2", by_integer2);
  RecordProperty("integer6", by_integer6);
  EXPECT_GT(by_double, 1000);
  EXPECT_GT(by_integer1, 1000);
  EXPECT_GT(by_interval, 100);
  EXPECT_GT(by_integer2, 100);
  EXPECT_GT(by_integer6, 100);
}

TEST(Orient3d, ValueIsWithinItsBound) {
  for_each_seed(2000, [](RandomGeometry& random, Terrain terrain) {
    const auto [a, b, c, d] = random.quadruple(terrain);
    const Rational exact = rational_volume(a, b, c, d);
    const BoundedValue v = orient3d_value(a, b, c, d);
    ASSERT_TRUE(CGAL::abs(Rational(exact - Rational(v.value))) <= Rational(v.error));
    if (v.error == 0) {
      ASSERT_EQ(v.value, 0);
    }
    const BoundedValue w = PlaneSide({a, b, c}).value(d);
    ASSERT_TRUE(CGAL::abs(Rational(exact - Rational(w.value))) <= Rational(w.error));
  });
}

// The bound must be about as tight as it says: values that are off by more than a
// thousandth of it do occur, so that a bound of another order would show.
TEST(Orient3d, BoundIsNotFarFromWhatHappens) {
  double worst = 0;
  for (int seed = 1; seed <= 3000; ++seed) {
    RandomGeometry random(seed);
    const auto [a, b, c, d] = random.quadruple(Terrain::Uniform);
    const BoundedValue v = orient3d_value(a, b, c, d);
    if (v.error == 0) continue;
    const Rational off = rational_volume(a, b, c, d) - Rational(v.value);
    worst = std::max(worst, std::abs(CGAL::to_double(off)) / v.error);
  }
  EXPECT_LE(worst, 1);
  EXPECT_GT(worst, 0.05);
}

TEST(Orient3d, AxisAlignedCoplanarityCostsNoExactStage) {
  const StageCounts before = thread_stage_counts();
  RandomGeometry random(5);
  for (int i = 0; i < 100; ++i) {
    std::array<Vector3d, 4> p;
    for (auto& x : p) x = random.point(Terrain::Uniform);
    for (auto& x : p) x[i % 3] = p[0][i % 3];
    ASSERT_EQ(orient3d(p[0], p[1], p[2], p[3]), Sign::Zero);
    ASSERT_EQ(PlaneSide({p[0], p[1], p[2]})(p[3]), Sign::Zero);
  }
  const StageCounts after = thread_stage_counts();
  EXPECT_EQ(after.by_double - before.by_double, 200u);
  EXPECT_EQ(total(after) - total(before), 200u);
}

// The smallest and the largest differences that admissible coordinates can have.
TEST(Orient3d, DecidesAtTheEndsOfTheRange) {
  const double tiny = kSmallestCoordinate;
  const double next = std::nextafter(tiny, 1);
  EXPECT_EQ(orient3d({tiny, tiny, tiny}, {next, tiny, tiny}, {tiny, next, tiny},
                     {tiny, tiny, next}),
            Sign::Positive);
  const double huge = kLargestCoordinate;
  EXPECT_EQ(orient3d({-huge, -huge, -huge}, {huge, -huge, -huge}, {-huge, huge, -huge},
                     {-huge, -huge, huge}),
            Sign::Positive);
  // Coplanar but for one ulp of 2^-140, 280 binary orders below the other coordinates.
  EXPECT_EQ(orient3d({0, 0, tiny}, {huge, 0, tiny}, {0, huge, tiny}, {huge, huge, next}),
            Sign::Positive);
  EXPECT_EQ(orient3d({0, 0, tiny}, {huge, 0, next}, {0, huge, next}, {-huge, 0, tiny}),
            Sign::Positive);
  EXPECT_EQ(
      orient3d({0, 0, 0}, {huge, tiny, 0}, {tiny, huge, tiny}, {huge + tiny, tiny, tiny}),
      Sign::Positive);
}

TEST(Admissible, IsZeroOrTheStatedRange) {
  EXPECT_TRUE(is_admissible(0.0));
  EXPECT_TRUE(is_admissible(-0.0));
  EXPECT_TRUE(is_admissible(-0x1p-140));
  EXPECT_TRUE(is_admissible(0x1p140));
  EXPECT_FALSE(is_admissible(std::nextafter(0x1p-140, 0)));
  EXPECT_FALSE(is_admissible(std::nextafter(-0x1p140, -INFINITY)));
  EXPECT_FALSE(is_admissible(INFINITY));
  EXPECT_FALSE(is_admissible(NAN));
}

// ---- one plane, many points -----------------------------------------------------------

TEST(PlaneSide, EqualsOrient3dAndTriageNeverErrs) {
  for_each_seed(2000, [](RandomGeometry& random, Terrain terrain) {
    const auto [a, b, c, d] = random.quadruple(terrain);
    const PlaneSide on({a, b, c});
    const Sign exact = sign_of(rational_volume(a, b, c, d));
    ASSERT_EQ(on(d), exact);
    ASSERT_EQ(on.triage(d).value_or(exact), exact);
    ASSERT_EQ(on(a), Sign::Zero);
    ASSERT_EQ(on(b), Sign::Zero);
    ASSERT_EQ(on(c), Sign::Zero);
  });
}

TEST(Orient3dBatch, EqualsTheSinglePredicateAndCountsEveryPoint) {
  for_each_seed(60, [](RandomGeometry& random, Terrain terrain) {
    const PlaneThrough plane{random.point(terrain), random.point(terrain),
                             random.point(terrain)};
    const int n = random.integer(0, 70);
    std::array<std::vector<double>, 3> x;
    std::vector<Vector3d> points;
    for (int i = 0; i < n; ++i) {
      points.push_back(random.one_in(3) ? random.near_plane(plane.a, plane.b, plane.c)
                                        : random.point(terrain));
      for (int k = 0; k < 3; ++k) x[k].push_back(points[i][k]);
    }
    std::vector<Sign> signs(n);
    const StageCounts before = thread_stage_counts();
    orient3d_batch(plane, x[0], x[1], x[2], signs);
    ASSERT_EQ(total(thread_stage_counts()) - total(before), static_cast<unsigned>(n));
    for (int i = 0; i < n; ++i)
      ASSERT_EQ(signs[i], orient3d(plane.a, plane.b, plane.c, points[i])) << i;
  });
}

// ---- compare_crossings ----------------------------------------------------------------

TEST(CompareCrossings, OrdersAlongTheEdge) {
  const LineThrough edge{{0, 0, 0}, {1, 0, 0}};
  const auto at = [](double x) { return PlaneThrough{{x, 0, 0}, {x, 1, 0}, {x, 0, 1}}; };
  EXPECT_EQ(compare_crossings(edge, at(0.25), at(0.5)), Sign::Negative);
  EXPECT_EQ(compare_crossings(edge, at(0.5), at(0.25)), Sign::Positive);
  EXPECT_EQ(compare_crossings(edge, at(-3), at(5)), Sign::Negative);
  EXPECT_EQ(compare_crossings(edge, at(0.3), at(0.3)), Sign::Zero);
}

struct Crossings {
  LineThrough edge;
  PlaneThrough p, q;
};

// Two planes that cross an edge: anywhere; in one point up to rounding; or in one point
// of the edge exactly, which the planes reach by different points.
std::optional<Crossings> random_crossings(RandomGeometry& random, Terrain terrain) {
  const auto point = [&] { return random.point(terrain); };
  Crossings x{
      {point(), point()}, {point(), point(), point()}, {point(), point(), point()}};
  switch (random.integer(0, 3)) {
    case 0:
      x.p.a = random.near_line(x.edge.from, x.edge.to);
      x.q.b = random.one_in(2) ? x.p.a : random.nudged(x.p.a);
      break;
    case 1:  // the common point is an end of the edge
      x.p.b = random.one_in(2) ? x.edge.from : x.edge.to;
      x.q.c = x.p.b;
      break;
    case 2:  // the same plane by other points of it, up to rounding
      x.q = {random.near_plane(x.p.a, x.p.b, x.p.c),
             random.near_plane(x.p.a, x.p.b, x.p.c), x.p.c};
      break;
    default:
      break;
  }
  if (!crossing(x.edge, x.p) || !crossing(x.edge, x.q)) return std::nullopt;
  return x;
}

TEST(CompareCrossings, StagesAgreeWithRationalsAndAreAllReached) {
  int by_double = 0, by_integer1 = 0, by_interval = 0, by_integer2 = 0, by_integer6 = 0;
  int ties = 0;
  for_each_seed(1500, [&](RandomGeometry& random, Terrain terrain) {
    const auto input = random_crossings(random, terrain);
    if (!input) return;
    const auto& [edge, p, q] = *input;
    const Sign exact = sign_of(*crossing(edge, p) - *crossing(edge, q));
    const auto first = internal::double_compare_crossings(edge, p, q);
    const auto interval = internal::interval_compare_crossings(edge, p, q);
    const auto integer1 = internal::integer_compare_crossings<1>(edge, p, q);
    const auto integer2 = internal::integer_compare_crossings<2>(edge, p, q);
    ASSERT_EQ(first.value_or(exact), exact);
    ASSERT_EQ(interval.value_or(exact), exact);
    ASSERT_EQ(integer1.value_or(exact), exact);
    ASSERT_EQ(integer2.value_or(exact), exact);
    ASSERT_EQ(internal::integer_compare_crossings<6>(edge, p, q), exact);
    ASSERT_EQ(compare_crossings(edge, p, q), exact);
    ties += exact == Sign::Zero;
    ++(first      ? by_double
       : integer1 ? by_integer1
       : interval ? by_interval
       : integer2 ? by_integer2
                  : by_integer6);
  });
  RecordProperty("ties", ties);
  EXPECT_GT(ties, 1000);
  EXPECT_GT(by_double, 1000);
  EXPECT_GT(by_integer1, 100);
  EXPECT_GT(by_interval, 100);
  EXPECT_GT(by_integer2, 100);
  EXPECT_GT(by_integer6, 100);
}

TEST(CompareCrossings, ObeysItsLaws) {
  for_each_seed(500, [](RandomGeometry& random, Terrain terrain) {
    const auto input = random_crossings(random, terrain);
    if (!input) return;
    const auto& [edge, p, q] = *input;
    const Sign s = compare_crossings(edge, p, q);
    ASSERT_EQ(compare_crossings(edge, q, p), -s);
    ASSERT_EQ(compare_crossings({edge.to, edge.from}, p, q), -s);
    ASSERT_EQ(compare_crossings(edge, {p.b, p.a, p.c}, q), s);
    ASSERT_EQ(compare_crossings(edge, p, {q.c, q.b, q.a}), s);
    ASSERT_EQ(compare_crossings(edge, p, {p.b, p.c, p.a}), Sign::Zero);
  });
}

// ---- collinear ------------------------------------------------------------------------

TEST(Collinear, AgreesWithRationalsInEveryStage) {
  int collinear_ones = 0, by_integer6 = 0;
  for_each_seed(2000, [&](RandomGeometry& random, Terrain terrain) {
    const Vector3d a = random.point(terrain), b = random.point(terrain);
    const Vector3d c = random.one_in(3)   ? random.point(terrain)
                       : random.one_in(8) ? a
                                          : random.near_line(a, b);
    const bool exact = rational_collinear(a, b, c);
    ASSERT_EQ(internal::double_collinear(a, b, c).value_or(exact), exact);
    ASSERT_EQ(internal::interval_collinear(a, b, c).value_or(exact), exact);
    ASSERT_EQ(internal::integer_collinear<1>(a, b, c).value_or(exact), exact);
    ASSERT_EQ(internal::integer_collinear<2>(a, b, c).value_or(exact), exact);
    ASSERT_EQ(internal::integer_collinear<6>(a, b, c), exact);
    ASSERT_EQ(collinear(a, b, c), exact);
    ASSERT_EQ(collinear(c, a, b), exact);
    collinear_ones += exact;
    by_integer6 += !internal::double_collinear(a, b, c) &&
                   !internal::interval_collinear(a, b, c) &&
                   !internal::integer_collinear<2>(a, b, c);
  });
  EXPECT_GT(collinear_ones, 500);
  EXPECT_GT(by_integer6, 10);
}

// ---- precision, counts ----------------------------------------------------------------

TEST(PrecisionScope, DoubleTakesTheFirstStageAsItIs) {
  int differ = 0;
  for_each_seed(500, [&](RandomGeometry& random, Terrain terrain) {
    const auto [a, b, c, d] = random.quadruple(terrain);
    const Sign exact = orient3d(a, b, c, d);
    const StageCounts before = thread_stage_counts();
    {
      const PrecisionScope scope(Precision::Double);
      const Sign s = orient3d(a, b, c, d);
      ASSERT_EQ(s, internal::sign_of(orient3d_value(a, b, c, d).value));
      const PlaneSide on({a, b, c});
      ASSERT_EQ(on(d), internal::sign_of(on.value(d).value));
      (void)compare_crossings({a, b}, {c, d, b}, {a, d, c});
      (void)collinear(a, b, c);
      differ += s != exact;
    }
    const StageCounts after = thread_stage_counts();
    ASSERT_EQ(after.by_double - before.by_double, 4u);
    ASSERT_EQ(total(after) - total(before), 4u);
    ASSERT_EQ(orient3d(a, b, c, d), exact);
  });
  EXPECT_GT(differ, 50) << "the inputs are too easy to tell Double from Exact";
}

TEST(PrecisionScope, NestsAndIsOfItsThread) {
  const Vector3d a(0, 0, 0), b(0.1, 0.1, 0.3), c(0.2, 0.2, 0.6), d(0.7, 0.3, 0.1);
  const PrecisionScope outer(Precision::Double);
  {
    const PrecisionScope inner(Precision::Exact);
    const auto exact_before = thread_stage_counts().by_exact;
    EXPECT_EQ(orient3d(a, b, c, d), Sign::Zero);
    EXPECT_EQ(thread_stage_counts().by_exact, exact_before + 1);
  }
  std::thread([&] {
    EXPECT_EQ(thread_stage_counts(), StageCounts{});
    EXPECT_EQ(orient3d(a, b, c, d), Sign::Zero);
    EXPECT_EQ(thread_stage_counts().by_exact, 1u);
  }).join();
  const auto exact_before = thread_stage_counts().by_exact;
  (void)orient3d(a, b, c, d);
  EXPECT_EQ(thread_stage_counts().by_exact, exact_before);
}

TEST(StageCounts, NameTheStageThatDecided) {
  for_each_seed(1000, [](RandomGeometry& random, Terrain terrain) {
    const auto [a, b, c, d] = random.quadruple(terrain);
    StageCounts expected = thread_stage_counts();
    if (internal::double_orient3d(a, b, c, d)) {
      ++expected.by_double;
    } else if (!internal::integer_orient3d<1>(a, b, c, d) &&
               internal::interval_orient3d(a, b, c, d)) {
      ++expected.by_interval;
    } else {
      ++expected.by_exact;
    }
    (void)orient3d(a, b, c, d);
    ASSERT_EQ(thread_stage_counts(), expected);
  });
}

// ---- the number types -----------------------------------------------------------------

template <int N>
Rational value_of(const internal::FixedInt<N>& x) {
  Rational sum = 0;
  for (int i = N; i-- > 0;) {
    sum = sum * Rational(0x1p32) + Rational(static_cast<double>(x.limbs[i] >> 32));
    sum = sum * Rational(0x1p32) + Rational(static_cast<double>(x.limbs[i] & 0xffffffff));
  }
  if (x.negative()) sum = sum - Rational(std::ldexp(1.0, 64 * N));
  return sum;
}

// Limbs that are often all zeros or all ones, where carries run furthest.
template <int N>
internal::FixedInt<N> random_int(RandomGeometry& random) {
  internal::FixedInt<N> x;
  for (auto& limb : x.limbs) {
    const int kind = random.integer(0, 3);
    limb = kind == 0 ? 0 : kind == 1 ? ~std::uint64_t{0} : random.bits();
  }
  return x;
}

template <int N, int M>
void check_integers(RandomGeometry& random) {
  const auto a = random_int<N>(random);
  const auto b = random_int<M>(random);
  ASSERT_TRUE(value_of(a * b) == value_of(a) * value_of(b));
  ASSERT_EQ(internal::sign_of(a), sign_of(value_of(a)));
  // Halved so that the sum fits.
  auto x = a, y = random_int<N>(random);
  for (auto* z : {&x, &y}) {
    z->limbs[N - 1] =
        static_cast<std::uint64_t>(static_cast<std::int64_t>(z->limbs[N - 1]) >> 1);
  }
  ASSERT_TRUE(value_of(x + y) == value_of(x) + value_of(y));
  ASSERT_TRUE(value_of(x - y) == value_of(x) - value_of(y));
}

TEST(FixedInt, ComputesLikeIntegers) {
  for (int seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE(seed);
    RandomGeometry random(seed);
    check_integers<1, 1>(random);
    check_integers<1, 2>(random);
    check_integers<2, 2>(random);
    check_integers<3, 3>(random);
    check_integers<2, 4>(random);
    check_integers<6, 6>(random);
    if (HasFatalFailure()) return;
  }
}

TEST(BallNumber, ContainsTheExactValue) {
  for_each_seed(1000, [](RandomGeometry& random, Terrain terrain) {
    std::array<internal::BallNumber, 3> ball;
    RationalVector exact;
    for (int i = 0; i < 3; ++i) {
      const double p = random.coordinate(terrain), q = random.coordinate(terrain);
      ball[i] = internal::exact_difference(p, q);
      exact[i] = Rational(p) - Rational(q);
    }
    const auto check = [](const internal::BallNumber& x, const Rational& value) {
      const Rational off = value - Rational(x.hi) - Rational(x.lo);
      return CGAL::abs(off) <= Rational(x.radius);
    };
    const auto sum = ball[0] + ball[1];
    const auto product = ball[0] * ball[1];
    const auto both = product * ball[2] - sum * (ball[0] - ball[2]);
    ASSERT_TRUE(check(ball[0], exact[0]));
    ASSERT_TRUE(check(sum, Rational(exact[0] + exact[1])));
    ASSERT_TRUE(check(product, Rational(exact[0] * exact[1])));
    const Rational all =
        exact[0] * exact[1] * exact[2] - (exact[0] + exact[1]) * (exact[0] - exact[2]);
    ASSERT_TRUE(check(both, all));
    ASSERT_TRUE(check(both * both, Rational(all * all)));
  });
}

}  // namespace
}  // namespace sightline
