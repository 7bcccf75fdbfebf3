#include "linespace/polygon_visibility.h"

#include <gtest/gtest.h>

#include "linespace/between/cover_search.h"
#include "linespace/between/visibility_cover.h"
#include "linespace/visibility_cover.h"
#include "tests/support/naive_polygon_visibility.h"
#include "tests/support/visibility_cases.h"

namespace sightline::testing {
namespace {

VisibilityQuestion question_of(const VisibilityInstance& instance) {
  return {instance.a, instance.b, instance.occluders};
}

Rational parsed(const std::string& text) { return Rational(text); }

Vec3 exact_point_of(const ExactPosition& p) {
  return {parsed(p.exact[0]), parsed(p.exact[1]), parsed(p.exact[2])};
}

// The answer, after its proof was checked: a witness by the oracle's own test of
// segments, a cover by check_cover.
Verdict checked_verdict(const VisibilityInstance& instance, int samples = 64) {
  const VisibilityQuestion question = question_of(instance);
  VisibilityRequest request;
  request.keep_cover = true;
  request.samples = samples;
  const VisibilityAnswer answer = polygon_visibility(question, request);
  EXPECT_EQ(answer.witness.has_value(), answer.verdict == Verdict::Visible);
  EXPECT_EQ(answer.cover != nullptr, answer.verdict == Verdict::Hidden);
  if (answer.witness) {
    EXPECT_TRUE(is_free(instance, exact_point_of((*answer.witness)[0]),
                        exact_point_of((*answer.witness)[1])));
  }
  if (answer.cover) {
    EXPECT_EQ(check_cover(question, *answer.cover), std::nullopt);
  }
  return answer.verdict;
}

Verdict expected(bool visible) { return visible ? Verdict::Visible : Verdict::Hidden; }

const Polygon kBelow{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
const Polygon kAbove{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
const Polygon kScreen{{-1, -1, 0.5}, {2, -1, 0.5}, {2, 2, 0.5}, {-1, 2, 0.5}};

TEST(PolygonVisibility, NothingBetweenIsVisible) {
  EXPECT_EQ(checked_verdict({kBelow, kAbove, {}}), Verdict::Visible);
}

TEST(PolygonVisibility, AScreenHides) {
  EXPECT_EQ(checked_verdict({kBelow, kAbove, {kScreen}}), Verdict::Hidden);
}

TEST(PolygonVisibility, KnownCases) {
  for (const double width : {0x1p-10, 0x1p-30, 0x1p-40}) {
    for (const VisibilityCase& c : known_visibility_cases(width)) {
      ASSERT_TRUE(c.visible.has_value()) << c.name;
      EXPECT_EQ(checked_verdict(c.instance), expected(*c.visible))
          << c.name << " width " << width;
    }
  }
}

TEST(PolygonVisibility, KnownCasesTurnedAndReordered) {
  for (const VisibilityCase& c : known_visibility_cases()) {
    for (int seed = 0; seed < 4; ++seed) {
      EXPECT_EQ(checked_verdict(transformed(c.instance, seed)), expected(*c.visible))
          << c.name << " seed " << seed;
    }
  }
}

TEST(PolygonVisibility, LensBetweenTwoTransversalsOfFourEdges) {
  for (const double epsilon : {0x1p-10, 0x1p-20, 0x1p-30, 0x1p-40}) {
    EXPECT_EQ(checked_verdict(lens_instance(epsilon)), Verdict::Visible) << epsilon;
    EXPECT_EQ(checked_verdict(lens_instance(-epsilon)), Verdict::Hidden) << -epsilon;
  }
  EXPECT_EQ(checked_verdict(lens_instance(0)), Verdict::Hidden);
}

// The oracle is independent of the library in all but the number type.
void agrees_with_oracle(const VisibilityInstance& instance, const std::string& name) {
  const NaiveVisibility naive = naive_visibility(instance);
  if (naive.answer == NaiveAnswer::Undecided) return;
  EXPECT_EQ(checked_verdict(instance), expected(naive.answer == NaiveAnswer::Visible))
      << name;
}

TEST(PolygonVisibility, AgreesWithTheOracleOnGrids) {
  for (int seed = 0; seed < 120; ++seed) {
    agrees_with_oracle(grid_instance(seed, 1 + seed % 5, 2 + seed % 3),
                       "grid " + std::to_string(seed));
  }
}

TEST(PolygonVisibility, AgreesWithTheOracleOnSlabs) {
  for (int seed = 0; seed < 60; ++seed) {
    agrees_with_oracle(slab_instance(seed, 1 + seed % 6, 1.5),
                       "slab " + std::to_string(seed));
  }
}

TEST(PolygonVisibility, HiddenSlabsHaveNoFreeSegment) {
  int hidden = 0;
  for (int seed = 0; seed < 60; ++seed) {
    const VisibilityInstance instance = slab_instance(seed, 60, 0.8);
    if (checked_verdict(instance) != Verdict::Hidden) continue;
    ++hidden;
    EXPECT_FALSE(find_free_segment(instance, seed, 200)) << seed;
  }
  EXPECT_GT(hidden, 5);
}

TEST(PolygonVisibility, DoesNotDependOnOrderOrOrientation) {
  for (int seed = 0; seed < 60; ++seed) {
    const VisibilityInstance instance = grid_instance(seed, 20, 3);
    const Verdict verdict = checked_verdict(instance);
    EXPECT_NE(verdict, Verdict::Undecided) << seed;
    EXPECT_EQ(checked_verdict(transformed(instance, seed)), verdict) << seed;
  }
}

TEST(PolygonVisibility, WithoutSamplesTheAnswerIsTheSame) {
  for (int seed = 0; seed < 40; ++seed) {
    const VisibilityInstance instance = slab_instance(seed, 30, 0.8);
    EXPECT_EQ(checked_verdict(instance, 0), checked_verdict(instance, 512)) << seed;
  }
}

TEST(PolygonVisibility, WithinACoplanarOccluderNothingIsSeen) {
  const auto triangle = [](double x, double y) -> Polygon {
    return {{x, y, 0}, {x + 1, y, 0}, {x, y + 1, 0}};
  };
  const Polygon plate{{-1, -1, 0}, {9, -1, 0}, {9, 9, 0}, {-1, 9, 0}};
  EXPECT_EQ(checked_verdict({triangle(0, 0), triangle(4, 4), {}}), Verdict::Visible);
  EXPECT_EQ(checked_verdict({triangle(0, 0), triangle(4, 4), {plate}}), Verdict::Hidden);
  // Only a lies in it; then neither, but it is between them.
  const Polygon under_a{{-1, -1, 0}, {3, -1, 0}, {3, 3, 0}, {-1, 3, 0}};
  EXPECT_EQ(checked_verdict({triangle(0, 0), triangle(4, 4), {under_a}}),
            Verdict::Hidden);
  const Polygon between{{-8, 12, 0}, {12, -8, 0}, {12.5, -8, 0}, {-8, 12.5, 0}};
  EXPECT_EQ(checked_verdict({triangle(0, 0), triangle(4, 4), {between}}),
            Verdict::Hidden);
}

TEST(SightSpace, BlockersAreClosed) {
  internal::SightSpace space({Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0)},
                             {Point(0, 0, 1), Point(1, 0, 1), Point(0, 1, 1)});
  space.add(0, {0, {{-1, -1, 0.5}, {0.25, -1, 0.5}, {0.25, 2, 0.5}, {-1, 2, 0.5}}});
  ASSERT_EQ(space.blockers().size(), 1U);
  const internal::Weights on{0.5, 0.25, 0.25};
  EXPECT_TRUE(space.blocks(space.blockers()[0], {on, on}));
  const internal::Weights beside{0.5 - 0x1p-40, 0.25 + 0x1p-40, 0.25};
  EXPECT_FALSE(space.blocks(space.blockers()[0], {beside, beside}));
}

TEST(PolygonVisibility, TilesOfAWallAreJoined) {
  VisibilityQuestion question{kBelow, kAbove, {}};
  constexpr int kTiles = 4;
  const auto at = [](int i, int j) { return Point(-0.5 + 0.5 * i, -0.5 + 0.5 * j, 0.5); };
  for (int i = 0; i < kTiles; ++i) {
    for (int j = 0; j < kTiles; ++j) {
      question.occluders.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      question.occluders.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  VisibilityRequest request;
  request.keep_cover = true;
  const VisibilityAnswer answer = polygon_visibility(question, request);
  ASSERT_EQ(answer.verdict, Verdict::Hidden);
  EXPECT_EQ(check_cover(question, *answer.cover), std::nullopt);
  // Triangle by triangle it would take dozens.
  EXPECT_LE(answer.cost.cells, 4);
  // One tile less opens a window.
  question.occluders.erase(question.occluders.begin() + 12,
                           question.occluders.begin() + 14);
  EXPECT_EQ(polygon_visibility(question).verdict, Verdict::Visible);
}

TEST(PolygonVisibility, SliversBlockNothing) {
  VisibilityInstance instance{kBelow, kAbove, {}};
  for (int i = 0; i < 9; ++i) {
    const double x = (i + 1) / 10.0;
    instance.occluders.push_back({{x, 0, 0.5}, {x, 0.5, 0.5}, {x, 1, 0.5}});
  }
  // In the middle, where samples are rare but witnesses are sought first.
  instance.occluders.push_back({{0.25, 0.25, 0.25}});
  instance.occluders.push_back({{0.25, 0.25, 0.5}, {0.25, 0.25, 0.5}, {0.5, 0.25, 0.5}});
  EXPECT_EQ(checked_verdict(instance), Verdict::Visible);
  EXPECT_EQ(checked_verdict(instance, 0), Verdict::Visible);
  // Repeated corners change nothing.
  EXPECT_EQ(checked_verdict({kBelow,
                             kAbove,
                             {{kScreen[0], kScreen[0], kScreen[1], kScreen[2], kScreen[3],
                               kScreen[0]}}}),
            Verdict::Hidden);
}

TEST(PolygonVisibility, RefusesBadPolygonsByName) {
  const auto message = [](const VisibilityQuestion& q) -> std::string {
    try {
      (void)polygon_visibility(q);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message({{{0, 0, 0}, {1, 0, 0}}, kAbove, {}}).find("a: has no area"),
            std::string::npos);
  EXPECT_NE(message({kBelow, kAbove, {{}}}).find("occluders[0]: a polygon without"),
            std::string::npos);
  EXPECT_NE(
      message({kBelow, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {}}).find("b: has no area"),
      std::string::npos);
  EXPECT_NE(message({kBelow, kAbove, {kScreen, {{0, 0, 0}, {NAN, 0, 0}, {0, 1, 0}}}})
                .find("occluders[1]: corner 1"),
            std::string::npos);
  const Polygon dart{{0, 0, 0}, {1, 1, 0}, {0, 4, 0}, {-1, 1, 0}, {0, 1.5, 0}};
  EXPECT_NE(message({kBelow, kAbove, {dart}}).find("occluders[0]: not convex"),
            std::string::npos);
}

TEST(PolygonVisibility, StopsWhenAsked) {
  std::stop_source source;
  source.request_stop();
  VisibilityRequest request;
  request.stop = source.get_token();
  request.samples = 0;
  request.budget_seconds = 0;
  VisibilityInstance instance = slab_instance(3, 200, 0.8);
  const VisibilityAnswer answer = polygon_visibility(question_of(instance), request);
  // A search of fewer than 64 cells ends by itself.
  EXPECT_TRUE(answer.verdict == Verdict::Undecided || answer.cost.cells < 64);
}

// ---- the checker must be able to say no
// --------------------------------------------------

VisibilityAnswer hidden_slab() {
  VisibilityRequest request;
  request.keep_cover = true;
  for (int seed = 0;; ++seed) {
    VisibilityAnswer answer =
        polygon_visibility(question_of(slab_instance(seed, 60, 0.8)), request);
    if (answer.verdict == Verdict::Hidden && answer.cover->leaves() > 30) {
      answer.cost.samples = seed;
      return answer;
    }
  }
}

TEST(CheckCover, RefusesACoverOfAnotherQuestion) {
  const VisibilityAnswer answer = hidden_slab();
  const int seed = static_cast<int>(answer.cost.samples);
  VisibilityQuestion question = question_of(slab_instance(seed, 60, 0.8));
  ASSERT_EQ(check_cover(question, *answer.cover), std::nullopt);
  // Without one occluder that the cover uses, and with one moved away.
  int used = answer.cover->data().pairs[0].blockers[0].piece;
  for (const auto& node : answer.cover->data().pairs[0].cover.nodes) {
    if (node.kind == internal::CoverNode::Kind::Blocked)
      used = answer.cover->data().pairs[0].blockers[node.index].piece;
  }
  for (Point& corner : question.occluders[used]) corner.x() += 2;
  EXPECT_NE(check_cover(question, *answer.cover), std::nullopt);
}

TEST(CheckCover, RefusesEveryDamage) {
  const VisibilityAnswer answer = hidden_slab();
  const int seed = static_cast<int>(answer.cost.samples);
  const VisibilityQuestion question = question_of(slab_instance(seed, 60, 0.8));
  const VisibilityCover::Data& whole = answer.cover->data();
  const auto refused = [&](auto damage) {
    auto data = std::make_shared<VisibilityCover::Data>(whole);
    damage(data->pairs[0].cover);
    return check_cover(question, VisibilityCover(data)).has_value();
  };
  using Kind = internal::CoverNode::Kind;
  EXPECT_TRUE(refused([](internal::Cover& c) { c.nodes.pop_back(); }));
  EXPECT_TRUE(refused([](internal::Cover& c) {
    c.nodes.push_back({Kind::Blocked, 0, 0, 0});
  }));
  EXPECT_TRUE(refused([](internal::Cover& c) {
    for (auto& share : c.shares) share.weight = -share.weight;
  }));
  EXPECT_TRUE(refused([](internal::Cover& c) {
    for (auto& node : c.nodes) {
      if (node.kind == Kind::Empty) node.count = 0;
    }
  }));
  int wrong_blockers = 0;
  for (std::size_t i = 0; i < whole.pairs[0].cover.nodes.size(); ++i) {
    if (whole.pairs[0].cover.nodes[i].kind != Kind::Empty) continue;
    // A cell that is empty is not blocked by just any blocker.
    wrong_blockers += refused([i](internal::Cover& c) {
      c.nodes[i] = {Kind::Blocked, 0, 0, 0};
    });
    if (i > 60) break;
  }
  EXPECT_GT(wrong_blockers, 0);
}

}  // namespace
}  // namespace sightline::testing
