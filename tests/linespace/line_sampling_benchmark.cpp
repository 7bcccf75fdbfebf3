// Price of random lines, and of visibility estimates beside Embree's own rtcOccluded
// (robust flag; one ray a call, and packets of 8) on the very same segments.
//
// Arguments of the estimates: scene (0 city, 1 soup), thousands of polygons, and which
// faces: 0 six near one place to six near another, 1 all faces to all; then threads.  The
// set-up of a call (areas of the faces) is part of its time.

#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

#include <algorithm>
#include <map>
#include <memory>
#include <numeric>
#include <tuple>
#include <vector>

#include "linespace/line_sampling.h"
#include "linespace/occlusion.h"
#include "linespace/visibility_estimate.h"
#include "tests/support/embree_rays.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

constexpr int kSegments = 1 << 16;

// The faces nearest to a point.
std::vector<int> faces_at(const Scene& scene, const Point& place, std::size_t count) {
  std::vector<std::pair<double, int>> order;
  for (int f = 0; f < static_cast<int>(scene.faces().size()); ++f) {
    const Point& p = scene.point(scene.face_points(f)[0]);
    order.emplace_back((p - place).squaredNorm(), f);
  }
  std::sort(order.begin(), order.end());
  std::vector<int> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(order[i].second);
  return out;
}

struct Setting {
  std::unique_ptr<Scene> scene;
  std::unique_ptr<OcclusionIndex> index;
  std::vector<int> a, b;
  std::unique_ptr<testing::EmbreeTriangles> embree;
  std::vector<RTCRay> rays;  // of the first kSegments samples

  Setting(bool soup, int thousands, bool all) {
    const int count = 1000 * thousands;
    scene = std::make_unique<Scene>(soup ? testing::triangle_soup(5, count)
                                         : testing::city(3, count));
    index = std::make_unique<OcclusionIndex>(*scene);
    if (all) {
      a.resize(scene->faces().size());
      std::iota(a.begin(), a.end(), 0);
      b = a;
    } else {
      const auto& [low, high] = scene->bounds();
      a = faces_at(*scene, low + 0.4 * (high - low), 6);
      b = faces_at(*scene, low + 0.6 * (high - low), 6);
    }
    embree = std::make_unique<testing::EmbreeTriangles>(*scene);
    make_rays();
  }

  // Ends stand off by a thousandth, so that Embree does not hit the end faces: this is
  // what a sampler that needs no care would do.
  void make_rays() {
    const PolygonSampler from(*scene, a), to(*scene, b);
    for (int i = 0; i < kSegments; ++i) {
      SampleNumbers numbers(1, static_cast<std::uint64_t>(i));
      const PairSegment s = segment_between(from, to, numbers);
      rays.push_back(testing::embree_ray(s.a.point, s.b.point, 0.001F, 0.999F));
    }
  }
};

const Setting& setting(const benchmark::State& state) {
  static std::map<std::tuple<std::int64_t, std::int64_t, std::int64_t>,
                  std::unique_ptr<Setting>>
      made;
  auto& s = made[{state.range(0), state.range(1), state.range(2)}];
  if (!s) {
    s = std::make_unique<Setting>(state.range(0) == 1, static_cast<int>(state.range(1)),
                                  state.range(2) == 1);
  }
  return *s;
}

void BM_embree(benchmark::State& state) {
  const Setting& s = setting(state);
  double free = 0;
  for (auto _ : state) {
    free = 0;
    for (RTCRay ray : s.rays) {
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      rtcOccluded1(s.embree->scene(), &context, &ray);
      free += !(ray.tfar < 0);
    }
  }
  state.counters["free"] = free / kSegments;
  state.SetItemsProcessed(kSegments * static_cast<std::int64_t>(state.iterations()));
}

