// The planar map of arcs in a plane: counts by hand, laws, naive oracles, invariances.

#include "shadows/planar/planar_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "linespace/scene.h"
#include "linespace/swaths/exact_swath.h"
#include "tests/shadows/naive_plane_counts.h"
#include "tests/shadows/plane_curve_generators.h"

namespace sightline::internal {
namespace {

PlaneOutline square(int from, int to) { return square_outline(from, to); }

PlaneCurve segment(int id, int ax, int ay, int bx, int by) {
  return plane_segment(id, {ax, ay}, {bx, by});
}

struct Counts {
  int vertices, edges, faces;
  bool operator==(const Counts&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Counts& c) {
  return out << c.vertices << " vertices, " << c.edges << " edges, " << c.faces
             << " faces";
}
Counts counts(const PlanarMap& map) {
  return {map.vertex_count(), map.edge_count(), map.face_count()};
}

// Half-edges, boundaries and faces belong together.
void expect_valid(const PlanarMap& map) {
  for (int h = 0; h < map.half_edge_count(); ++h) {
    ASSERT_EQ(map.target(h), map.origin(map.next(h)));
    ASSERT_EQ(map.face(h), map.face(map.next(h)));
  }
  std::vector<int> seen(map.half_edge_count(), 0);
  for (int v = 0; v < map.vertex_count(); ++v) {
    for (const int h : map.star(v)) {
      ASSERT_EQ(map.origin(h), v);
      ++seen[h];
    }
  }
  EXPECT_EQ(std::ranges::count(seen, 1), map.half_edge_count());
  // Each boundary is listed once.
  std::vector<int> walked(map.half_edge_count(), 0);
  const auto walk = [&](int first, int f) {
    int h = first;
    do {
      ASSERT_EQ(map.face(h), f);
      ++walked[h];
      h = map.next(h);
    } while (h != first);
  };
  int holes = 0;
  for (int f = 0; f < map.face_count(); ++f) {
    ASSERT_GE(map.outer_boundary(f), 0);
    walk(map.outer_boundary(f), f);
    for (const int h : map.holes(f)) walk(h, f);
    holes += static_cast<int>(map.holes(f).size());
  }
  for (int h = 0; h < map.half_edge_count(); ++h) {
    ASSERT_EQ(walked[h], map.face(h) == PlanarMap::kOutside ? 0 : 1);
  }
}

// Of edges and vertices.
int components(const PlanarMap& map) {
  std::vector<int> seen(map.vertex_count(), 0);
  int count = 0;
  for (int v = 0; v < map.vertex_count(); ++v) {
    if (seen[v]) continue;
    ++count;
    std::vector<int> stack{v};
    seen[v] = 1;
    while (!stack.empty()) {
      const int u = stack.back();
      stack.pop_back();
      for (const int h : map.star(u)) {
        if (!seen[map.target(h)]) {
          seen[map.target(h)] = 1;
          stack.push_back(map.target(h));
        }
      }
    }
  }
  return count;
}

// Euler's formula, areas that are positive and fill an outline without holes, points
// inside faces that lie in these faces.
void expect_consistent(const PlanarMap& map, double area) {
  expect_valid(map);
  EXPECT_EQ(map.vertex_count() - map.edge_count() + map.face_count() + 1,
            1 + components(map));
  double sum = 0;
  for (int f = 0; f < map.face_count(); ++f) {
    EXPECT_GT(map.area(f), 0);
    sum += map.area(f);
    const PlanePoint p = map.interior_point(f);
    EXPECT_EQ(naive_faces_around(map, {nearest_double(p[0]), nearest_double(p[1])}),
              std::vector{f});
  }
  EXPECT_NEAR(sum, area, 1e-12 * area);
}

TEST(PlanarMapOfSegments, NothingButTheOutline) {
  const PlanarMap map({}, square(0, 4));
  EXPECT_EQ(counts(map), (Counts{4, 4, 1}));
  expect_valid(map);
}

TEST(PlanarMapOfSegments, TwoDiagonals) {
  const std::vector curves{segment(7, 0, 0, 4, 4), segment(3, 4, 0, 0, 4)};
  const PlanarMap map(curves, square(0, 4));
  EXPECT_EQ(counts(map), (Counts{5, 8, 4}));
  expect_valid(map);
}

TEST(PlanarMapOfSegments, HolesTreesAndIsolatedParts) {
  const std::vector curves{
      // A square in a square in the outline, a cross in the inner one, a tree beside.
      segment(1, 10, 10, 50, 10),  segment(2, 50, 10, 50, 50), segment(3, 50, 50, 10, 50),
      segment(4, 10, 50, 10, 10),  segment(5, 20, 20, 40, 20), segment(6, 40, 20, 40, 40),
      segment(7, 40, 40, 20, 40),  segment(8, 20, 40, 20, 20), segment(9, 25, 30, 35, 30),
      segment(10, 30, 25, 30, 35), segment(11, 60, 60, 70, 60)};
  const PlanarMap map(curves, square(0, 100));
  EXPECT_EQ(counts(map), (Counts{4 + 8 + 5 + 2, 4 + 8 + 4 + 1, 3}));
  expect_valid(map);
  std::multiset<std::size_t> holes;
  for (int f = 0; f < map.face_count(); ++f) holes.insert(map.holes(f).size());
  EXPECT_EQ(holes, (std::multiset<std::size_t>{1, 1, 2}));
}

TEST(PlanarMapOfSegments, CollinearOverlaps) {
  const std::vector curves{segment(1, 1, 1, 5, 1), segment(2, 7, 1, 3, 1),
                           segment(3, 5, 1, 6, 1), segment(4, 3, 0, 3, 2)};
  const PlanarMap map(curves, square(0, 8));
  // On the line: 1 to 3 (1), 3 to 5 (1, 2), 5 to 6 (2, 3), 6 to 7 (2).
  EXPECT_EQ(counts(map), (Counts{4 + 5 + 2, 5 + 4 + 2, 1}));
  expect_valid(map);
  std::multiset<std::vector<int>> ids;
  for (int e = 0; e < map.edge_count(); ++e) {
    ids.insert({map.curves(e).begin(), map.curves(e).end()});
  }
  EXPECT_EQ(ids, (std::multiset<std::vector<int>>{
                     {}, {}, {}, {}, {}, {1}, {1, 2}, {2}, {2, 3}, {4}, {4}}));
}

TEST(PlanarMapOfSegments, OutlineWithHoles) {
  PlaneOutline outline = square(0, 10);
  outline.push_back({{2, 2}, {4, 2}, {4, 4}, {2, 4}});
  outline.push_back({{4, 4}, {6, 4}, {6, 6}});  // touches the other hole
  const std::vector curves{segment(1, 0, 2, 2, 2), segment(2, 6, 6, 10, 10),
                           segment(3, 4, 4, 4, 2)};
  const PlanarMap map(curves, outline);
  EXPECT_EQ(counts(map), (Counts{4 + 4 + 2 + 1, 4 + 1 + 4 + 3 + 2, 2}));
  expect_valid(map);
}

TEST(PlanarMapOfSegments, CurvesOutsideAreRefused) {
  EXPECT_THROW(PlanarMap(std::vector{segment(1, 1, 1, 11, 1)}, square(0, 10)),
               InvalidInput);
  EXPECT_THROW(PlanarMap(std::vector{segment(1, 11, 1, 12, 1)}, square(0, 10)),
               InvalidInput);
}

// ---- conics by hand

// The quarter circle from angle 90 q to 90 (q + 1) degrees: (1 - s^2 : 2 s : 1 + s^2).
PlaneCurve quarter(int id, const PlanePoint& centre, const Rational& radius, int q) {
  const RationalQuadratic w{1, 0, 1}, c{1, 0, -1}, s{0, 2, 0};
  PlaneCurve curve{id, {}, {}, w, rational_end(0), rational_end(1)};
  for (int k = 0; k < 3; ++k) {
    const Rational x = q % 2 == 0 ? c[k] : -s[k], y = q % 2 == 0 ? s[k] : c[k];
    const Rational sign = q < 2 ? 1 : -1;
    curve.x[k] = centre[0] * w[k] + sign * radius * x;
    curve.y[k] = centre[1] * w[k] + sign * radius * y;
  }
  return curve;
}

void append_circle(std::vector<PlaneCurve>& curves, int id, const PlanePoint& centre,
                   const Rational& radius) {
  for (int q = 0; q < 4; ++q) curves.push_back(quarter(id, centre, radius, q));
}

// y = a x^2 / (1 - b x) from x = from to x = to.
PlaneCurve bowl(int id, const Rational& a, const Rational& b, int from, int to) {
  return {id, {0, 1, -b}, {0, 0, a}, {1, -b, 0}, rational_end(from), rational_end(to)};
}

std::multiset<std::vector<int>> id_lists(const PlanarMap& map) {
  std::multiset<std::vector<int>> ids;
  for (int e = 0; e < map.edge_count(); ++e) {
    ids.insert({map.curves(e).begin(), map.curves(e).end()});
  }
  return ids;
}

TEST(PlanarMapOfConics, CircleThatTouchesTheOutline) {
  std::vector<PlaneCurve> curves;
  append_circle(curves, 1, {5, 5}, 5);
  const PlanarMap map(curves, square(0, 10));
  EXPECT_EQ(counts(map), (Counts{8, 12, 5}));
  expect_consistent(map, 100);
  double largest = 0;
  for (int f = 0; f < map.face_count(); ++f) largest = std::max(largest, map.area(f));
  EXPECT_NEAR(largest, 25 * std::numbers::pi, 1e-13);
}

// Touching with multiplicity 2, 3 and 4 in one vertex, from both sides: bowls, a line, a
// bowl that crosses one of them where it osculates it, and the circle that fits one best.
TEST(PlanarMapOfConics, ManyTangentsInOneVertex) {
  std::vector<PlaneCurve> curves{bowl(1, 1, 0, -1, 1),
                                 bowl(2, 2, 0, -1, 1),
                                 bowl(3, -1, 0, -1, 1),
                                 segment(4, -2, 0, 2, 0),
                                 bowl(5, 1, Rational(1, 2), -1, 1),
                                 quarter(6, {0, Rational(1, 2)}, Rational(1, 2), 2),
                                 quarter(7, {0, Rational(1, 2)}, Rational(1, 2), 3)};
  const PlanarMap map(curves, square(-4, 4));
  expect_consistent(map, 64);
  // In (0, 0) twelve half-edges, ordered by what they are a moment later: at x > 0
  // -x^2, 0, x^2, x^2 + x^4 (the circle), x^2 / (1 - x / 2), 2 x^2.
  int hub = -1;
  for (int v = 0; v < map.vertex_count(); ++v) {
    if (map.vertex(v).at.norm() < 1e-9) hub = v;
  }
  ASSERT_GE(hub, 0);
  std::vector<int> ids;
  for (const int h : map.star(hub)) ids.push_back(map.curves(PlanarMap::edge_of(h))[0]);
  // From the direction (1, 0) on.
  const auto first = std::ranges::find(ids, 4);
  std::ranges::rotate(ids, first);
  const std::vector<int> right_first{4, 1, 7, 5, 2, 2, 6, 1, 5, 4, 3, 3};
  const std::vector<int> left_first{4, 3, 3, 4, 1, 7, 5, 2, 2, 6, 1, 5};
  EXPECT_TRUE(ids == right_first || ids == left_first) << testing::PrintToString(ids);
}

// Circles through (0, +-sqrt 15), and the line through these points: all crossings have
// irrational parameters, roots of polynomials that differ from pair to pair.
TEST(PlanarMapOfConics, CirclesAndTheirCommonChord) {
  std::vector<PlaneCurve> curves;
  append_circle(curves, 1, {1, 0}, 4);
  append_circle(curves, 2, {-1, 0}, 4);
  append_circle(curves, 3, {7, 0}, 8);
  append_circle(curves, 4, {-7, 0}, 8);
  curves.push_back(segment(5, 0, -20, 0, 20));
  const PlanarMap map(curves, square(-20, 20));
  expect_consistent(map, 1600);
  // Corners, ends of quarters, the two points, where the line ends.
  EXPECT_EQ(map.vertex_count(), 4 + 16 + 2 + 2);
  // Quarters, their cuts, the line in three, the outline in six.
  EXPECT_EQ(map.edge_count(), 16 + 8 + 3 + 6);
  int of_ten = 0;
  for (int v = 0; v < map.vertex_count(); ++v) of_ten += map.star(v).size() == 10;
  EXPECT_EQ(of_ten, 2);
}

// An ellipse in a circle, F + L^2 25/4 = 0 in F = x^2 + y^2 - 25 = 0, touches it where L
// = x - y - 2 = 0: at irrational points, roots of a polynomial of degree 4.
TEST(PlanarMapOfConics, TouchingInIrrationalPoints) {
  std::vector<PlaneCurve> curves;
  append_circle(curves, 1, {0, 0}, 5);
  // The second crossing with the line y = m x through (0, 0); and with x = m y.
  const Rational a(25, 4);
  curves.push_back({2,
                    {25, -25, 0},
                    {0, 25, -25},
                    {1 + a, -2 * a, 1 + a},
                    rational_end(-50),
                    rational_end(50)});
  curves.push_back({3,
                    {0, -25, 25},
                    {-25, 25, 0},
                    {1 + a, -2 * a, 1 + a},
                    rational_end(Rational(-1, 50)),
                    rational_end(Rational(1, 50))});
  for (const bool with_chord : {false, true}) {
    SCOPED_TRACE(with_chord);
    if (with_chord) curves.push_back(segment(4, -4, -6, 6, 4));
    const PlanarMap map(curves, square(-8, 8));
    expect_consistent(map, 256);
    EXPECT_EQ(counts(map), with_chord ? (Counts{14, 17, 5}) : (Counts{12, 14, 4}));
    double error = 0;
    for (int v = 0; v < map.vertex_count(); ++v) {
      error = std::max(error, map.vertex(v).error);
    }
    EXPECT_LE(error, 8 * kVertexError);
  }
}

// Is p strictly between the chord y = 0 and the bowl y = a x (1 - x)?
bool inside_bowl(const PlanePoint& p, const Rational& a) {
  return p[1] > 0 && p[1] < a * p[0] * (1 - p[0]);
}

// Faces that are thinner than doubles tell apart, one with a segment alone in it.
TEST(PlanarMapOfConics, FacesTooThinForDoubles) {
  for (const int bits : {30, 60, -60, 90, 300, -300}) {
    SCOPED_TRACE(bits);
    const bool with_segment = bits > 0;
    const Rational a(1, Integer(1) << std::abs(bits));
    const PlanePoint shift{Rational(1, 3), Rational(1, 7)};
    // y = a x (1 - x), moved by `shift`.
    const RationalQuadratic x{shift[0], 1, 0}, y{shift[1], a, -a}, w{1, 0, 0};
    const PlanePoint left = shift, right{shift[0] + 1, shift[1]};
    std::vector curves{PlaneCurve{1, x, y, w, rational_end(0), rational_end(1)},
                       plane_segment(2, left, right)};
    if (with_segment)
      curves.push_back(plane_segment(3, {shift[0] + Rational(1, 4), shift[1] + a / 16},
                                     {shift[0] + Rational(3, 4), shift[1] + a / 15}));
    const PlanarMap map(curves, square(0, 2));
    EXPECT_EQ(counts(map), with_segment ? (Counts{4 + 2 + 2, 4 + 2 + 1, 2})
                                        : (Counts{4 + 2, 4 + 2, 2}));
    expect_valid(map);
    int thin = 0;
    for (int f = 0; f < 2; ++f) {
      PlanePoint p = map.interior_point(f);
      p[0] -= shift[0];
      p[1] -= shift[1];
      if (inside_bowl(p, a)) {
        ++thin;
        EXPECT_EQ(map.holes(f).size(), with_segment ? 1u : 0u);
      }
    }
    EXPECT_EQ(thin, 1);
  }
}

// y = c0 + c1 x + c2 x^2.
PlaneCurve parabola(int id, const Rational& c0, const Rational& c1, const Rational& c2,
                    const Rational& from, const Rational& to) {
  return {id, {0, 1, 0}, {c0, c1, c2}, {1, 0, 0}, rational_end(from), rational_end(to)};
}

// The same with another parameter, x = t / (1 + t), from t = from to t = to.
PlaneCurve bent_parabola(int id, const Rational& c0, const Rational& c1,
                         const Rational& c2, const Rational& from, const Rational& to) {
  return {id,        {0, 1, 1},          {c0, 2 * c0 + c1, c0 + c1 + c2},
          {1, 2, 1}, rational_end(from), rational_end(to)};
}

// Two parabolas that cross at x = c - e and c + e, closer than doubles tell apart, and a
// third that passes through the first of these points.
TEST(PlanarMapOfConics, CrossingsNextToOneAnother) {
  const Rational c(1, 3), e(1, Integer(1) << 70);
  // y = x^2, that plus (x - c)^2 - e^2, that plus (x - c + e).
  const Rational c0 = c * c - e * e, c1 = -2 * c;
  const auto third = parabola(3, e - c, 1, 1, -1, Rational(3, 4));
  for (const bool bent : {false, true}) {
    SCOPED_TRACE(bent);
    const std::vector curves{
        parabola(1, 0, 0, 1, -1, 1),
        bent ? bent_parabola(2, c0, c1, 2, Rational(-1, 9), 5)
             : parabola(2, c0, c1, 2, Rational(-1, 8), Rational(5, 6)),
        third};
    const PlanarMap map(curves, square(-4, 4));
    expect_valid(map);
    // Crossings: 1 and 2 in two points, 3 in the first of them; 2 and 3 again where x - c
    // - e = 1, beyond the end of 3.
    EXPECT_EQ(counts(map), (Counts{4 + 6 + 2, 4 + 3 + 3 + 2, 2}));
    for (int v = 0; v < map.vertex_count(); ++v) {
      // On each curve the crossing with all three comes before the other one.
      if (map.star(v).size() != 6) continue;
      int to_next = 0;
      for (const int h : map.star(v)) to_next += map.star(map.target(h)).size() == 4;
      EXPECT_EQ(to_next, 2);
    }
    for (int f = 0; f < map.face_count(); ++f) {
      if (map.area(f) > 1) continue;
      const PlanePoint p = map.interior_point(f);
      const Rational x = p[0] - c;
      EXPECT_TRUE(p[1] < p[0] * p[0] && p[1] > p[0] * p[0] + x * x - e * e);
    }
  }
}

// An arc that ends just before, on, or just after a line.
TEST(PlanarMapOfConics, EndsNextToALine) {
  const Rational c(1, 3), e(1, Integer(1) << 70);
  for (const int past : {-1, 0, 1}) {
    SCOPED_TRACE(past);
    const std::vector curves{parabola(1, 0, 0, 1, -1, c + past * e),
                             plane_segment(2, {c, 0}, {c, 1})};
    const PlanarMap map(curves, square(-4, 4));
    expect_valid(map);
    EXPECT_EQ(counts(map), past < 0    ? (Counts{4 + 4, 4 + 2, 1})
                           : past == 0 ? (Counts{4 + 4, 4 + 3, 1})
                                       : (Counts{4 + 5, 4 + 4, 1}));
  }
}

// On the line y = 0 parabolas with the roots c and d, and c and d + e.
TEST(PlanarMapOfConics, OneCommonRootAndTwoNeighbours) {
  const Rational c(1, 3), d(5, 7), e(1, Integer(1) << 70);
  const auto with_roots = [&](int id, const Rational& u, const Rational& v) {
    return parabola(id, u * v, -u - v, 1, -1, 2);
  };
  const std::vector curves{segment(1, -2, 0, 2, 0), with_roots(2, c, d),
                           with_roots(3, c, d + e)};
  const PlanarMap map(curves, square(-4, 4));
  expect_valid(map);
  EXPECT_EQ(counts(map), (Counts{4 + 6 + 3, 4 + 4 + 3 + 3, 3}));
}

double smallest_area(const PlanarMap& map) {
  double area = map.area(0);
  for (int f = 1; f < map.face_count(); ++f) area = std::min(area, map.area(f));
  return area;
}

TEST(PlanarMapOfConics, AreasInClosedForm) {
  // A parabola over its chord: a sixth of the cubed width; from the flat to the bent.
  for (const int k : {1, 10, 1000}) {
    const PlanarMap map(std::vector{parabola(1, 0, Rational(1, k), Rational(-1, k), 0, 1),
                                    segment(2, 0, 0, 1, 0)},
                        square(-1, 2));
    EXPECT_NEAR(smallest_area(map), 1. / 6 / k, 1e-15);
  }
  // A circle in four quarters.
  std::vector<PlaneCurve> curves;
  append_circle(curves, 1, {0, 0}, 2);
  const PlanarMap circle(curves, square(-9, 9));
  EXPECT_NEAR(smallest_area(circle), 4 * std::numbers::pi, 2e-14);
  // More than half of an ellipse in one arc: a negative weight.
  const PlaneCurve ellipse{1,         {3, 0, -3},       {0, 4, 0},
                           {1, 0, 1}, rational_end(-2), rational_end(2)};
  // Between the angles +-2 atan 2 of the circle that it is the image of.
  const double angle = 2 * std::atan(2.);
  const PlanarMap large(
      std::vector{ellipse, plane_segment(2, {Rational(-9, 5), Rational(8, 5)},
                                         {Rational(-9, 5), Rational(-8, 5)})},
      square(-9, 9));
  EXPECT_NEAR(smallest_area(large), 6 * (angle - std::sin(angle) * std::cos(angle)),
              2e-14);
  // A hyperbola y = 1 / x over the axis, from 1 to 2 and from 1 to 100.
  for (const int to : {2, 100}) {
    const PlanarMap map(
        std::vector{
            PlaneCurve{
                1, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, rational_end(1), rational_end(to)},
            segment(2, 1, 0, to, 0), segment(3, 1, 0, 1, 1),
            plane_segment(4, {to, 0}, {to, Rational(1, to)})},
        square(-1, 110));
    EXPECT_NEAR(smallest_area(map), std::log(to), 1e-13);
  }
}

TEST(PlanarMapOfConics, PiecesThatCoincideAreOneEdge) {
  CurveGenerator generate(1, 10);
  const auto whole = CurveGenerator::bezier(1, {{{1, 1}, {5, 9}, {9, 2}}}, {2, 1, 3});
  PlaneCurve same = CurveGenerator::reparametrised(whole);
  same.id = 2;
  PlaneCurve part = same;  // s = 1/3 to 2/3, t = 1/2 to 4/5 of the whole
  part.id = 3;
  part.from = rational_end(Rational(1, 3));
  part.to = rational_end(Rational(2, 3));
  // Backwards.
  const auto back = CurveGenerator::bezier(4, {{{9, 2}, {5, 9}, {1, 1}}}, {3, 1, 2});
  const PlanarMap map(std::vector{whole, same, part, back}, square(0, 10));
  expect_consistent(map, 100);
  EXPECT_EQ(counts(map), (Counts{4 + 4, 4 + 3, 1}));
  EXPECT_EQ(id_lists(map), (std::multiset<std::vector<int>>{
                               {}, {}, {}, {}, {1, 2, 4}, {1, 2, 3, 4}, {1, 2, 4}}));
  for (int e = 0; e < map.edge_count(); ++e) {
    if (map.curves(e).size() != 4) continue;
    EXPECT_NEAR(std::abs(map.part(e, 1).to - map.part(e, 1).from), 0.3, 1e-13);
    EXPECT_NEAR(std::abs(map.part(e, 3).to - map.part(e, 3).from), 1. / 3, 1e-13);
    EXPECT_NEAR(map.part(e, 1).from + map.part(e, 4).from, 1, 1e-13);
  }
}

TEST(PlanarMapOfConics, TwoHalvesOfOneEllipseHaveTheSameEnds) {
  std::vector<PlaneCurve> curves;
  const auto half = [](int id, const Rational& sign) {
    return PlaneCurve{id,        {3, 0, -3},       {0, 4 * sign, 0},
                      {1, 0, 1}, rational_end(-1), rational_end(1)};
  };
  // Right and left half of an ellipse.
  PlaneCurve left = half(2, 1);
  for (Rational& c : left.x) c = -c;
  const PlanarMap map(std::vector{half(1, 1), left}, square(-4, 4));
  EXPECT_EQ(counts(map), (Counts{4 + 2, 4 + 2, 2}));
  expect_consistent(map, 64);
}

// A parametrisation of degree 2 of a line, with irrational ends, over a plain segment.
TEST(PlanarMapOfConics, ATraceThatIsASegment) {
  const CurveEnd root{{2, -4, 1}, false};  // 2 - sqrt 2
  // ((1 + s)^2 : (1 + s)^2 : (1 + s) + s^2).
  const PlaneCurve trace{1, {1, 2, 1}, {1, 2, 1}, {1, 1, 1}, rational_end(0), root};
  const PlanarMap map(std::vector{trace, segment(2, 0, 0, 4, 4)}, square(0, 4));
  expect_consistent(map, 16);
  EXPECT_EQ(counts(map), (Counts{4 + 2, 4 + 3, 2}));
  EXPECT_EQ(id_lists(map),
            (std::multiset<std::vector<int>>{{}, {}, {}, {}, {2}, {1, 2}, {2}}));
  for (int e = 0; e < map.edge_count(); ++e) {
    if (map.curves(e).size() != 2) continue;
    EXPECT_NEAR(map.part(e, 1).from, 0, 1e-13);
    EXPECT_NEAR(map.part(e, 1).to, 2 - std::numbers::sqrt2, 1e-13);
  }
}

TEST(PlanarMapOfConics, BadCurvesAreRefused) {
  const auto map_of = [](const PlaneCurve& c) {
    PlanarMap(std::vector{c}, square(-9, 9));
  };
  const RationalQuadratic zero{0, 0, 0}, one{1, 0, 0}, s{0, 1, 0};
  // A point; ends out of order; no real end; through infinity, once and twice.
  EXPECT_THROW(map_of({1, one, one, one, rational_end(0), rational_end(1)}),
               InvalidInput);
  EXPECT_THROW(map_of({1, s, zero, one, rational_end(1), rational_end(0)}), InvalidInput);
  EXPECT_THROW(map_of({1, s, zero, one, rational_end(0), {{1, 0, 1}, true}}),
               InvalidInput);
  EXPECT_THROW(map_of({1, one, zero, s, rational_end(-1), rational_end(1)}),
               InvalidInput);
  EXPECT_THROW(map_of({1, one, s, {-1, 0, 4}, rational_end(-1), rational_end(1)}),
               InvalidInput);
  EXPECT_NO_THROW(map_of({1, one, s, {4, 0, -1}, rational_end(-1), rational_end(1)}));
}

// ---- curves from swaths

TEST(PlaneCurves, EndsAtPositionsInQuadraticFields) {
  for (const int b : {-1, 0, 1}) {
    const QuadraticRoot s{2, b, 3, 2};  // (2 + b sqrt 2) / 3
    const PlaneCurve curve{1,         {0, 1, 0},       {1, 0, 0},
                           {1, 0, 0}, rational_end(0), curve_end_at(s)};
    const PlanarMap map(std::vector{curve}, square(-4, 4));
    double furthest = 0;
    for (int v = 0; v < map.vertex_count(); ++v) {
      if (map.vertex(v).at.y() == 1) furthest = std::max(furthest, map.vertex(v).at.x());
    }
    EXPECT_NEAR(furthest, (2 + b * std::numbers::sqrt2) / 3, 1e-15);
  }
}

TEST(PlaneCurves, TraceOfASwath) {
  // From a vertex at height 4 through an edge at height 2: twice as far on the ground.
  const ExactSwath swath =
      exact_swath(Eigen::Vector3d(1, 1, 4), LineThrough{{2, 1, 2}, {1, 3, 2}});
  const auto trace = swath.trace({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  const PlaneCurve curve{1,
                         rational_quadratic(trace[0]),
                         rational_quadratic(trace[1]),
                         rational_quadratic(trace[3]),
                         rational_end(0),
                         rational_end(1)};
  const PlanarMap map(std::vector{curve}, square(-8, 8));
  for (int e = 0; e < map.edge_count(); ++e) {
    if (map.on_outline(e)) continue;
    const CurvePart part = map.part(e, 1);
    const Eigen::Vector2d p = map.vertex(map.origin(2 * e)).at;
    const Eigen::Vector2d q = map.vertex(map.target(2 * e)).at;
    EXPECT_LT(((part.from < part.to ? p : q) - Eigen::Vector2d(3, 1)).norm(), 1e-14);
    EXPECT_LT(((part.from < part.to ? q : p) - Eigen::Vector2d(1, 5)).norm(), 1e-14);
  }
}

// ---- random curves

enum class Kind { Segments, Arcs, Shortened, Mixed, Overlapping };

std::vector<PlaneCurve> random_curves(Kind kind, unsigned seed, int count, int size) {
  CurveGenerator generate(seed, size);
  std::vector<PlaneCurve> curves;
  for (int i = 0; i < count; ++i) {
    const int which =
        kind == Kind::Mixed ? generate.number(0, 2) : static_cast<int>(kind);
    PlaneCurve curve = which == 0 ? generate.segment(i) : generate.arc(i);
    if (which == 2) curve = generate.shortened(curve);
    curves.push_back(curve);
  }
  return curves;
}

class PlanarMapOfRandomCurves : public testing::TestWithParam<Kind> {};

TEST_P(PlanarMapOfRandomCurves, IsConsistentAndCountedRight) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const int size = seed % 3 == 0 ? 4 : seed % 3 == 1 ? 10 : 100;
    const int count = 2 + static_cast<int>(seed % 9);
    SCOPED_TRACE(testing::Message()
                 << "seed " << seed << ", " << count << " in " << size);
    const auto curves = random_curves(GetParam(), seed, count, size);
    const PlaneOutline outline = square(0, size);
    const PlanarMap map(curves, outline);
    expect_consistent(map, size * size);
    const NaiveCounts naive = naive_counts(curves, outline);
    EXPECT_EQ(map.vertex_count(), naive.vertices);
    EXPECT_EQ(map.edge_count(), naive.edges);
  }
}

// ---- edges

double value(const std::array<Rational, 6>& f, const Eigen::Vector2d& p) {
  std::array<double, 6> c;
  for (int i = 0; i < 6; ++i) c[i] = nearest_double(f[i]);
  return c[0] * p.x() * p.x() + c[1] * p.x() * p.y() + c[2] * p.y() * p.y() +
         c[3] * p.x() + c[4] * p.y() + c[5];
}

// To first order.
double distance(const std::array<Rational, 6>& f, const Eigen::Vector2d& p) {
  constexpr double h = 1e-4;
  const Eigen::Vector2d gradient(
      value(f, p + Eigen::Vector2d(h, 0)) - value(f, p - Eigen::Vector2d(h, 0)),
      value(f, p + Eigen::Vector2d(0, h)) - value(f, p - Eigen::Vector2d(0, h)));
  return std::abs(value(f, p)) / (gradient.norm() / (2 * h));
}

TEST(PlanarMapEdges, PointsPartsAndDrawingsLieOnTheirCurves) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE(seed);
    const auto curves =
        random_curves(seed % 2 ? Kind::Mixed : Kind::Overlapping, seed, 14, 30);
    const PlanarMap map(curves, square(0, 30));
    for (int e = 0; e < map.edge_count(); ++e) {
      const std::array<Rational, 6> f = map.implicit_form(e);
      const PlanePoint p = map.exact_point(e);
      EXPECT_EQ(f[0] * p[0] * p[0] + f[1] * p[0] * p[1] + f[2] * p[1] * p[1] +
                    f[3] * p[0] + f[4] * p[1] + f[5],
                0);
      EXPECT_LT(distance(f, map.point(e, 0.3)), 1e-10);
      const auto line = map.polyline(e, 1e-3);
      EXPECT_EQ(line.front(), map.vertex(map.origin(2 * e)).at);
      EXPECT_EQ(line.back(), map.vertex(map.target(2 * e)).at);
      for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        EXPECT_LT(distance(f, line[i]), 1e-10);
        EXPECT_LT(distance(f, 0.5 * (line[i] + line[i + 1])), 1.1e-3);
      }
      for (const int id : map.curves(e)) {
        const CurvePart part = map.part(e, id);
        const naive::Curve curve = naive::curve_of(curves[id]);
        EXPECT_LT((curve.at(part.from) - map.vertex(map.origin(2 * e)).at).norm(), 1e-9);
        EXPECT_LT((curve.at(part.to) - map.vertex(map.target(2 * e)).at).norm(), 1e-9);
      }
    }
  }
}

