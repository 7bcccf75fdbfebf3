// Cost and correctness of the count of lines through four lines, in every stage, beside
// plain double arithmetic and exact arithmetic with CGAL's Mpzf and Gmpq; and of all
// lines through n segments.  Inputs: random lines; lines near a tangency (the fourth
// rounded into the tangent plane of the regulus of three); small integers.  Compare
// ratios within one run.
//
// The counter `each` is the time of one quadruple in seconds; `wrong` is how many of the
// kCount signs differ from rational arithmetic, `undecided` how many a stage leaves open.

#include <CGAL/Gmpq.h>
#include <CGAL/Mpzf.h>
#include <benchmark/benchmark.h>

#include <array>
#include <vector>

#include "linespace/lines/transversals.h"
#include "linespace/segment_transversals.h"
#include "tests/support/random_geometry.h"

namespace sightline {
namespace {

using Eigen::Vector3d;
using testing::RandomGeometry;
using testing::Terrain;

enum Input { Random, NearTangent, IntegerGrid };
constexpr int kCount = 256;
using Four = std::array<LineThrough, 4>;

LineThrough random_line(RandomGeometry& random, Terrain terrain) {
  for (;;) {
    const LineThrough l{random.point(terrain), random.point(terrain)};
    if (l.from != l.to) return l;
  }
}

std::vector<Four> inputs(Input input) {
  RandomGeometry random(17);
  std::vector<Four> out;
  while (static_cast<int>(out.size()) < kCount) {
    Four l;
    for (LineThrough& x : l) {
      x = random_line(random, input == IntegerGrid ? Terrain::Grid : Terrain::Uniform);
    }
    if (input == NearTangent) {
      const Vector3d p = l[0].from + random.uniform(-1, 1) * (l[0].to - l[0].from);
      const auto ruling = ExactLine::through(p, l[1], l[2]);
      const Vector3d d = ruling->direction().point;
      const double s = random.uniform(-2, 2), t = random.uniform(-2, 2);
      l[3].from = p + random.uniform(-1, 1) * (s * d + t * (l[0].to - l[0].from));
      l[3].to = p + random.uniform(1, 2) * (s * d + t * (l[0].to - l[0].from));
    }
    out.push_back(l);
  }
  return out;
}

// The discriminant over any number type.
template <class T>
int discriminant_sign(const Four& l) {
  const auto side_of = [](const LineThrough& a, const LineThrough& b) {
    std::array<T, 3> u, v, w;
    for (int i = 0; i < 3; ++i) {
      u[i] = T(a.to[i]) - T(a.from[i]);
      v[i] = T(b.from[i]) - T(a.from[i]);
      w[i] = T(b.to[i]) - T(a.from[i]);
    }
    return T(u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
             u[2] * (v[0] * w[1] - v[1] * w[0]));
  };
  const T a = side_of(l[0], l[1]) * side_of(l[2], l[3]);
  const T b = side_of(l[0], l[2]) * side_of(l[1], l[3]);
  const T c = side_of(l[0], l[3]) * side_of(l[1], l[2]);
  const T d = a * a + b * b + c * c - T(2) * (a * b + a * c + b * c);
  return (d > T(0) ? 1 : 0) - (d < T(0) ? 1 : 0);
}

int sign_of_class(TransversalClass c) {
  if (c == TransversalClass::None) return -1;
  return c == TransversalClass::Two || c == TransversalClass::OneOtherAtInfinity ? 1 : 0;
}

template <class Classify>
void run(benchmark::State& state, Input input, Classify classify) {
  const std::vector<Four> all = inputs(input);
  for (auto _ : state) {
    int sum = 0;
    for (const Four& l : all) sum += classify(l).value_or(0);
    benchmark::DoNotOptimize(sum);
  }
  int wrong = 0, undecided = 0;
  for (const Four& l : all) {
    const auto s = classify(l);
    undecided += s ? 0 : 1;
    wrong += s && *s != discriminant_sign<CGAL::Gmpq>(l) ? 1 : 0;
  }
  state.counters["wrong"] = wrong;
  state.counters["undecided"] = undecided;
  state.counters["each"] =
      benchmark::Counter(kCount, benchmark::Counter::kIsIterationInvariantRate |
                                     benchmark::Counter::kInvert);
}

template <class T>
void BM_plain(benchmark::State& state) {
  run(state, static_cast<Input>(state.range(0)),
      [](const Four& l) { return std::optional<int>(discriminant_sign<T>(l)); });
}
BENCHMARK(BM_plain<double>)->ArgName("input")->DenseRange(0, 2);
BENCHMARK(BM_plain<CGAL::Mpzf>)->ArgName("input")->DenseRange(0, 2);
BENCHMARK(BM_plain<CGAL::Gmpq>)->ArgName("input")->DenseRange(0, 2);

void BM_transversal_class(benchmark::State& state) {
  run(state, static_cast<Input>(state.range(0)), [](const Four& l) {
    return std::optional<int>(sign_of_class(transversal_class(l[0], l[1], l[2], l[3])));
  });
}
BENCHMARK(BM_transversal_class)->ArgName("input")->DenseRange(0, 2);

using Stage =
    std::optional<TransversalClass> (*)(const std::array<const LineThrough*, 4>&);
template <Stage stage>
void BM_stage(benchmark::State& state) {
  run(state, static_cast<Input>(state.range(0)), [](const Four& l) -> std::optional<int> {
    const auto c = stage({&l[0], &l[1], &l[2], &l[3]});
    if (!c) return std::nullopt;
    return sign_of_class(*c);
  });
}
BENCHMARK(BM_stage<internal::double_transversal_class>)
    ->Name("BM_stage<double>")
    ->ArgName("input")
    ->DenseRange(0, 2);
BENCHMARK(BM_stage<internal::interval_transversal_class>)
    ->Name("BM_stage<interval>")
    ->ArgName("input")
    ->DenseRange(0, 2);
BENCHMARK(BM_stage<internal::integer_transversal_class>)
    ->Name("BM_stage<integer>")
    ->ArgName("input")
    ->DenseRange(0, 2);

void BM_lines(benchmark::State& state) {
  const std::vector<Four> all = inputs(Random);
  for (auto _ : state) {
    std::size_t sum = 0;
    for (const Four& l : all) sum += transversals(l[0], l[1], l[2], l[3]).lines.size();
    benchmark::DoNotOptimize(sum);
  }
  state.counters["each"] =
      benchmark::Counter(kCount, benchmark::Counter::kIsIterationInvariantRate |
                                     benchmark::Counter::kInvert);
}
BENCHMARK(BM_lines);

// Segments with both ends uniform in a cube, on one thread.
void BM_segments(benchmark::State& state) {
  RandomGeometry random(5);
  std::vector<LineThrough> segments;
  for (int i = 0; i < state.range(0); ++i) {
    segments.push_back(random_line(random, Terrain::Uniform));
  }
  TransversalRequest request;
  request.threads = 1;
  request.only_count = state.range(1) != 0;
  std::uint64_t lines = 0;
  for (auto _ : state) {
    lines = transversals_of_segments(segments, {}, request).line_count;
    benchmark::DoNotOptimize(lines);
  }
  state.counters["lines"] = static_cast<double>(lines);
}
BENCHMARK(BM_segments)
    ->ArgNames({"n", "only_count"})
    ->ArgsProduct({{50, 100}, {0, 1}})
    ->Args({200, 1})
    ->Args({400, 1})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sightline
