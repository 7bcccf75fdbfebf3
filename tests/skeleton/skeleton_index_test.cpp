// Look-ups in a skeleton against plain searches, and the catalogue of nodes.

#include "skeleton/skeleton_index.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "linespace/scene.h"
#include "skeleton/build.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

class SkeletonIndexTest : public ::testing::Test {
 protected:
  SkeletonIndexTest()
      : scene_(testing::random_polytopes(2, 12, {.max_vertices = 8, .density = 0.25})),
        skeleton_(build_skeleton(scene_)),
        index_(scene_, skeleton_) {}
  Scene scene_;
  Skeleton skeleton_;
  SkeletonIndex index_;
};

TEST_F(SkeletonIndexTest, ArcsAtANodeAreThoseThatNameIt) {
  for (std::uint32_t n = 0; n < skeleton_.nodes.size(); n += 7) {
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < skeleton_.arcs.size(); ++i) {
      for (const auto k : skeleton_.arcs[i].nodes) {
        if (k == n) expected.push_back(i);
      }
    }
    const auto found = index_.arcs_at(n);
    EXPECT_EQ(std::vector<std::uint32_t>(found.begin(), found.end()), expected);
  }
}

TEST_F(SkeletonIndexTest, ArcsAndNodesOfAGenerator) {
  for (int e = 0; e < static_cast<int>(scene_.edges().size()); e += 5) {
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < skeleton_.arcs.size(); ++i) {
      const SkeletonArc& arc = skeleton_.arcs[i];
      if (arc.is_ev() ? arc.edge() == e : std::ranges::count(arc.edges(), e) > 0) {
        expected.push_back(i);
      }
    }
    const auto found = index_.arcs_of({GeneratorKind::Edge, e});
    EXPECT_EQ(std::vector<std::uint32_t>(found.begin(), found.end()), expected);
  }
  std::size_t with_facets = 0;
  for (int f = 0; f < static_cast<int>(scene_.facets().size()); ++f) {
    const Generator facet{GeneratorKind::Face, f};
    EXPECT_TRUE(index_.arcs_of(facet).empty());
    for (const std::uint32_t n : index_.nodes_of(facet)) {
      const auto generators = skeleton_.generators(skeleton_.nodes[n]);
      EXPECT_NE(std::find(generators.begin(), generators.end(), facet), generators.end());
      ++with_facets;
    }
  }
  const auto count = std::count_if(
      skeleton_.nodes.begin(), skeleton_.nodes.end(), [](const SkeletonNode& n) {
        return n.kind == NodeKind::FvE || n.kind == NodeKind::FEE;
      });
  EXPECT_EQ(with_facets, static_cast<std::size_t>(count));
}

TEST_F(SkeletonIndexTest, EveryNodeIsAsTheCatalogueSays) {
  EXPECT_EQ(index_.check_invariants(), std::vector<std::string>());
}

TEST_F(SkeletonIndexTest, AMissingArcIsNamed) {
  Skeleton broken = skeleton_;
  const SkeletonArc gone = broken.eee().back();
  broken.arcs.pop_back();
  const auto wrong = SkeletonIndex(scene_, broken).check_invariants();
  ASSERT_EQ(wrong.size(), gone.nodes[0] == gone.nodes[1] ? 1u : 2u);
  const auto smaller = std::min(gone.nodes[0], gone.nodes[1]);
  EXPECT_TRUE(wrong[0].starts_with("node " + std::to_string(smaller) + ", ")) << wrong[0];
}

TEST(SkeletonIndex, CatalogueHoldsInLargerScenes) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Scene scene(testing::random_polytopes(seed, 40, {.density = 0.2}));
    const Skeleton skeleton = build_skeleton(scene);
    EXPECT_EQ(SkeletonIndex(scene, skeleton).check_invariants(),
              std::vector<std::string>());
  }
}

}  // namespace
}  // namespace sightline
