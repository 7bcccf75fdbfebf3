// How long all events of one light over a city take.
//
//   light_events_scaling [street|square] [POLYGONS [THREADS [ground|all]]]
//
// The light is square, a tenth of the slab wide, over its middle, at twice the height of
// the highest roof.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "linespace/light/light_events.h"
#include "tests/support/generators.h"

namespace {

double seconds() {
  using std::chrono::steady_clock;
  return std::chrono::duration<double>(steady_clock::now().time_since_epoch()).count();
}

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

int main(int argc, char** argv) {
  using namespace sightline;
  const std::string kind = argc > 1 ? argv[1] : "street";
  const int polygons = argc > 2 ? std::atoi(argv[2]) : 996;
  const int threads = argc > 3 ? std::atoi(argv[3]) : 2;
  const bool ground_only = argc > 4 && std::string(argv[4]) == "ground";
  PolygonSoup soup = testing::street_city(1, polygons, {.square = kind == "square"});
  Point low = soup.vertices[0];
  Point high = low;
  for (const Point& p : soup.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double half = 0.05 * std::min(high.x() - low.x(), high.y() - low.y());
  const double x = 0.5 * (low.x() + high.x());
  const double y = 0.5 * (low.y() + high.y());
  const double z = 2 * high.z();
  const int v = static_cast<int>(soup.vertices.size());
  for (const auto& [dx, dy] : {std::pair(-1, -1), {-1, 1}, {1, 1}, {1, -1}}) {
    soup.vertices.emplace_back(x + dx * half, y + dy * half, z);
  }
  soup.polygons.push_back({v, v + 1, v + 2, v + 3});
  soup.groups.push_back({"light", {static_cast<int>(soup.polygons.size()) - 1}});
  const Scene scene(soup);
  const double start = seconds();
  const double start_cpu = processor_seconds();
  const internal::LightSpace space(scene);
  const double built = seconds();
  internal::LightEventsRequest request;
  request.threads = threads;
  request.source_faces = scene.faces_named("light");
  if (ground_only) request.receivers = scene.faces_named("ground");
  const internal::LightEvents events = internal::light_events(space, request);
  const double done = seconds();
  std::size_t pieces[4] = {};
  std::size_t traces[4] = {};
  std::size_t on_ground = 0;
  const std::vector<int> ground = scene.faces_named("ground");
  for (const internal::LightTrace& t : events.traces) {
    ++traces[static_cast<int>(t.kind)];
    pieces[static_cast<int>(t.kind)] += t.pieces.size();
    for (const auto& p : t.pieces)
      on_ground += std::ranges::binary_search(ground, p.face);
  }
  std::printf(
      "%s %zu polygons: traces face %zu EE %zu EV %zu EEE %zu, pieces %zu %zu %zu %zu, "
      "%zu "
      "on the ground; %zu families; space %.2f s, events %.2f s, processor %.2f s\n",
      kind.c_str(), soup.polygons.size(), traces[0], traces[1], traces[2], traces[3],
      pieces[0], pieces[1], pieces[2], pieces[3], on_ground, events.families,
      built - start, done - built, processor_seconds() - start_cpu);
}
