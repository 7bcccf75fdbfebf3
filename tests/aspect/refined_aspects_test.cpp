// Refined and sampled aspect graphs against each other and against exact ones.

#include <gtest/gtest.h>

#include "aspect/aspect_graph.h"
#include "tests/support/add_box.h"
#include "tests/support/aspect_scenes.h"

namespace sightline {
namespace {

using testing::add_box;
using testing::letter;
using testing::two_boxes;

AspectGraph graph_by(const Scene& scene, AspectMethod method, int samples,
                     Projection projection = Projection::Orthographic) {
  AspectRequest request;
  request.method = method;
  request.projection = projection;
  request.samples = samples;
  request.check = 100;
  request.list = true;
  return find_aspects(scene, request);
}

TEST(RefinedAspects, FewViewsFindWhatManySamplesFind) {
  const Scene scene = letter();
  const AspectGraph refined = graph_by(scene, AspectMethod::Refined, 12);
  const AspectGraph sampled = graph_by(scene, AspectMethod::Sampled, 2562);
  EXPECT_EQ(refined.method, AspectMethod::Refined);
  EXPECT_FALSE(refined.certified);
  EXPECT_EQ(refined.aspects, 16u);
  EXPECT_EQ(refined.distinct, sampled.distinct);
  EXPECT_EQ(refined.by_shape, sampled.by_shape);
  EXPECT_LT(refined.views, 60u);
  EXPECT_EQ(refined.check->not_in_graph, 0);
  // What is beside what by samples holds for walls too; the samples add corners.
  EXPECT_LE(refined.adjacencies, sampled.adjacencies);
  for (const Aspect& a : refined.list) {
    for (const AspectNeighbour& n : a.neighbours) EXPECT_FALSE(n.walls.empty());
  }
}

// 40,000 regular samples find as many labels.
TEST(RefinedAspects, TwoBoxes) {
  const AspectGraph few = graph_by(two_boxes(), AspectMethod::Refined, 12);
  EXPECT_EQ(few.distinct, 117u);
  EXPECT_EQ(few.by_shape, 62u);
  EXPECT_EQ(few.check->not_in_graph, 0);
  EXPECT_LT(few.views, 1000u);
}

// The cells of a cube's planes are found from samples and events alone.
TEST(RefinedAspects, CubeFromPoints) {
  PolygonSoup soup;
  add_box(soup, "cube", {0, 0, 0}, {1, 1, 1});
  const AspectGraph graph =
      graph_by(Scene(soup), AspectMethod::Refined, 8, Projection::Perspective);
  EXPECT_EQ(graph.aspects, 26u);
  EXPECT_EQ(graph.by_shape, 3u);
  EXPECT_EQ(graph.check->not_in_graph, 0);
}

}  // namespace
}  // namespace sightline
