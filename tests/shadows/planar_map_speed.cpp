// How long planar maps take: planar_map_speed [curves].  A line for each kind of input;
// build and faces apart.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>

#include "linespace/swaths/exact_swath.h"
#include "shadows/planar/planar_map.h"
#include "tests/shadows/plane_curve_generators.h"

namespace sightline::internal {
namespace {

// Wall clock, and the processor time of all threads.
struct Time {
  std::chrono::steady_clock::time_point wall = std::chrono::steady_clock::now();
  std::clock_t processor = std::clock();

  [[nodiscard]] double wall_ms() const {
    const auto passed = std::chrono::steady_clock::now() - wall;
    return std::chrono::duration<double, std::milli>(passed).count();
  }
  [[nodiscard]] double processor_ms() const {
    return 1e3 * static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC;
  }
};

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

// Traces on the plane z = 0 of the lines through three edges: an upright
// one and two level ones, near one another, above a square of side 100.
std::vector<PlaneCurve> traces(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  const PlaneThrough ground{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  std::vector<PlaneCurve> curves;
  while (static_cast<int>(curves.size()) < count) {
    const Eigen::Vector3d place(100 * unit(random), 100 * unit(random), 0);
    const int turn = static_cast<int>(3 * unit(random));
    std::array<Eigen::Vector3d, 6> p;
    for (int i = 0; i < 6; i += 2) {
      // The last edge is low, so that it throws its shadow near by.
      const double low = i == 0 ? 60 : i == 2 ? 8 : 4;
      p[i] = place +
             Eigen::Vector3d(12 * unit(random), 12 * unit(random), low + unit(random));
      p[i + 1] = p[i];
      p[i + 1][(i / 2 + turn) % 3] += 3;
    }
    const ExactSwath swath = exact_swath(LineThrough{p[0], p[1]}, LineThrough{p[2], p[3]},
                                         LineThrough{p[4], p[5]});
    const auto trace = swath.trace(ground);
    PlaneCurve curve{static_cast<int>(curves.size()),
                     rational_quadratic(trace[0]),
                     rational_quadratic(trace[1]),
                     rational_quadratic(trace[3]),
                     {},
                     {}};
    // The sign of w; 0: outside.
    const auto inside = [&](int k) {
      const Rational s(k, 64);
      const auto value = [&](const RationalQuadratic& f) {
        return nearest_double(f[0] + s * (f[1] + s * f[2]));
      };
      const double w = value(curve.w), x = value(curve.x) / w, y = value(curve.y) / w;
      return x > 0 && x < 100 && y > 0 && y < 100 ? (w > 0 ? 1 : -1) : 0;
    };
    // The first stretch that lies inside, by samples; the outline leaves it some room.
    int from = 0;
    while (from < 64 && inside(from) == 0) ++from;
    int to = from;
    while (to < 64 && inside(to + 1) == inside(from)) ++to;
    if (to - from < 8) continue;
    curve.from = rational_end(Rational(from, 64));
    curve.to = rational_end(Rational(to, 64));
    curves.push_back(curve);
  }
  return curves;
}

void measure(const char* name, const std::vector<PlaneCurve>& curves, int size,
             int margin = 0) {
  const PlaneOutline outline = square_outline(-margin, size + margin);
  const Time building;
  const PlanarMap map(curves, outline);
  std::printf(
      "%-20s %6zu curves %7d vertices %7d edges %7d faces  map %6.0f ms, %6.0f of "
      "processor",
      name, curves.size(), map.vertex_count(), map.edge_count(), map.face_count(),
      building.wall_ms(), building.processor_ms());
  const Time adding;
  double sum = 0;
  for (int f = 0; f < map.face_count(); ++f) sum += map.area(f);
  std::printf("  areas %5.0f ms (off by %.0e)", adding.processor_ms(),
              std::abs(sum / std::pow(size + 2 * margin, 2) - 1));
  const Time looking;
  int doubles = 0;
  for (int f = 0; f < map.face_count(); ++f) {
    const PlanePoint p = map.interior_point(f);
    doubles += Rational(nearest_double(p[0])) == p[0];
  }
  std::printf("  points %5.0f ms (%d no doubles)\n", looking.processor_ms(),
              map.face_count() - doubles);
}

}  // namespace
}  // namespace sightline::internal

int main(int argc, char** argv) {
  using namespace sightline::internal;
  const int count = argc > 1 ? std::atoi(argv[1]) : 7000;
  measure("segments", fans(count, 4, 0), 100);
  measure("a quarter conics", fans(count, 4, 0.25), 100);
  measure("conics", fans(count, 4, 1), 100);
  measure("traces of swaths", traces(count), 100, 50);
  measure("aligned segments", aligned(count), 40);
  return 0;
}
