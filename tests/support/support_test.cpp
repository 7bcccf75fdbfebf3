// The generators make what they promise: closed solids, disjoint where they should be,
// the same for the same seed; and the naive oracles answer cases worked out by hand.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdio>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "tests/support/generators.h"
#include "tests/support/naive_boxes.h"
#include "tests/support/naive_ev.h"

namespace sightline::testing {
namespace {

/// Six times the enclosed volume of a group; positive when its faces face outwards.
double signed_volume(const PolygonSoup& soup, const PolygonSoup::Group& group) {
  double result = 0;
  const Point& origin = soup.vertices[soup.polygons[group.faces[0]][0]];
  for (const int f : group.faces) {
    const std::vector<int>& face = soup.polygons[f];
    for (std::size_t i = 2; i < face.size(); ++i) {
      const Point a = soup.vertices[face[0]] - origin;
      const Point b = soup.vertices[face[i - 1]] - origin;
      const Point c = soup.vertices[face[i]] - origin;
      result += a.dot(b.cross(c));
    }
  }
  return result;
}

/// Every group is a closed surface, consistently oriented, facing outwards.
void expect_solids(const PolygonSoup& soup) {
  std::vector<bool> used(soup.polygons.size(), false);
  for (const PolygonSoup::Group& group : soup.groups) {
    std::set<std::pair<int, int>> sides;
    std::set<int> vertices;
    for (const int f : group.faces) {
      EXPECT_FALSE(used[f]);
      used[f] = true;
      const std::vector<int>& face = soup.polygons[f];
      for (std::size_t i = 0; i < face.size(); ++i) {
        EXPECT_TRUE(sides.insert({face[i], face[(i + 1) % face.size()]}).second);
        vertices.insert(face[i]);
      }
    }
    for (const auto& [a, b] : sides) EXPECT_TRUE(sides.contains({b, a}));
    EXPECT_EQ(vertices.size() + group.faces.size(), sides.size() / 2 + 2) << "Euler";
    EXPECT_GT(signed_volume(soup, group), 0) << soup.source << " " << group.name;
  }
  EXPECT_EQ(std::ranges::count(used, false), 0);
}

/// Largest and smallest of a direction's values over a group.
std::pair<double, double> extent(const PolygonSoup& soup, const PolygonSoup::Group& group,
                                 const Point& direction) {
  std::pair<double, double> result = {1e300, -1e300};
  for (const int f : group.faces) {
    for (const int v : soup.polygons[f]) {
      const double x = direction.dot(soup.vertices[v]);
      result = {std::min(result.first, x), std::max(result.second, x)};
    }
  }
  return result;
}

/// A separating direction for each pair of convex groups, by a search of its own: face
/// normals and edge cross products, in doubles with a margin.
void expect_disjoint(const PolygonSoup& soup) {
  std::vector<std::vector<Point>> normals, edges;
  for (const PolygonSoup::Group& group : soup.groups) {
    normals.emplace_back();
    edges.emplace_back();
    for (const int f : group.faces) {
      const std::vector<int>& face = soup.polygons[f];
      const Point u = soup.vertices[face[1]] - soup.vertices[face[0]];
      const Point v = soup.vertices[face[2]] - soup.vertices[face[1]];
      normals.back().push_back(u.cross(v).normalized());
      for (std::size_t i = 0; i < face.size(); ++i) {
        edges.back().push_back(soup.vertices[face[(i + 1) % face.size()]] -
                               soup.vertices[face[i]]);
      }
    }
  }
  for (std::size_t i = 0; i < soup.groups.size(); ++i) {
    for (std::size_t j = i + 1; j < soup.groups.size(); ++j) {
      std::vector<Point> directions = normals[i];
      directions.insert(directions.end(), normals[j].begin(), normals[j].end());
      for (const Point& a : edges[i]) {
        for (const Point& b : edges[j]) {
          if (a.cross(b).norm() > 1e-9) directions.push_back(a.cross(b).normalized());
        }
      }
      const bool apart = std::ranges::any_of(directions, [&](const Point& d) {
        const auto p = extent(soup, soup.groups[i], d);
        const auto q = extent(soup, soup.groups[j], d);
        return p.second < q.first - 1e-9 || q.second < p.first - 1e-9;
      });
      EXPECT_TRUE(apart) << soup.source << ": " << i << " and " << j;
    }
  }
}

TEST(Generators, PolytopesAreDisjointSolidsOfTheAskedSize) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const PolygonSoup soup = random_polytopes(
        seed, 6, {.min_vertices = 4, .max_vertices = 20, .density = 0.2});
    ASSERT_EQ(soup.groups.size(), 6u);
    expect_solids(soup);
    expect_disjoint(soup);
    for (const auto& polygon : soup.polygons) EXPECT_EQ(polygon.size(), 3u);
  }
  const PolygonSoup tetrahedra =
      random_polytopes(1, 50, {.min_vertices = 4, .max_vertices = 4});
  EXPECT_EQ(tetrahedra.polygons.size(), 200u);
  expect_solids(tetrahedra);
}

