// Connected occluders act by their outline.

#include <gtest/gtest.h>

#include <random>

#include "linespace/between/concurrent_lines.h"
#include "linespace/between/occluder_source.h"
#include "linespace/between/visibility_cover.h"
#include "linespace/polygon_visibility.h"
#include "linespace/visibility_cover.h"
#include "tests/support/visibility_cases.h"

namespace sightline::testing {
namespace {

using internal::SightPoint;
using internal::SightSpace;
using internal::Triangle;

Polygon triangle_at(double size, double z) {
  return {{size, 0, z}, {-0.5 * size, 0.875 * size, z}, {-0.5 * size, -0.875 * size, z}};
}

VisibilityInstance between(double size, std::vector<std::vector<Polygon>> bodies) {
  VisibilityInstance instance{triangle_at(size, 0), triangle_at(size, 1), {}};
  for (const auto& body : bodies) {
    instance.occluders.insert(instance.occluders.end(), body.begin(), body.end());
  }
  return instance;
}

Vec3 exact_point_of(const ExactPosition& p) {
  return {Rational(p.exact[0]), Rational(p.exact[1]), Rational(p.exact[2])};
}

// The answer, with its proof checked.
VisibilityAnswer checked(const VisibilityInstance& instance) {
  const VisibilityQuestion question{instance.a, instance.b, instance.occluders};
  VisibilityRequest request;
  request.keep_cover = true;
  VisibilityAnswer answer = polygon_visibility(question, request);
  if (answer.witness) {
    EXPECT_TRUE(is_free(instance, exact_point_of((*answer.witness)[0]),
                        exact_point_of((*answer.witness)[1])));
  }
  if (answer.cover) {
    EXPECT_EQ(check_cover(question, *answer.cover), std::nullopt);
  }
  return answer;
}

TEST(VisibilityPatch, ABulgeHidesByItsOutline) {
  const VisibilityInstance instance = between(0.5, {bulge(16, 0.75, 0.25)});
  ASSERT_EQ(instance.occluders.size(), 512U);
  for (int seed = 0; seed < 4; ++seed) {
    const VisibilityAnswer answer = checked(transformed(instance, seed));
    ASSERT_EQ(answer.verdict, Verdict::Hidden) << seed;
    EXPECT_LE(answer.cover->leaves(), 4U) << seed;
  }
}

TEST(VisibilityPatch, AHoleInABulgeIsFound) {
  VisibilityInstance instance = between(0.5, {bulge(16, 0.75, 0.25)});
  for (const std::size_t hole : {std::size_t{270}, std::size_t{205}}) {
    VisibilityInstance open = instance;
    open.occluders.erase(open.occluders.begin() + static_cast<std::ptrdiff_t>(hole));
    EXPECT_EQ(checked(open).verdict, Verdict::Visible) << hole;
    EXPECT_EQ(checked(transformed(open, hole)).verdict, Verdict::Visible) << hole;
  }
}

TEST(VisibilityPatch, ABallHidesAndIsSeenPast) {
  const std::vector<Polygon> solid = ball({0, 0, 0.5}, 0.45, 16);
  ASSERT_EQ(solid.size(), 960U);
  const VisibilityAnswer hidden = checked(between(0.25, {solid}));
  ASSERT_EQ(hidden.verdict, Verdict::Hidden);
  EXPECT_LE(hidden.cover->leaves(), 4U);
  EXPECT_EQ(checked(transformed(between(0.25, {solid}), 3)).verdict, Verdict::Hidden);
  // Past it only near the corners.
  EXPECT_EQ(checked(between(0.5, {ball({0, 0, 0.5}, 0.49, 16)})).verdict,
            Verdict::Visible);
}

TEST(VisibilityPatch, TwoBallsSideBySide) {
  const auto balls = [](double apart) {
    return between(0.3,
                   {ball({apart, 0.01, 0.5}, 0.4, 16), ball({-apart, 0, 0.52}, 0.4, 16)});
  };
  for (const double apart : {0.2, 0.3, 0.35}) {
    const VisibilityAnswer answer = checked(balls(apart));
    ASSERT_EQ(answer.verdict, Verdict::Hidden) << apart;
    EXPECT_LT(answer.cost.cells, 1'000) << apart;
  }
  EXPECT_EQ(checked(balls(0.38)).verdict, Verdict::Visible);
  EXPECT_EQ(checked(transformed(balls(0.35), 1)).verdict, Verdict::Hidden);
}

TEST(VisibilityPatch, FourBallsMeetingInTheMiddle) {
  const VisibilityInstance instance =
      between(0.3, {ball({0.3, 0.2, 0.3}, 0.35, 16), ball({-0.3, 0.1, 0.52}, 0.35, 16),
                    ball({0, -0.3, 0.7}, 0.4, 16), ball({0, 0, 0.7}, 0.2, 16)});
  EXPECT_EQ(checked(instance).verdict, Verdict::Hidden);
}

// Solids that reach behind a and b: what of them is behind does not count.
TEST(VisibilityPatch, ABallAroundASourceHides) {
  EXPECT_EQ(checked(between(0.25, {ball({0, 0, 0}, 0.5, 8)})).verdict, Verdict::Hidden);
  EXPECT_EQ(checked(between(0.25, {ball({0, 0, -0.5}, 0.4, 8)})).verdict,
            Verdict::Visible);
  // Both inside: its far side is behind each.
  EXPECT_EQ(checked(between(0.25, {ball({0, 0, 0.5}, 2, 8)})).verdict, Verdict::Visible);
}

// What a patch blocks, one of its pieces blocks; and it blocks what it grew around.
TEST(SightSpace, APatchBlocksNothingThatItsPiecesDoNot) {
  std::mt19937_64 random(7);
  const auto weights = [&] {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const auto grid = [](double x) { return std::nearbyint(x * 0x1p20) / 0x1p20; };
    double s = grid(uniform(random)), t = grid(uniform(random));
    if (s + t > 1) {
      s = 1 - s;
      t = 1 - t;
    }
    return internal::Weights{1 - s - t, s, t};
  };
  int grown = 0, blocked = 0;
  for (int seed = 0; seed < 60; ++seed) {
    // A rough terrain, a ball that reaches behind a, a ball between.
    std::vector<Polygon> polygons = seed % 3 == 0   ? bulge(6, 0.5, 0.3)
                                    : seed % 3 == 1 ? ball({0.1, 0, 0.2}, 0.4, 6)
                                                    : ball({0.1, 0, 0.5}, 0.3, 6);
    if (seed % 3 == 0) {
      for (Polygon& p : polygons) {
        for (Point& x : p) x.z() += 0.1 * std::sin(40 * x.x() + 31 * x.y() + seed);
      }
    }
    const internal::OccluderSet set(polygons);
    const Polygon a = triangle_at(0.4, 0), b = triangle_at(0.4, 1);
    SightSpace singles({a[0], a[1], a[2]}, {b[0], b[1], b[2]});
    for (std::size_t i = 0; i < polygons.size(); ++i) {
      singles.add(static_cast<int>(i), {static_cast<int>(i), polygons[i]});
    }
    const auto blocks = [&](const SightSpace& space, const SightPoint& s) {
      return std::ranges::any_of(space.blockers(), [&](const internal::Blocker& x) {
        return x.halves[0] < 0 && space.blocks(x, s);
      });
    };
    const SightPoint around{weights(), weights()};
    internal::OccluderSource source(set, internal::OccluderSource::Numbers::AsInSet, {});
    (void)source.start({});
    SightSpace found({a[0], a[1], a[2]}, {b[0], b[1], b[2]});
    const int first = source.find_blocker(found, around);
    if (first < 0) continue;
    SightSpace space({a[0], a[1], a[2]}, {b[0], b[1], b[2]});
    source.add_patch(space, first, around);
    if (space.blockers().empty()) continue;
    ++grown;
    EXPECT_GE(space.patches()[0].size(), 2U);
    EXPECT_TRUE(blocks(space, around)) << seed;
    for (int i = 0; i < 400; ++i) {
      const SightPoint s{weights(), weights()};
      if (!blocks(space, s)) continue;
      ++blocked;
      EXPECT_TRUE(blocks(singles, s)) << seed;
    }
  }
  EXPECT_GT(grown, 30);
  EXPECT_GT(blocked, 3'000);
}

TEST(CheckCover, RefusesADamagedPatch) {
  const VisibilityInstance instance = between(0.25, {ball({0, 0, 0.5}, 0.45, 8)});
  const VisibilityQuestion question{instance.a, instance.b, instance.occluders};
  const VisibilityAnswer answer = checked(instance);
  ASSERT_EQ(answer.verdict, Verdict::Hidden);
  const auto refused = [&](auto damage) {
    auto data = std::make_shared<VisibilityCover::Data>(answer.cover->data());
    for (auto& patch : data->pairs[0].patches) damage(patch);
    return check_cover(question, VisibilityCover(data)).has_value();
  };
  using Patch = std::vector<internal::FacingPiece>;
  EXPECT_FALSE(refused([](Patch&) {}));
  EXPECT_TRUE(refused([](Patch& patch) { patch.clear(); }));
  EXPECT_TRUE(refused([](Patch& patch) { patch.erase(patch.begin()); }));
  EXPECT_TRUE(refused([](Patch& patch) { patch[0].front = -patch[0].front; }));
  // All of the ball: nothing winds around an empty outline.
  EXPECT_TRUE(refused([&](Patch& patch) {
    patch.clear();
    for (std::size_t i = 0; i < question.occluders.size(); ++i) {
      patch.push_back({static_cast<int>(i), 1});
    }
  }));
  // A patch behind a: lines cross it, segments do not.
  VisibilityQuestion moved = question;
  for (Polygon& p : moved.occluders) {
    for (Point& x : p) x.z() -= 1;
  }
  EXPECT_TRUE(check_cover(moved, *answer.cover).has_value());
}

// The identity itself, at random points.
TEST(ConcurrentLines, WeightsMakeTheSidesCancel) {
  std::mt19937_64 random(3);
  std::uniform_int_distribution<int> digit(-9, 9);
  const auto point = [&] {
    const double x = digit(random), y = digit(random);
    return Point(x, y, digit(random));
  };
  int proofs = 0;
  for (int trial = 0; trial < 2'000; ++trial) {
    const Point v = point();
    std::array<internal::SignedLine, 3> lines;
    for (auto& line : lines) {
      line = {{v, point(), v}, digit(random) > 0 ? 1 : -1};
      if (digit(random) > 0) std::swap(line.points[0], line.points[1]);
    }
    std::array<internal::ExactPoint, 3> a, b;
    Triangle ta, tb;
    for (int j = 0; j < 3; ++j) {
      ta[j] = 0.125 * point() - Point(0, 0, 12);
      tb[j] = 0.125 * point() + Point(0, 0, 12);
      a[j] = internal::exact_point(ta[j]);
      b[j] = internal::exact_point(tb[j]);
    }
    const auto weights = internal::concurrent_weights(lines, a, b);
    if (!weights) continue;
    EXPECT_TRUE(internal::may_have_concurrent_weights(lines, ta, tb));
    ++proofs;
    for (int n = 0; n < 9; ++n) {
      internal::Rational sum = 0;
      for (int i = 0; i < 3; ++i) {
        EXPECT_GE((*weights)[i][n], 0);
        sum += (*weights)[i][n] * lines[i].sign *
               internal::exact_orient3d(a[n / 3], b[n % 3],
                                        internal::exact_point(lines[i].points[0]),
                                        internal::exact_point(lines[i].points[1]));
      }
      EXPECT_EQ(sum, 0);
    }
  }
  EXPECT_GT(proofs, 50);
}

TEST(ConcurrentLines, TriplesShareAnEnd) {
  const auto line = [](Point u, Point v) { return internal::SignedLine{{u, v, u}, 1}; };
  const Point o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const auto triples =
      internal::concurrent_triples({line(o, x), line(y, o), line(x, y), line(z, o)}, 9);
  ASSERT_EQ(triples.size(), 1U);
  EXPECT_EQ(triples[0], (std::array{0, 1, 3}));
}

}  // namespace
}  // namespace sightline::testing
