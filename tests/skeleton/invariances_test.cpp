// What a scene is written down as changes nothing: the order of its objects, faces and
// corners, axes, shears, translations and scales that are exact in doubles, edges and
// facets cut at points on them, faces repeated within their object.
// docs/degenerate_scenes.md, "What is invariant", says so.

#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

#include "linespace/mesh_io.h"
#include "tests/support/answers.h"

namespace sightline {
namespace {

using testing::Answers;
using testing::Crowd;
using testing::Questions;
using testing::Variant;

PolygonSoup read(const std::string& file) {
  return read_mesh(std::string(SIGHTLINE_TEST_DATA "/skeleton/invariant/") + file);
}

Point same(const Point& p) { return p; }

Variant itself(PolygonSoup soup) { return {"itself", std::move(soup), same, same}; }

/// Two files that hold the same scene, or one that is an image of the other.
void expect_alike(const std::string& file, Variant variant) {
  SCOPED_TRACE(file);
  const PolygonSoup soup = read(file);
  const Questions q = testing::questions_for(soup, 1);
  EXPECT_EQ(testing::difference(testing::answers_of(itself(soup), q, false),
                                testing::answers_of(variant, q, false)),
            "");
}

void expect_alike(const std::string& file, const std::string& other) {
  expect_alike(file, itself(read(other)));
}

TEST(Invariances, OrderOfObjects) {
  expect_alike("order_sheet_a.obj", "order_sheet_b.obj");
  expect_alike("order_wedges_a.obj", "order_wedges_b.obj");
}

TEST(Invariances, Shear) {
  expect_alike("shear_base.obj", {"sheared", read("shear_sheared.obj"),
                                  [](const Point& p) -> Point {
                                    return {p[0], p[1] + p[0], p[2]};
                                  },
                                  [](const Point& p) -> Point {
                                    return {p[0], p[1] - p[0], p[2]};
                                  }});
}

TEST(Invariances, Translation) {
  expect_alike("translation_base.obj", {"moved", read("translation_moved.obj"),
                                        [](const Point& p) -> Point {
                                          return {p[0] + 0x1p40, p[1], p[2]};
                                        },
                                        [](const Point& p) -> Point {
                                          return {p[0] - 0x1p40, p[1], p[2]};
                                        }});
}

TEST(Invariances, EdgesCutInTheMiddle) {
  expect_alike("midpoints_one_base.obj", "midpoints_one_cut.obj");
  expect_alike("midpoints_two_base.obj", "midpoints_two_cut.obj");
}

TEST(Invariances, SheetCutAlongItsDiagonal) {
  expect_alike("sheet_quad.obj", "sheet_two_triangles.obj");
}

TEST(Invariances, GroundInNinePieces) {
  expect_alike("slab_plain.obj", "slab_conforming.obj");
}

// Sheets of other objects that cross at a corner draw nothing there, however they are
// cut.
TEST(Invariances, CornerOnSheetsThatCross) {
  expect_alike("corner_on_sheets_base.obj", "corner_on_sheets_cut.obj");
}

// A line in the plane of a face at a corner grazes between lines that end there.
TEST(Invariances, FaceEdgeOnAtACorner) {
  expect_alike("edge_on_base.obj", {"moved", read("edge_on_cut.obj"),
                                    [](const Point& p) -> Point {
                                      return {p[2] + 64, -p[0], p[0] - p[1] + p[2] - 32};
                                    },
                                    [](const Point& p) -> Point {
                                      const double z = p[0] - 64;
                                      return {-p[1], -p[1] + z - 32 - p[2], z};
                                    }});
}

// Of two edges that enter a solid the parts inside see nothing of each other.
TEST(Invariances, EdgesInASolid) {
  expect_alike("edges_in_solid_base.obj",
               {"moved", read("edges_in_solid_cut.obj"),
                [](const Point& p) -> Point {
                  return {p[0] + p[1] - 2 * p[2] + 64, -p[2], -p[0] - 32};
                },
                [](const Point& p) -> Point {
                  const double x = -p[2] - 32;
                  return {x, p[0] - 64 - x - 2 * p[1], -p[1]};
                }});
}

// A line in the plane of a facet that an edge on it pierces.
TEST(Invariances, FacetPiercedByAnEdge) {
  const PolygonSoup soup = read("pierced_by_edge.obj");
  PolygonSoup moved = soup;
  const auto map = [](const Point& p) -> Point {
    return {p[0] - 0x1p40, p[1] + 0x1p40, p[2]};
  };
  for (Point& p : moved.vertices) p = map(p);
  expect_alike("pierced_by_edge.obj",
               {"moved", std::move(moved), map, [](const Point& p) -> Point {
                  return {p[0] + 0x1p40, p[1] - 0x1p40, p[2]};
                }});
}

// A line through four edges that arcs of different outer edges end in is one node.
TEST(Invariances, LineThroughFourEdgesFoundTwice) {
  expect_alike("order_eeee_a.obj", "order_eeee_b.obj");
}

// A small share of invariances_soak_test.cpp: about two seconds a scene.
TEST(Invariances, CrowdedScenesInEveryWriting) {
  for (const std::uint64_t seed : {2, 111}) {
    EXPECT_EQ(testing::count_alike(Crowd::Overlapping, seed), 10) << seed;
  }
  EXPECT_EQ(testing::count_alike(Crowd::Touching, 1), 10);
  for (const std::uint64_t seed : {1, 135}) {
    EXPECT_EQ(testing::count_alike(Crowd::RepeatedFaces, seed), 10) << seed;
  }
  // Of non-manifold scenes those of a first thousand in which most went wrong.
  for (const std::uint64_t seed : {1, 15, 69, 138, 167, 176}) {
    EXPECT_EQ(testing::count_alike(Crowd::NonManifold, seed), 10) << seed;
  }
}

// Each differed in this writing.
TEST(Invariances, CrowdedScenesThatDiffered) {
  const std::vector<std::tuple<Crowd, int, std::string>> found{
      {Crowd::Overlapping, 38, "order"},      {Crowd::Overlapping, 106, "order"},
      {Crowd::Overlapping, 121, "facets"},    {Crowd::Overlapping, 180, "shear"},
      {Crowd::Overlapping, 228, "midpoints"}, {Crowd::RepeatedFaces, 159, "shear"},
      {Crowd::RepeatedFaces, 165, "facets"},  {Crowd::RepeatedFaces, 198, "axes"},
      {Crowd::NonManifold, 19, "facets"},     {Crowd::NonManifold, 115, "shear"},
      {Crowd::NonManifold, 203, "facets"},    {Crowd::NonManifold, 233, "midpoints"}};
  for (const auto& [crowd, seed, variant] : found) {
    EXPECT_EQ(testing::count_alike(crowd, static_cast<std::uint64_t>(seed), variant), 1)
        << testing::name(crowd) << ' ' << seed;
  }
}

}  // namespace
}  // namespace sightline
