// Exact aspect graphs of convex solids, against Euler's formula and views computed anew.

#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "aspect/aspect_graph.h"
#include "aspect/cells/space_cells.h"
#include "aspect/cells/sphere_cells.h"
#include "aspect/convex/convex_solid.h"
#include "linespace/point_view.h"
#include "tests/support/add_box.h"
#include "tests/support/add_polygons.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

using internal::CircleNormal;
using testing::add_box;
using testing::add_polygons;

Scene cube() {
  PolygonSoup soup;
  add_box(soup, "cube", {0, 0, 0}, {1, 1, 1});
  return Scene(soup);
}

Scene tetrahedron() {
  const Point o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  PolygonSoup soup;
  add_polygons(soup, "tetrahedron", {{o, y, x}, {o, x, z}, {x, y, z}, {y, o, z}});
  return Scene(soup);
}

/// A prism over a regular polygon whose corners are rounded, its sides still flat.
Scene prism(int sides) {
  std::vector<Point> low, high;
  for (int i = 0; i < sides; ++i) {
    const double a = 2 * std::numbers::pi * i / sides;
    low.emplace_back(std::cos(a), std::sin(a), 0);
    high.emplace_back(std::cos(a), std::sin(a), 1);
  }
  std::vector<std::vector<Point>> faces{{low.rbegin(), low.rend()}, high};
  for (int i = 0; i < sides; ++i) {
    const int j = (i + 1) % sides;
    faces.push_back({low[i], low[j], high[j], high[i]});
  }
  PolygonSoup soup;
  add_polygons(soup, "prism", faces);
  return Scene(soup);
}

/// Two pyramids over a square: 8 planes, four of them through each corner.
Scene octahedron() {
  std::vector<std::vector<Point>> faces;
  const Point ring[] = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  for (int i = 0; i < 4; ++i) {
    faces.push_back({ring[i], ring[(i + 1) % 4], {0, 0, 1}});
    faces.push_back({ring[(i + 1) % 4], ring[i], {0, 0, -1}});
  }
  PolygonSoup soup;
  add_polygons(soup, "octahedron", faces);
  return Scene(soup);
}

/// A cube without a corner, cut off exactly.
Scene box_cut_at_a_corner() {
  const Point a(2, 2, 1), b(2, 1, 2), c(1, 2, 2);
  PolygonSoup soup;
  add_polygons(soup, "cut",
               {{{0, 0, 0}, {0, 2, 0}, {2, 2, 0}, {2, 0, 0}},
                {{0, 0, 0}, {2, 0, 0}, {2, 0, 2}, {0, 0, 2}},
                {{0, 0, 0}, {0, 0, 2}, {0, 2, 2}, {0, 2, 0}},
                {{0, 0, 2}, {2, 0, 2}, b, c, {0, 2, 2}},
                {{2, 0, 0}, {2, 2, 0}, a, b, {2, 0, 2}},
                {{0, 2, 0}, {0, 2, 2}, c, a, {2, 2, 0}},
                {a, c, b}});
  return Scene(soup);
}

std::vector<Scene> solids() {
  std::vector<Scene> out;
  out.push_back(cube());
  out.push_back(tetrahedron());
  out.push_back(octahedron());
  out.push_back(box_cut_at_a_corner());
  for (const int sides : {3, 4, 5, 6, 8, 12}) out.push_back(prism(sides));
  for (std::uint64_t seed = 1; seed <= 30; ++seed)
    out.emplace_back(testing::random_polytopes(seed, 1));
  return out;
}

AspectGraph graph_of(const Scene& scene, Projection projection, bool list = false) {
  AspectRequest request;
  request.projection = projection;
  request.list = list;
  return find_aspects(scene, request);
}

struct Counts {
  std::size_t aspects, adjacencies, by_shape;
  friend bool operator==(const Counts&, const Counts&) = default;
};
std::ostream& operator<<(std::ostream& out, const Counts& c) {
  return out << c.aspects << ' ' << c.adjacencies << ' ' << c.by_shape;
}
Counts counts(const Scene& scene, Projection projection) {
  const AspectGraph graph = graph_of(scene, projection);
  EXPECT_TRUE(graph.certified);
  return {graph.aspects, graph.adjacencies, graph.by_shape};
}

