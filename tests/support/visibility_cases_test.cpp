// The constructed instances have the answers they claim, by the naive decision; the
// random ones are what they are said to be.

#include "tests/support/visibility_cases.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "tests/support/naive_transversals.h"

namespace sightline::testing {
namespace {

NaiveAnswer expected(const VisibilityCase& c) {
  return *c.visible ? NaiveAnswer::Visible : NaiveAnswer::Hidden;
}

TEST(VisibilityCases, KnownAnswers) {
  for (const VisibilityCase& c : known_visibility_cases()) {
    EXPECT_EQ(naive_visibility(c.instance).answer, expected(c)) << c.name;
  }
}

TEST(VisibilityCases, KnownAnswersTransformedAndWithNarrowerSlits) {
  std::uint64_t seed = 0;
  for (const VisibilityCase& c : known_visibility_cases(0x1p-40)) {
    const VisibilityInstance moved = transformed(c.instance, ++seed);
    EXPECT_EQ(naive_visibility(moved).answer, expected(c)) << c.name;
    if (!*c.visible) {
      EXPECT_FALSE(find_free_segment(moved, seed, 100)) << c.name;
    }
  }
}

TEST(VisibilityCases, ALensHangsBetweenTwoTransversalsOfItsEdges) {
  const auto count = [](double epsilon) {
    const VisibilityInstance lens = lens_instance(epsilon);
    std::vector<ExactSegment> edges;
    for (const auto& o : lens.occluders) edges.push_back({exact(o[0]), exact(o[1])});
    const QuadrupleTransversals t = naive_quadruple(edges);
    EXPECT_TRUE(t.families.empty());
    return t.isolated.size();
  };
  EXPECT_EQ(count(0x1p-20), 2u);
  EXPECT_EQ(count(0), 1u);
  EXPECT_EQ(count(-0x1p-20), 0u);
}

// The answer does not depend on how the question is asked.
TEST(VisibilityCases, GridInstancesTransformed) {
  int hidden = 0, visible = 0;
  for (int seed = 0; seed < 120; ++seed) {
    const VisibilityInstance instance = grid_instance(seed, 1 + seed % 3, 3);
    const NaiveAnswer answer = naive_visibility(instance).answer;
    EXPECT_NE(answer, NaiveAnswer::Undecided) << seed;
    EXPECT_EQ(naive_visibility(transformed(instance, seed)).answer, answer) << seed;
    if (answer == NaiveAnswer::Hidden) {
      ++hidden;
      EXPECT_FALSE(find_free_segment(instance, seed, 100)) << seed;
    } else {
      ++visible;
    }
  }
  EXPECT_GT(hidden, 12);
  EXPECT_GT(visible, 12);
}

TEST(VisibilityCases, SlabInstancesHaveTheSizeAsked) {
  double edges = 0;
  int count = 0;
  for (int seed = 0; seed < 20; ++seed) {
    const VisibilityInstance slab = slab_instance(seed, 100, 0.4);
    ASSERT_EQ(slab.occluders.size(), 100u);
    for (const auto& o : slab.occluders) {
      const double edge = (o[1] - o[0]).norm();
      EXPECT_NEAR((o[2] - o[1]).norm(), edge, 1e-12);
      EXPECT_NEAR((o[0] - o[2]).norm(), edge, 1e-12);
      edges += edge;
      ++count;
    }
    for (const Point& p : slab.a) EXPECT_NEAR(std::hypot(p[0], p[1]), 0.5, 1e-12);
  }
  EXPECT_NEAR(edges / count, 0.4, 0.01);
}

TEST(VisibilityCases, AreWrittenAsJson) {
  const std::string path = ::testing::TempDir() + "visibility_cases.json";
  write_visibility_json(path, {{"one",
                                {{{0, 0, 0.1}, {1, 0, 0}, {0, 1, 0}},
                                 {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}},
                                 {{{0, 0, 2}, {1, 0, 2}, {0, 1, 2}}}},
                                false},
                               {"two", {}, std::nullopt}});
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  std::remove(path.c_str());
  EXPECT_EQ(text.str(),
            "{\"instances\": [\n"
            " {\"name\": \"one\", \"expected\": false,\n"
            "  \"a\": [[0, 0, 0.10000000000000001], [1, 0, 0], [0, 1, 0]],\n"
            "  \"b\": [[0, 0, 1], [1, 0, 1], [0, 1, 1]],\n"
            "  \"occluders\": [[[0, 0, 2], [1, 0, 2], [0, 1, 2]]]},\n"
            " {\"name\": \"two\", \"expected\": null,\n"
            "  \"a\": [],\n  \"b\": [],\n  \"occluders\": []}\n]}\n");
  EXPECT_THROW(write_visibility_json("/no/such/folder/x.json", {}), std::runtime_error);
}

}  // namespace
}  // namespace sightline::testing
