#include "linespace/scene.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "linespace/mesh_io.h"
#include "linespace/predicates.h"
#include "linespace/space/bvh.h"

namespace sightline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

PolygonSoup soup(std::vector<Point> vertices, std::vector<std::vector<int>> polygons,
                 std::vector<PolygonSoup::Group> groups = {}) {
  return {std::move(vertices), std::move(polygons), std::move(groups), ""};
}

// Appends an axis-aligned box of six quads, its own vertices, front outside.
void add_box(PolygonSoup& s, const Point& low, const Point& high,
             const std::string& name = "") {
  const int n = static_cast<int>(s.vertices.size());
  for (int i = 0; i < 8; ++i) {
    s.vertices.emplace_back((i & 1 ? high : low)[0], (i & 2 ? high : low)[1],
                            (i & 4 ? high : low)[2]);
  }
  std::vector<int> faces;
  for (const auto& q : std::vector<std::vector<int>>{{0, 2, 3, 1},
                                                     {4, 5, 7, 6},
                                                     {0, 1, 5, 4},
                                                     {1, 3, 7, 5},
                                                     {3, 2, 6, 7},
                                                     {2, 0, 4, 6}}) {
    faces.push_back(static_cast<int>(s.polygons.size()));
    s.polygons.push_back({n + q[0], n + q[1], n + q[2], n + q[3]});
  }
  if (!name.empty()) s.groups.push_back({name, faces});
}

PolygonSoup box(const Point& low = {0, 0, 0}, const Point& high = {1, 1, 1}) {
  PolygonSoup s;
  add_box(s, low, high);
  return s;
}

PolygonSoup triangulated(PolygonSoup s) {
  std::vector<std::vector<int>> triangles;
  for (const auto& p : s.polygons) {
    for (std::size_t i = 1; i + 1 < p.size(); ++i)
      triangles.push_back({p[0], p[i], p[i + 1]});
  }
  s.polygons = triangles;
  s.groups.clear();
  return s;
}

PolygonSoup reversed(PolygonSoup s) {
  for (auto& p : s.polygons) std::reverse(p.begin(), p.end());
  return s;
}

PolygonSoup in_file(const std::string& name) {
  return read_mesh(std::string(SIGHTLINE_TEST_DATA) + "/defects/" + name);
}

std::array<int, 5> counts(const MeshEdgeCounts& c) {
  return {c.convex, c.reflex, c.flat, c.boundary, c.nonmanifold};
}

std::map<std::string, int> kinds(const std::vector<Defect>& defects) {
  std::map<std::string, int> found;
  for (const Defect& d : defects) ++found[d.kind];
  return found;
}
using Kinds = std::map<std::string, int>;

double area(const Scene& scene) {
  double sum = 0;
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    const auto ids = scene.face_points(static_cast<int>(f));
    for (std::size_t i = 1; i + 1 < ids.size(); ++i) {
      const Point &a = scene.point(ids[0]), &b = scene.point(ids[i]);
      sum += (b - a).cross(scene.point(ids[i + 1]) - a).norm() / 2;
    }
  }
  return sum;
}

// What every scene promises.
void check_invariants(const Scene& scene) {
  for (std::size_t i = 0; i < scene.faces().size(); ++i) {
    const int f = static_cast<int>(i);
    const auto ids = scene.face_points(f);
    ASSERT_GE(ids.size(), 3u);
    const Point &a = scene.point(ids[0]), &b = scene.point(ids[1]),
                &c = scene.point(ids[2]);
    ASSERT_FALSE(collinear(a, b, c)) << "first corners of face " << f;
    for (const int p : ids) {
      ASSERT_EQ(orient3d(a, b, c, scene.point(p)), Sign::Zero) << "face " << f;
      const auto at = scene.faces_at(p);
      ASSERT_NE(std::find(at.begin(), at.end(), f), at.end());
    }
    const auto& facet = scene.facets()[scene.faces()[i].facet];
    ASSERT_NE(std::find(facet.faces.begin(), facet.faces.end(), f), facet.faces.end());
    ASSERT_EQ(facet.object, scene.faces()[i].object);
    if (facet.planar) {
      for (const int p : scene.face_points(facet.faces[0])) {
        ASSERT_EQ(orient3d(a, b, c, scene.point(p)), Sign::Zero);
      }
    }
    for (std::size_t k = 0; k < ids.size(); ++k) {
      const int e = scene.edge_of_side(f, static_cast<int>(k));
      if (e < 0) continue;
      const Edge& edge = scene.edges()[e];
      const Point &p = scene.point(edge.points[0]), &q = scene.point(edge.points[1]);
      ASSERT_TRUE(collinear(p, q, scene.point(ids[k])));
      ASSERT_TRUE(collinear(p, q, scene.point(ids[(k + 1) % ids.size()])));
      const Point along = scene.point(ids[(k + 1) % ids.size()]) - scene.point(ids[k]);
      const bool forward = along.dot(q - p) > 0;
      ASSERT_TRUE(std::any_of(edge.sides.begin(), edge.sides.end(), [&](const auto& s) {
        return scene.faces()[s.face].facet == scene.faces()[f].facet &&
               s.forward == forward;
      }));
    }
  }
  std::set<int> ends;
  for (std::size_t e = 0; e < scene.edges().size(); ++e) {
    const Edge& edge = scene.edges()[e];
    ASSERT_LT(edge.points[0], edge.points[1]);
    ASSERT_NE(edge.kind, EdgeKind::Flat);
    for (const auto& side : edge.sides) {
      ASSERT_EQ(scene.faces()[side.face].object, edge.object);
    }
    if (edge.kind == EdgeKind::Convex || edge.kind == EdgeKind::Reflex) {
      ASSERT_EQ(edge.sides.size(), 2u);
      ASSERT_TRUE(edge.sides[0].forward);
      ASSERT_FALSE(edge.sides[1].forward);
    }
    for (const int p : edge.points) {
      ends.insert(p);
      const auto at = scene.edges_at(p);
      ASSERT_NE(std::find(at.begin(), at.end(), static_cast<int>(e)), at.end());
    }
  }
  const auto corners = scene.corners();
  ASSERT_EQ(std::vector<int>(ends.begin(), ends.end()),
            std::vector<int>(corners.begin(), corners.end()));
}

