// A hundred thousand random questions, and thousands that the oracle can answer too.

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <thread>

#include "linespace/polygon_visibility.h"
#include "linespace/visibility_cover.h"
#include "tests/support/naive_polygon_visibility.h"
#include "tests/support/visibility_cases.h"

namespace sightline::testing {
namespace {

Vec3 exact_point_of(const ExactPosition& p) {
  return {Rational(p.exact[0]), Rational(p.exact[1]), Rational(p.exact[2])};
}

struct Tally {
  std::atomic<int> visible = 0, hidden = 0, undecided = 0, wrong = 0;
};

// Every "visible" by the oracle's exact test of its witness, every "hidden" by the exact
// checker of covers and by random segments.
void ask(const VisibilityInstance& instance, int seed, Tally& tally) {
  const VisibilityQuestion question{instance.a, instance.b, instance.occluders};
  VisibilityRequest request;
  request.keep_cover = true;
  request.samples = 32 + seed % 200;
  request.seed = seed;
  const VisibilityAnswer answer = polygon_visibility(question, request);
  bool right = true;
  switch (answer.verdict) {
    case Verdict::Visible:
      ++tally.visible;
      right = is_free(instance, exact_point_of((*answer.witness)[0]),
                      exact_point_of((*answer.witness)[1]));
      break;
    case Verdict::Hidden:
      ++tally.hidden;
      right =
          !check_cover(question, *answer.cover) && !find_free_segment(instance, seed, 20);
      break;
    case Verdict::Undecided:
      ++tally.undecided;
  }
  if (!right) ++tally.wrong;
  EXPECT_TRUE(right) << "seed " << seed;
}

template <class Make>
void ask_many(int count, Tally& tally, Make make) {
  std::atomic<int> next = 0;
  const auto work = [&] {
    for (int seed = next++; seed < count; seed = next++) ask(make(seed), seed, tally);
  };
  std::thread other(work);
  work();
  other.join();
}

void report(const char* what, const Tally& tally) {
  std::printf("%s: %d visible, %d hidden, %d undecided, %d wrong\n", what,
              tally.visible.load(), tally.hidden.load(), tally.undecided.load(),
              tally.wrong.load());
}

TEST(PolygonVisibilitySoak, RandomTriangles) {
  Tally tally;
  ask_many(70'000, tally, [](int seed) {
    return slab_instance(seed, 1 + seed % 60, 0.5 + 0.25 * (seed % 5));
  });
  report("slabs", tally);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_EQ(tally.undecided, 0);
  EXPECT_GT(tally.hidden, 10'000);
  EXPECT_GT(tally.visible, 10'000);
}

TEST(PolygonVisibilitySoak, Grids) {
  Tally tally;
  ask_many(30'000, tally,
           [](int seed) { return grid_instance(seed, 1 + seed % 60, 2 + seed % 5); });
  report("grids", tally);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_EQ(tally.undecided, 0);
  EXPECT_GT(tally.hidden, 3'000);
}

TEST(PolygonVisibilitySoak, AgreesWithTheOracleOnThousands) {
  std::atomic<int> next = 0, compared = 0, hidden = 0;
  const auto work = [&] {
    for (int seed = next++; seed < 4000; seed = next++) {
      const VisibilityInstance instance =
          seed % 4 == 3 ? slab_instance(seed, 1 + seed % 3, 2.0)
                        : grid_instance(seed, 1 + seed % 3, 2 + seed % 3);
      const NaiveVisibility naive = naive_visibility(instance);
      if (naive.answer == NaiveAnswer::Undecided) continue;
      const Verdict verdict =
          polygon_visibility({instance.a, instance.b, instance.occluders}).verdict;
      const bool is_hidden = naive.answer == NaiveAnswer::Hidden;
      EXPECT_EQ(verdict, is_hidden ? Verdict::Hidden : Verdict::Visible) << seed;
      ++compared;
      hidden += is_hidden;
    }
  };
  std::thread other(work);
  work();
  other.join();
  std::printf("oracle: %d compared, %d hidden\n", compared.load(), hidden.load());
  EXPECT_GT(compared, 3'900);
  EXPECT_GT(hidden, 300);
}

}  // namespace
}  // namespace sightline::testing
