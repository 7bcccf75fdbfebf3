// Two uses of random lines: measuring a surface by counting lines that meet it, and
// estimating how much of one square another sees past a blocker.  One task, top to
// bottom.

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <utility>
#include <vector>

#include "linespace/line_sampling.h"
#include "linespace/occlusion.h"
#include "linespace/scene.h"
#include "linespace/visibility_estimate.h"

int main() {
  // Three unit squares above each other, the middle one half as wide.
  sightline::PolygonSoup soup;
  for (const auto& [low, high, z] : {std::array{0.0, 1.0, 0.0}, std::array{0.0, 1.0, 1.0},
                                     std::array{0.25, 0.75, 0.5}}) {
    const int v = static_cast<int>(soup.vertices.size());
    soup.vertices.insert(
        soup.vertices.end(),
        {{low, low, z}, {high, low, z}, {high, high, z}, {low, high, z}});
    soup.polygons.push_back({v, v + 1, v + 2, v + 3});
  }
  const sightline::Scene scene(std::move(soup));
  const sightline::OcclusionIndex index(scene);

  // Cauchy and Crofton: of uniform lines that meet a ball, the share that meets a convex
  // surface S inside is S over the ball's surface.  A square has two sides.
  const sightline::Ball ball{{0.5, 0.5, 0}, 1};
  constexpr int kLines = 200'000;
  int met = 0;
  for (int i = 0; i < kLines; ++i) {
    sightline::SampleNumbers numbers(1, static_cast<std::uint64_t>(i));
    const auto [from, to] = sightline::line_by_two_points(ball, numbers);
    const double t = from.z() / (from.z() - to.z());
    const sightline::Point p = from + t * (to - from);
    met += t > 0 && t < 1 && p.x() > 0 && p.x() < 1 && p.y() > 0 && p.y() < 1;
  }
  const double area = 2 * std::numbers::pi * met / kLines;
  std::printf("area of the square, by counting lines: %.3f\n", area);

  // Of the pairs of points of the outer squares, 7 in 16 see each other.
  const auto seen = sightline::estimate_visibility(index, std::vector{0}, std::vector{1},
                                                   {.samples = 200'000});
  std::printf("estimated visible: %.4f, between %.4f and %.4f with 95 %% confidence\n",
              seen.fraction.value, seen.interval[0], seen.interval[1]);
  std::printf("estimated form factor: %.4f +- %.4f\n",
              seen.line_measure.value / std::numbers::pi,
              seen.line_measure.standard_error / std::numbers::pi);

  const bool as_expected =
      std::abs(area - 1) < 0.03 &&
      std::abs(seen.fraction.value - 7.0 / 16) < 5 * seen.fraction.standard_error &&
      seen.candidate;
  return as_expected ? 0 : 1;
}
