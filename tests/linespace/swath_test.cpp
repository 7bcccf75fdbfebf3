// Swaths against rational arithmetic on their generators: where the line at a position
// meets a fourth line, where its points pass planes, what it marks on a plane.

#include "linespace/swath.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "linespace/numbers/rational.h"
#include "tests/support/random_geometry.h"

namespace sightline {
namespace {

using internal::exact_orient;
using internal::exact_point;
using internal::ExactPoint;
using internal::Rational;
using testing::RandomGeometry;
using testing::Terrain;

constexpr std::array kLands{Terrain::Uniform, Terrain::Grid, Terrain::Tenths,
                            Terrain::Shifted};

ExactPoint on(const LineThrough& e, const Rational& s) {
  return internal::along(exact_point(e.from), exact_point(e.to), s);
}

struct Generators {
  std::optional<Point> vertex;
  LineThrough first, middle, last;  // vertex: the last alone

  [[nodiscard]] std::optional<Swath> swath() const {
    return vertex ? Swath::through(*vertex, last) : Swath::through(first, middle, last);
  }
  [[nodiscard]] ExactPoint x(const Rational& s) const {
    return vertex ? exact_point(*vertex) : on(first, s);
  }
  // A function that is linear in the last point, at s, times that point's weight: it is a
  // polynomial in s, whatever goes through infinity.
  template <class F>
  [[nodiscard]] Rational at_last(const Rational& s, const F& f) const {
    if (vertex) return f(on(last, s));
    const ExactPoint m0 = exact_point(middle.from), m1 = exact_point(middle.to);
    const ExactPoint q0 = exact_point(last.from), q1 = exact_point(last.to);
    const Rational f0 = exact_orient(x(s), q0, m0, m1);
    const Rational f1 = exact_orient(x(s), q1, m0, m1);
    return f0 * f(q1) - f1 * f(q0);
  }
  [[nodiscard]] Rational side(const Rational& s, const LineThrough& l) const {
    return at_last(s, [&](const ExactPoint& y) {
      return exact_orient(x(s), y, exact_point(l.from), exact_point(l.to));
    });
  }
  // The two points of the line; nullopt where the last is at infinity.
  [[nodiscard]] std::optional<std::array<ExactPoint, 2>> line(const Rational& s) const {
    const Rational w = at_last(s, [](const ExactPoint&) { return Rational(1); });
    if (w == 0) return std::nullopt;
    ExactPoint y;
    for (int i = 0; i < 3; ++i) {
      y[i] = at_last(s, [i](const ExactPoint& q) { return q[i]; }) / w;
    }
    return std::array{x(s), y};
  }
};

// The zeros in [0, 1] of a polynomial of degree two at most, by its values at 0, 1/2 and
// 1; nullopt: it is zero everywhere.
std::optional<std::vector<double>> naive_zeros(const Rational& at0, const Rational& half,
                                               const Rational& at1) {
  const Rational a = 2 * (at0 + at1) - 4 * half;
  const Rational b = at1 - at0 - a;
  std::vector<double> out;
  if (a == 0 && b == 0) return at0 == 0 ? std::nullopt : std::optional(out);
  if (a == 0) {
    const Rational s = -at0 / b;
    if (s >= 0 && s <= 1) out.push_back(s.convert_to<double>());
    return out;
  }
  const Rational d = b * b - 4 * a * at0;
  if (d < 0) return out;
  // The zeros are middle -+ root; which side of 0 and 1 they lie on, squares tell.
  const Rational middle = -b / (2 * a);
  const Rational squared = d / (4 * a * a);
  const double root = std::sqrt(squared.convert_to<double>());
  const auto at_least = [&](int k, const Rational& bound) {  // middle + k root >= bound
    const Rational gap = bound - middle;
    if (k > 0) return gap <= 0 || gap * gap <= squared;
    return gap <= 0 && gap * gap >= squared;
  };
  const auto at_most = [&](int k, const Rational& bound) {
    const Rational gap = bound - middle;
    if (k > 0) return gap >= 0 && gap * gap >= squared;
    return gap >= 0 || gap * gap <= squared;
  };
  for (const int k : {-1, 1}) {
    if (k == 1 && d == 0) break;
    if (at_least(k, 0) && at_most(k, 1)) {
      out.push_back(middle.convert_to<double>() + k * root);
    }
  }
  return out;
}

class Random : public RandomGeometry {
 public:
  using RandomGeometry::RandomGeometry;
  Point point(Terrain t) { return {coordinate(t), coordinate(t), coordinate(t)}; }
  LineThrough edge(Terrain t) {
    LineThrough e{point(t), point(t)};
    while (e.from == e.to) e.to = point(t);
    return e;
  }
  Generators generators(Terrain t) {
    Generators g{std::nullopt, edge(t), edge(t), edge(t)};
    if (one_in(3)) g.vertex = point(t);
    // Edges that meet, share an end, or lie in one plane.
    if (one_in(5)) g.middle.from = g.first.to;
    if (one_in(5)) g.last.from = g.middle.to;
    return g;
  }
};

TEST(Swath, MeetsALineWhereItsExactSideVanishes) {
  Random random(1);
  int twice = 0, once = 0, never = 0, always = 0;
  for (int i = 0; i < 3000; ++i) {
    const Terrain land = kLands[i % kLands.size()];
    const Generators g = random.generators(land);
    const auto swath = g.swath();
    if (!swath) continue;
    LineThrough l = random.edge(land);
    if (random.one_in(6)) l.to = g.last.from;
    const Swath::Positions found = swath->meeting(l);
    const auto zeros = naive_zeros(g.side(0, l), g.side(Rational(1, 2), l), g.side(1, l));
    ASSERT_EQ(found.always, !zeros) << i;
    if (found.always) {
      ++always;
      continue;
    }
    ASSERT_EQ(found.at.size(), zeros->size()) << i;
    (zeros->empty() ? never : zeros->size() == 1 ? once : twice)++;
    for (std::size_t k = 0; k < zeros->size(); ++k) {
      ASSERT_NEAR(found.at[k].value(), (*zeros)[k], 1e-6) << i;
    }
    if (found.at.size() == 2) {
      ASSERT_EQ(Swath::Position::compare(found.at[0], found.at[1]), Sign::Negative);
    }
  }
  EXPECT_GT(twice, 100);
  EXPECT_GT(once, 300);
  EXPECT_GT(never, 300);
  EXPECT_GT(always, 5);
}

// Two lines through points of one ruling meet the swath in one position, whatever its
// square root; and doubles are told apart from it.
TEST(Swath, ComparesPositionsExactly) {
  Random random(2);
  int equal = 0;
  for (int i = 0; i < 2000; ++i) {
    const Terrain land = kLands[i % kLands.size()];
    const Generators g = random.generators(land);
    const auto swath = g.swath();
    if (!swath) continue;
    const LineThrough l = random.edge(land);
    LineThrough m = l;  // the same line by other points
    m.from = 2 * l.from - l.to;
    if (!(m.from - l.from == l.from - l.to)) continue;
    const Swath::Positions a = swath->meeting(l), b = swath->meeting(m);
    ASSERT_EQ(a.at.size(), b.at.size());
    for (std::size_t k = 0; k < a.at.size(); ++k) {
      if (collinear(l.from, l.to, m.from)) {
        ASSERT_EQ(Swath::Position::compare(a.at[k], b.at[k]), Sign::Zero);
        ++equal;
      }
      const double s = a.at[k].value();
      const Swath::Position low(s - 0x1p-40), high(s + 0x1p-40);
      ASSERT_EQ(Swath::Position::compare(low, a.at[k]), Sign::Negative);
      ASSERT_EQ(Swath::Position::compare(high, a.at[k]), Sign::Positive);
    }
  }
  EXPECT_GT(equal, 200);
}

TEST(Swath, ItsPointsPassPlanes) {
  Random random(3);
  int first = 0, last = 0;
  for (int i = 0; i < 3000; ++i) {
    const Terrain land = kLands[i % kLands.size()];
    const Generators g = random.generators(land);
    const auto swath = g.swath();
    const PlaneThrough h{random.point(land), random.point(land), random.point(land)};
    if (!swath || collinear(h.a, h.b, h.c)) continue;
    for (const bool at_last : {false, true}) {
      const Swath::Positions found = at_last ? swath->last_in(h) : swath->first_in(h);
      ASSERT_LE(found.at.size(), 1U);
      const auto value = [&](const Rational& s) {
        const auto of = [&](const ExactPoint& x) {
          return exact_orient(exact_point(h.a), exact_point(h.b), exact_point(h.c), x);
        };
        return at_last ? g.at_last(s, of) : of(g.x(s));
      };
      const auto zeros = naive_zeros(value(0), value(Rational(1, 2)), value(1));
      ASSERT_EQ(found.always, !zeros) << i;
      if (found.always) continue;
      ASSERT_EQ(found.at.size(), zeros->size()) << i;
      (at_last ? last : first) += static_cast<int>(zeros->size());
      if (!zeros->empty()) ASSERT_NEAR(found.at[0].value(), (*zeros)[0], 1e-12);
    }
  }
  EXPECT_GT(first, 300);
  EXPECT_GT(last, 300);
}

TEST(Swath, TraceIsWhereTheLinesMeetThePlane) {
  Random random(4);
  double worst = 0;
  int curved = 0, seen = 0;
  for (int i = 0; i < 2000; ++i) {
    const Terrain land = kLands[i % 3];
    const Generators g = random.generators(land);
    const auto swath = g.swath();
    const PlaneThrough h{random.point(land), random.point(land), random.point(land)};
    if (!swath || collinear(h.a, h.b, h.c)) continue;
    const Swath::Trace trace = swath->trace(h);
    ASSERT_EQ(trace.curved, !g.vertex);
    curved += trace.curved;
    for (const double s : {0.0, 0.125, 0.7, 1.0}) {
      const auto xy = g.line(Rational(s));
      if (!xy) continue;
      const ExactPoint a = exact_point(h.a), b = exact_point(h.b), c = exact_point(h.c);
      const Rational hx = exact_orient(a, b, c, (*xy)[0]);
      const Rational hy = exact_orient(a, b, c, (*xy)[1]);
      if (hx == hy) continue;
      const Point exact =
          internal::rounded(internal::along((*xy)[0], (*xy)[1], hx / Rational(hx - hy)));
      if (!(exact.norm() < 1e3)) continue;
      // Cancellation in the sums, by the size of their terms.
      double size = 0;
      for (const auto& k : trace.coefficients) {
        for (const double x : k) size = std::max(size, std::abs(x));
      }
      double w = 0;
      for (int k = 2; k >= 0; --k) w = trace.coefficients[3][k] + s * w;
      const double error = (trace.at(s) - exact).norm();
      ASSERT_LE(error, 0x1p-46 * size / std::abs(w) * (1 + exact.norm())) << i;
      worst = std::max(worst, error / (1 + exact.norm()));
      ++seen;
    }
  }
  EXPECT_GT(curved, 300);
  EXPECT_GT(seen, 2000);
}

TEST(Swath, NoneWhereTheLinesAreNotOfOneParameter) {
  const LineThrough x{{0, 0, 0}, {1, 0, 0}}, y{{0, 1, 0}, {1, 3, 0}},
      z{{5, 5, 0}, {2, 9, 0}};
  EXPECT_FALSE(Swath::through(x, y, z));  // in one plane
  EXPECT_FALSE(Swath::through(x, {{2, 0, 0}, {3, 0, 0}}, {{0, 0, 1}, {1, 1, 1}}));
  EXPECT_FALSE(Swath::through(Point(7, 0, 0), x));  // on the edge's line
  EXPECT_TRUE(Swath::through(Point(7, 0x1p-60, 0), x));
  EXPECT_TRUE(Swath::through(x, {{0, 1, 1}, {1, 3, 0}}, z));  // a pencil in the plane
}

// The hyperboloid x^2 + y^2 = z^2 + 1 is made of the lines through three of its rulings.
TEST(Swath, RulesAHyperboloid) {
  const auto ruling = [](double cos, double sin) -> LineThrough {
    const Point at(cos, sin, 0), way(-sin, cos, 1);
    return {at - 8 * way, at + 8 * way};
  };
  const auto swath = Swath::through(ruling(1, 0), ruling(0.6, 0.8), ruling(0, 1));
  ASSERT_TRUE(swath);
  for (int i = 0; i <= 20; ++i) {
    const auto [p, q] = swath->line(0.49 + 0.002 * i);
    for (const double t : {0.0, 0.3, 0.8, 1.0}) {
      const Point x = (1 - t) * p + t * q;
      EXPECT_NEAR(x.x() * x.x() + x.y() * x.y(), x.z() * x.z() + 1, 1e-12);
    }
  }
  // On the plane z = 1 they mark the circle of radius sqrt 2.
  const auto trace = swath->trace({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}});
  for (int i = 0; i <= 20; ++i) {
    const Point x = trace.at(0.49 + 0.002 * i);
    EXPECT_NEAR(std::hypot(x.x(), x.y()), std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(x.z(), 1, 1e-12);
  }
}

}  // namespace
}  // namespace sightline
