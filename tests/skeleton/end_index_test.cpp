// Look-ups by far ends against plain searches, and against points of the facets.

#include "skeleton/end_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "linespace/scene.h"
#include "skeleton/build.h"
#include "skeleton/skeleton_lines.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

std::vector<std::uint32_t> copied(std::span<const std::uint32_t> arcs) {
  return {arcs.begin(), arcs.end()};
}

class EndIndexTest : public ::testing::Test {
 protected:
  EndIndexTest()
      : scene_(testing::random_polytopes(2, 12, {.max_vertices = 8, .density = 0.25})),
        skeleton_(build_skeleton(scene_)),
        index_(scene_, skeleton_) {}

  template <class Visit>
  void each_piece(Visit&& visit) const {
    const SkeletonLines lines(scene_);
    const auto facet = [&](const std::vector<int>& faces) {
      return faces.empty() ? kOutside : scene_.faces()[faces.front()].facet;
    };
    for (std::uint32_t i = 0; i < skeleton_.arcs.size(); ++i) {
      for (const auto& end : lines.ends(skeleton_.arcs[i])) {
        visit(i, end.range, facet(end.faces[0]), facet(end.faces[1]));
      }
    }
  }
  [[nodiscard]] std::int32_t object(std::int32_t facet) const {
    return facet == kOutside ? kOutside : scene_.facets()[facet].object;
  }

  Scene scene_;
  Skeleton skeleton_;
  EndIndex index_;
};

TEST_F(EndIndexTest, FindsWhatAPlainSearchFinds) {
  std::map<std::pair<int, int>, std::set<std::uint32_t>> facets, objects;
  std::map<int, std::set<std::uint32_t>> seen;
  each_piece([&](std::uint32_t arc, const auto&, std::int32_t a, std::int32_t b) {
    facets[std::minmax(a, b)].insert(arc);
    objects[std::minmax(object(a), object(b))].insert(arc);
    seen[a].insert(arc);
    seen[b].insert(arc);
  });
  const auto expect = [](std::span<const std::uint32_t> found,
                         const std::set<std::uint32_t>& arcs) {
    EXPECT_EQ(copied(found), std::vector<std::uint32_t>(arcs.begin(), arcs.end()));
  };
  const int facet_count = static_cast<int>(scene_.facets().size());
  for (int a = kOutside; a < facet_count; ++a) {
    expect(index_.seen_from(a), seen[a]);
    for (int b = a; b < facet_count; ++b) {
      expect(index_.between_facets(a, b), facets[{a, b}]);
      expect(index_.between_facets(b, a), facets[{a, b}]);
    }
  }
  const int object_count = static_cast<int>(scene_.objects().size());
  for (int a = kOutside; a < object_count; ++a) {
    for (int b = a; b < object_count; ++b) {
      expect(index_.between_objects(b, a), objects[{a, b}]);
    }
  }
  EXPECT_GT(facets.size(), 100U);
}

TEST_F(EndIndexTest, PiecesCoverTheRangeOfTheirArc) {
  std::uint32_t last = 0xffffffff;
  std::size_t k = 0;
  each_piece([&](std::uint32_t arc, const std::array<double, 2>& range, std::int32_t a,
                 std::int32_t b) {
    k = arc == last ? k + 1 : 0;
    last = arc;
    const auto pieces = index_.pieces(arc);
    ASSERT_LT(k, pieces.size());
    EXPECT_EQ(pieces[k].from, range[0]);
    EXPECT_EQ(index_.end_of(arc, k), range[1]);
    EXPECT_EQ(pieces[k].facets, (std::array<std::int32_t, 2>{a, b}));
  });
}

TEST_F(EndIndexTest, ThreadsAndBudgetDoNotChangeWhatIsThere) {
  Request one;
  one.threads = 1;
  const EndIndex alone(scene_, skeleton_, one);
  EXPECT_TRUE(alone.complete());
  EXPECT_EQ(copied(alone.seen_from(3)), copied(index_.seen_from(3)));
  Request none;
  none.budget_seconds = 0;
  const EndIndex empty(scene_, skeleton_, none);
  EXPECT_FALSE(empty.complete());
  EXPECT_TRUE(empty.pieces(0).empty());
  EXPECT_TRUE(empty.seen_from(3).empty());
  EXPECT_GT(index_.bytes(), empty.bytes());
}

}  // namespace
}  // namespace sightline