void BM_embree_packets(benchmark::State& state) {
  const Setting& s = setting(state);
  double free = 0;
  for (auto _ : state) {
    free = 0;
    for (std::size_t i = 0; i < s.rays.size(); i += 8) {
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      alignas(32) const int valid[8] = {-1, -1, -1, -1, -1, -1, -1, -1};
      RTCRay8 rays{};
      for (int r = 0; r < 8; ++r) {
        const RTCRay& ray = s.rays[i + static_cast<std::size_t>(r)];
        rays.org_x[r] = ray.org_x;
        rays.org_y[r] = ray.org_y;
        rays.org_z[r] = ray.org_z;
        rays.dir_x[r] = ray.dir_x;
        rays.dir_y[r] = ray.dir_y;
        rays.dir_z[r] = ray.dir_z;
        rays.tnear[r] = ray.tnear;
        rays.tfar[r] = ray.tfar;
        rays.mask[r] = ~0u;
      }
      rtcOccluded8(valid, s.embree->scene(), &context, &rays);
      for (const float tfar : rays.tfar) free += !(tfar < 0);
    }
  }
  state.counters["free"] = free / kSegments;
  state.SetItemsProcessed(kSegments * static_cast<std::int64_t>(state.iterations()));
}

void BM_estimate(benchmark::State& state) {
  const Setting& s = setting(state);
  Request request;
  request.threads = static_cast<int>(state.range(3));
  VisibilityEstimate e;
  for (auto _ : state) {
    e = estimate_visibility(*s.index, s.a, s.b, {.samples = kSegments}, request);
  }
  state.counters["free"] = e.fraction.value;
  state.SetItemsProcessed(kSegments * static_cast<std::int64_t>(state.iterations()));
}

void settings(benchmark::internal::Benchmark* b) {
  b->ArgNames({"soup", "thousands", "all"});
  for (const int soup : {0, 1}) {
    for (const int thousands : {10, 100}) {
      for (const int all : {0, 1}) b->Args({soup, thousands, all});
    }
  }
}
void settings_and_threads(benchmark::internal::Benchmark* b) {
  b->ArgNames({"soup", "thousands", "all", "threads"})->UseRealTime();
  for (const int soup : {0, 1}) {
    for (const int thousands : {10, 100}) {
      for (const int all : {0, 1}) {
        for (const int threads : {1, 2}) b->Args({soup, thousands, all, threads});
      }
    }
  }
}
BENCHMARK(BM_embree)->Apply(settings)->UseRealTime();
BENCHMARK(BM_embree_packets)->Apply(settings)->UseRealTime();
BENCHMARK(BM_estimate)->Apply(settings_and_threads);

// Price of one draw.
template <class Draw>
void draws(benchmark::State& state, const Draw& draw) {
  std::uint64_t i = 0;
  for (auto _ : state) {
    SampleNumbers numbers(1, i++);
    benchmark::DoNotOptimize(draw(numbers));
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}

void BM_line_by_two_points(benchmark::State& state) {
  const Ball ball{{1, 2, 3}, 2};
  draws(state, [&](SampleNumbers& n) { return line_by_two_points(ball, n); });
}
void BM_line_by_direction(benchmark::State& state) {
  const Ball ball{{1, 2, 3}, 2};
  draws(state, [&](SampleNumbers& n) { return line_by_direction(ball, n); });
}
void BM_line_of_box(benchmark::State& state) {
  const ConvexBodyLines lines(Point(0, 0, 0), Point(1, 2, 3));
  draws(state, [&](SampleNumbers& n) { return lines.line(n); });
}
void BM_segment_between(benchmark::State& state) {
  const std::vector<std::vector<Point>> a = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}};
  const std::vector<std::vector<Point>> b = {{{0, 0, 1}, {1, 0, 1}, {1, 1, 1}}};
  const PolygonSampler from(a), to(b);
  draws(state, [&](SampleNumbers& n) { return segment_between(from, to, n); });
}
void BM_line_through(benchmark::State& state) {
  const std::vector<std::vector<Point>> a = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}};
  const std::vector<Point> b = {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}};
  const PolygonSampler from(a);
  draws(state, [&](SampleNumbers& n) { return line_through(from, b, n); });
}
BENCHMARK(BM_line_by_two_points);
BENCHMARK(BM_line_by_direction);
BENCHMARK(BM_line_of_box);
BENCHMARK(BM_segment_between);
BENCHMARK(BM_line_through);

}  // namespace
}  // namespace sightline