// ---- without

TEST(PlanarMapWithout, KeepsCornersAndEndsOfCurves) {
  // A corner in the middle of a side; two segments that continue one another.
  const PlaneOutline outline{{{0, 0}, {2, 0}, {4, 0}, {4, 4}, {0, 4}}};
  const PlanarMap map(std::vector{segment(1, 1, 1, 2, 1), segment(2, 2, 1, 3, 1)},
                      outline);
  EXPECT_EQ(counts(map), (Counts{5 + 3, 5 + 2, 1}));
  EXPECT_EQ(counts(map.without({}).map), counts(map));
}

TEST(PlanarMapWithout, JoinsEdgesAndFaces) {
  // Two crossing segments and a third that ends on one of them.
  const std::vector curves{segment(1, 0, 2, 8, 2), segment(2, 4, 0, 4, 8),
                           segment(3, 6, 2, 6, 6)};
  const PlanarMap map(curves, square(0, 8));
  EXPECT_EQ(counts(map), (Counts{4 + 4 + 2 + 1, 8 + 3 + 2 + 1, 4}));
  std::vector<int> out;
  for (int e = 0; e < map.edge_count(); ++e) {
    const auto ids = map.curves(e);
    if (!ids.empty() && ids[0] != 1) out.push_back(e);
  }
  const ReducedMap less = map.without(out);
  EXPECT_EQ(counts(less.map), (Counts{6, 7, 2}));
  expect_consistent(less.map, 64);
  for (int f = 0; f < map.face_count(); ++f) {
    const PlanePoint p = map.interior_point(f);
    EXPECT_EQ(naive_faces_around(less.map, {nearest_double(p[0]), nearest_double(p[1])}),
              std::vector{less.face_of[f]});
  }
  const int side = [&] {
    for (int e = 0; e < map.edge_count(); ++e) {
      if (map.on_outline(e)) return e;
    }
    return -1;
  }();
  EXPECT_THROW((void)map.without(std::vector{side}), InvalidInput);
}

