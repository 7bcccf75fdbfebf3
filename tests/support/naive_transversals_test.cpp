// The naive enumeration of transversals against published counts and cases by hand.

#include "tests/support/naive_transversals.h"

#include <gtest/gtest.h>

#include "tests/support/generators.h"

namespace sightline::testing {
namespace {

ExactSegment segment(std::array<int, 3> a, std::array<int, 3> b) {
  return {{a[0], a[1], a[2]}, {b[0], b[1], b[2]}};
}
using Segments = std::vector<ExactSegment>;
using Families = std::set<NaiveFamily>;

// Examples of CGAL's (never released) package on lines through segments, Fogel et al.
TEST(NaiveTransversals, PublishedQuadruples) {
  const Segments two = {segment({2, -3, 1}, {10, 1, 1}), segment({1, 5, 11}, {5, 7, 1}),
                        segment({-10, -23, -31}, {71, -38, -1}),
                        segment({11, -40, 35}, {-7, 52, -21})};
  EXPECT_EQ(naive_quadruple(two).isolated.size(), 2u);
  EXPECT_TRUE(naive_quadruple(two).families.empty());
  const Segments one = {segment({2, -3, 1}, {13, 1, 1}), segment({1, 5, 11}, {5, 7, 1}),
                        segment({-10, -2, -3}, {23, -32, -1}),
                        segment({11, -4, 3}, {-7, 5, -21})};
  EXPECT_EQ(naive_quadruple(one).isolated.size(), 1u);
  const Segments concurrent = {
      segment({-1, 0, 0}, {1, 0, 0}), segment({0, -1, 0}, {0, 1, 0}),
      segment({0, 0, -1}, {0, 0, 1}), segment({-1, -2, -3}, {1, 2, 3})};
  EXPECT_TRUE(naive_quadruple(concurrent).isolated.empty());
  EXPECT_EQ(naive_quadruple(concurrent).families, (Families{{2, NaiveFamilyKind::Star}}));
}

// Every segment of one grid, and of another one behind it, meets two of the other
// direction: n^4 / 256 lines through four of n segments (Fogel et al., figure 2), moved
// a little so that no line meets more than four.
TEST(NaiveTransversals, TwoGridsReachThePublishedCount) {
  const int n = 12;
  Segments segments;
  for (int i = 0; i < n / 4; ++i) {
    const auto grid = [&](int z, int shift) {
      // Lines x = const and y = const in two close planes.
      const int u = 10 * i + shift * (i * i + 3);
      segments.push_back(segment({u, -1000, z}, {u, 1000, z}));
      segments.push_back(segment({-1000, u + i, z + 1}, {1000, u + i, z + 1}));
    };
    grid(0, 1);
    grid(100, 2);
  }
  const NaiveTransversals all = naive_transversals(segments);
  int of_kind = 0;
  for (const NaiveLine& l : all.lines) of_kind += l.segments.size() == 4;
  EXPECT_EQ(of_kind, n * n * n * n / 256);
  EXPECT_EQ(all.lines.size(), static_cast<std::size_t>(of_kind));
}

TEST(NaiveTransversals, OneOfTheTwoTransversalsMayBeAtInfinity) {
  // All parallel to the plane z = 0.
  const Segments parallel = {
      segment({-9, 0, 0}, {9, 0, 0}), segment({0, -9, 1}, {0, 9, 1}),
      segment({-9, -9, 2}, {9, 9, 2}), segment({-9, 3, 3}, {9, 3, 3})};
  EXPECT_EQ(naive_quadruple(parallel).isolated.size(), 1u);
}

TEST(NaiveTransversals, SegmentsOnARegulus) {
  // Rulings x = t, z = t y of z = x y; the transversals are y = s, z = s x.
  const auto ruling = [](int t, int from, int to) {
    return segment({t, from, t * from}, {t, to, t * to});
  };
  const Segments apart = {ruling(0, -1, 1), ruling(1, 0, 4), ruling(2, -2, 5),
                          ruling(3, 2, 5)};
  EXPECT_TRUE(naive_quadruple(apart).isolated.empty());
  EXPECT_TRUE(naive_quadruple(apart).families.empty());
  const Segments common = {ruling(0, -1, 3), ruling(1, 0, 4), ruling(2, -2, 5),
                           ruling(3, 2, 5)};
  EXPECT_EQ(naive_quadruple(common).families, (Families{{1, NaiveFamilyKind::Regulus}}));
  EXPECT_TRUE(naive_quadruple(common).isolated.empty());
  const Segments touching = {ruling(0, -1, 2), ruling(1, 0, 4), ruling(2, -2, 5),
                             ruling(3, 2, 5)};
  EXPECT_TRUE(naive_quadruple(touching).families.empty());
  ASSERT_EQ(naive_quadruple(touching).isolated.size(), 1u);
  // y = 2, z = 2 x: direction (1, 0, 2), moment (0, 2, 0) x (1, 0, 2) = (4, 0, -2).
  const CanonicalLine line = *naive_quadruple(touching).isolated.begin();
  const CanonicalLine expected = {{{1, 0}, {0, 0}, {2, 0}, {4, 0}, {0, 0}, {-2, 0}}};
  EXPECT_EQ(line, expected);
}

TEST(NaiveTransversals, CoplanarSegments) {
  const auto flat = [](int ax, int ay, int bx, int by) {
    return segment({ax, ay, 0}, {bx, by, 0});
  };
  const Segments parallel = {flat(0, -1, 0, 1), flat(1, -1, 1, 1), flat(2, -1, 2, 1),
                             flat(3, -1, 3, 1)};
  EXPECT_EQ(naive_quadruple(parallel).families, (Families{{2, NaiveFamilyKind::Plane}}));
  EXPECT_TRUE(naive_quadruple(parallel).isolated.empty());
  // Above, below, above the x axis, which alone passes.
  const Segments only_axis = {flat(0, 0, 0, 1), flat(1, -1, 1, 0), flat(2, 0, 2, 1),
                              flat(3, -1, 3, 5)};
  EXPECT_TRUE(naive_quadruple(only_axis).families.empty());
  EXPECT_EQ(naive_quadruple(only_axis).isolated.size(), 1u);
  // Two meet at an end, one above the other, and the line must pass there.
  const Segments hinge = {flat(0, 0, 0, 1), flat(0, -1, 0, 0), flat(2, -1, 2, 1),
                          flat(3, -3, 3, 3)};
  EXPECT_EQ(naive_quadruple(hinge).families, (Families{{1, NaiveFamilyKind::Plane}}));
}

TEST(NaiveTransversals, SegmentsOfOneLine) {
  const auto piece = [](int a, int b) { return segment({a, a, 1}, {b, b, 1}); };
  const Segments apart = {piece(0, 2), piece(1, 3), piece(2, 4), piece(5, 6)};
  EXPECT_EQ(naive_quadruple(apart).isolated.size(), 1u);
  const Segments point = {piece(0, 2), piece(1, 3), piece(2, 4), piece(-7, 6)};
  EXPECT_EQ(naive_quadruple(point).families, (Families{{2, NaiveFamilyKind::Star}}));
  const Segments overlap = {piece(0, 3), piece(1, 3), piece(2, 4), piece(-7, 6)};
  EXPECT_EQ(naive_quadruple(overlap).families, (Families{{3, NaiveFamilyKind::Complex}}));
}

TEST(NaiveTransversals, TwoPencils) {
  // Two that cross at the origin, in the plane z = 0, and two pieces of a line across it.
  const auto q = [](int from, int to) {
    return Segments{segment({-1, 0, 0}, {1, 0, 0}), segment({0, -1, 0}, {0, 1, 0}),
                    segment({5, 5, -9}, {5, 5, to}), segment({5, 5, from}, {5, 5, 9})};
  };
  EXPECT_EQ(naive_quadruple(q(-2, 3)).families, (Families{{1, NaiveFamilyKind::Pencil}}));
  // The lines through the origin and (5, 5, z), 1 <= z <= 3: none are in the plane.
  EXPECT_EQ(naive_quadruple(q(1, 3)).families, (Families{{1, NaiveFamilyKind::Pencil}}));
  EXPECT_TRUE(naive_quadruple(q(3, 1)).families.empty());
  EXPECT_TRUE(naive_quadruple(q(3, 1)).isolated.empty());
  EXPECT_EQ(naive_quadruple(q(3, 3)).isolated.size(), 1u);
}

// Order, orientation and permuted axes change nothing, on grids where most is degenerate.
TEST(NaiveTransversals, SymmetriesOnGrids) {
  for (int seed = 0; seed < 60; ++seed) {
    Random random(seed);
    const int side = random.integer(2, 5);
    Segments segments;
    while (segments.size() < 7) {
      const auto x = [&] { return random.integer(0, side); };
      const ExactSegment s = segment({x(), x(), x()}, {x(), x(), x()});
      if (s.a != s.b) segments.push_back(s);
    }
    const NaiveTransversals before = naive_transversals(segments);
    Segments moved = segments;
    random.shuffle(moved);
    for (ExactSegment& s : moved) {
      if (random.one_in(2)) std::swap(s.a, s.b);
      for (Vec3* p : {&s.a, &s.b}) *p = {-(*p)[1], (*p)[2], (*p)[0]};
    }
    const NaiveTransversals after = naive_transversals(moved);
    EXPECT_EQ(before.families, after.families) << seed;
    const auto sizes = [](const NaiveTransversals& t) {
      std::multiset<std::size_t> result;
      for (const NaiveLine& l : t.lines) result.insert(l.segments.size());
      return result;
    };
    EXPECT_EQ(sizes(before), sizes(after)) << seed;
  }
}

}  // namespace
}  // namespace sightline::testing
