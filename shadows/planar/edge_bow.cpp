#include "shadows/planar/edge_bow.h"

#include <cmath>

#include "shadows/planar/arcs/arc_box.h"

namespace sightline::internal {
namespace {

double cross2(const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
  return u.x() * v.y() - u.y() * v.x();
}

// The area beside the chord over twice the area of the triangle of control points, over
// the weight w.  An affine map takes the curve to a circle's arc of half the angle a, w
// = cos a, for which it is k / 2, k = (a - sin a cos a) / sin^3 a; for w > 1 the angle is
// imaginary.  In v = 1 - w^2, k is twice the integral of u^2 / sqrt(1 - v u^2) over [0,
// 1]: a power series.
double bow_factor(double w) {
  const double v = (1 - w) * (1 + w);
  constexpr double kSeries = 0.2;
  if (std::abs(v) < kSeries) {
    double sum = 0, term = 1;
    for (int n = 0; n < 30; ++n) {
      sum += term / (2 * n + 3);
      term *= v * (2 * n + 1) / (2 * n + 2);
    }
    return 2 * sum;
  }
  const double sine = std::sqrt(std::abs(v));
  const double difference = v > 0 ? std::acos(w) - w * sine : w * sine - std::acosh(w);
  return difference / (sine * sine * sine);
}

}  // namespace

Eigen::Vector2d EdgeBow::at(double t) const {
  const double a = (1 - t) * (1 - t), b = 2 * t * (1 - t), c = t * t;
  return (a * p + b * middle + c * q) / (a + b * weight + c);
}

// Halving doubles to the same form once its end weights are scaled to 1 again.
std::array<EdgeBow, 2> EdgeBow::halves() const {
  const double sum = 1 + weight;
  const double next = std::sqrt(0.5 * sum);
  const Eigen::Vector2d shoulder = (p + 2 * middle + q) / (2 * sum);
  return {EdgeBow{p, shoulder, (p + middle) / sum * next, next},
          EdgeBow{shoulder, q, (middle + q) / sum * next, next}};
}

double EdgeBow::height() const {
  const Eigen::Vector2d chord = q - p;
  const Eigen::Vector2d shoulder = at(0.5) - p;
  const double length = chord.norm();
  return length > 0 ? std::abs(cross2(chord, shoulder)) / length : shoulder.norm();
}

EdgeBow edge_bow(const PlanarData& map, int e) {
  const auto& [from, to] = map.edges[e].ends;
  const Eigen::Vector2d p = map.vertices[from].at, q = map.vertices[to].at;
  const PlaneSupport& support = map.support_of_edge(e);
  if (support.straight) return {p, q, 0.5 * (p + q), 1};
  const auto control = control_points(support, ball(map.position(e, 0).range),
                                      ball(map.position(e, 1).range));
  const double scale = std::sqrt(control[0][2].hi * control[2][2].hi);
  return {p, q, Eigen::Vector2d(control[1][0].hi, control[1][1].hi) / scale,
          control[1][2].hi / scale};
}

double area_beside_chord(const EdgeBow& bow) {
  // A turn of more than 70 degrees or so: in two parts, with the triangle between.
  constexpr double kLeastWeight = 0.3;
  if (bow.weight < kLeastWeight) {
    const auto [first, second] = bow.halves();
    return 0.5 * cross2(first.q - bow.p, bow.q - bow.p) + area_beside_chord(first) +
           area_beside_chord(second);
  }
  // middle - weight p is the weight times the way to the control point.
  return 0.5 * cross2(bow.middle - bow.weight * bow.p, bow.q - bow.p) *
         bow_factor(bow.weight);
}

}  // namespace sightline::internal