// Convexity of an object by its definition.
bool naive_convex(const Scene& scene, int object) {
  const Object& o = scene.objects()[object];
  if (!o.closed) return false;
  bool some_behind = false;
  for (const int f : o.faces) {
    const auto t = scene.face_points(f);
    for (const int g : o.faces) {
      for (const int p : scene.face_points(g)) {
        const Sign s = orient3d(scene.point(t[0]), scene.point(t[1]), scene.point(t[2]),
                                scene.point(p));
        if (s == Sign::Positive) return false;
        some_behind = some_behind || s == Sign::Negative;
      }
    }
  }
  return some_behind;
}

TEST(Scene, CubeOfQuadsAndOfTriangles) {
  for (const bool triangles : {false, true}) {
    const Scene scene(triangles ? triangulated(box()) : box());
    check_invariants(scene);
    EXPECT_EQ(counts(scene.mesh_edges()),
              (std::array<int, 5>{12, 0, triangles ? 6 : 0, 0, 0}));
    EXPECT_EQ(scene.faces().size(), triangles ? 12u : 6u);
    EXPECT_EQ(scene.facets().size(), 6u);
    EXPECT_EQ(scene.edges().size(), 12u);
    EXPECT_EQ(scene.corners().size(), 8u);
    EXPECT_EQ(scene.solids(), 1);
    ASSERT_EQ(scene.objects().size(), 1u);
    EXPECT_EQ(scene.objects()[0].name, "component0");
    EXPECT_TRUE(scene.objects()[0].closed);
    EXPECT_TRUE(scene.objects()[0].convex);
    for (const int p : scene.corners()) EXPECT_EQ(scene.edges_at(p).size(), 3u);
    EXPECT_TRUE(validate(scene).empty());
  }
}

// Its edges count with the fronts of the file; it is taken turned outwards.
TEST(Scene, InsideOutCubeIsReflexAndARoom) {
  const Scene scene(reversed(box()));
  EXPECT_EQ(counts(scene.mesh_edges()), (std::array<int, 5>{0, 12, 0, 0, 0}));
  EXPECT_TRUE(scene.objects()[0].closed);
  EXPECT_TRUE(scene.objects()[0].convex && scene.objects()[0].inside_out);
  EXPECT_EQ(scene.edges()[0].kind, EdgeKind::Convex);
  ASSERT_EQ(validate(scene).size(), 1U);
  EXPECT_EQ(validate(scene)[0].kind, "inside-out");
  EXPECT_EQ(scene.solids(), 1);
}

// An L-shaped prism: caps of six corners are cut, walls stay quads.
TEST(Scene, PrismOverAnL) {
  std::vector<Point> v;
  const double outline[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (const double z : {0., 1.}) {
    for (const auto& p : outline) v.emplace_back(p[0], p[1], z);
  }
  std::vector<std::vector<int>> polygons{{5, 4, 3, 2, 1, 0}, {6, 7, 8, 9, 10, 11}};
  for (int i = 0; i < 6; ++i) {
    const int j = (i + 1) % 6;
    polygons.push_back({i, j, j + 6, i + 6});
  }
  const Scene scene(soup(v, polygons));
  check_invariants(scene);
  EXPECT_EQ(counts(scene.mesh_edges()), (std::array<int, 5>{17, 1, 0, 0, 0}));
  EXPECT_EQ(scene.edges().size(), 18u);
  EXPECT_EQ(scene.facets().size(), 8u);
  EXPECT_EQ(scene.faces().size(), 6u + 2 * 4);
  for (const Facet& facet : scene.facets()) EXPECT_TRUE(facet.planar);
  EXPECT_TRUE(scene.objects()[0].closed);
  EXPECT_FALSE(scene.objects()[0].convex);
  EXPECT_EQ(kinds(validate(scene)), (Kinds{{"non-convex polygon", 2}}));
}

// Each side of the box is a grid of n x n quads, cut into triangles.
PolygonSoup grid_box(int n) {
  PolygonSoup s;
  const auto side = [&](const Point& origin, const Point& u, const Point& v) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const int first = static_cast<int>(s.vertices.size());
        s.vertices.push_back(origin + i * u + j * v);
        s.vertices.push_back(origin + (i + 1) * u + j * v);
        s.vertices.push_back(origin + (i + 1) * u + (j + 1) * v);
        s.vertices.push_back(origin + i * u + (j + 1) * v);
        s.polygons.push_back({first, first + 1, first + 2});
        s.polygons.push_back({first, first + 2, first + 3});
      }
    }
  };
  const Point x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  side({0, 0, 0}, y, x);
  side(n * z, x, y);
  side({0, 0, 0}, x, z);
  side(n * y, z, x);
  side({0, 0, 0}, z, y);
  side(n * x, y, z);
  return s;
}

