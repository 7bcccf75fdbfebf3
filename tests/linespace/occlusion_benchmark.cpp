// Rate of certified answers beside Embree's own rtcOccluded (robust flag) on the same
// segments: blocked and free ones apart, in a city of boxes and in a triangle soup.
//
// Arguments: scene (0 city, 1 soup), thousands of polygons, blocked (0/1).

#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "linespace/occlusion.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

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

struct Segment {
  Point a, b;
};

// A scene with Embree's view of it and segments that are blocked, and that are free.
struct Setting {
  std::unique_ptr<Scene> scene;
  std::unique_ptr<OcclusionIndex> index;
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene embree = rtcNewScene(device);
  std::vector<Segment> segments[2];  // [blocked]

  Setting(bool soup, int thousands) {
    const int count = 1000 * thousands;
    scene =
        std::make_unique<Scene>(soup ? triangle_soup(count) : testing::city(3, count));
    index = std::make_unique<OcclusionIndex>(*scene);
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
    RTCRay ray;
    ray.org_x = static_cast<float>(a[0]);
    ray.org_y = static_cast<float>(a[1]);
    ray.org_z = static_cast<float>(a[2]);
    ray.dir_x = static_cast<float>(b[0] - a[0]);
    ray.dir_y = static_cast<float>(b[1] - a[1]);
    ray.dir_z = static_cast<float>(b[2] - a[2]);
    ray.tnear = 0;
    ray.tfar = 1;
    ray.time = 0;
    ray.mask = ~0u;
    ray.id = 0;
    ray.flags = 0;
    rtcOccluded1(s.embree, &context, &ray);
    hits += ray.tfar < 0;
  }
  benchmark::DoNotOptimize(hits);
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}

void BM_is_free(benchmark::State& state) {
  const Setting& s = setting(state);
  const auto& segments = s.segments[state.range(2)];
  std::size_t i = 0, hits = 0;
  for (auto _ : state) {
    const auto& [a, b] = segments[i++ % segments.size()];
    hits += s.index->is_free(a, b);
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
BENCHMARK(BM_maximal_free_segment)
    ->ArgNames({"soup", "thousands", "blocked"})
    ->Args({0, 10, 0})
    ->Args({1, 10, 0});

}  // namespace
}  // namespace sightline
