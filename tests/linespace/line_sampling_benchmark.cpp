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
#include "tests/support/generators.h"

namespace sightline {
namespace {

constexpr int kSegments = 1 << 16;

PolygonSoup triangle_soup(int count) {
  testing::Random random(5);
  PolygonSoup soup;
  for (int i = 0; i < count; ++i) {
    const Point center(random.uniform(-1, 1), random.uniform(-1, 1),
                       random.uniform(-1, 1));
    const double size = 1.5 / std::sqrt(static_cast<double>(count));
    for (int c = 0; c < 3; ++c) {
      soup.vertices.push_back(center + Point(random.uniform(-size, size),
                                             random.uniform(-size, size),
                                             random.uniform(-size, size)));
    }
    soup.polygons.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return soup;
}

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
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene embree = rtcNewScene(device);
  std::vector<RTCRay> rays;  // of the first kSegments samples

  Setting(bool soup, int thousands, bool all) {
    const int count = 1000 * thousands;
    scene =
        std::make_unique<Scene>(soup ? triangle_soup(count) : testing::city(3, count));
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
    add_to_embree();
    make_rays();
  }

  void add_to_embree() {
    rtcSetSceneFlags(embree, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(embree, RTC_BUILD_QUALITY_HIGH);
    std::vector<float> vertices;
    for (const Point& p : scene->points()) {
      for (const double x : p) vertices.push_back(static_cast<float>(x));
    }
    std::vector<unsigned> triangles;
    for (int f = 0; f < static_cast<int>(scene->faces().size()); ++f) {
      const auto ids = scene->face_points(f);
      for (std::size_t i = 1; i + 1 < ids.size(); ++i) {
        for (const int p : {ids[0], ids[i], ids[i + 1]}) {
          triangles.push_back(static_cast<unsigned>(p));
        }
      }
    }
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    std::copy(vertices.begin(), vertices.end(),
              static_cast<float*>(rtcSetNewGeometryBuffer(
                  geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                  3 * sizeof(float), vertices.size() / 3)));
    std::copy(triangles.begin(), triangles.end(),
              static_cast<unsigned*>(rtcSetNewGeometryBuffer(
                  geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                  3 * sizeof(unsigned), triangles.size() / 3)));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(embree, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(embree);
  }

  // Ends stand off by a thousandth, so that Embree does not hit the end faces: this is
  // what a sampler that needs no care would do.
  void make_rays() {
    const PolygonSampler from(*scene, a), to(*scene, b);
    for (int i = 0; i < kSegments; ++i) {
      SampleNumbers numbers(1, static_cast<std::uint64_t>(i));
      const PairSegment s = segment_between(from, to, numbers);
      const Point d = s.b.point - s.a.point;
      RTCRay ray{};
      ray.org_x = static_cast<float>(s.a.point[0]);
      ray.org_y = static_cast<float>(s.a.point[1]);
      ray.org_z = static_cast<float>(s.a.point[2]);
      ray.dir_x = static_cast<float>(d[0]);
      ray.dir_y = static_cast<float>(d[1]);
      ray.dir_z = static_cast<float>(d[2]);
      ray.mask = ~0u;
      rays.push_back(ray);
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
      ray.tnear = 0.001F;
      ray.tfar = 0.999F;
      rtcOccluded1(s.embree, &context, &ray);
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
        rays.tnear[r] = 0.001F;
        rays.tfar[r] = 0.999F;
        rays.mask[r] = ~0u;
      }
      rtcOccluded8(valid, s.embree, &context, &rays);
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
