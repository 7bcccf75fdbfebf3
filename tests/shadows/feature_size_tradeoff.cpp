// What a feature size saves and what it costs: a city under a light with small boxes on
// its ground, on its roofs and in the air.
//
//   feature_size_tradeoff [POLYGONS OF THE CITY [SMALL BOXES [POINTS]]]
//
// A line for each feature size: blockers left out, edges of the ground's mesh, seconds of
// processor time, the bound, the largest difference seen on points of the ground.

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "shadows/backprojection.h"
#include "shadows/shadow_mesh.h"
#include "shadows/small_blockers.h"
#include "tests/support/add_box.h"
#include "tests/support/generators.h"
#include "tests/support/random_geometry.h"

namespace {

using namespace sightline;

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// Boxes of 2^-4 to 2 scene units; a quarter stands on the ground.
PolygonSoup city_with_small_boxes(int polygons, int boxes) {
  PolygonSoup soup = testing::lit_city(polygons, false);
  testing::RandomGeometry random(7);
  Point low = soup.vertices[0], high = low;
  for (const Point& p : soup.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  for (int i = 0; i < boxes; ++i) {
    const double size = std::exp2(random.uniform(-4, 1));
    const Point at(random.uniform(low.x() + 2, high.x() - 4),
                   random.uniform(low.y() + 2, high.y() - 4),
                   random.one_in(4) ? 0 : random.uniform(1, high.z() / 2));
    testing::add_box(
        soup, ("small" + std::to_string(i)).c_str(), at,
        at + size * Point(1, random.uniform(0.3, 1), random.uniform(0.3, 1)));
  }
  return soup;
}

}  // namespace

int main(int argc, char** argv) {
  const Scene scene(city_with_small_boxes(argc > 1 ? std::atoi(argv[1]) : 996,
                                          argc > 2 ? std::atoi(argv[2]) : 200));
  const int points = argc > 3 ? std::atoi(argv[3]) : 1000;
  const std::vector<std::string> lamp{"light"};
  const LightSource light = light_source(scene, lamp);
  const std::vector<int> ground = scene.faces_named("ground");
  const BackprojectionIndex whole(scene, light);
  const auto& [low, high] = scene.bounds();
  for (const double size : {0.0, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0}) {
    const double start = processor_seconds();
    const auto parts = small_parts(scene, size, light.faces);
    const double bound = left_out_bound(scene, light, {{"ground", ground, true}}, parts);
    const double bounded = processor_seconds();
    std::vector<std::string> names;
    for (const SmallPart& part : parts)
      names.push_back(scene.objects()[part.object].name);
    const Scene rest = scene_without(scene, names);
    const LightSource its_light = light_source(rest, lamp);
    const Shadows shadows =
        find_shadows(rest, its_light, {{"ground", rest.faces_named("ground"), true}});
    const double done = processor_seconds();
    const BackprojectionIndex less(rest, its_light);
    testing::RandomGeometry random(3);
    double seen = 0;
    for (int i = 0; i < points && !parts.empty(); ++i) {
      const Point p(random.uniform(low.x(), high.x()), random.uniform(low.y(), high.y()),
                    0);
      const ShadowPoint at = shadow_point(p, {0, 0, 1});
      seen = std::max(seen, *less.from(at).form_factor - *whole.from(at).form_factor);
    }
    std::size_t edges = 0;
    for (const ShadowMesh& mesh : shadows.receivers[0].meshes) edges += mesh.edges.size();
    std::printf("| %g | %zu | %zu | %.2f | %.2f | %.3g | %.3g |\n", size, parts.size(),
                edges, done - bounded, bounded - start, bound, seen);
    std::fflush(stdout);
  }
}
