// How long planar maps take: planar_map_speed [curves].  A line for each kind of input;
// build and faces apart.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "shadows/planar/planar_map.h"
#include "tests/shadows/plane_curve_generators.h"

namespace sightline::internal {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::time_point from) {
  return std::chrono::duration<double, std::milli>(Clock::now() - from).count();
}

// Curves that start in common points, in a square of side 100, at most `reach` long;
// a share of them arcs of conics.  Coordinates have 53 binary digits.
std::vector<PlaneCurve> fans(int count, double reach, double conics) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<PlaneCurve> curves;
  PlanePoint hub;
  for (int i = 0; i < count; ++i) {
    if (i % 6 == 0) hub = {100 * unit(random), 100 * unit(random)};
    const auto near = [&](const PlanePoint& p) {
      const auto moved = [&](const Rational& x) {
        const double y = nearest_double(x) + reach * (2 * unit(random) - 1);
        return Rational(std::clamp(y, 0.0, 100.0));
      };
      return PlanePoint{moved(p[0]), moved(p[1])};
    };
    const PlanePoint middle = near(hub), end = near(middle);
    if (unit(random) >= conics) {
      curves.push_back(plane_segment(i, hub, end));
      continue;
    }
    PlaneCurve curve = CurveGenerator::bezier(i, {hub, middle, end}, {1, 1, 1});
    const Rational weight(0.3 + unit(random));
    const PlaneCurve bent = CurveGenerator::bezier(i, {hub, middle, end}, {0, 1, 0});
    for (int k = 0; k < 3; ++k) {
      curve.x[k] += weight * bent.x[k];
      curve.y[k] += weight * bent.y[k];
      curve.w[k] += weight * bent.w[k];
    }
    curves.push_back(curve);
  }
  return curves;
}

// Segments between points of a grid of side 40, most of them along its lines.
std::vector<PlaneCurve> aligned(int count) {
  CurveGenerator generate(3, 40);
  std::vector<PlaneCurve> curves;
  while (static_cast<int>(curves.size()) < count) {
    PlanePoint a = generate.point();
    PlanePoint b = a;
    const int way = generate.number(0, 9), length = generate.number(1, 8);
    if (way != 0) b[0] += length;
    if (way == 0 || way > 8) b[1] += length;
    if (way % 2 == 1) {
      std::swap(a[0], a[1]);
      std::swap(b[0], b[1]);
    }
    if (b[0] > 40 || b[1] > 40) continue;
    curves.push_back(plane_segment(static_cast<int>(curves.size()), a, b));
  }
  return curves;
}

void measure(const char* name, const std::vector<PlaneCurve>& curves, int size) {
  const PlaneOutline outline = square_outline(0, size);
  auto start = Clock::now();
  const PlanarMap map(curves, outline);
  const double build = milliseconds(start);
  start = Clock::now();
  double sum = 0;
  for (int f = 0; f < map.face_count(); ++f) sum += map.area(f);
  const double areas = milliseconds(start);
  start = Clock::now();
  double checksum = 0;
  for (int f = 0; f < map.face_count(); ++f) {
    checksum += nearest_double(map.interior_point(f)[0]);
  }
  const double points = milliseconds(start);
  std::printf(
      "%-28s %6zu curves %7d vertices %7d edges %7d faces  build %7.1f ms  areas "
      "%6.1f ms (off by %.1e)  points %6.1f ms\n",
      name, curves.size(), map.vertex_count(), map.edge_count(), map.face_count(), build,
      areas, std::abs(sum / (size * size) - 1), points);
}

}  // namespace
}  // namespace sightline::internal

int main(int argc, char** argv) {
  using namespace sightline::internal;
  const int count = argc > 1 ? std::atoi(argv[1]) : 7000;
  measure("segments", fans(count, 4, 0), 100);
  measure("a quarter conics", fans(count, 4, 0.25), 100);
  measure("conics", fans(count, 4, 1), 100);
  measure("aligned segments", aligned(count), 40);
  return 0;
}