TEST(ConvexAspects, CubeAndTetrahedron) {
  EXPECT_EQ(counts(cube(), Projection::Orthographic), (Counts{8, 12, 1}));
  EXPECT_EQ(counts(cube(), Projection::Perspective), (Counts{26, 48, 3}));
  EXPECT_EQ(counts(tetrahedron(), Projection::Orthographic), (Counts{14, 24, 3}));
  EXPECT_EQ(counts(tetrahedron(), Projection::Perspective), (Counts{14, 24, 3}));
}

// On the sphere V - E + F = 2; of space, cut into open cells, V - E + W - C = -1.
TEST(ConvexAspects, EulersFormula) {
  int asked = 0;
  for (const Scene& scene : solids()) {
    const auto solid = internal::convex_solid(scene);
    if (!solid) continue;
    ++asked;
    // Facets without parallels, so that each is a circle.
    std::vector<CircleNormal> normals;
    std::set<std::array<double, 3>> known;
    for (const internal::LightPlane& plane : solid->planes) {
      CircleNormal n;
      Eigen::Vector3d rounded;
      for (int i = 0; i < 3; ++i) {
        n.near[i] = plane.near[i];
        n.exact[i] = plane.exact[i];
        rounded[i] = plane.near[i].v;
      }
      bool parallel = false;
      for (const CircleNormal& m : normals) {
        parallel |= CGAL::is_zero(n.exact[0] * m.exact[1] - n.exact[1] * m.exact[0]) &&
                    CGAL::is_zero(n.exact[1] * m.exact[2] - n.exact[2] * m.exact[1]) &&
                    CGAL::is_zero(n.exact[2] * m.exact[0] - n.exact[0] * m.exact[2]);
      }
      if (!parallel) normals.push_back(n);
    }
    const internal::SphereCells sphere = internal::sphere_cells(normals);
    EXPECT_EQ(static_cast<int>(sphere.vertices) - static_cast<int>(sphere.walls.size()) +
                  sphere.cells.size(),
              2);
    const internal::SpaceCells space = internal::space_cells(solid->planes, Request{});
    EXPECT_EQ(static_cast<int>(space.vertices) - static_cast<int>(space.edges) +
                  static_cast<int>(space.walls.size()) - space.cells.size(),
              -1);
  }
  EXPECT_GE(asked, 20);
}

// Three planes through one line, and two across it: six sectors in three layers.
TEST(ConvexAspects, PlanesThroughOneLine) {
  std::vector<internal::LightPlane> planes;
  for (const std::array<double, 4>& p : {std::array{1., 0., 0., 0.},
                                         {0., 1., 0., 0.},
                                         {1., -1., 0., 0.},
                                         {0., 0., 1., 0.},
                                         {0., 0., 1., -1.}}) {
    internal::LightPlane plane;
    for (int i = 0; i < 4; ++i) {
      plane.near[i] = {p[i], 0};
      plane.exact[i] = internal::Ring(p[i]);
    }
    planes.push_back(plane);
  }
  const internal::SpaceCells space = internal::space_cells(planes, Request{});
  EXPECT_EQ(space.cells.size(), 18);
  EXPECT_EQ(space.vertices, 2u);
  EXPECT_EQ(space.edges, 3u + 2 * 6);
  EXPECT_EQ(space.walls.size(), 3u * 6 + 2 * 6);
}

