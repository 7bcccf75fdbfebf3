// The planar map of arcs in a plane: counts by hand, laws, naive oracles, invariances.

#include "shadows/planar/planar_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "linespace/scene.h"
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

enum class Kind { Segments, Arcs, Shortened, Mixed };

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

INSTANTIATE_TEST_SUITE_P(All, PlanarMapOfRandomCurves,
                         testing::Values(Kind::Segments, Kind::Arcs, Kind::Shortened,
                                         Kind::Mixed));

}  // namespace
}  // namespace sightline::internal
