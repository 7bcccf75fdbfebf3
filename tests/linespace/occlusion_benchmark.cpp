// Rate of certified answers beside Embree's own rtcOccluded (robust flag) on the same
// segments: blocked and free ones apart, in a city of boxes and in a triangle soup.  Both
// ask whether anything is in the way, not what comes first, one segment a call.  `exact`
// counts the rays that double arithmetic could not certify: 0, for they are generic.
//
// Arguments: scene (0 city, 1 soup), thousands of polygons, blocked (0/1).

#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

#include <cmath>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "linespace/occlusion.h"
#include "tests/support/embree_rays.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

struct Segment {
  Point a, b;
};

// A scene with Embree's view of it and segments that are blocked, and that are free.
struct Setting {
  std::unique_ptr<Scene> scene;
  std::unique_ptr<OcclusionIndex> index;
  std::unique_ptr<testing::EmbreeTriangles> embree;
  std::vector<Segment> segments[2];  // [blocked]

  Setting(bool soup, int thousands) {
    const int count = 1000 * thousands;
    scene = std::make_unique<Scene>(soup ? testing::triangle_soup(5, count)
                                         : testing::city(3, count));
    index = std::make_unique<OcclusionIndex>(*scene);
    embree = std::make_unique<testing::EmbreeTriangles>(*scene);

    // Ends uniform in the scene's box; of free ones most are short.
    testing::Random random(17);
    const auto [low, high] = scene->bounds();
    const auto point = [&] {
      Point p;
      for (int i = 0; i < 3; ++i) p[i] = random.uniform(low[i], high[i]);
      return p;
    };
    constexpr std::size_t kEach = 1 << 14;
    while (segments[0].size() < kEach || segments[1].size() < kEach) {
      const Point a = point();
      Point b = point();
      if (segments[1].size() == kEach) b = a + random.uniform(0, 1) * (b - a);
      auto& list = segments[index->is_free(a, b) ? 0 : 1];
      if (list.size() < kEach) list.push_back({a, b});
    }
  }
};

const Setting& setting(const benchmark::State& state) {
  static std::map<std::tuple<std::int64_t, std::int64_t>, std::unique_ptr<Setting>> made;
  auto& s = made[{state.range(0), state.range(1)}];
  if (!s) s = std::make_unique<Setting>(state.range(0) == 1, state.range(1));
  return *s;
}

void BM_embree(benchmark::State& state) {
  const Setting& s = setting(state);
  const auto& segments = s.segments[state.range(2)];
  std::size_t i = 0, hits = 0;
  for (auto _ : state) {
    const auto& [a, b] = segments[i++ % segments.size()];
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = testing::embree_ray(a, b);
    rtcOccluded1(s.embree->scene(), &context, &ray);
    hits += ray.tfar < 0;
  }
  benchmark::DoNotOptimize(hits);
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}

void BM_is_free(benchmark::State& state) {
  const Setting& s = setting(state);
  const auto& segments = s.segments[state.range(2)];
  std::size_t i = 0, hits = 0;
  const StageCounts before = thread_stage_counts();
  for (auto _ : state) {
    const auto& [a, b] = segments[i++ % segments.size()];
    hits += s.index->is_free(a, b);
  }
  benchmark::DoNotOptimize(hits);
  state.counters["exact"] =
      static_cast<double>(thread_stage_counts().by_exact - before.by_exact);
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}

// Two closest hits, past b and before a: what a maximal free segment asks.
void BM_embree_two_hits(benchmark::State& state) {
  const Setting& s = setting(state);
  const auto& segments = s.segments[state.range(2)];
  std::size_t i = 0, hits = 0;
  for (auto _ : state) {
    const auto& [a, b] = segments[i++ % segments.size()];
    for (const bool forth : {true, false}) {
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      RTCRayHit hit;
      hit.ray = forth ? testing::embree_ray(a, b, 1, HUGE_VALF)
                      : testing::embree_ray(b, a, 1, HUGE_VALF);
      hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(s.embree->scene(), &context, &hit);
      hits += hit.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
  }
  benchmark::DoNotOptimize(hits);
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}

void BM_maximal_free_segment(benchmark::State& state) {
  const Setting& s = setting(state);
  const auto& segments = s.segments[state.range(2)];
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& [a, b] = segments[i++ % segments.size()];
    benchmark::DoNotOptimize(s.index->maximal_free_segment(a, b));
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}

void settings(benchmark::internal::Benchmark* b) {
  b->ArgNames({"soup", "thousands", "blocked"});
  for (const int soup : {0, 1}) {
    for (const int thousands : {10, 100}) {
      for (const int blocked : {1, 0}) b->Args({soup, thousands, blocked});
    }
  }
}
BENCHMARK(BM_embree)->Apply(settings);
BENCHMARK(BM_is_free)->Apply(settings);
BENCHMARK(BM_embree_two_hits)
    ->ArgNames({"soup", "thousands", "blocked"})
    ->Args({0, 10, 0})
    ->Args({1, 10, 0});
BENCHMARK(BM_maximal_free_segment)
    ->ArgNames({"soup", "thousands", "blocked"})
    ->Args({0, 10, 0})
    ->Args({1, 10, 0});

}  // namespace
}  // namespace sightline