TEST(Scene, JoinsCollinearEdgesAndCoplanarFaces) {
  for (const int n : {1, 2, 5}) {
    const Scene scene(grid_box(n));
    check_invariants(scene);
    EXPECT_EQ(scene.edges().size(), 12u);
    EXPECT_EQ(scene.corners().size(), 8u);
    EXPECT_EQ(scene.facets().size(), 6u);
    EXPECT_EQ(counts(scene.mesh_edges()),
              (std::array<int, 5>{12 * n, 0, 6 * (n * n + 2 * n * (n - 1)), 0, 0}));
    EXPECT_TRUE(scene.objects()[0].convex);
  }
}

TEST(Scene, JoinsEdgesWhereOthersMeetThatAreAlike) {
  // A square with a corner inside a side, and a triangle that hangs from there: the side
  // goes straight on, as it would without that corner.
  const Scene hanging(soup(
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, -1, 1}, {1, -1, 2}},
      {{0, 1, 2, 3, 4}, {1, 5, 6}}));
  check_invariants(hanging);
  EXPECT_EQ(hanging.edges().size(), 7u);
  EXPECT_EQ(hanging.corners().size(), 7u);
  // A square with a corner inside a side, half of which carries a fin.
  const Scene scene(
      soup({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {0, 1, 0}, {1, 1, 1}},
           {{0, 1, 2, 3, 4}, {3, 2, 5}}));
  check_invariants(scene);
  // Sides: 2-3 is an edge of two faces, 3-4 a border; collinear, but unlike.
  EXPECT_EQ(scene.edges().size(), 7u);
  EXPECT_EQ(scene.corners().size(), 6u);
}

TEST(Scene, PolygonWithCornersOnItsSidesStaysWhole) {
  const Scene scene(
      soup({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, {{0, 1, 2, 3, 4}}));
  check_invariants(scene);
  ASSERT_EQ(scene.faces().size(), 1u);
  EXPECT_EQ(scene.face_points(0).size(), 5u);
  EXPECT_EQ(scene.edges().size(), 4u);
  EXPECT_EQ(scene.mesh_edges().boundary, 5);
  EXPECT_TRUE(scene.defects().empty());
}

TEST(Scene, WeldsEqualCoordinatesAndBothZeros) {
  const Scene scene(
      soup({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, -0.0, -0.0}, {-0.0, 1, 0}, {1, 1, 0}},
           {{0, 1, 2}, {3, 5, 4}}));
  EXPECT_EQ(scene.points().size(), 4u);
  EXPECT_EQ(counts(scene.mesh_edges()), (std::array<int, 5>{0, 0, 1, 4, 0}));
  EXPECT_EQ(scene.vertex_of(3), 5);
}

TEST(Scene, FoldedSheetHasConvexEdgesAndIsNoConvexSolid) {
  const Scene scene(soup({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 0}}));
  EXPECT_EQ(counts(scene.mesh_edges()), (std::array<int, 5>{3, 0, 0, 0, 0}));
  EXPECT_TRUE(scene.objects()[0].closed);
  EXPECT_FALSE(scene.objects()[0].convex);
}

TEST(Scene, RotatedQuadsAreFlatByDeclaration) {
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(0.7, Point(1, 2, 3).normalized())).toRotationMatrix();
  PolygonSoup s = box();
  for (Point& p : s.vertices) p = turn * p + Point(0.3, 0.1, 0.7);
  const Scene scene(s);
  check_invariants(scene);
  EXPECT_GT(kinds(validate(scene))["non-planar polygon"], 0);
  EXPECT_EQ(scene.facets().size(), 6u);
  EXPECT_EQ(scene.edges().size(), 12u);
  EXPECT_EQ(counts(scene.mesh_edges()), (std::array<int, 5>{12, 0, 0, 0, 0}));
  int planar = 0;
  for (const Facet& facet : scene.facets()) planar += facet.planar;
  EXPECT_EQ(planar, 6 - kinds(validate(scene))["non-planar polygon"]);

  // Its triangles alone carry no such declaration; a tolerance makes one.
  const Scene exact(triangulated(s));
  EXPECT_GT(exact.facets().size(), 6u);
  const Scene tolerant(triangulated(s), {.flatness = 1e-12});
  check_invariants(tolerant);
  EXPECT_EQ(tolerant.facets().size(), 6u);
  EXPECT_EQ(tolerant.edges().size(), 12u);
  EXPECT_EQ(kinds(validate(tolerant)), (Kinds{{"declared flat", 1}}));
}

