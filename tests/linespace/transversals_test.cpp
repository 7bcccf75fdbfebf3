// Lines that meet four lines: classes by hand and against the Gram determinant in
// rationals, invariances, and the predicates on the lines found.

#include "linespace/transversals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <vector>

#include "linespace/lines/transversals.h"
#include "linespace/numbers/rational.h"
#include "tests/support/random_geometry.h"

namespace sightline {
namespace {

using Eigen::Vector3d;
using internal::Rational;
using testing::RandomGeometry;
using testing::Terrain;
using Four = std::array<LineThrough, 4>;

TransversalClass class_of(const Four& l) {
  return transversal_class(l[0], l[1], l[2], l[3]);
}
LineTransversals transversals_of(const Four& l) {
  return transversals(l[0], l[1], l[2], l[3]);
}

// A Gray code of sorts: all orders of the four, each with some lines turned round.
template <class F>
void for_each_order(Four l, F f) {
  std::array<int, 4> order{0, 1, 2, 3};
  unsigned turn = 0;
  do {
    Four m;
    for (int i = 0; i < 4; ++i) {
      m[i] = l[order[i]];
      if ((turn >> i & 1) != 0) std::swap(m[i].from, m[i].to);
    }
    f(m);
    ++turn;
  } while (std::ranges::next_permutation(order).found);
}

LineThrough mapped(const LineThrough& l, const auto& f) { return {f(l.from), f(l.to)}; }

// ---- classes by hand ------------------------------------------------------------------

struct Case {
  const char* name;
  Four lines;
  TransversalClass expected;
};

const std::vector<Case>& cases() {
  using enum TransversalClass;
  const LineThrough x{{0, 0, 0}, {1, 0, 0}}, y{{0, 0, 0}, {0, 1, 0}},
      z{{0, 0, 0}, {0, 0, 1}};
  const LineThrough diagonal{{-1, -1, -1}, {2, 2, 2}};
  const LineThrough y1{{0, 0, 1}, {0, 1, 1}};      // skew to x
  const LineThrough across{{0, 5, 0}, {1, 5, 0}};  // parallel to x
  // Rulings of z = x y: x = c, z = c y.
  const auto ruling = [](double c) { return LineThrough{{c, 0, 0}, {c, 1, c}}; };
  static const std::vector<Case> all{
      {"two pairs that meet",
       {x, y, {{0, 0, 5}, {1, 1, 5}}, {{2, 0, 5}, {2, 1, 7}}},
       Two},
      // (s, s, -1) would be on the rulings' surface where s^2 = -1.
      {"no real line", {ruling(0), ruling(1), ruling(2), {{0, 0, -1}, {1, 1, -1}}}, None},
      {"parallel to a plane",
       {x, y1, {{1, 1, 2}, {2, 2, 2}}, {{1, 2, 3}, {2, 0, 3}}},
       OneOtherAtInfinity},
      {"four rulings", {ruling(0), ruling(1), ruling(2), ruling(5)}, Regulus},
      {"three skew lines, one twice",
       {ruling(0), ruling(1), ruling(2), ruling(1)},
       Regulus},
      {"a tangent to a regulus",
       // At (3, 0, 0) the surface's tangent plane is z = 3 y: a line in it, through that
       // point, that is no ruling.
       {ruling(0), ruling(1), ruling(2), {{3, 0, 0}, {4, 1, 3}}},
       Double},
      {"three coplanar, one crossing",
       {x, y, {{1, 0, 0}, {0, 1, 0}}, {{5, 5, -1}, {5, 6, 1}}},
       Pencil},
      {"three concurrent, one skew to all", {x, y, z, {{1, 2, 3}, {2, 5, 3}}}, Pencil},
      {"two meet, one skew twice",
       {x, y, {{1, 2, 3}, {2, 5, 4}}, {{0, -1, 2}, {3, 8, 5}}},
       TwoPencils},
      {"x, y1 and z that meets both", {x, y1, z, {{0, 0, 7}, {0, 0, 5}}}, TwoPencils},
      {"concurrent", {x, y, z, diagonal}, ThroughPoint},
      {"parallel",
       {z, {{1, 0, 0}, {1, 0, 1}}, {{0, 1, 0}, {0, 1, 1}}, {{5, 6, 0}, {5, 6, 1}}},
       ThroughPoint},
      {"coplanar", {x, y, across, {{1, 0, 0}, {0, 1, 0}}}, InPlane},
      {"one pencil",
       {x, y, {{0, 0, 0}, {1, 1, 0}}, {{0, 0, 0}, {1, 2, 0}}},
       ThroughPointAndInPlane},
      {"two that meet, twice each",
       {x, y, x, {{0, 2, 0}, {0, 3, 0}}},
       ThroughPointAndInPlane},
      {"parallel in a plane",
       {x, across, {{0, 1, 0}, {1, 1, 0}}, {{0, 2, 0}, {3, 2, 0}}},
       ThroughPointAndInPlane},
      {"two skew, twice each", {x, y1, {{7, 0, 0}, {9, 0, 0}}, y1}, MeetingTwoLines},
      {"two skew, three and one", {x, y1, x, x}, MeetingTwoLines},
      {"one line", {x, x, {{2, 0, 0}, {1, 0, 0}}, x}, MeetingOneLine},
  };
  return all;
}

TEST(TransversalClasses, ByHandInEveryOrder) {
  for (const Case& c : cases()) {
    for_each_order(c.lines, [&](const Four& l) {
      EXPECT_EQ(class_of(l), c.expected) << c.name;
      const LineTransversals t = transversals_of(l);
      EXPECT_EQ(t.kind, c.expected) << c.name;
      EXPECT_EQ(static_cast<int>(t.lines.size()), isolated_lines(c.expected)) << c.name;
    });
  }
}

TEST(TransversalClasses, EachHasACase) {
  std::set<TransversalClass> seen;
  for (const Case& c : cases()) seen.insert(c.expected);
  // A double line at infinity is the one left, below.
  EXPECT_EQ(seen.size(), 12U);
}

TEST(TransversalClasses, DoubleAtInfinity) {
  // In the planes z = h with directions (1, h), of the paraboloid y = x z: three through
  // the z axis are rulings of it, whose other rulings x = const, among them the line at
  // infinity of z = const, meet them.  The fourth, moved off in its plane, meets the
  // paraboloid at infinity only, and twice.
  const auto at = [](double h, double dx, double dy, double x, double y) {
    return LineThrough{{x, y, h}, {x + dx, y + dy, h}};
  };
  const Four l{at(0, 1, 0, 0, 0), at(1, 1, 1, 0, 0), at(2, 1, 2, 0, 0),
               at(3, 1, 3, 1, 0)};
  for_each_order(l, [&](const Four& m) {
    EXPECT_EQ(class_of(m), TransversalClass::DoubleAtInfinity);
    EXPECT_TRUE(transversals_of(m).lines.empty());
  });
}

// ---- against rationals
// ------------------------------------------------------------------

Rational exact_side(const LineThrough& l, const LineThrough& m) {
  using internal::exact_point;
  const auto a = exact_point(l.from), b = exact_point(l.to), c = exact_point(m.from),
             d = exact_point(m.to);
  std::array<Rational, 3> u, v, w;
  for (int i = 0; i < 3; ++i) {
    u[i] = b[i] - a[i];
    v[i] = c[i] - a[i];
    w[i] = d[i] - a[i];
  }
  return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
         u[2] * (v[0] * w[1] - v[1] * w[0]);
}

int discriminant_sign(const Four& l) {
  const Rational a = exact_side(l[0], l[1]) * exact_side(l[2], l[3]);
  const Rational b = exact_side(l[0], l[2]) * exact_side(l[1], l[3]);
  const Rational c = exact_side(l[0], l[3]) * exact_side(l[1], l[2]);
  const Rational d = a * a + b * b + c * c - 2 * (a * b + a * c + b * c);
  return d.sign();
}

int sign_of_class(TransversalClass c) {
  if (c == TransversalClass::None) return -1;
  return c == TransversalClass::Two || c == TransversalClass::OneOtherAtInfinity ? 1 : 0;
}

LineThrough random_line(RandomGeometry& random, Terrain terrain) {
  for (;;) {
    const LineThrough l{random.point(terrain), random.point(terrain)};
    if (l.from != l.to) return l;
  }
}

// Four lines: general; meeting a common line up to rounding (Two, nearly); with the
// fourth rounded into the tangent plane of the regulus of three (near Double); with
// shared points and repeats.
Four random_four(RandomGeometry& random, Terrain terrain) {
  Four l;
  for (LineThrough& x : l) x = random_line(random, terrain);
  switch (random.integer(0, 4)) {
    case 0: {
      const LineThrough t = random_line(random, terrain);
      for (LineThrough& x : l) x.from = random.near_line(t.from, t.to);
      break;
    }
    case 1: {
      const LineTransversals t = transversals(l[0], l[1], l[2], l[0]);
      // A line of the regulus through l[0].from, and the tangent plane there.
      const auto r = ExactLine::through(l[0].from, l[1], l[2]);
      if (!r || t.kind != TransversalClass::Regulus) break;
      const Vector3d d = r->direction().point;
      const Vector3d e = l[0].to - l[0].from;
      l[3].from = l[0].from;
      l[3].to = l[0].from + random.uniform(0.5, 2) * e + random.uniform(0.5, 2) * d;
      break;
    }
    case 2:
      l[random.integer(0, 1)].from = l[random.integer(2, 3)].to;
      break;
    case 3:
      l[random.integer(0, 1)] = l[random.integer(2, 3)];
      break;
    default:
      break;
  }
  for (LineThrough& x : l) {
    for (double& c : x.from) c = is_admissible(c) ? c : 0;
    for (double& c : x.to) c = is_admissible(c) ? c : 0;
    if (x.from == x.to) x = {{0, 0, 1}, {1, 0, 2}};
  }
  return l;
}

TEST(TransversalClasses, AgreeWithTheGramDeterminantInRationals) {
  std::array<int, 3> seen{};
  for (const Terrain terrain : testing::kTerrains) {
    RandomGeometry random(11);
    for (int i = 0; i < 2000; ++i) {
      const Four l = random_four(random, terrain);
      const int expected = discriminant_sign(l);
      ++seen[expected + 1];
      ASSERT_EQ(sign_of_class(class_of(l)), expected);
    }
  }
  for (const int n : seen) EXPECT_GT(n, 200);
}

TEST(TransversalClasses, EveryStageIsRightOrUndecidedAndReached) {
  using Stage =
      std::optional<TransversalClass> (*)(const std::array<const LineThrough*, 4>&);
  const std::array<Stage, 3> stages{internal::double_transversal_class,
                                    internal::interval_transversal_class,
                                    internal::integer_transversal_class};
  std::array<int, 3> decided{}, undecided{};
  const StageCounts before = thread_stage_counts();
  for (const Terrain terrain : testing::kTerrains) {
    RandomGeometry random(17);
    for (int i = 0; i < 2000; ++i) {
      const Four l = random_four(random, terrain);
      const std::array<const LineThrough*, 4> p{&l[0], &l[1], &l[2], &l[3]};
      const TransversalClass exact = internal::exact_transversal_class(p);
      ASSERT_EQ(class_of(l), exact);
      for (int s = 0; s < 3; ++s) {
        const auto c = stages[s](p);
        ++(c ? decided : undecided)[s];
        if (c) {
          ASSERT_EQ(*c, exact) << s;
        }
      }
    }
  }
  for (int s = 0; s < 3; ++s) {
    EXPECT_GT(decided[s], 1000) << s;
    EXPECT_GT(undecided[s], 100) << s;
  }
  const StageCounts after = thread_stage_counts();
  EXPECT_GT(after.by_double, before.by_double + 1000);
  EXPECT_GT(after.by_interval, before.by_interval + 100);
  EXPECT_GT(after.by_exact, before.by_exact + 1000);
}

TEST(TransversalClasses, DoublePrecisionTakesTheFirstStagesSign) {
  const auto ruling = [](double c) { return LineThrough{{c, 0, 0}, {c, 1, c}}; };
  const PrecisionScope precision(Precision::Double);
  EXPECT_EQ(transversal_class(ruling(0), ruling(1), ruling(2), {{3, 0, 0}, {4, 1, 3}}),
            TransversalClass::Double);
}

TEST(TransversalClasses, DoNotDependOnOrderOrientationAxesOrScale) {
  for (const Terrain terrain : {Terrain::Uniform, Terrain::Grid, Terrain::Tenths}) {
    RandomGeometry random(12);
    for (int i = 0; i < 300; ++i) {
      const Four l = random_four(random, terrain);
      const TransversalClass expected = class_of(l);
      for_each_order(l, [&](const Four& m) { ASSERT_EQ(class_of(m), expected); });
      const auto expect_same = [&](const auto& f) {
        Four m;
        for (int k = 0; k < 4; ++k) m[k] = mapped(l[k], f);
        ASSERT_EQ(class_of(m), expected);
      };
      expect_same([](const Vector3d& p) { return Vector3d(p.y(), p.z(), p.x()); });
      expect_same([](const Vector3d& p) { return Vector3d(p.y(), p.x(), p.z()); });
      expect_same([](const Vector3d& p) { return Vector3d(-p.x(), p.y(), p.z()); });
      expect_same([](const Vector3d& p) { return Vector3d(p * 0x1p-40); });
      expect_same([](const Vector3d& p) { return Vector3d(p * 0x1p30); });
    }
  }
}

// ---- the lines
// --------------------------------------------------------------------------

TEST(ExactLine, MeetsItsFourGenerators) {
  int found = 0;
  for (const Terrain terrain : testing::kTerrains) {
    RandomGeometry random(13);
    for (int i = 0; i < 300; ++i) {
      const Four l = random_four(random, terrain);
      const LineTransversals t = transversals_of(l);
      for (const ExactLine& line : t.lines) {
        ++found;
        for (const LineThrough& m : l) ASSERT_EQ(line.side(m), Sign::Zero);
        const LineThrough fifth = random_line(random, terrain);
        ASSERT_EQ(line.side(fifth), -line.reversed().side(fifth));
      }
      if (t.lines.size() == 2) {
        ASSERT_FALSE(same_line(t.lines[0], t.lines[1]));
      }
    }
  }
  EXPECT_GT(found, 1000);
}

TEST(ExactLine, IsTheSameFromAnyOrderOfItsGenerators) {
  for (const Terrain terrain : {Terrain::Uniform, Terrain::Grid}) {
    RandomGeometry random(14);
    for (int i = 0; i < 60; ++i) {
      const Four l = random_four(random, terrain);
      const LineTransversals t = transversals_of(l);
      for_each_order(l, [&](const Four& m) {
        const LineTransversals other = transversals_of(m);
        ASSERT_EQ(other.lines.size(), t.lines.size());
        for (const ExactLine& line : t.lines) {
          ASSERT_EQ(
              std::ranges::count_if(
                  other.lines, [&](const ExactLine& o) { return same_line(line, o); }),
              1);
        }
      });
    }
  }
}

// The two rulings through lines x = +-1 of the hyperboloid x^2 + y^2 - z^2 = 1 and so on:
// lines with sqrt(2) in them.
TEST(ExactLine, KnowsIrrationalLines) {
  // Lines (c, t, c t): c = 0, 1, 2 are rulings of z = x y, the others x = s, y = t with
  // z = s t are met along y = const.  A fourth line meets z = x y at two points.
  const auto ruling = [](double c) { return LineThrough{{c, 0, 0}, {c, 1, c}}; };
  // (s, s, 2): on the surface where s^2 = 2.
  const LineThrough fourth{{0, 0, 2}, {1, 1, 2}};
  const LineTransversals t = transversals(ruling(0), ruling(1), ruling(3), fourth);
  ASSERT_EQ(t.kind, TransversalClass::Two);
  for (const ExactLine& line : t.lines) {
    EXPECT_FALSE(line.is_rational());
    const Vector3d p = line.contact(fourth).point;
    EXPECT_NEAR(std::abs(p.x()), std::sqrt(2.0), 1e-15);
    EXPECT_EQ(p.z(), 2);
    const double s = p.x() > 0 ? 1 : -1;
    EXPECT_NEAR(line.contact(ruling(0)).point.y(), s * std::sqrt(2.0), 1e-15);
    EXPECT_EQ(line.meets({{0, 0, 0}, {0, s * 2, 0}}), SegmentContact::Interior);
    EXPECT_EQ(line.meets({{0, 0, 0}, {0, s, 0}}), SegmentContact::None);
    EXPECT_EQ(line.meets({{0, 1, 0}, {0, 1.5, 0}}),
              s > 0 ? SegmentContact::Interior : SegmentContact::None);
    // sqrt(2) lies between these neighbours.
    const double below = 1.4142135623730949, above = 1.4142135623730951;
    EXPECT_EQ(line.meets({{0, s * below, 0}, {0, s * above, 0}}),
              SegmentContact::Interior);
    EXPECT_EQ(compare_along(ruling(0), line, Vector3d(0, s * below, 0)),
              s > 0 ? Sign::Positive : Sign::Negative);
    // Along x, which is how it is oriented.
    EXPECT_EQ(line.direction_signs()[0], Sign::Positive);
    EXPECT_EQ(line.contact_order(ruling(0), ruling(1)), Sign::Negative);
    EXPECT_EQ(line.contact_order(ruling(3), ruling(1)), Sign::Positive);
    EXPECT_EQ(line.contact_order(ruling(3), fourth), Sign::Positive);
    EXPECT_EQ(line.reversed().contact_order(ruling(3), fourth), Sign::Negative);
  }
  EXPECT_NE(compare_along(ruling(0), t.lines[0], t.lines[1]), Sign::Zero);
  EXPECT_EQ(compare_along(ruling(0), t.lines[0], t.lines[1]),
            -compare_along(ruling(0), t.lines[1], t.lines[0]));
  EXPECT_EQ(compare_along(ruling(0), t.lines[0], t.lines[0]), Sign::Zero);
}

TEST(ExactLine, PredicatesAgreeWithRoundedContacts) {
  RandomGeometry random(15);
  int compared = 0;
  for (int i = 0; i < 400; ++i) {
    Four l;
    for (LineThrough& x : l) x = random_line(random, Terrain::Uniform);
    const LineTransversals t = transversals_of(l);
    Four other = l;
    other[2] = random_line(random, Terrain::Uniform);
    const LineTransversals u = transversals_of(other);
    for (const ExactLine& line : t.lines) {
      const Vector3d d = line.direction().point;
      for (int a = 0; a < 4; ++a) {
        const Vector3d p = line.contact(l[a]).point;
        // On the edge at parameter w: inside iff 0 < w < 1.
        const Vector3d e = l[a].to - l[a].from;
        const double w = (p - l[a].from).dot(e) / e.squaredNorm();
        if (std::min(std::abs(w), std::abs(w - 1)) > 1e-9) {
          ASSERT_EQ(line.meets(l[a]),
                    w > 0 && w < 1 ? SegmentContact::Interior : SegmentContact::None);
        }
        for (int b = 0; b < a; ++b) {
          const double ahead = (p - line.contact(l[b]).point).dot(d);
          if (std::abs(ahead) < 1e-9) continue;
          ++compared;
          ASSERT_EQ(line.contact_order(l[a], l[b]),
                    ahead > 0 ? Sign::Positive : Sign::Negative);
        }
        if (a == 2) continue;
        for (const ExactLine& second : u.lines) {
          const double s = (second.contact(l[a]).point - l[a].from).dot(e);
          const double difference = w * e.squaredNorm() - s;
          if (std::abs(difference) < 1e-9) continue;
          ASSERT_EQ(compare_along(l[a], line, second),
                    difference > 0 ? Sign::Positive : Sign::Negative);
        }
      }
      // A fifth line: side() as orient3d of rounded points, where that is clear.
      const LineThrough fifth = random_line(random, Terrain::Uniform);
      const Vector3d p = line.nearest({0, 0, 0}).point;
      const auto v = orient3d_value(p, p + d, fifth.from, fifth.to);
      if (std::abs(v.value) > 1e-9 * (1 + p.norm())) {
        ASSERT_EQ(line.side(fifth), v.value > 0 ? Sign::Positive : Sign::Negative);
      }
    }
  }
  EXPECT_GT(compared, 1000);
}

TEST(ExactLine, ThroughPointsAndPlanes) {
  const ExactLine line = ExactLine::through(Vector3d(2, 0, 0), Vector3d(0, 0, 0));
  EXPECT_EQ(line.direction_signs()[0], Sign::Negative);
  EXPECT_TRUE(line.passes_through({7, 0, 0}));
  EXPECT_FALSE(line.passes_through({7, 0, 1e-40}));
  EXPECT_TRUE(line.is_parallel({{0, 1, 0}, {5, 1, 0}}));
  EXPECT_EQ(line.meets({{1, 0, 0}, {5, 0, 0}}), SegmentContact::Along);
  EXPECT_EQ(line.meets({{1, 0, 0}, {5, 0, 1}}), SegmentContact::End);
  EXPECT_EQ(line.meets({{1, 1, 0}, {5, 1, 0}}), SegmentContact::None);
  EXPECT_EQ(line.heads({{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}), Sign::Negative);
  EXPECT_EQ(line.heads({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}), Sign::Zero);
  for (int i = 0; i < 3; ++i) {
    const Vector3d p(1, 2, i), q(0, 3, -i), r(-2, i, 5);
    EXPECT_EQ(line.side({p, q}), side({{2, 0, 0}, {0, 0, 0}}, {p, q}));
    EXPECT_EQ(line.side({r, q}), side({{2, 0, 0}, {0, 0, 0}}, {r, q}));
  }
  // Through a point and two lines.
  const Vector3d v(0, 0, 1);
  const LineThrough l{{1, 0, 0}, {1, 1, 0}}, m{{0, 2, 5}, {1, 2, 5}};
  const auto through = ExactLine::through(v, l, m);
  ASSERT_TRUE(through);
  EXPECT_TRUE(through->passes_through(v));
  EXPECT_EQ(through->side(l), Sign::Zero);
  EXPECT_EQ(through->side(m), Sign::Zero);
  EXPECT_FALSE(ExactLine::through(Vector3d(1, 7, 0), l, m));
  EXPECT_FALSE(ExactLine::through(v, l, LineThrough{{2, 0, -1}, {2, 1, -1}}));
  const auto meet = ExactLine::in_planes({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                         {{0, 3, 0}, {1, 3, 0}, {0, 3, 1}});
  ASSERT_TRUE(meet);
  EXPECT_TRUE(same_line(*meet, ExactLine::through(Vector3d(5, 3, 0), Vector3d(4, 3, 0))));
  EXPECT_FALSE(same_line(*meet, line));
}

TEST(ExactLine, RoundsWithinItsBound) {
  // Rational lines, where the exact point is at hand.
  RandomGeometry random(16);
  for (int i = 0; i < 500; ++i) {
    const auto terrain = testing::kTerrains[i % testing::kTerrains.size()];
    const LineThrough l = random_line(random, terrain);
    const Vector3d p = random.point(terrain);
    const ExactLine line = ExactLine::through(l.from, l.to);
    const RoundedPoint near = line.nearest(p);
    const auto a = internal::exact_point(l.from), b = internal::exact_point(l.to),
               c = internal::exact_point(p);
    Rational num = 0, den = 0;
    for (int k = 0; k < 3; ++k) {
      num += (b[k] - a[k]) * (c[k] - a[k]);
      den += (b[k] - a[k]) * (b[k] - a[k]);
    }
    for (int k = 0; k < 3; ++k) {
      const Rational exact = a[k] + num / den * (b[k] - a[k]);
      const Rational off = abs(Rational(near.point[k]) - exact);
      EXPECT_LE(off, abs(exact) * Rational(near.error) + Rational(0x1p-1000));
    }
  }
}

}  // namespace
}  // namespace sightline
