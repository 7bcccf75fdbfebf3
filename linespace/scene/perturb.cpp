#include "linespace/perturb.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>

namespace sightline {
namespace {

double power_below(double x) { return std::ldexp(1.0, std::ilogb(x)); }

// Points go to a grid of steps h <= size / 8, and from there to
//   x + E (x - c) + t,
// the entries of E at most size / (16 r) and 1/16, with r the largest |x - c| by
// coordinate, those of t at most size / 4.  A coordinate moves by at most size (1/16 + 3
// / 16 + 1/4) = size / 2, a point by less than size.  E is in steps of q, 2^-10 of its
// bound rounded down to a power of two; x, c and t are multiples of h 2^-10.  So all is a
// multiple of h q, with h > size / 16, q > size / (64 R 2^10) for the largest coordinate
// R and r <= 2 R, and at most 3 R: less than 2^53 h q when R < 2^15.7 size or so.
struct Motion {
  Point centre = Point::Zero();
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
  Point shift = Point::Zero();
};

Motion random_motion(const std::vector<Point>& points, double size, double step,
                     std::mt19937_64& engine) {
  constexpr int kLevels = 1024;
  const auto level = [&] {
    return static_cast<double>(static_cast<int>(engine() % (2 * kLevels + 1)) - kLevels);
  };
  Point low = points.front();
  Point high = points.front();
  for (const Point& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  Motion motion;
  for (int i = 0; i < 3; ++i) {
    motion.centre[i] = std::round(0.5 * (low[i] + high[i]) / step) * step;
  }
  const double radius = std::max((high - motion.centre).cwiseAbs().maxCoeff(),
                                 (low - motion.centre).cwiseAbs().maxCoeff());
  const double bound = power_below(std::min(0.0625, size / (16 * radius)));
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) motion.turn(i, j) = level() * (bound / kLevels);
    motion.shift[i] = level() * (power_below(size / 4) / kLevels);
  }
  return motion;
}

}  // namespace

PolygonSoup perturbed(const Scene& scene, double size, std::uint64_t seed) {
  double largest = 0;
  for (const Point& p : scene.points()) {
    largest = std::max(largest, p.cwiseAbs().maxCoeff());
  }
  if (!std::isfinite(size) || !(size > 0) || size < std::ldexp(largest, -16)) {
    throw InvalidInput("a perturbation must be at least 2^-16 of the largest coordinate");
  }
  const PolygonSoup& soup = scene.soup();
  std::vector<int> object_of(soup.polygons.size(), -1);
  for (const Face& f : scene.faces()) object_of[f.source] = f.object;

  PolygonSoup out;
  out.groups = soup.groups;
  out.source = soup.source + ", perturbed by " + std::to_string(size) + ", seed " +
               std::to_string(seed);
  out.polygons.resize(soup.polygons.size());
  std::map<std::pair<int, int>, int> copies;  // (object, vertex of the file)
  std::vector<std::vector<int>> of_object(scene.objects().size());
  for (std::size_t k = 0; k < soup.polygons.size(); ++k) {
    for (const int v : soup.polygons[k]) {
      const auto [at, fresh] =
          copies.try_emplace({object_of[k], v}, static_cast<int>(out.vertices.size()));
      if (fresh) {
        out.vertices.push_back(soup.vertices[v]);
        if (object_of[k] >= 0) of_object[object_of[k]].push_back(at->second);
      }
      out.polygons[k].push_back(at->second);
    }
  }
  const double step = power_below(size / 8);
  std::mt19937_64 engine(seed);
  for (const std::vector<int>& vertices : of_object) {
    std::vector<Point> points;
    for (const int v : vertices) {
      Point p = out.vertices[v] / step;
      for (int i = 0; i < 3; ++i) p[i] = std::round(p[i]) * step;
      points.push_back(p);
    }
    if (points.empty()) continue;
    const Motion m = random_motion(points, size, step, engine);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Point d = points[i] - m.centre;
      for (int a = 0; a < 3; ++a) {
        out.vertices[vertices[i]][a] =
            points[i][a] + m.shift[a] +
            (m.turn(a, 0) * d[0] + m.turn(a, 1) * d[1] + m.turn(a, 2) * d[2]);
      }
    }
  }
  return out;
}

}  // namespace sightline