TEST(Scene, FlatnessLeavesLargerAnglesAlone) {
  // Two triangles of a roof with slope 0.1.
  const auto roof =
      soup({{0, 0, 0}, {0, 1, 0}, {1, 0, -0.1}, {-1, 0, 0}}, {{0, 2, 1}, {0, 1, 3}});
  EXPECT_EQ(Scene(roof).mesh_edges().convex, 1);
  EXPECT_EQ(Scene(roof, {.flatness = 0.0996}).mesh_edges().convex, 1);
  const Scene flat(roof, {.flatness = 0.0997});
  EXPECT_EQ(flat.mesh_edges().flat, 1);
  EXPECT_FALSE(flat.facets()[0].planar);
  EXPECT_NE(flat.defects()[0].message.find("0.0997"), std::string::npos);
}

TEST(Scene, ObjectsAreGroupsOrComponentsInOrderOfFirstFace) {
  PolygonSoup s;
  add_box(s, {0, 0, 0}, {1, 1, 1});
  add_box(s, {5, 0, 0}, {6, 1, 1}, "named");
  add_box(s, {1, 1, 1}, {2, 2, 2});  // touches the first in a corner: one component
  add_box(s, {9, 0, 0}, {10, 1, 1});
  const Scene scene(s);
  ASSERT_EQ(scene.objects().size(), 3u);
  EXPECT_EQ(scene.objects()[0].name, "named");
  EXPECT_EQ(scene.objects()[1].name, "component0");
  EXPECT_EQ(scene.objects()[2].name, "component1");
  EXPECT_EQ(scene.objects()[1].faces.size(), 12u);
  EXPECT_TRUE(scene.objects()[1].closed);
  EXPECT_FALSE(scene.objects()[1].convex);
  EXPECT_TRUE(scene.objects()[2].convex);
  EXPECT_EQ(scene.object_named("component1"), 2);
  EXPECT_EQ(scene.faces_named("#5-6"), (std::vector<int>{5, 6}));
  EXPECT_EQ(scene.faces_named("named").front(), 6);
  for (const char* const name : {"nobody", "#3-2", "#0-99", "#1", "#-1-2", "#0-1x", ""}) {
    EXPECT_THROW((void)scene.faces_named(name), InvalidInput) << name;
    EXPECT_THROW((void)scene.object_named(name), InvalidInput) << name;
  }
  try {
    (void)scene.object_named("nobody");
  } catch (const InvalidInput& error) {
    EXPECT_STREQ(
        error.what(),
        "no group named 'nobody'; there are 'named', 'component0', 'component1'");
  }
}

TEST(Scene, EdgesDoNotJoinObjects) {
  PolygonSoup s;
  add_box(s, {0, 0, 0}, {1, 1, 1}, "left");
  add_box(s, {1, 0, 0}, {2, 1, 1}, "right");
  const Scene named(s);
  EXPECT_EQ(counts(named.mesh_edges()), (std::array<int, 5>{24, 0, 0, 0, 0}));
  EXPECT_EQ(named.points().size(), 12u);
  EXPECT_EQ(named.solids(), 2);
  EXPECT_TRUE(validate(named).empty());  // solids may touch
  s.groups.clear();
  const Scene welded(s);
  EXPECT_EQ(welded.objects().size(), 1u);
  EXPECT_EQ(counts(welded.mesh_edges()), (std::array<int, 5>{16, 0, 0, 0, 4}));
  EXPECT_EQ(kinds(validate(welded))["duplicate face"], 1);
  EXPECT_TRUE(welded.objects()[0].closed);
  EXPECT_FALSE(welded.objects()[0].convex);
}

