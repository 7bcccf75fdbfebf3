// Exact aspect graphs of scenes of several parts, against refined ones, random views and
// each other.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "aspect/aspect_graph.h"
#include "linespace/point_view.h"
#include "tests/support/add_box.h"
#include "tests/support/add_polygons.h"
#include "tests/support/aspect_scenes.h"

namespace sightline {
namespace {

using testing::add_box;
using testing::add_polygons;

using testing::Outline;

// The prism of height 1.2 over a polygon; of a mirrored one its mirror image.
void add_prism(PolygonSoup& soup, Outline outline, bool mirrored = false) {
  if (mirrored) {
    std::ranges::reverse(outline);
    for (auto& corner : outline) corner[0] = -corner[0];
  }
  add_polygons(soup, "prism", testing::prism(outline, 0, 1.2));
}

Scene prism(const Outline& outline, bool mirrored = false) {
  PolygonSoup soup;
  add_prism(soup, outline, mirrored);
  return Scene(soup);
}

const Outline kL = testing::kLetterL;
const Outline kT{{1, 0},      {2, 0},   {2, 1.5}, {3.25, 1.5},
                 {3.25, 2.5}, {0, 2.5}, {0, 1.5}, {1, 1.5}};
const Outline kU{{0, 0}, {3, 0}, {3, 2.5}, {2, 2.5}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};

struct TestBox {
  Point low, high;
};
Scene boxes(const std::vector<TestBox>& all) {
  PolygonSoup soup;
  for (std::size_t i = 0; i < all.size(); ++i)
    add_box(soup, ("box " + std::to_string(i)).c_str(), all[i].low, all[i].high);
  return Scene(soup);
}
const TestBox kA{{0, 0, 0}, {1, 1, 1}}, kB{{2, 0.3, 0.2}, {3, 1.5, 1.7}};

AspectGraph exact_graph(const Scene& scene, AspectRequest request = {}) {
  request.list = true;
  return find_aspects(scene, request);
}

void expect_counts(const AspectGraph& graph, std::array<std::size_t, 5> counts) {
  EXPECT_EQ(graph.method, AspectMethod::Exact) << graph.why;
  EXPECT_TRUE(graph.certified);
  EXPECT_EQ((std::array{graph.aspects, graph.adjacencies, graph.distinct,
                        graph.by_visible_faces, graph.by_shape}),
            counts);
}

void expect_same_counts(const AspectGraph& a, const AspectGraph& b) {
  expect_counts(a,
                {b.aspects, b.adjacencies, b.distinct, b.by_visible_faces, b.by_shape});
}

double sum_of_weights(const AspectGraph& graph) {
  double sum = 0;
  for (const Aspect& a : graph.list) sum += *a.weight;
  return sum;
}

// Every aspect's viewpoint shows what is told of it, random views know no others, and
// every wall has an event.
void expect_sound(const Scene& scene, int random_views) {
  AspectRequest request;
  request.check = random_views;
  const AspectGraph graph = exact_graph(scene, request);
  EXPECT_TRUE(graph.certified) << graph.why;
  EXPECT_EQ(graph.check->not_in_graph, 0);
  EXPECT_NEAR(sum_of_weights(graph), 4 * std::numbers::pi, 1e-11);
  const PointViewIndex index(scene);
  std::size_t neighbours = 0;
  for (const Aspect& a : graph.list) {
    EXPECT_EQ(index.view(a.at).structure, a.structure);
    neighbours += a.neighbours.size();
    for (const AspectNeighbour& n : a.neighbours) {
      EXPECT_FALSE(n.walls.empty());
      EXPECT_NE(graph.list[n.aspect].structure, a.structure);
    }
  }
  EXPECT_EQ(neighbours, 2 * graph.adjacencies);
}

TEST(GeneralAspects, PrismsFromInfinity) {
  expect_counts(find_aspects(prism(kL), {}), {16, 34, 16, 8, 8});
  expect_counts(find_aspects(prism(kT), {}), {24, 52, 24, 8, 12});
  expect_counts(find_aspects(prism(kU), {}), {36, 80, 36, 8, 24});
}

// The labels and shapes are those of 40,962 samples (docs/aspects.md).
TEST(GeneralAspects, BoxesFromInfinity) {
  expect_counts(find_aspects(boxes({kA, kB}), {}), {117, 240, 117, 12, 62});
}

TEST(GeneralAspects, ViewsWallsAndWeights) {
  expect_sound(prism(kL), 1000);
  expect_sound(boxes({kA, kB}), 1000);
}

// Two flush boxes make an L.
TEST(GeneralAspects, CutOrMirroredTheSame) {
  const AspectGraph whole = find_aspects(prism(kL), {});
  const TestBox foot{{0, 0, 0}, {3, 1, 1.2}}, stem{{0, 1, 0}, {1, 2.5, 1.2}};
  expect_same_counts(find_aspects(boxes({foot, stem}), {}), whole);
  expect_same_counts(find_aspects(boxes({stem, foot}), {}), whole);
  expect_same_counts(find_aspects(prism(kL, true), {}), whole);
}

// Edges cross in points that are no corners.
TEST(GeneralAspects, TouchingBoxes) {
  const Scene stair = boxes({{{0, 0, 0}, {2, 2, 1}}, {{1.25, -1, 1}, {3, 1.5, 2}}});
  expect_counts(find_aspects(stair, {}), {72, 158, 72, 11, 34});
  expect_sound(stair, 1000);
}

TEST(GeneralAspects, ThreeBarsAreRefinedAndSayWhy) {
  AspectRequest request;
  request.samples = 12;
  request.budget_seconds = 0.5;
  const AspectGraph graph = find_aspects(
      boxes({{{-3, 0, 0}, {3, 1, 1}}, {{2, -3, 2}, {3, 3, 3}}, {{0, 2, -3}, {1, 3, 4}}}),
      request);
  EXPECT_EQ(graph.method, AspectMethod::Refined);
  EXPECT_FALSE(graph.certified);
  EXPECT_NE(graph.why.find("EEE"), std::string::npos) << graph.why;
}

TEST(GeneralAspects, LFromPoints) {
  AspectRequest request;
  request.projection = Projection::Perspective;
  request.check = 200;
  const AspectGraph graph = find_aspects(prism(kL), request);
  expect_counts(graph, {71, 164, 71, 47, 34});
  EXPECT_EQ(*graph.unbounded, 60u);
  EXPECT_EQ(*graph.unbounded + *graph.bounded, graph.aspects);
  EXPECT_EQ(graph.check->not_in_graph, 0);
}

}  // namespace
}  // namespace sightline
