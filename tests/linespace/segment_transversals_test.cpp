// Lines that meet four of n segments: published counts, laws, and enumeration of all
// quadruples by the predicates on exact lines.

#include "linespace/segment_transversals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "linespace/lines/segment_transversals.h"
#include "linespace/scene.h"
#include "tests/support/random_geometry.h"

namespace sightline {
namespace {

using Eigen::Vector3d;
using testing::RandomGeometry;
using testing::Terrain;
using Segments = std::vector<LineThrough>;

// What does not depend on the order of the elements: contact sets of the lines, and of
// the families by kind.
struct Summary {
  std::multiset<std::vector<int>> lines;
  std::multiset<std::pair<std::string, std::vector<int>>> families;
  friend bool operator==(const Summary&, const Summary&) = default;
};

Summary summary(const SegmentTransversals& t, const std::vector<int>& names = {}) {
  const auto named = [&names](const auto& elements) {
    std::vector<int> out;
    for (const int e : elements) out.push_back(names.empty() ? e : names[e]);
    std::ranges::sort(out);
    return out;
  };
  Summary s;
  for (std::size_t i = 0; i < t.lines.size(); ++i) {
    s.lines.insert(named(t.contacts_of(i)));
  }
  for (const auto& f : t.families) {
    s.families.emplace(std::to_string(f.dimension) + std::string(family_name(f.kind)),
                       named(f.elements));
  }
  return s;
}

std::multiset<std::string> family_names(const SegmentTransversals& t) {
  std::multiset<std::string> out;
  for (const auto& f : t.families) out.emplace(family_name(f.kind));
  return out;
}

Segments random_segments(RandomGeometry& random, int n, int side) {
  Segments out;
  while (static_cast<int>(out.size()) < n) {
    const auto point = [&]() -> Vector3d {
      if (side == 0) return random.point(Terrain::Uniform);
      return {static_cast<double>(random.integer(0, side - 1)),
              static_cast<double>(random.integer(0, side - 1)),
              static_cast<double>(random.integer(0, side - 1))};
    };
    const LineThrough l{point(), point()};
    if (l.from != l.to) out.push_back(l);
  }
  return out;
}

// ---- published and by hand
// --------------------------------------------------------------

TEST(SegmentTransversals, PublishedCases) {
  const Segments two{{{2, -3, 1}, {10, 1, 1}},
                     {{1, 5, 11}, {5, 7, 1}},
                     {{-10, -23, -31}, {71, -38, -1}},
                     {{11, -40, 35}, {-7, 52, -21}}};
  EXPECT_EQ(transversals_of_segments(two).line_count, 2U);
  const Segments one{{{2, -3, 1}, {13, 1, 1}},
                     {{1, 5, 11}, {5, 7, 1}},
                     {{-10, -2, -3}, {23, -32, -1}},
                     {{11, -4, 3}, {-7, 5, -21}}};
  EXPECT_EQ(transversals_of_segments(one).line_count, 1U);
  const Segments concurrent{{{-1, -2, 0}, {3, 6, 0}},
                            {{0, 0, -1}, {0, 0, 5}},
                            {{1, 1, 1}, {-2, -2, -2}},
                            {{0, 0, 0}, {1, 0, 7}}};
  const SegmentTransversals t = transversals_of_segments(concurrent);
  EXPECT_EQ(t.line_count, 0U);
  ASSERT_EQ(t.families.size(), 1U);
  EXPECT_EQ(t.families[0].kind, FamilyKind::Star);
  EXPECT_EQ(t.families[0].dimension, 2);
  EXPECT_EQ(t.families[0].elements, (std::vector<int>{0, 1, 2, 3}));
}

// Two grids: m lines along x at (y = i, z = 0) crossed by m along y (x = j, z = 0), and
// the same at z = 1 turned a little: a line joins a crossing to a crossing, one of each.
TEST(SegmentTransversals, TwoGridsHaveOneLineForEachPairOfCrossings) {
  for (const int m : {2, 3, 4}) {
    Segments s;
    for (int z = 0; z < 2; ++z) {
      // Offsets that no two differences share.
      for (int i = 0; i < m; ++i) {
        const double p = i + 0.01 * i * i + 0.3 * z, q = i + 0.013 * i * i + 0.17 * z;
        s.push_back({{-10, p, 5.0 * z}, {20, p + (z == 0 ? 0.0 : 0.7), 5.0 * z}});
        s.push_back({{q, -10, 5.0 * z}, {q + (z == 0 ? 0.0 : 0.9), 20, 5.0 * z}});
      }
    }
    const SegmentTransversals t = transversals_of_segments(s);
    int joins = 0;
    for (std::size_t i = 0; i < t.lines.size(); ++i) {
      const auto met = t.contacts_of(i);
      const auto low = std::ranges::count_if(met, [m](int e) { return e < 2 * m; });
      joins += met.size() == 4 && low == 2 ? 1 : 0;
    }
    EXPECT_EQ(joins, m * m * m * m) << m;  // n = 4 m: n^4 / 256
  }
}

TEST(SegmentTransversals, FamiliesByHand) {
  const auto names = [](const Segments& s) {
    return family_names(transversals_of_segments(s));
  };
  using Names = std::multiset<std::string>;
  const LineThrough x{{-1, 0, 0}, {1, 0, 0}}, y{{0, -1, 0}, {0, 1, 0}},
      z{{0, 0, -1}, {0, 0, 1}};
  // Rulings x = c of z = x y, cut to |y| <= 1.
  const auto ruling = [](double c, double to = 1) {
    return LineThrough{{c, -1, -c}, {c, to, c * to}};
  };
  EXPECT_EQ(names({ruling(0), ruling(1), ruling(2), ruling(3)}), Names{"regulus"});
  // The last ends where y = -1/2: the others' lines for y in [-1, -1/2].
  EXPECT_EQ(names({ruling(0), ruling(1), ruling(2), ruling(3, -0.5)}), Names{"regulus"});
  EXPECT_EQ(names({x, y, {{-1, 1, 0}, {1, -0.5, 0}}, {{-2, -2, -1}, {-2, -2, 1}}}),
            Names{"pencil"});
  // Through a point between them, on either side of the third: the two ways round.
  EXPECT_EQ(names({x, y, {{0, -1, 0}, {1, 1, 0}}, {{0.25, 0.25, -1}, {0.25, 0.25, 1}}}),
            (Names{"pencil", "pencil"}));
  // From the origin to z at (0, 5), and from (0, 5, 0) to x: the y axis is common.
  const LineThrough long_y{{0, -1, 0}, {0, 6, 0}};
  EXPECT_EQ(names({x, long_y, {{0, 5, -1}, {0, 5, 1}}, {{0, 5, -3}, {0, 5, 3}}}),
            Names{"joined_pencils"});
  EXPECT_EQ(names({x, x, {{0, 5, -1}, {0, 5, 1}}, {{0, 5, -3}, {0, 5, 0}}}),
            Names{"congruence"});
  EXPECT_EQ(
      names(
          {x, {{1, 0, 0}, {2, 0, 0}}, {{0, 5, -1}, {0, 5, 1}}, {{0, 5, -3}, {0, 5, 0}}}),
      Names{"pencil"});
  EXPECT_EQ(names({x, y, z, x}), Names{"star"});
  EXPECT_EQ(names({x, {{0, 0, 0}, {5, 0, 0}}, {{1, 0, 0}, {3, 0, 0}}, x}), Names{"star"});
  EXPECT_EQ(names({x, {{0, 0, 0}, {5, 0, 0}}, {{0.5, 0, 0}, {3, 0, 0}}, x}),
            Names{"complex"});
  EXPECT_EQ(names({x, y, {{-1, -1, 0}, {1, 1, 0}}, {{-1, 1, 0}, {1, -1, 0}}}),
            Names{"star_plane"});
  EXPECT_EQ(
      names(
          {x, {{-1, 1, 0}, {1, 1, 0}}, {{-1, 2, 0}, {1, 2, 0}}, {{-1, 3, 0}, {1, 3, 0}}}),
      Names{"plane"});
}

TEST(SegmentTransversals, IsolatedLinesOfDegenerateSupports) {
  const auto count = [](const Segments& s) {
    const SegmentTransversals t = transversals_of_segments(s);
    EXPECT_TRUE(t.families.empty());
    return t.line_count;
  };
  // Apart on one line: that line.
  EXPECT_EQ(count({{{0, 0, 0}, {1, 0, 0}},
                   {{2, 0, 0}, {3, 0, 0}},
                   {{4, 0, 0}, {5, 0, 0}},
                   {{6, 0, 0}, {7, 0, 0}}}),
            1U);
  // In a plane, ends touching the x axis from both sides in turn.
  EXPECT_EQ(count({{{0, 0, 0}, {0, 1, 0}},
                   {{1, 0, 0}, {1, -1, 0}},
                   {{2, 0, 0}, {2, 1, 0}},
                   {{3, 0, 0}, {3, -1, 0}}}),
            1U);
  // Rulings of which one only touches the others' last common line.
  const auto ruling = [](double c, double from, double to) {
    return LineThrough{{c, from, c * from}, {c, to, c * to}};
  };
  EXPECT_EQ(
      count({ruling(0, -1, 1), ruling(1, -1, 1), ruling(2, -1, 1), ruling(3, 1, 2)}), 1U);
  EXPECT_EQ(
      count({ruling(0, -1, 1), ruling(1, -1, 1), ruling(2, -1, 1), ruling(3, 1.5, 2)}),
      0U);
  // Concurrent but for one, along which the only line runs.
  EXPECT_EQ(count({{{-1, 0, 0}, {1, 0, 0}},
                   {{0, -1, 0}, {0, 1, 0}},
                   {{0, 0, -1}, {0, 0, 1}},
                   {{1, 1, 1}, {2, 2, 2}}}),
            1U);
}

TEST(SegmentTransversals, ALineThroughManyIsOne) {
  // Seven segments through points of the x axis, in directions without further relation,
  // and one along it.
  Segments s;
  for (int i = 0; i < 7; ++i) {
    const Vector3d p(i, 0, 0), d(0.1 * i * i - 0.3 * i, 1 + 0.3 * i, i * i * 0.25 - i);
    s.push_back({p - 0.125 * d, p + 0.125 * d});
    s.back().from[0] = s.back().to[0] = i;
    s.back().to = 2 * p - s.back().from;
  }
  s.push_back({{10, 0, 0}, {11, 0, 0}});
  const SegmentTransversals t = transversals_of_segments(s);
  int along = 0;
  for (std::size_t i = 0; i < t.lines.size(); ++i) {
    along += t.contacts_of(i).size() == 8 ? 1 : 0;
  }
  EXPECT_EQ(along, 1);
}

TEST(SegmentTransversals, UnboundedLines) {
  const LineThrough x{{0, 0, 0}, {1, 0, 0}};
  const LineThrough a{{0, 0, 1}, {0, 1, 1}}, b{{1, 1, 2}, {2, 2, 2}},
      c{{1, 2, 3}, {2, 0, 3}};
  // Parallel to one plane: one finite line.
  EXPECT_EQ(transversals_of_segments({}, Segments{x, a, b, c}).line_count, 1U);
  // As segments of their own two points they are missed.
  EXPECT_EQ(transversals_of_segments(Segments{x, a, b, c}).line_count, 0U);
  const auto ruling = [](double k) { return LineThrough{{k, 0, 0}, {k, 1, k}}; };
  const auto t = transversals_of_segments(
      {}, Segments{ruling(0), ruling(1), ruling(2), ruling(3), ruling(5)});
  EXPECT_EQ(family_names(t), std::multiset<std::string>{"regulus"});
  EXPECT_EQ(t.families.front().elements.size(), 5U);
}

TEST(SegmentTransversals, RefusesWhatItCannotUse) {
  EXPECT_THROW(transversals_of_segments(Segments{{{0, 0, 0}, {0, 0, 0}}}), InvalidInput);
  EXPECT_THROW(transversals_of_segments({}, Segments{{{0, 0, 0}, {0, 0, 1e300}}}),
               InvalidInput);
  EXPECT_EQ(transversals_of_segments({}).line_count, 0U);
}

// ---- against all quadruples
// ---------------------------------------------------------------

// In general position, from the predicates on lines alone.
std::multiset<std::vector<int>> by_quadruples(const Segments& s) {
  std::multiset<std::vector<int>> out;
  const int n = static_cast<int>(s.size());
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      for (int k = j + 1; k < n; ++k) {
        for (int l = k + 1; l < n; ++l) {
          for (const ExactLine& line : transversals(s[i], s[j], s[k], s[l]).lines) {
            const bool all = std::ranges::all_of(std::array{i, j, k, l}, [&](int e) {
              return line.meets(s[e]) != SegmentContact::None;
            });
            if (all) out.insert({i, j, k, l});
          }
        }
      }
    }
  }
  return out;
}

