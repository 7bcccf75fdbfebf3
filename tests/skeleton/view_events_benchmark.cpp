// Queries in a skeleton of about 500,000 arcs: 110 random polytopes.  Building it takes
// some seconds, once.

#include <benchmark/benchmark.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <numeric>
#include <vector>

#include "linespace/scene.h"
#include "skeleton/build.h"
#include "skeleton/skeleton_index.h"
#include "skeleton/view_events.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

struct Data {
  Scene scene{testing::random_polytopes(1, 110, {.density = 0.2})};
  Skeleton skeleton = build_skeleton(scene);
  SkeletonIndex generators{scene, skeleton};
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  EndIndex ends{scene, skeleton};
  double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  ViewEvents events{scene, skeleton, ends};

  Data() {
    std::size_t pieces = 0;
    for (std::uint32_t i = 0; i < skeleton.arcs.size(); ++i) {
      pieces += ends.pieces(i).size();
    }
    std::printf("%zu EV and %zu EEE arcs, %zu pieces; index: %.2f s, %.1f MB\n",
                skeleton.ev().size(), skeleton.eee().size(), pieces, seconds,
                static_cast<double>(ends.bytes()) * 1e-6);
  }
};

const Data& data() {
  static const Data kData;
  return kData;
}

void BM_seen_from(benchmark::State& state) {
  const auto& d = data();
  std::int32_t facet = 0;
  const auto count = static_cast<std::int32_t>(d.scene.facets().size());
  for (auto _ : state) {
    benchmark::DoNotOptimize(d.ends.seen_from(facet));
    facet = (facet + 7) % count;
  }
}
BENCHMARK(BM_seen_from);

void BM_between_facets(benchmark::State& state) {
  const auto& d = data();
  std::int32_t facet = 0;
  const auto count = static_cast<std::int32_t>(d.scene.facets().size());
  for (auto _ : state) {
    benchmark::DoNotOptimize(d.ends.between_facets(facet, (facet + 101) % count));
    facet = (facet + 7) % count;
  }
}
BENCHMARK(BM_between_facets);

void BM_pieces(benchmark::State& state) {
  const auto& d = data();
  std::uint32_t arc = 0;
  const auto count = static_cast<std::uint32_t>(d.skeleton.ev().size());
  for (auto _ : state) {
    benchmark::DoNotOptimize(d.ends.pieces(arc));
    arc = (arc + 12345) % count;
  }
}
BENCHMARK(BM_pieces);

void BM_arcs_of_generator(benchmark::State& state) {
  const auto& d = data();
  std::int32_t edge = 0;
  const auto count = static_cast<std::int32_t>(d.scene.edges().size());
  for (auto _ : state) {
    benchmark::DoNotOptimize(d.generators.arcs_of({GeneratorKind::Edge, edge}));
    edge = (edge + 7) % count;
  }
}
BENCHMARK(BM_arcs_of_generator);

// Paths of one in that many of the scene's diagonal, at random places and in random
// directions.
std::vector<std::array<Point, 2>> paths(std::int64_t share) {
  const auto& bounds = data().scene.bounds();
  const Point size = bounds[1] - bounds[0];
  testing::Random random(7);
  const auto point = [&](double margin) {
    Point p;
    for (int i = 0; i < 3; ++i) {
      p[i] = bounds[0][i] + size[i] * random.uniform(margin, 1 - margin);
    }
    return p;
  };
  std::vector<std::array<Point, 2>> out;
  for (int i = 0; i < 32; ++i) {
    const Point a = point(0.2);
    const Point way = (point(0) - a).normalized() * size.norm();
    out.push_back({a, a + way / static_cast<double>(share)});
  }
  return out;
}

void report(benchmark::State& state, std::size_t events) {
  state.counters["events"] =
      static_cast<double>(events) / static_cast<double>(state.iterations());
}

// Paths as long as the scene's diagonal by these.
void of_all_lengths(benchmark::internal::Benchmark* b) {
  for (const int part : {1000000, 1000, 100, 10, 2}) b->Arg(part);
  b->Unit(benchmark::kMicrosecond);
}

void BM_crossed(benchmark::State& state) {
  const auto& d = data();
  const auto all = paths(state.range(0));
  state.counters["index_MB"] = static_cast<double>(d.events.index_bytes()) * 1e-6;
  std::size_t events = 0, i = 0;
  for (auto _ : state) {
    const auto& [a, b] = all[i++ % all.size()];
    events += d.events.crossed(a, b).size();
  }
  report(state, events);
}
BENCHMARK(BM_crossed)->Apply(of_all_lengths);

// The same, facets left out, without the index: every arc is asked.
void BM_crossed_asking_all(benchmark::State& state) {
  const auto& d = data();
  const auto all = paths(state.range(0));
  std::vector<std::uint32_t> arcs(d.skeleton.arcs.size());
  std::iota(arcs.begin(), arcs.end(), 0U);
  std::size_t events = 0, i = 0;
  for (auto _ : state) {
    const auto& [a, b] = all[i++ % all.size()];
    events += d.events.crossed(a, b, arcs).size();
  }
  report(state, events);
}
BENCHMARK(BM_crossed_asking_all)->Apply(of_all_lengths);

void BM_build_index(benchmark::State& state) {
  const auto& d = data();
  for (auto _ : state) {
    const ViewEvents events(d.scene, d.skeleton, d.ends);
    benchmark::DoNotOptimize(events.index_bytes());
  }
}
BENCHMARK(BM_build_index)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace sightline