// The edges of some curves taken out, against a map without these curves.
TEST(PlanarMapWithout, IsTheMapOfTheOtherCurves) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    const auto curves = random_curves(Kind::Mixed, seed, 12, 1000);
    const PlanarMap map(curves, square(0, 1000));
    std::vector<PlaneCurve> kept;
    std::vector<int> out;
    for (const PlaneCurve& c : curves) {
      if (c.id % 3 != 0) kept.push_back(c);
    }
    for (int e = 0; e < map.edge_count(); ++e) {
      if (!map.on_outline(e) && map.curves(e)[0] % 3 == 0) out.push_back(e);
    }
    const ReducedMap less = map.without(out);
    const PlanarMap other(kept, square(0, 1000));
    EXPECT_EQ(counts(less.map), counts(other));
    expect_consistent(less.map, 1e6);
    std::multiset<long> areas, wanted;
    for (int f = 0; f < other.face_count(); ++f) {
      areas.insert(std::lround(less.map.area(f) * 1e3));
      wanted.insert(std::lround(other.area(f) * 1e3));
    }
    EXPECT_EQ(areas, wanted);
    for (int e = 0; e < map.edge_count(); ++e) {
      if (less.edge_of[e] < 0) continue;
      for (const int side : {0, 1}) {
        const int f = map.face(2 * e + side),
                  g = less.map.face(2 * less.edge_of[e] + side);
        EXPECT_EQ(f < 0 ? -1 : less.face_of[f], g);
      }
    }
  }
}