TEST(Scene, ConvexAgreesWithItsDefinition) {
  // Bipyramids over a convex or a star-shaped outline, some dented.
  int convex = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 rng(seed);
    const auto uniform = [&](double lo, double hi) {
      return std::uniform_real_distribution<double>(lo, hi)(rng);
    };
    const int n = 3 + static_cast<int>(rng() % 6);
    std::vector<Point> v{{uniform(-0.3, 0.3), uniform(-0.3, 0.3), 1},
                         {uniform(-0.3, 0.3), uniform(-0.3, 0.3), uniform(-1, 0.2)}};
    const double dent = seed % 3 == 0 ? 0.5 : 1;
    for (int i = 0; i < n; ++i) {
      const double angle = 6.283185307179586 * (i + uniform(-0.2, 0.2)) / n;
      const double r = i == 0 ? dent : 1;
      v.emplace_back(r * std::cos(angle), r * std::sin(angle),
                     seed % 5 == 0 ? uniform(-0.2, 0.2) : 0);
    }
    std::vector<std::vector<int>> polygons;
    for (int i = 0; i < n; ++i) {
      const int a = 2 + i, b = 2 + (i + 1) % n;
      polygons.push_back({a, b, 0});
      polygons.push_back({b, a, 1});
    }
    const Scene scene(soup(v, polygons));
    ASSERT_EQ(scene.objects()[0].convex, naive_convex(scene, 0));
    convex += scene.objects()[0].convex;
  }
  EXPECT_GT(convex, 30);
  EXPECT_LT(convex, 270);
  // Two nested cubes in one group: every edge is convex, the whole is not.
  PolygonSoup nested;
  add_box(nested, {0, 0, 0}, {4, 4, 4}, "nested");
  add_box(nested, {1, 1, 1}, {3, 3, 3});
  nested.groups[0].faces = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  const Scene scene(nested);
  EXPECT_TRUE(scene.objects()[0].closed);
  EXPECT_FALSE(scene.objects()[0].convex);
  EXPECT_EQ(scene.solids(), 2);
}

TEST(Scene, ReportsEachDefect) {
  const std::map<std::string, Kinds> expected{
      {"zero_area.obj", {{"zero area", 1}}},
      {"repeated_vertex.obj", {{"repeated vertex", 2}, {"zero area", 1}}},
      {"non_planar.obj", {{"non-planar polygon", 1}}},
      {"non_convex.obj", {{"non-convex polygon", 1}}},
      {"self_crossing.obj", {{"self-crossing polygon", 1}}},
      {"keyhole.obj", {{"repeated vertex", 1}, {"non-convex polygon", 1}}},
      {"duplicate_face.obj", {{"duplicate face", 2}, {"self-touching", 2}}},
      {"inconsistent_orientation.obj", {{"inconsistent orientation", 4}}},
      {"non_manifold.obj", {{"non-manifold edge", 1}}},
      {"self_touching.obj", {{"self-touching", 8}}},
      {"unused_vertex.obj", {{"unused vertex", 1}}},
      {"fewer_than_three_corners.obj", {{"fewer than three corners", 1}}}};
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::string(SIGHTLINE_TEST_DATA) + "/defects")) {
    const std::string name = entry.path().filename().string();
    SCOPED_TRACE(name);
    const Scene scene(in_file(name));
    check_invariants(scene);
    ASSERT_TRUE(expected.contains(name));
    EXPECT_EQ(kinds(validate(scene)), expected.at(name));
    for (const Defect& d : validate(scene)) {
      EXPECT_FALSE(d.message.empty());
      EXPECT_FALSE(d.faces.empty() && d.vertices.empty());
    }
    ++files;
  }
  EXPECT_EQ(files, expected.size());
}

TEST(Scene, DefectsNameTheElementsOfTheFile) {
  EXPECT_EQ(Scene(in_file("zero_area.obj")).defects()[0].faces, (std::vector<int>{1}));
  EXPECT_EQ(Scene(in_file("unused_vertex.obj")).defects()[0].vertices,
            (std::vector<int>{0, 3}));
  const Scene flipped(in_file("inconsistent_orientation.obj"));
  for (const Defect& d : flipped.defects()) {
    EXPECT_EQ(d.faces[0], 1);
    EXPECT_EQ(d.vertices.size(), 2u);
  }
  EXPECT_FALSE(flipped.objects()[0].closed);
  EXPECT_EQ(flipped.solids(), 0);
  const auto touching = find_self_touching(Scene(in_file("self_touching.obj")));
  std::set<std::vector<int>> pairs;
  for (const Defect& d : touching) pairs.insert(d.faces);
  EXPECT_EQ(pairs,
            (std::set<std::vector<int>>{
                {0, 1}, {1, 0}, {2, 3}, {3, 2}, {4, 5}, {5, 4}, {10, 11}, {11, 10}}));
}

// Two polygons of one object, whichever comes first, however they turn and lie.
void expect_touching(const std::vector<Point>& f, const std::vector<Point>& g,
                     bool expected) {
  SCOPED_TRACE(::testing::Message() << g[0].transpose() << ", " << g[1].transpose());
  for (int variant = 0; variant < 24; ++variant) {
    PolygonSoup s;
    std::vector<int> faces;
    for (const auto& polygon : variant & 1 ? std::array{g, f} : std::array{f, g}) {
      std::vector<int> ring;
      for (const Point& p : polygon) {
        ring.push_back(static_cast<int>(s.vertices.size()));
        const int k = variant % 3;
        s.vertices.emplace_back(p[k], p[(k + 1) % 3], p[(k + 2) % 3]);
      }
      if (variant & (s.polygons.empty() ? 2 : 4)) std::reverse(ring.begin(), ring.end());
      faces.push_back(static_cast<int>(s.polygons.size()));
      s.polygons.push_back(ring);
    }
    s.groups = {{"both", faces}};
    EXPECT_EQ(!find_self_touching(Scene(s)).empty(), expected) << variant;
  }
}