TEST(SegmentTransversals, AgreeWithAllQuadruplesInGeneralPosition) {
  RandomGeometry random(21);
  std::size_t lines = 0;
  for (int round = 0; round < 12; ++round) {
    const Segments s = random_segments(random, 8 + round, 0);
    const auto expected = by_quadruples(s);
    const SegmentTransversals t = transversals_of_segments(s);
    EXPECT_EQ(summary(t).lines, expected);
    EXPECT_TRUE(t.families.empty());
    EXPECT_TRUE(t.exact_lines.empty());
    lines += expected.size();
    for (std::size_t i = 0; i < t.lines.size(); i += 7) {
      const ExactLine line = t.exact(i);
      for (const int e : t.contacts_of(i)) {
        ASSERT_EQ(line.meets(s[e]), SegmentContact::Interior);
      }
      const LineThrough& first = s[t.lines[i].generators[0]];
      const Vector3d at = first.from + t.lines[i].at[0] * (first.to - first.from);
      EXPECT_LT((line.contact(first).point - at).norm(), 1e-9);
    }
  }
  EXPECT_GT(lines, 1000U);
}

// Quadruples one by one and all at once say the same, and each component of a quadruple
// is told: isolated lines by equality, families by their lines.
TEST(SegmentTransversals, HoldEveryComponentOfEveryQuadruple) {
  RandomGeometry random(22);
  int families = 0;
  for (int round = 0; round < 120; ++round) {
    const Segments s = random_segments(random, 7, 3 + round % 4);
    const SegmentTransversals t = transversals_of_segments(s);
    std::vector<ExactLine> seen;
    for (int q = 0; q < 1 << 7; ++q) {
      if (__builtin_popcount(static_cast<unsigned>(q)) != 4) continue;
      internal::FourElements four;
      int k = 0;
      for (int e = 0; e < 7; ++e) {
        if (q >> e & 1) four[k++] = {s[e], true};
      }
      const auto c = internal::components_of(four);
      EXPECT_LE(c.isolated.size() + c.families.size(), 4U);
      families += static_cast<int>(c.families.size());
      for (const ExactLine& l : c.isolated) {
        if (std::ranges::none_of(seen, [&](const auto& m) { return same_line(l, m); })) {
          seen.push_back(l);
        }
      }
    }
    ASSERT_EQ(t.line_count, seen.size());
    for (std::size_t i = 0; i < t.lines.size(); ++i) {
      const ExactLine line = t.exact(i);
      EXPECT_EQ(std::ranges::count_if(
                    seen, [&](const ExactLine& l) { return same_line(l, line); }),
                1);
      for (int e = 0; e < 7; ++e) {
        const bool met = line.meets(s[e]) != SegmentContact::None;
        EXPECT_EQ(std::ranges::count(t.contacts_of(i), e), met ? 1 : 0);
      }
    }
    for (const auto& f : t.families) {
      for (const int e : f.elements) {
        EXPECT_NE(f.sample.meets(s[e]), SegmentContact::None);
      }
    }
  }
  EXPECT_GT(families, 30);
}