TEST(Generators, ParallelepipedsArePlanarAndDisjoint) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const PolygonSoup soup = random_parallelepipeds(seed, 5, {.density = 0.15});
    expect_solids(soup);
    expect_disjoint(soup);
    for (const auto& f : soup.polygons) {
      // Multiples of 2^-12 below 2^6: these sums are exact.
      EXPECT_EQ(soup.vertices[f[0]] + soup.vertices[f[2]],
                soup.vertices[f[1]] + soup.vertices[f[3]]);
    }
  }
}

TEST(Generators, BoxesAreSolids) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    for (const PolygonSoup& soup :
         {random_boxes(seed, 8), rotated_boxes(seed, 8),
          random_boxes(seed, 8, {.grid = 8, .min_size = 1, .max_size = 3})}) {
      EXPECT_EQ(soup.groups.size(), 8u);
      expect_solids(soup);
      expect_disjoint(soup);
    }
    expect_solids(random_boxes(
        seed, 12, {.grid = 6, .may_touch = true, .min_size = 1, .max_size = 3}));
  }
}

TEST(Generators, TouchingBoxesTouchAndDoNotOverlap) {
  for (const Touching kind : all_touching()) {
    SCOPED_TRACE(name(kind));
    const PolygonSoup soup = touching_boxes(kind);
    expect_solids(soup);
    int touching = 0;
    for (std::size_t i = 0; i < soup.groups.size(); ++i) {
      for (std::size_t j = i + 1; j < soup.groups.size(); ++j) {
        bool open_overlap = true, closed_overlap = true;
        for (int axis = 0; axis < 3; ++axis) {
          const auto p = extent(soup, soup.groups[i], Point::Unit(axis));
          const auto q = extent(soup, soup.groups[j], Point::Unit(axis));
          open_overlap &= p.first < q.second && q.first < p.second;
          closed_overlap &= p.first <= q.second && q.first <= p.second;
        }
        EXPECT_FALSE(open_overlap) << i << " " << j;
        touching += closed_overlap;
      }
    }
    EXPECT_GE(touching, 1);
  }
}