TEST(FindSelfTouching, TellsSharingFromTouching) {
  const std::vector<Point> square{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  // Apart, also where the boxes overlap.
  expect_touching(square, {{1, 1, 1}, {2, 1, 1}, {1, 2, 1}}, false);
  expect_touching(square, {{5.5, 3, -1}, {5.5, 3, 1}, {3, 5.5, 1}}, false);
  expect_touching(square, {{5, 2, 0}, {2, 5, 0}, {5, 5, 0}, {6, 4, 0}}, true);
  expect_touching(square, {{5, 3.5, 0}, {3.5, 5, 0}, {5, 5, 0}}, false);
  // Sharing a corner, a side; folded by less than a half turn.
  expect_touching(square, {{4, 4, 0}, {5, 4, 0}, {5, 5, 0}}, false);
  expect_touching(square, {{4, 4, 0}, {5, 4, 1}, {5, 5, 2}}, false);
  expect_touching(square, {{4, 0, 0}, {4, 4, 0}, {6, 1, 0}}, false);
  expect_touching(square, {{4, 0, 0}, {4, 4, 0}, {1, 1, 3}}, false);
  // Sharing a side and folded flat; sharing all corners of one.
  expect_touching(square, {{4, 0, 0}, {4, 4, 0}, {2, 2, 0}}, true);
  expect_touching(square, {{4, 0, 0}, {4, 4, 0}, {-2, 2, 0}}, true);
  expect_touching(square, {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}}, true);
  // A side that joins two corners through the inside.
  expect_touching(square, {{0, 0, 0}, {4, 4, 0}, {2, 2, 3}}, true);
  // A spike through the middle; one that is pierced; a needle from a shared corner.
  expect_touching(square, {{1, 1, -1}, {2, 1, -1}, {1, 1, 3}}, true);
  expect_touching(square, {{-9, 2, -9}, {9, 2, -9}, {2, 2, 20}}, true);
  expect_touching(square, {{4, 4, 0}, {1, 1, -1}, {1, 1, 3}}, true);
  // A corner or a side that rests on the inside, on a side, across.
  expect_touching(square, {{1, 1, 0}, {1, 1, 1}, {2, 1, 1}}, true);
  expect_touching(square, {{4, 1, 0}, {5, 1, 1}, {5, 2, 1}}, true);
  expect_touching(square, {{1, 1, 0}, {2, 2, 0}, {2, 1, 1}}, true);
  expect_touching(square, {{-1, 2, 0}, {5, 2, 0}, {2, 2, 1}}, true);
  expect_touching(square, {{4, 1, 0}, {4, 3, 0}, {5, 2, 2}}, true);
  // Coplanar, crossing like a plus, without a corner inside.
  expect_touching(square, {{1, -1, 0}, {2, -1, 0}, {2, 5, 0}, {1, 5, 0}}, true);
}

TEST(Scene, AStarThatWindsTwiceCrossesItself) {
  std::vector<Point> v;
  for (const auto& p : {Point(0, 3, 1), Point(3, 1, 1), Point(2, -2, 1), Point(-2, -2, 1),
                        Point(-3, 1, 1)}) {
    v.push_back(p);
  }
  const Scene scene(soup(v, {{0, 2, 4, 1, 3}}));
  EXPECT_EQ(kinds(validate(scene)), (Kinds{{"self-crossing polygon", 1}}));
  EXPECT_TRUE(Scene(soup(v, {{0, 1, 2, 3, 4}})).defects().empty());
}

TEST(Scene, RepeatedFaceCountsOnceAndOpensNoSolid) {
  PolygonSoup s = grid_box(1);
  const std::size_t faces = s.polygons.size();
  s.groups = {{"box", {}}, {"copy", {}}};
  for (int f = 0; f < static_cast<int>(faces); ++f) s.groups[0].faces.push_back(f);
  std::vector<int> again = s.polygons[2];
  std::rotate(again.begin(), again.begin() + 1, again.end());
  s.groups[0].faces.push_back(static_cast<int>(faces));
  s.groups[1].faces.push_back(static_cast<int>(faces));
  s.polygons.push_back(again);
  const Scene scene(s);
  check_invariants(scene);
  EXPECT_EQ(scene.faces().size(), faces);
  EXPECT_EQ(scene.edges().size(), 12u);
  EXPECT_TRUE(scene.objects()[0].closed);
  EXPECT_TRUE(scene.objects()[0].convex);
  EXPECT_EQ(kinds(validate(scene)), (Kinds{{"duplicate face", 1}}));
  // Names of the copy mean the face that it repeats.
  EXPECT_EQ(scene.faces_named("copy"), std::vector<int>{2});
  EXPECT_EQ(scene.faces_named("box").size(), faces);
}

