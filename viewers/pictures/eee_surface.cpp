#include "viewers/eee_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace sightline::viewers {
namespace {

double orient(const Point& a, const Point& b, const Point& c, const Point& d) {
  return (b - a).cross(c - a).dot(d - a);
}

/// How far along the last edge, with b between b0 and b1, as a share of the way.
double share(double b, double b0, double b1) {
  return b1 == b0 ? 0.5 : std::clamp((b - b0) / (b1 - b0), 0.0, 1.0);
}

}  // namespace

EeeSurface::EeeSurface(const Scene& scene, const EeeArc& arc) {
  const auto ends = [&](int k) {
    const Edge& edge = scene.edges()[arc.edges[k]];
    return std::array{scene.point(edge.points[0]), scene.point(edge.points[1])};
  };
  p_ = ends(0);
  q_ = ends(2);
  const std::array<Point, 2> m = ends(1);
  for (const int a : {0, 1}) {
    for (const int b : {0, 1}) f_[a][b] = orient(p_[a], q_[b], m[0], m[1]);
  }
}

double EeeSurface::last_parameter(double s) const {
  const double f0 = (1 - s) * f_[0][0] + s * f_[1][0];
  const double f1 = (1 - s) * f_[0][1] + s * f_[1][1];
  const double t = f0 / (f0 - f1);
  return std::isfinite(t) ? std::clamp(t, 0.0, 1.0) : 0.5;
}

std::array<Point, 2> EeeSurface::line(double s) const {
  const double t = last_parameter(s);
  return {(1 - s) * p_[0] + s * p_[1], (1 - t) * q_[0] + t * q_[1]};
}

std::vector<std::array<Point, 2>> EeeSurface::rungs(std::array<double, 2> range,
                                                    double deviation) const {
  // Intervals still to be drawn, the next one last.  Depth ends where doubles do.
  std::vector<std::array<double, 2>> waiting{range};
  std::vector<std::array<Point, 2>> out{line(range[0])};
  while (!waiting.empty()) {
    const auto [from, to] = waiting.back();
    waiting.pop_back();
    const std::array<Point, 2> end = line(to);
    const Point change = (end[0] - out.back()[0]) - (end[1] - out.back()[1]);
    const double middle = from + 0.5 * (to - from);
    // At a = 1/2, b = 1 / (1 + k).
    const double b =
        share(last_parameter(middle), last_parameter(from), last_parameter(to));
    const double root_k = std::sqrt((1 - b) / std::max(b, 1e-300));
    const bool fine = change.norm() <= 2 * (1 + root_k) * deviation;
    if (fine || !(middle > from && middle < to)) {
      out.push_back(end);
    } else {
      waiting.push_back({middle, to});
      waiting.push_back({from, middle});
    }
  }
  return out;
}

std::vector<std::array<Point, 2>> rungs_of(const Scene& scene, const EeeArc& arc) {
  const double size = (scene.bounds()[1] - scene.bounds()[0]).norm();
  return EeeSurface(scene, arc).rungs(arc.range, kEeeDeviation * size);
}

double spanned_volume(const Scene& scene, const EeeArc& arc) {
  const EeeSurface surface(scene, arc);
  const auto [p0, q0] = surface.line(arc.range[0]);
  const auto [p1, q1] = surface.line(arc.range[1]);
  return std::abs(orient(p0, q0, p1, q1)) / 6;
}

}  // namespace sightline::viewers
