// Polygon-to-polygon visibility between two parallel triangles at distance 1,
// circumradius 1/2, with n random triangles of mean edge length s between: visible and
// hidden apart, exact and double; and whole bodies of triangles.  A benchmark's argument
// names the set; its counters say how many of the set's questions are asked and what they
// took in the mean, at the 99th percentile and at worst.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <map>

#include "linespace/polygon_visibility.h"
#include "tests/support/visibility_cases.h"

namespace sightline::testing {
namespace {

struct Questions {
  std::vector<VisibilityQuestion> visible, hidden;
};

const Questions& questions(int n, double size) {
  static std::map<std::pair<int, double>, Questions> made;
  auto [entry, is_new] = made.try_emplace({n, size});
  if (!is_new) return entry->second;
  constexpr int kCount = 300;
  for (int seed = 0; seed < kCount; ++seed) {
    VisibilityInstance instance = slab_instance(seed, n, size);
    VisibilityQuestion q{instance.a, instance.b, std::move(instance.occluders)};
    const bool hidden = polygon_visibility(q).verdict == Verdict::Hidden;
    (hidden ? entry->second.hidden : entry->second.visible).push_back(std::move(q));
  }
  return entry->second;
}

void ask_all(benchmark::State& state, const std::vector<VisibilityQuestion>& set,
             Precision precision) {
  if (set.empty()) {
    state.SkipWithError("no such question among the random ones");
    return;
  }
  VisibilityRequest request;
  request.precision = precision;
  std::vector<double> milliseconds;
  for (auto _ : state) {
    for (const VisibilityQuestion& q : set) {
      const auto start = std::chrono::steady_clock::now();
      benchmark::DoNotOptimize(polygon_visibility(q, request));
      const std::chrono::duration<double, std::milli> spent =
          std::chrono::steady_clock::now() - start;
      milliseconds.push_back(spent.count());
    }
  }
  std::ranges::sort(milliseconds);
  double sum = 0;
  for (const double t : milliseconds) sum += t;
  const std::size_t count = milliseconds.size();
  state.counters["questions"] = static_cast<double>(set.size());
  state.counters["mean_ms"] = sum / static_cast<double>(count);
  state.counters["p99_ms"] = milliseconds[count * 99 / 100];
  state.counters["max_ms"] = milliseconds.back();
}

// Whole bodies of triangles between: what, and whether it hides.
VisibilityQuestion bodies(int which) {
  const auto end = [](double size, double z) -> Polygon {
    return {
        {size, 0, z}, {-0.5 * size, 0.875 * size, z}, {-0.5 * size, -0.875 * size, z}};
  };
  const double size = which == 0 ? 0.5 : which == 1 || which == 4 ? 0.25 : 0.3;
  VisibilityQuestion q{end(size, 0), end(size, 1), {}};
  const auto add = [&](const std::vector<Polygon>& body) {
    q.occluders.insert(q.occluders.end(), body.begin(), body.end());
  };
  switch (which) {
    case 0:
      add(bulge(16, 0.75, 0.25));
      break;
    case 1:
      add(ball({0, 0, 0.5}, 0.45, 16));
      break;
    case 2:
    case 3:  // with a gap between them
      add(ball({which == 2 ? 0.35 : 0.38, 0.01, 0.5}, 0.4, 16));
      add(ball({which == 2 ? -0.35 : -0.38, 0, 0.52}, 0.4, 16));
      break;
    default:  // past it near the corners
      q = {end(0.5, 0), end(0.5, 1), ball({0, 0, 0.5}, 0.49, 16)};
  }
  return q;
}

void BM_bodies(benchmark::State& state) {
  const VisibilityQuestion q = bodies(static_cast<int>(state.range(0)));
  Verdict verdict = Verdict::Undecided;
  for (auto _ : state) verdict = polygon_visibility(q).verdict;
  state.counters["triangles"] = static_cast<double>(q.occluders.size());
  state.counters["hidden"] = verdict == Verdict::Hidden ? 1 : 0;
}
BENCHMARK(BM_bodies)->ArgName("body")->DenseRange(0, 4)->Unit(benchmark::kMillisecond);

void BM_visible(benchmark::State& state, Precision precision) {
  ask_all(state, questions(state.range(0), state.range(1) / 100.0).visible, precision);
}
void BM_hidden(benchmark::State& state, Precision precision) {
  ask_all(state, questions(state.range(0), state.range(1) / 100.0).hidden, precision);
}

// Arguments: number of occluders, mean edge length in hundredths.  The papers say "mean
// size": 25 as a mean edge length, 22 as the mean diameter of the circumcircle.
BENCHMARK_CAPTURE(BM_visible, exact, Precision::Exact)
    ->ArgNames({"n", "s"})
    ->Args({100, 25})
    ->Args({200, 25})
    ->Args({100, 22})
    ->Args({200, 22})
    ->Args({100, 40})
    ->Args({100, 50})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_visible, double, Precision::Double)
    ->ArgNames({"n", "s"})
    ->Args({100, 25})
    ->Args({200, 25})
    ->Args({100, 22})
    ->Args({200, 22})
    ->Args({100, 40})
    ->Args({100, 50})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_hidden, exact, Precision::Exact)
    ->ArgNames({"n", "s"})
    ->Args({100, 40})
    ->Args({100, 43})
    ->Args({100, 50})
    ->Args({200, 40})
    ->Args({400, 40})
    ->Args({800, 40})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_hidden, double, Precision::Double)
    ->ArgNames({"n", "s"})
    ->Args({100, 40})
    ->Args({100, 43})
    ->Args({100, 50})
    ->Args({200, 40})
    ->Args({400, 40})
    ->Args({800, 40})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sightline::testing