TEST(Scene, DuplicatesOfCutPolygonsKnowTheirSide) {
  const PolygonSoup l = in_file("non_convex.obj");
  for (int start = 0; start < 6; ++start) {
    for (const bool opposite : {false, true}) {
      PolygonSoup s = l;
      auto copy = s.polygons[0];
      if (opposite) std::reverse(copy.begin(), copy.end());
      std::rotate(copy.begin(), copy.begin() + start, copy.end());
      s.polygons.push_back(copy);
      const auto all = validate(Scene(s));
      const auto d = std::find_if(all.begin(), all.end(), [](const Defect& x) {
        return x.kind == "duplicate face";
      });
      ASSERT_NE(d, all.end());
      EXPECT_EQ(d->faces, (std::vector<int>{0, 1}));
      EXPECT_EQ(d->message.find("opposite") != std::string::npos, opposite);
    }
  }
}

TEST(Scene, RepeatedVerticesLeaveTheRestOfThePolygon) {
  const Scene scene(in_file("repeated_vertex.obj"));
  ASSERT_EQ(scene.faces().size(), 1u);
  EXPECT_EQ(area(scene), 0.5);
  // A spike encloses nothing, wherever it starts in the ring.
  for (int start = 0; start < 5; ++start) {
    std::vector<int> ring{0, 1, 3, 1, 2};
    std::rotate(ring.begin(), ring.begin() + start, ring.end());
    const Scene spiked(soup({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 5, 0}}, {ring}));
    EXPECT_EQ(area(spiked), 0.5) << start;
  }
  // Nor does one that ends elsewhere: 3 lies beyond 1 on the line from 0.
  for (int start = 0; start < 4; ++start) {
    std::vector<int> ring{0, 3, 1, 2};
    std::rotate(ring.begin(), ring.begin() + start, ring.end());
    const Scene spiked(soup({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {3, 0, 0}}, {ring}));
    EXPECT_EQ(area(spiked), 0.5) << start;
  }
}

TEST(Scene, CutsPolygonsWithoutGapOrOverlap) {
  EXPECT_EQ(area(Scene(in_file("keyhole.obj"))), 12);
  EXPECT_EQ(area(Scene(in_file("non_convex.obj"))), 3);
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    // A comb: teeth of integer heights, so that many corners are collinear.
    std::mt19937 rng(seed);
    const int teeth = 1 + static_cast<int>(rng() % 12);
    std::vector<Point> v;
    double exact = 0;
    for (int i = 0; i < teeth; ++i) {
      const double h = 1 + static_cast<double>(rng() % 4);
      v.emplace_back(i, h, 0);
      v.emplace_back(i + 1, h, 0);
      exact += h;
    }
    v.emplace_back(teeth, 0, 0);
    v.emplace_back(0, 0, 0);
    const int axis = static_cast<int>(seed % 3);
    for (Point& p : v) p = Point(p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]);
    std::vector<int> ring(v.size());
    for (std::size_t i = 0; i < ring.size(); ++i) ring[i] = static_cast<int>(i);
    std::rotate(ring.begin(), ring.begin() + static_cast<int>(rng() % ring.size()),
                ring.end());
    if (seed % 2 == 0) std::reverse(ring.begin(), ring.end());
    const Scene scene(soup(v, {ring}));
    check_invariants(scene);
    EXPECT_NEAR(area(scene), exact, 1e-9);
    EXPECT_EQ(scene.facets().size(), 1u);
    EXPECT_EQ(kinds(validate(scene))["self-crossing polygon"], 0);
    EXPECT_EQ(find_self_touching(scene).size(), 0u);
    // All pieces face the way the polygon does.
    const double front = seed % 2 == 0 ? 1 : -1;
    for (std::size_t f = 0; f < scene.faces().size(); ++f) {
      const auto ids = scene.face_points(static_cast<int>(f));
      const Point& a = scene.point(ids[0]);
      const Point n = (scene.point(ids[1]) - a).cross(scene.point(ids[2]) - a);
      EXPECT_GT(front * n.sum(), 0);
    }
  }
}

