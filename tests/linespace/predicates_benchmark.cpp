// Cost and correctness of orient3d in every form and stage beside plain double arithmetic
// and CGAL's Epick, on random, near-degenerate (rounded onto the plane), integer-grid and
// many-decades input (half of the grid's quadruples are coplanar); and of
// compare_crossings.  Compare ratios within one run.
//
// The counter `each` is the time of one predicate in seconds; `wrong` is how many of the
// kCount signs differ from rational arithmetic, `undecided` how many a stage leaves open.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <benchmark/benchmark.h>

#include <array>
#include <vector>

#include "linespace/numbers/predicates.h"
#include "linespace/predicates.h"
#include "tests/support/random_geometry.h"

namespace sightline {
namespace {

using Eigen::Vector3d;
using testing::RandomGeometry;
using testing::Terrain;

enum Input { Random, NearDegenerate, IntegerGrid, ManyDecades };
constexpr int kCount = 256;  // 24 kB of points: they stay in the first-level cache

struct Quadruple {
  Vector3d a, b, c, d;
};

bool on_plane(Input input) { return input == NearDegenerate || input == ManyDecades; }

Vector3d rounded_onto_plane(RandomGeometry& random, const Vector3d& a, const Vector3d& b,
                            const Vector3d& c) {
  const double s = random.uniform(-2, 2);
  return a + s * (b - a) + random.uniform(-2, 2) * (c - a);
}

Quadruple quadruple(RandomGeometry& random, Input input) {
  const auto terrain = input == IntegerGrid   ? Terrain::Grid
                       : input == ManyDecades ? Terrain::Decades
                                              : Terrain::Uniform;
  Quadruple q{random.point(terrain), random.point(terrain), random.point(terrain),
              random.point(terrain)};
  if (on_plane(input)) q.d = rounded_onto_plane(random, q.a, q.b, q.c);
  if (input == IntegerGrid && random.one_in(2))  // half of them exactly coplanar
    q.d = q.a + random.integer(-2, 2) * (q.b - q.a) + random.integer(-2, 2) * (q.c - q.a);
  return q;
}

std::vector<Quadruple> quadruples(Input input) {
  RandomGeometry random(7);
  std::vector<Quadruple> out;
  for (int i = 0; i < kCount; ++i) out.push_back(quadruple(random, input));
  return out;
}

struct OnePlane {
  PlaneThrough plane;
  std::vector<Vector3d> points;
};
OnePlane one_plane(Input input) {
  RandomGeometry random(8);
  const Quadruple q = quadruple(random, input);
  OnePlane out{{q.a, q.b, q.c}, {}};
  for (int i = 0; i < kCount; ++i) {
    const bool coplanar = input == IntegerGrid && random.one_in(2);
    const double s = random.integer(-2, 2), t = random.integer(-2, 2);
    out.points.push_back(on_plane(input) ? rounded_onto_plane(random, q.a, q.b, q.c)
                         : coplanar      ? q.a + s * (q.b - q.a) + t * (q.c - q.a)
                                         : quadruple(random, input).d);
  }
  return out;
}

Sign rational_orient3d(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                       const Vector3d& d) {
  using Q = CGAL::Exact_rational;
  std::array<std::array<Q, 3>, 3> m;
  for (int k = 0; k < 3; ++k) {
    m[0][k] = Q(b[k]) - Q(a[k]);
    m[1][k] = Q(c[k]) - Q(a[k]);
    m[2][k] = Q(d[k]) - Q(a[k]);
  }
  const Q det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return det > 0 ? Sign::Positive : det < 0 ? Sign::Negative : Sign::Zero;
}

Sign plain_double(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                  const Vector3d& d) {
  const double u0 = b[0] - a[0], u1 = b[1] - a[1], u2 = b[2] - a[2];
  const double v0 = c[0] - a[0], v1 = c[1] - a[1], v2 = c[2] - a[2];
  const double w0 = d[0] - a[0], w1 = d[1] - a[1], w2 = d[2] - a[2];
  return internal::sign_of(w0 * (u1 * v2 - u2 * v1) + w1 * (u2 * v0 - u0 * v2) +
                           w2 * (u0 * v1 - u1 * v0));
}

int as_int(std::optional<Sign> s) { return s ? static_cast<int>(*s) : 0; }
int as_int(Sign s) { return static_cast<int>(s); }

void report_time(benchmark::State& state) {
  state.counters["each"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * kCount,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

template <auto function>
void BM_orient3d(benchmark::State& state) {
  const auto input = quadruples(static_cast<Input>(state.range(0)));
  int wrong = 0, undecided = 0;
  for (const auto& [a, b, c, d] : input) {
    const std::optional<Sign> s = function(a, b, c, d);
    wrong += s && *s != rational_orient3d(a, b, c, d);
    undecided += !s;
  }
  for (auto _ : state) {
    int sum = 0;
    for (const auto& [a, b, c, d] : input) sum += as_int(function(a, b, c, d));
    benchmark::DoNotOptimize(sum);
  }
  report_time(state);
  state.counters["wrong"] = wrong;
  state.counters["undecided"] = undecided;
}

void BM_epick(benchmark::State& state) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  const auto input = quadruples(static_cast<Input>(state.range(0)));
  std::vector<std::array<Kernel::Point_3, 4>> points;
  int wrong = 0;
  for (const auto& [a, b, c, d] : input) {
    points.push_back({Kernel::Point_3(a[0], a[1], a[2]),
                      {b[0], b[1], b[2]},
                      {c[0], c[1], c[2]},
                      {d[0], d[1], d[2]}});
    const auto& p = points.back();
    wrong += static_cast<int>(CGAL::orientation(p[0], p[1], p[2], p[3])) !=
             static_cast<int>(rational_orient3d(a, b, c, d));
  }
  for (auto _ : state) {
    int sum = 0;
    for (const auto& p : points) sum += CGAL::orientation(p[0], p[1], p[2], p[3]);
    benchmark::DoNotOptimize(sum);
  }
  report_time(state);
  state.counters["wrong"] = wrong;
}

void BM_plane_side(benchmark::State& state) {
  const auto [plane, points] = one_plane(static_cast<Input>(state.range(0)));
  const PlaneSide on(plane);
  int wrong = 0;
  for (const auto& p : points)
    wrong += on(p) != rational_orient3d(plane.a, plane.b, plane.c, p);
  for (auto _ : state) {
    int sum = 0;
    for (const auto& p : points) sum += as_int(on(p));
    benchmark::DoNotOptimize(sum);
  }
  report_time(state);
  state.counters["wrong"] = wrong;
}

void BM_batch(benchmark::State& state) {
  const auto [plane, points] = one_plane(static_cast<Input>(state.range(0)));
  std::array<std::vector<double>, 3> x;
  for (const auto& p : points) {
    for (int k = 0; k < 3; ++k) x[k].push_back(p[k]);
  }
  std::vector<Sign> signs(points.size());
  for (auto _ : state) {
    orient3d_batch(plane, x[0], x[1], x[2], signs);
    benchmark::ClobberMemory();
  }
  int wrong = 0;
  for (int i = 0; i < kCount; ++i)
    wrong += signs[i] != rational_orient3d(plane.a, plane.b, plane.c, points[i]);
  report_time(state);
  state.counters["wrong"] = wrong;
}

struct Crossings {
  LineThrough edge;
  PlaneThrough p, q;
};

template <class Number>
std::optional<Sign> naive_compare(const Crossings& x) {
  const auto& [edge, p, q] = x;
  using V = std::array<Number, 3>;
  const auto sub = [](const Vector3d& s, const Vector3d& t) {
    return V{Number(s[0]) - Number(t[0]), Number(s[1]) - Number(t[1]),
             Number(s[2]) - Number(t[2])};
  };
  const auto triple = [](const V& u, const V& v, const V& w) {
    return Number(u[0] * (v[1] * w[2] - v[2] * w[1]) +
                  u[1] * (v[2] * w[0] - v[0] * w[2]) +
                  u[2] * (v[0] * w[1] - v[1] * w[0]));
  };
  const auto cut = [&](const PlaneThrough& plane) {
    const V u = sub(plane.b, plane.a), v = sub(plane.c, plane.a);
    return std::array<Number, 2>{triple(sub(edge.from, plane.a), u, v),
                                 triple(sub(edge.to, edge.from), u, v)};
  };
  const auto f = cut(p), g = cut(q);
  if (f[1] == 0 || g[1] == 0) return std::nullopt;
  const Number n =
      (g[0] * f[1] - f[0] * g[1]) * Number(f[1] > 0 ? 1 : -1) * Number(g[1] > 0 ? 1 : -1);
  return n > 0 ? Sign::Positive : n < 0 ? Sign::Negative : Sign::Zero;
}

/// Edges that two planes cross: anywhere, in nearly the same point, on a grid.
std::vector<Crossings> crossings(Input input) {
  RandomGeometry random(9);
  std::vector<Crossings> out;
  while (out.size() < kCount) {
    const Quadruple u = quadruple(random, input);
    const Quadruple v = quadruple(random, input);
    Crossings x{{u.a, v.a}, {u.b, u.c, v.d}, {v.b, v.c, u.d}};
    if (on_plane(input)) x.p.a = x.q.a = u.a + random.uniform(0, 1) * (v.a - u.a);
    if (naive_compare<CGAL::Exact_rational>(x)) out.push_back(x);
  }
  return out;
}

Sign plain_compare(const LineThrough& edge, const PlaneThrough& p,
                   const PlaneThrough& q) {
  return naive_compare<double>({edge, p, q}).value_or(Sign::Zero);
}

template <auto function>
void BM_compare_crossings(benchmark::State& state) {
  const auto input = crossings(static_cast<Input>(state.range(0)));
  int wrong = 0, undecided = 0;
  for (const auto& x : input) {
    const std::optional<Sign> s = function(x.edge, x.p, x.q);
    wrong += s && *s != naive_compare<CGAL::Exact_rational>(x);
    undecided += !s;
  }
  for (auto _ : state) {
    int sum = 0;
    for (const auto& [edge, p, q] : input) sum += as_int(function(edge, p, q));
    benchmark::DoNotOptimize(sum);
  }
  report_time(state);
  state.counters["wrong"] = wrong;
  state.counters["undecided"] = undecided;
}

#define SIGHTLINE_INPUTS ArgName("input")->DenseRange(Random, ManyDecades)
BENCHMARK(BM_orient3d<plain_double>)->SIGHTLINE_INPUTS;
BENCHMARK(BM_epick)->SIGHTLINE_INPUTS;
BENCHMARK(BM_orient3d<orient3d>)->SIGHTLINE_INPUTS;
BENCHMARK(BM_plane_side)->SIGHTLINE_INPUTS;
BENCHMARK(BM_batch)->SIGHTLINE_INPUTS;
BENCHMARK(BM_orient3d<internal::double_orient3d>)->SIGHTLINE_INPUTS;
BENCHMARK(BM_orient3d<internal::integer_orient3d<1>>)->SIGHTLINE_INPUTS;
BENCHMARK(BM_orient3d<internal::interval_orient3d>)->SIGHTLINE_INPUTS;
BENCHMARK(BM_orient3d<internal::integer_orient3d<2>>)->SIGHTLINE_INPUTS;
BENCHMARK(BM_orient3d<internal::integer_orient3d<6>>)->SIGHTLINE_INPUTS;
BENCHMARK(BM_orient3d<rational_orient3d>)->SIGHTLINE_INPUTS;
BENCHMARK(BM_compare_crossings<plain_compare>)->SIGHTLINE_INPUTS;
BENCHMARK(BM_compare_crossings<compare_crossings>)->SIGHTLINE_INPUTS;
BENCHMARK(BM_compare_crossings<internal::integer_compare_crossings<1>>)->SIGHTLINE_INPUTS;
BENCHMARK(BM_compare_crossings<internal::interval_compare_crossings>)->SIGHTLINE_INPUTS;
BENCHMARK(BM_compare_crossings<internal::integer_compare_crossings<2>>)->SIGHTLINE_INPUTS;
BENCHMARK(BM_compare_crossings<internal::integer_compare_crossings<6>>)->SIGHTLINE_INPUTS;

}  // namespace
}  // namespace sightline
