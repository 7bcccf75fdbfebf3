// Irradiance on a city's ground: error against time, of the exact values, of polynomials
// over the discontinuity mesh and of random rays.
//
//   irradiance_tradeoff [POINTS [POLYGONS [THREADS]]]
//
// Errors are divided by the mean of what the ground would receive if nothing blocked.
// Times are of the processor, of all threads together, so that other work does not count.
// The time of a mesh contains finding it.  Many rays are shot from the first points only,
// and their time is that of these points times what all are to them.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numbers>
#include <random>
#include <string>

#include "linespace/occlusion.h"
#include "linespace/work/parallel.h"
#include "shadows/irradiance.h"
#include "shadows/point_form_factor.h"
#include "tests/support/generators.h"

namespace {

using namespace sightline;

double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Study {
  explicit Study(int polygons) : scene(testing::lit_city(polygons, false)) {
    ground.faces = scene.faces_named("ground");
    for (const int p : scene.face_points(scene.faces_named("light").front()))
      lamp.push_back(scene.point(p));
    // Seen from below counter-clockwise.
    const Eigen::Vector3d across = (lamp[1] - lamp[0]).cross(lamp[2] - lamp[0]);
    if (across.z() > 0) std::reverse(lamp.begin(), lamp.end());
    area = across.norm();
  }

  // Of the first points.
  template <class Value>
  std::vector<double> values(std::size_t count, Value&& value) const {
    std::vector<double> values(count);
    internal::Stage stage(request, "points");
    internal::for_each_of(0, count, count, request, stage,
                          [&](std::size_t i) { values[i] = value(i); });
    return values;
  }
  template <class Value>
  std::vector<double> all(Value&& value) const {
    return values(points.size(), value);
  }

  void row(const std::string& name, double time, const std::vector<double>& v) const {
    double sum = 0, most = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
      const double off = std::abs(v[i] - exact[i]) / mean;
      sum += off * off;
      most = std::max(most, off);
    }
    std::printf("| %-28s | %8.3f | %.2e | %.2e |\n", name.c_str(), time,
                std::sqrt(sum / static_cast<double>(v.size())), most);
    std::fflush(stdout);
  }

  Scene scene;
  Receiver ground{"ground", {}, true};
  std::vector<Point> lamp;  // a parallelogram
  double area = 0, mean = 0;
  Request request;
  std::vector<Point> points;
  std::vector<double> exact;
};

void scatter(Study& study, int count) {
  const auto& [low, high] = study.scene.bounds();
  std::mt19937_64 random(996);
  std::uniform_real_distribution<double> x(low.x(), high.x()), y(low.y(), high.y());
  for (int i = 0; i < count; ++i) study.points.emplace_back(x(random), y(random), 0);
  for (const Point& p : study.points)
    study.mean += point_form_factor(p, {0, 0, 1}, study.lamp) / count;
}

void rays(const Study& study) {
  const double begun = seconds();
  const OcclusionIndex occlusion(study.scene);
  const double built = seconds() - begun;
  for (int n = 10; n <= 100000; n *= 10) {
    constexpr std::size_t kMostRays = 30'000'000;
    const std::size_t count = std::min(study.points.size(), kMostRays / n);
    const double start = seconds();
    const auto values = study.values(count, [&](std::size_t i) {
      std::mt19937_64 random(i);
      std::uniform_real_distribution<double> unit(0, 1);
      double sum = 0;
      for (int k = 0; k < n; ++k) {
        const Point at = study.lamp[0] + unit(random) * (study.lamp[1] - study.lamp[0]) +
                         unit(random) * (study.lamp[3] - study.lamp[0]);
        const Eigen::Vector3d way = at - study.points[i];
        const double r2 = way.squaredNorm();
        if (occlusion.is_free(study.points[i], at))
          sum += study.area * way.z() * way.z() / (std::numbers::pi * r2 * r2);
      }
      return sum / n;
    });
    const double share =
        static_cast<double>(study.points.size()) / static_cast<double>(count);
    study.row("rays, " + std::to_string(n), built + share * (seconds() - start), values);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 100000;
  Study study(argc > 2 ? std::atoi(argv[2]) : 996);
  study.request.threads = argc > 3 ? std::atoi(argv[3]) : 2;
  scatter(study, count);
  const LightSource source = light_source(study.scene, std::vector<std::string>{"light"});

  std::printf("| %-28s | seconds  | rms      | largest  |\n|---|---|---|---|\n", "how");
  double start = seconds();
  const BackprojectionIndex light(study.scene, source);
  study.exact = study.all([&](std::size_t i) {
    return *light.from(shadow_point(study.points[i], {0, 0, 1})).form_factor;
  });
  study.row("exact", seconds() - start, study.exact);
  const double exact_time = seconds() - start;

  start = seconds();
  const Shadows shadows =
      find_shadows(study.scene, source, {study.ground}, study.request);
  const double mesh_time = seconds() - start;
  // The ground is a slab: its top has the most faces.
  const auto& meshes = shadows.receivers[0].meshes;
  const ShadowMesh& top = *std::ranges::max_element(
      meshes, {}, [](const ShadowMesh& m) { return m.faces.size(); });
  const auto interpolated = [&](int order, double accuracy) {
    start = seconds();
    const IrradianceMesh mesh(study.scene, light, study.ground, shadows, top,
                              {.order = order, .accuracy = accuracy * study.mean},
                              study.request);
    const double made = seconds();
    const auto values = study.all([&](std::size_t i) {
      const auto here = mesh.at(study.points[i]);
      return here ? here->value : 0.0;
    });
    const double done = seconds();
    const IrradianceMesh::Statistics& s = mesh.statistics();
    char name[64];
    std::snprintf(name, sizeof name, "%s, %.0e, %zu",
                  order == 0   ? "closed form"
                  : order == 1 ? "linear"
                               : "quadratic",
                  accuracy, s.triangles);
    study.row(name, mesh_time + done - start, values);
    std::fprintf(
        stderr,
        "  made in %.3f s; %.3f microseconds a point; largest bound %.2e, closed "
        "form %.2e, above accuracy %.2e\n",
        made - start, 1e6 * (done - made) / count, s.largest_bound / study.mean,
        s.closed_form_share, s.above_accuracy_share);
  };
  interpolated(0, 1e-4);
  for (const int order : {1, 2}) {
    for (const double accuracy : {1e-1, 1e-2, 1e-3, 1e-4}) interpolated(order, accuracy);
  }
  rays(study);
  std::printf("%d points; %.0f exact points a second; the mesh took %.2f s; %zu faces\n",
              count, count / exact_time, mesh_time, top.faces.size());
}