// Weights add up, and each view from a listed point is what is told.
TEST(ConvexAspects, ListedViews) {
  for (const Scene& scene : {cube(), tetrahedron(), octahedron()}) {
    const PointViewIndex index(scene);
    for (const Projection p : {Projection::Orthographic, Projection::Perspective}) {
      const AspectGraph graph = graph_of(scene, p, true);
      ASSERT_EQ(graph.list.size(), graph.aspects);
      double sum = 0;
      std::set<std::string> structures;
      std::size_t pairs = 0;
      for (const Aspect& aspect : graph.list) {
        const PointView view = index.view(aspect.at);
        EXPECT_TRUE(view.general);
        std::vector<int> facets;
        for (const SeenFacet& f : view.facets) facets.push_back(f.facet);
        EXPECT_EQ(facets, aspect.facets);
        structures.insert(aspect.structure);
        sum += aspect.weight.value_or(0);
        EXPECT_GT(*aspect.clearance, 0);
        pairs += aspect.neighbours.size();
      }
      EXPECT_EQ(structures.size(), graph.aspects);
      EXPECT_EQ(pairs, 2 * graph.adjacencies);
      if (p == Projection::Orthographic) EXPECT_NEAR(sum, 4 * std::numbers::pi, 1e-12);
    }
  }
}

// Orthographic aspects are the perspective ones that go on for ever all around: from far
// away these facets are seen together.
TEST(ConvexAspects, SeenFromFarAway) {
  for (const Scene& scene :
       {cube(), tetrahedron(), octahedron(), box_cut_at_a_corner()}) {
    std::set<std::vector<int>> far, near;
    for (const Aspect& a : graph_of(scene, Projection::Orthographic, true).list)
      far.insert(a.facets);
    const AspectGraph perspective = graph_of(scene, Projection::Perspective, true);
    for (const Aspect& a : perspective.list) near.insert(a.facets);
    EXPECT_TRUE(std::ranges::includes(near, far));
    EXPECT_LE(far.size(), *perspective.unbounded);
  }
}

// In a box only what lies in it counts, and volumes add up to what is outside the solid.
TEST(ConvexAspects, Bounds) {
  const Scene scene = cube();
  const auto in = [&](const Point& low, const Point& high) {
    AspectRequest request;
    request.projection = Projection::Perspective;
    request.list = true;
    request.bounds = {{low, high}};
    const AspectGraph graph = find_aspects(scene, request);
    EXPECT_TRUE(graph.certified);
    EXPECT_FALSE(graph.unbounded);
    double sum = 0;
    for (const Aspect& a : graph.list) {
      sum += *a.weight;
      for (int i = 0; i < 3; ++i) {
        EXPECT_GT(a.at.at.nearest[i], low[i]);
        EXPECT_LT(a.at.at.nearest[i], high[i]);
      }
    }
    return std::tuple(graph.aspects, graph.adjacencies, sum);
  };
  EXPECT_EQ(in({-1, -1, -1}, {2, 2, 2}), std::tuple(26u, 48u, 26.0));
  // A side of the box in a facet's plane.
  EXPECT_EQ(in({-1, -1, 1}, {2, 2, 3}), std::tuple(9u, 12u, 18.0));
  EXPECT_EQ(in({2, 2, 2}, {3, 4, 5}), std::tuple(1u, 0u, 6.0));
  // Without bounds volumes are of the box three times as large.
  double sum = 0;
  for (const Aspect& a : graph_of(scene, Projection::Perspective, true).list)
    sum += *a.weight;
  EXPECT_NEAR(sum, 26, 1e-12);
}

// Samples find the exact graph's labels, and no others.
TEST(ConvexAspects, SamplesAgree) {
  for (const Scene& scene : {cube(), tetrahedron(), octahedron(), prism(5)}) {
    const AspectGraph exact = graph_of(scene, Projection::Orthographic, true);
    if (!exact.certified) continue;
    std::set<std::string> known;
    for (const Aspect& a : exact.list) known.insert(a.structure);
    AspectRequest request;
    request.method = AspectMethod::Sampled;
    request.samples = 642;
    request.list = true;
    const AspectGraph sampled = find_aspects(scene, request);
    EXPECT_EQ(sampled.by_shape, exact.by_shape);
    EXPECT_EQ(sampled.distinct, exact.distinct);
    for (const Aspect& a : sampled.list) EXPECT_TRUE(known.contains(a.structure));
  }
}

}  // namespace
}  // namespace sightline
