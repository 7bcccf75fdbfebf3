// Queries in a skeleton of about 500,000 arcs: 110 random polytopes.  Building it takes
// some seconds, once.

#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdio>

#include "linespace/scene.h"
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
      pieces += ends.pieces({ArcKind::EV, i}).size();
    }
    for (std::uint32_t i = 0; i < skeleton.eee_arcs.size(); ++i) {
      pieces += ends.pieces({ArcKind::EEE, i}).size();
    }
    std::printf("%zu EV and %zu EEE arcs, %zu pieces; index: %.2f s, %.1f MB\n",
                skeleton.arcs.size(), skeleton.eee_arcs.size(), pieces, seconds,
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
  const auto count = static_cast<std::uint32_t>(d.skeleton.arcs.size());
  for (auto _ : state) {
    benchmark::DoNotOptimize(d.ends.pieces({ArcKind::EV, arc}));
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

// A path of that share of the scene's diagonal, at its middle.
void BM_crossed(benchmark::State& state) {
  const auto& d = data();
  const auto& bounds = d.scene.bounds();
  const Point middle = 0.5 * (bounds[0] + bounds[1]);
  const Point way = (bounds[1] - bounds[0]) / static_cast<double>(state.range(0));
  std::size_t events = 0;
  for (auto _ : state) {
    events = d.events.crossed(middle, middle + way).size();
  }
  state.counters["events"] = static_cast<double>(events);
}
BENCHMARK(BM_crossed)->Arg(100000)->Arg(100)->Arg(10)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sightline