TEST(Generators, CitiesStandOnTheirSlab) {
  for (const PolygonSoup& soup :
       {city(3, 1000), grid_city(3, 1000), grid_city(3, 1000, {.may_touch = true})}) {
    EXPECT_EQ(soup.polygons.size(), 996u);
    EXPECT_EQ(soup.groups.size(), 166u);
    expect_solids(soup);
    const auto ground = soup.groups[0];
    for (std::size_t g = 1; g < soup.groups.size(); ++g) {
      EXPECT_EQ(extent(soup, soup.groups[g], Point::UnitZ()).first, 0);
      for (const Point& axis : {Point(1, 0, 0), Point(0, 1, 0)}) {
        const auto outer = extent(soup, ground, axis);
        const auto inner = extent(soup, soup.groups[g], axis);
        EXPECT_LT(outer.first, inner.first);
        EXPECT_LT(inner.second, outer.second);
      }
    }
    EXPECT_EQ(extent(soup, ground, Point::UnitZ()).second, 0);
  }
  // Streets: footprints are disjoint, and grid cities share roofs' heights.
  for (const PolygonSoup& soup : {city(5, 300), grid_city(5, 300)}) {
    PolygonSoup buildings = soup;
    buildings.groups.erase(buildings.groups.begin());
    expect_disjoint(buildings);
  }
}

TEST(Generators, StreetCitiesFillTheirLots) {
  for (const bool square : {false, true}) {
    for (const double bottom : {0.0, -1.0, 0.001}) {
      const PolygonSoup soup = street_city(3, 1000, {.square = square, .bottom = bottom});
      EXPECT_EQ(soup.polygons.size(), 996u);
      EXPECT_EQ(soup.groups.size(), 166u);
      expect_solids(soup);
      // 13 columns, 13 rows.
      using Range = std::pair<double, double>;
      const auto range = [&](std::size_t g, const Point& axis) -> Range {
        return extent(soup, soup.groups[g], axis);
      };
      EXPECT_EQ(range(0, Point::UnitX()), Range(-10, 140));
      EXPECT_EQ(range(0, Point::UnitY()), Range(-10, 140));
      EXPECT_EQ(range(0, Point::UnitZ()), Range(-5, 0));
      for (std::size_t g = 1; g < soup.groups.size(); ++g) {
        const double column = 10.0 * static_cast<double>((g - 1) % 13);
        const double row = 10.0 * static_cast<double>((g - 1) / 13);
        for (const auto& [axis, corner] :
             {std::pair{Point(1, 0, 0), column}, std::pair{Point(0, 1, 0), row}}) {
          const auto [low, high] = range(g, axis);
          EXPECT_GE(low, corner);
          EXPECT_LE(low, corner + (square ? 0 : 2));
          EXPECT_GE(high - low, square ? 4 : 3);
          EXPECT_LE(high - low, 7);
        }
        EXPECT_EQ(range(g, Point::UnitZ()).first, bottom);
        EXPECT_GE(range(g, Point::UnitZ()).second, 2);
        EXPECT_LE(range(g, Point::UnitZ()).second, 25);
      }
      PolygonSoup buildings = soup;
      buildings.groups.erase(buildings.groups.begin());
      expect_disjoint(buildings);
    }
  }
  EXPECT_EQ(cut_into_triangles(street_city(1, 100)).polygons.size(), 192u);
  expect_solids(cut_into_triangles(street_city(1, 100)));
}

TEST(Generators, SameSeedSameScene) {
  const PolygonSoup a = random_polytopes(7, 4), b = random_polytopes(7, 4);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.polygons, b.polygons);
  EXPECT_NE(a.vertices, random_polytopes(8, 4).vertices);
  // Fixed for ever: benchmarks of different days compare the same scenes.
  EXPECT_EQ(Random(1).integer(0, 999999), 311528);
}

TEST(Generators, ObjKeepsEveryBit) {
  const PolygonSoup soup = city(1, 60);
  const std::string path = ::testing::TempDir() + "sightline_support_test.obj";
  write_obj(path, soup);
  std::ifstream file(path);
  std::vector<Point> vertices;
  int faces = 0, groups = 0;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    faces += key == "f";
    groups += key == "o";
    if (key != "v") continue;
    std::string x, y, z;
    words >> x >> y >> z;
    vertices.emplace_back(std::stod(x), std::stod(y), std::stod(z));
  }
  std::remove(path.c_str());
  EXPECT_EQ(vertices, soup.vertices);
  EXPECT_EQ(faces, 60);
  EXPECT_EQ(groups, 10);
}