TEST(Scene, CountsDoNotDependOnOrderAxesOrScale) {
  PolygonSoup s = in_file("self_touching.obj");
  s.groups.clear();
  add_box(s, {70, 0, 0}, {71, 2, 3});
  const PolygonSoup l = in_file("non_convex.obj");
  const int n = static_cast<int>(s.vertices.size());
  for (const Point& p : l.vertices) s.vertices.push_back(p + Point(80, 0, 0));
  for (auto polygon : l.polygons) {
    for (int& v : polygon) v += n;
    s.polygons.push_back(polygon);
  }
  const auto summary = [](const Scene& scene) {
    return std::tuple(counts(scene.mesh_edges()), scene.points().size(),
                      scene.faces().size(), scene.facets().size(), scene.edges().size(),
                      scene.corners().size(), scene.objects().size(), scene.solids(),
                      kinds(validate(scene)));
  };
  const auto expected = summary(Scene(s));
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 rng(seed);
    std::vector<int> order(s.vertices.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
    std::shuffle(order.begin(), order.end(), rng);
    PolygonSoup t = s;
    const double scale = std::ldexp(1, static_cast<int>(seed % 41) - 20);
    const bool mirror = seed % 2 == 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Point& p = s.vertices[i];
      const int k = static_cast<int>(seed % 3);
      t.vertices[order[i]] =
          scale * Point((mirror ? -1 : 1) * p[k], p[(k + 1) % 3], p[(k + 2) % 3]);
    }
    for (auto& polygon : t.polygons) {
      for (int& v : polygon) v = order[v];
      std::rotate(polygon.begin(),
                  polygon.begin() + static_cast<int>(rng() % polygon.size()),
                  polygon.end());
      if (mirror) std::reverse(polygon.begin(), polygon.end());
    }
    std::shuffle(t.polygons.begin(), t.polygons.end(), rng);
    const Scene scene(t);
    check_invariants(scene);
    EXPECT_EQ(summary(scene), expected);
  }
}

TEST(Scene, RefusesWhatCannotBeUsed) {
  const auto message = [](PolygonSoup s) -> std::string {
    s.source = "file";
    try {
      const Scene scene(std::move(s));
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  const auto with = [](double x) {
    return soup({{0, 0, 0}, {1, 0, 0}, {0, x, 0}}, {{0, 1, 2}});
  };
  EXPECT_EQ(message(with(0x1p-140)), "");
  EXPECT_EQ(message(with(-0x1p140)), "");
  EXPECT_NE(message(with(0x1p-141)).find("file: vertex 2"), std::string::npos);
  EXPECT_NE(message(with(0x1.8p140)).find("file: vertex 2"), std::string::npos);
  EXPECT_NE(message(with(std::nan(""))).find("not finite"), std::string::npos);
  EXPECT_NE(message(with(-kInfinity)).find("not finite"), std::string::npos);
  EXPECT_EQ(message(soup({{0, 0, 0}}, {})), "file: no faces");
  EXPECT_EQ(message(soup({{0, 0, 0}, {1, 0, 0}}, {{0, 1, 2}})),
            "file: face 0 names vertex 2 of 2");
  EXPECT_NE(message(soup({{0, 0, 0}}, {{0, 0, -1}})), "");
  EXPECT_NE(message(soup({{0, 0, 0}}, {{0, 0, 0}}, {{"g", {1}}})), "");
}

TEST(Scene, OnlyZeroAreaFacesMakeAnEmptyScene) {
  const Scene scene(soup({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}));
  EXPECT_TRUE(scene.faces().empty());
  EXPECT_TRUE(scene.points().empty());
  EXPECT_TRUE(scene.objects().empty());
  EXPECT_EQ(scene.bounds()[1].x(), 2);
  EXPECT_EQ(kinds(validate(scene)), (Kinds{{"zero area", 1}}));
}

TEST(Scene, MovesAndKeepsItsIds) {
  Scene a(box());
  const Point p = a.point(3);
  const Scene b(std::move(a));
  EXPECT_EQ(b.point(3), p);
  EXPECT_EQ(b.object_named("component0"), 0);
}

TEST(Bvh, FindsExactlyTheOverlappingBoxes) {
  using internal::Box;
  using internal::Bvh;
  std::mt19937 rng(3);
  const auto uniform = [&] { return std::uniform_real_distribution<double>(0, 1)(rng); };
  EXPECT_TRUE(Bvh({}).empty());
  for (const int n : {1, 4, 5, 100, 3000}) {
    std::vector<Box> boxes(n);
    for (Box& b : boxes) {
      // A third of them equal, a third on a line at doubling distances.
      const int kind = static_cast<int>(rng() % 3);
      const double at = kind == 1 ? std::ldexp(1, -static_cast<int>(rng() % 1000)) : 0;
      for (int k = 0; k < 3; ++k) {
        b.min[k] = kind == 2 ? uniform() : k == 0 ? at : 0;
        b.max[k] = b.min[k] + (kind == 2 ? 0.1 * uniform() : 0);
      }
    }
    const Bvh tree(boxes);
    for (int query = 0; query < 20; ++query) {
      Box q{};
      for (int k = 0; k < 3; ++k) {
        q.min[k] = query == 0 ? 0 : uniform();
        q.max[k] = q.min[k] + 0.2 * uniform();
      }
      const auto meets = [&](const Box& b) {
        for (int k = 0; k < 3; ++k) {
          if (b.max[k] < q.min[k] || q.max[k] < b.min[k]) return false;
        }
        return true;
      };
      std::vector<int> found, expected;
      tree.traverse(meets, [&](std::uint32_t i) {
        if (meets(boxes[i])) found.push_back(static_cast<int>(i));
      });
      for (int i = 0; i < n; ++i) {
        if (meets(boxes[i])) expected.push_back(i);
      }
      std::sort(found.begin(), found.end());
      ASSERT_EQ(found, expected);
    }
  }
}

}  // namespace
}  // namespace sightline
