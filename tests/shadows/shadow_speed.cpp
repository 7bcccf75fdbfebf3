// How long the mesh of a city's ground takes under a light over its middle, and what it
// is made of.
//
//   shadow_speed [street|square] [POLYGONS [THREADS [ground|all]]]
//
// The light is square, a tenth of the slab wide, over its middle, at twice the height of
// the highest roof.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

#include "shadows/backprojection.h"
#include "shadows/shadow_mesh.h"
#include "tests/support/generators.h"

namespace {

double seconds() {
  using std::chrono::steady_clock;
  return std::chrono::duration<double>(steady_clock::now().time_since_epoch()).count();
}

}  // namespace

int main(int argc, char** argv) {
  using namespace sightline;
  const std::string kind = argc > 1 ? argv[1] : "street";
  const int polygons = argc > 2 ? std::atoi(argv[2]) : 996;
  const Scene scene(testing::lit_city(polygons, kind == "square"));
  Request request;
  request.threads = argc > 3 ? std::atoi(argv[3]) : 2;
  const bool all = argc > 4 && std::string(argv[4]) == "all";
  const std::vector<std::string> light{"light"};
  const LightSource source = light_source(scene, light);
  std::vector<Receiver> receivers;
  for (const Object& object : scene.objects()) {
    if (object.name != "light" && (all || object.name == "ground"))
      receivers.push_back({object.name, object.faces, true});
  }

  // 1. Points of the ground.
  const double start = seconds();
  const BackprojectionIndex index(scene, source);
  const double built = seconds();
  const auto& [low, high] = scene.bounds();
  constexpr int kPoints = 2000;
  int classes[3] = {};
  for (int i = 0; i < kPoints; ++i) {
    // Points of a lattice of two irrational steps.
    const double u = std::fmod(0.5 + i * 0.7548776662466927, 1.0);
    const double v = std::fmod(0.5 + i * 0.5698402909980532, 1.0);
    const Point p(low.x() + u * (high.x() - low.x()), low.y() + v * (high.y() - low.y()),
                  0);
    ++classes[static_cast<int>(index.from(shadow_point(p, {0, 0, 1})).shadow)];
  }
  const double asked = seconds();
  std::printf("index %.3f s, a point %.1f microseconds (umbra %d, penumbra %d, lit %d)\n",
              built - start, 1e6 * (asked - built) / kPoints, classes[0], classes[1],
              classes[2]);

  // 2. The mesh.
  double last = seconds();
  std::string stage;
  request.progress = [&](std::string_view name, double) {
    if (name == stage) return;
    if (!stage.empty()) std::printf("  %s: %.2f s\n", stage.c_str(), seconds() - last);
    last = seconds();
    stage = name;
  };
  const std::clock_t cpu = std::clock();
  const double begun = seconds();
  const Shadows shadows = find_shadows(scene, source, receivers, request);
  const double done = seconds();
  std::printf("  %s: %.2f s\n", stage.c_str(), done - last);
  std::size_t counts[kShadowEdgeKinds] = {}, edges = 0, faces = 0;
  for (const ReceiverShadows& r : shadows.receivers) {
    for (const ShadowMesh& mesh : r.meshes) {
      edges += mesh.edges.size();
      faces += mesh.faces.size();
      for (const auto& e : mesh.edges) ++counts[static_cast<int>(e.kind)];
    }
  }
  std::printf(
      "%s %d: %.2f s, %.2f s of processor time; %zu faces, %zu edges: boundary %zu, "
      "contact %zu, plane %zu, face %zu, EE %zu, EV %zu, EEE %zu\n",
      kind.c_str(), polygons, done - begun,
      static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC, faces, edges, counts[0],
      counts[1], counts[2], counts[3], counts[4], counts[5], counts[6]);
}