// ---- invariance

// Everything of a map but ids.
void expect_same(const PlanarMap& a, const PlanarMap& b) {
  ASSERT_EQ(counts(a), counts(b));
  for (int v = 0; v < a.vertex_count(); ++v) {
    EXPECT_EQ(a.vertex(v).at, b.vertex(v).at);
    EXPECT_TRUE(std::ranges::equal(a.star(v), b.star(v)));
  }
  for (int h = 0; h < a.half_edge_count(); ++h) {
    EXPECT_EQ(a.origin(h), b.origin(h));
    EXPECT_EQ(a.next(h), b.next(h));
    EXPECT_EQ(a.face(h), b.face(h));
  }
}

TEST(PlanarMapInvariance, OrderOfInput) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    auto curves = random_curves(seed % 2 ? Kind::Mixed : Kind::Overlapping, seed, 20, 12);
    const PlanarMap map(curves, square(0, 12));
    std::ranges::shuffle(curves, std::mt19937(seed));
    PlaneOutline outline = square(0, 12);
    std::ranges::reverse(outline[0]);
    const PlanarMap other(curves, outline);
    expect_same(map, other);
    EXPECT_EQ(id_lists(map), id_lists(other));
  }
}

// x' = a x + b y + c, y' = d x + e y + f.
template <class F>
void expect_invariant(const F& transformed, double scale) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    auto curves = random_curves(seed % 2 ? Kind::Mixed : Kind::Overlapping, seed, 16, 12);
    PlaneOutline outline = square(0, 12);
    const PlanarMap map(curves, outline);
    for (PlaneCurve& c : curves) {
      for (int k = 0; k < 3; ++k) {
        const PlanePoint p = transformed(c.x[k], c.y[k], c.w[k]);
        c.x[k] = p[0];
        c.y[k] = p[1];
      }
    }
    for (PlanePoint& p : outline[0]) p = transformed(p[0], p[1], Rational(1));
    const PlanarMap other(curves, outline);
    ASSERT_EQ(counts(map), counts(other));
    expect_consistent(other, 144 * scale);
    EXPECT_EQ(id_lists(map), id_lists(other));
    std::multiset<long> areas, wanted;
    std::multiset<std::size_t> degrees, wanted_degrees;
    for (int f = 0; f < map.face_count(); ++f) {
      wanted.insert(std::lround(map.area(f) * 1e6));
      areas.insert(std::lround(other.area(f) / scale * 1e6));
    }
    for (int v = 0; v < map.vertex_count(); ++v) {
      wanted_degrees.insert(map.star(v).size());
      degrees.insert(other.star(v).size());
    }
    EXPECT_EQ(areas, wanted);
    EXPECT_EQ(degrees, wanted_degrees);
  }
}

TEST(PlanarMapInvariance, AxesExchanged) {
  expect_invariant(
      [](const Rational& x, const Rational& y, const Rational&) {
        return PlanePoint{y, x};
      },
      1);
}

TEST(PlanarMapInvariance, AffineMaps) {
  expect_invariant(
      [](const Rational& x, const Rational& y, const Rational& w) {
        return PlanePoint{x / 3 - 2 * y + w / 7, 5 * x + y / 11 - 3 * w};
      },
      1. / 33 + 10);
}

INSTANTIATE_TEST_SUITE_P(All, PlanarMapOfRandomCurves,
                         testing::Values(Kind::Segments, Kind::Arcs, Kind::Shortened,
                                         Kind::Mixed, Kind::Overlapping));

}  // namespace
}  // namespace sightline::internal