TEST(NaiveEv, IsDefinedForGeneralPositionOnly) {
  EXPECT_THROW((void)naive_ev(touching_boxes(Touching::Row)), NotGeneral);
  EXPECT_THROW((void)naive_ev(random_boxes(1, 3, {.grid = 9, .max_size = 3})),
               NotGeneral);
}

// The identity 2 EV = 4 VV + VEE + FvE and the match of arcs' ends with nodes are checked
// inside; every kind must occur for that to mean anything.
TEST(NaiveEv, FindsEveryKindAndEachOnce) {
  const CanonicalSkeleton s =
      naive_ev(random_polytopes(14, 5, {.max_vertices = 8, .density = 0.25}));
  for (const char* kind : {"VV", "VEE", "EVE", "FvE", "EV"}) {
    EXPECT_GT(s.counts()[kind], 0) << kind;
  }
  EXPECT_EQ(std::ranges::adjacent_find(s.nodes), s.nodes.end());
}

TEST(BoxUnion, KnowsItsCornersAndRidges) {
  const BoxUnion flush(touching_boxes(Touching::FaceFlush));
  EXPECT_TRUE(flush.is_corner({0, 0, 0}));
  EXPECT_TRUE(flush.is_corner({2, 0, 2}));   // where the higher wall starts
  EXPECT_FALSE(flush.is_corner({2, 0, 0}));  // inside an edge of the union
  EXPECT_TRUE(flush.is_ridge({2, 0, 3}, 2));
  EXPECT_FALSE(flush.is_ridge({2, 0, 1}, 2));  // inside the common front wall
  EXPECT_FALSE(flush.is_ridge({2, 1, 2}, 1));  // a valley
  const BoxUnion diagonal(touching_boxes(Touching::Edge));
  EXPECT_FALSE(diagonal.is_ridge({2, 2, 1}, 2));
}

TEST(BoxUnion, JudgesContactsByNearbyLines) {
  const auto judge = [](Touching kind, const Point& a, const Point& b) {
    return BoxUnion(touching_boxes(kind)).judge(a, b);
  };
  // Between two boxes that share an edge no line passes across it.
  EXPECT_FALSE(judge(Touching::Edge, {1, 3, 1}, {3, 1, 1}).free);
  // Where edges cross, a slit is left that only tilted lines pass.
  EXPECT_TRUE(judge(Touching::CrossedEdges, {2, 3, 2}, {4, 1, 2}).free);
  EXPECT_FALSE(judge(Touching::CrossedEdges, {2, 1, 2}, {4, 3, 2}).free);
  // Nor does a line pass in the plane of a common face, but over a row of roofs it does.
  EXPECT_FALSE(judge(Touching::FaceToFace, {2, -1, 1}, {2, 3, 1}).free);
  EXPECT_TRUE(judge(Touching::Row, {-1, 0.5, 1}, {6, 0.25, 1}).free);
  EXPECT_TRUE(judge(Touching::Row, {-1, 0.5, 1}, {6, 0.25, 1}).edge_on);
  EXPECT_FALSE(judge(Touching::RowOfDifferent, {-1, 1, 2}, {6, 1, 2}).free);
  EXPECT_TRUE(judge(Touching::RowOfDifferent, {2, -1, 4}, {2, 5, 4}).free);
  // Down a shaft whose walls touch along edges, and through the touching edges.
  EXPECT_TRUE(judge(Touching::Around, {3, 3, -1}, {3, 3, 5}).free);
  EXPECT_TRUE(judge(Touching::Around, {2, 3, -1}, {2, 3, 5}).free);
  EXPECT_FALSE(judge(Touching::Around, {1, 1, 1}, {5, 5, 1}).free);
  EXPECT_TRUE(judge(Touching::Corner, {2, 2, 5}, {2, 2, -1}).free);
}

}  // namespace
}  // namespace sightline::testing