TEST(SegmentTransversals, DoNotDependOnOrderOrientationAxesOrScale) {
  RandomGeometry random(23);
  for (int round = 0; round < 240; ++round) {
    const int side = round % 9 == 8 ? 0 : 3 + round % 8;
    Segments s = random_segments(random, 5 + round % 6, side);
    const Summary expected = summary(transversals_of_segments(s));
    std::vector<int> names(s.size());
    for (std::size_t i = 0; i < s.size(); ++i) names[i] = static_cast<int>(i);
    for (int turn = 0; turn < 4; ++turn) {
      for (std::size_t i = s.size() - 1; i > 0; --i) {
        const int j = random.integer(0, static_cast<int>(i));
        std::swap(s[i], s[j]);
        std::swap(names[i], names[j]);
      }
      for (LineThrough& l : s) {
        if (random.one_in(2)) std::swap(l.from, l.to);
        for (Vector3d* p : {&l.from, &l.to}) {
          *p = Vector3d(p->y(), -p->z(), p->x()) * 0.5;
        }
      }
      const Summary turned = summary(transversals_of_segments(s), names);
      ASSERT_EQ(turned.lines, expected.lines) << round;
      ASSERT_EQ(turned.families, expected.families) << round;
    }
  }
}

TEST(SegmentTransversals, DoNotDependOnThreadsAndCanBeCountedOnly) {
  RandomGeometry random(24);
  for (const int side : {0, 5}) {
    const Segments s = random_segments(random, 14, side);
    TransversalRequest request;
    const SegmentTransversals all = transversals_of_segments(s, {}, request);
    request.threads = 1;
    const SegmentTransversals one = transversals_of_segments(s, {}, request);
    EXPECT_EQ(summary(all), summary(one));
    EXPECT_EQ(all.predicates, one.predicates);
    request.only_count = true;
    const SegmentTransversals counted = transversals_of_segments(s, {}, request);
    EXPECT_EQ(counted.line_count, all.lines.size());
    EXPECT_EQ(counted.families.size(), all.families.size());
    EXPECT_TRUE(counted.lines.empty());
  }
}

TEST(SegmentTransversals, StopWhenAsked) {
  RandomGeometry random(25);
  TransversalRequest request;
  request.budget_seconds = -1;
  EXPECT_FALSE(
      transversals_of_segments(random_segments(random, 20, 0), {}, request).complete);
}

}  // namespace
}  // namespace sightline
