#include "linespace/swaths/exact_swath.h"

#include <functional>

namespace sightline::internal {
namespace {

WeightedPoint weighted(const Eigen::Vector3d& p) { return {ring_point(p), 1}; }

// u p - v q.
WeightedPoint combination(const Ring& u, const WeightedPoint& p, const Ring& v,
                          const WeightedPoint& q) {
  WeightedPoint out;
  for (int i = 0; i < 3; ++i) out.x[i] = u * p.x[i] - v * q.x[i];
  out.w = u * p.w - v * q.w;
  return out;
}

// n . x - k w, positive in front of the plane.
struct PlaneValue {
  RingVector n;
  Ring k;

  explicit PlaneValue(const PlaneThrough& plane)
      : n(cross(ring_difference(plane.b, plane.a), ring_difference(plane.c, plane.a))),
        k(dot(n, ring_point(plane.a))) {}
  Ring operator()(const WeightedPoint& p) const { return dot(n, p.x) - k * p.w; }
};

// The side of the line XY to a line of direction d and moment m (permuted inner product
// of their Pluecker coordinates).
Ring side(const WeightedPoint& x, const WeightedPoint& y, const RingVector& d,
          const RingVector& m) {
  RingVector way;
  for (int i = 0; i < 3; ++i) way[i] = x.w * y.x[i] - y.w * x.x[i];
  return dot(way, m) + dot(d, cross(x.x, y.x));
}

// A bilinear function of X and Y, along the swath.
Quadratic<Ring> along(
    const ExactSwath& swath,
    const std::function<Ring(const WeightedPoint&, const WeightedPoint&)>& f) {
  const auto& [x, y] = swath;
  return {f(x[0], y[0]), f(x[0], y[1]) + f(x[1], y[0]), f(x[1], y[1])};
}

}  // namespace

Quadratic<Ring> ExactSwath::meeting(const LineThrough& line) const {
  const RingVector a = ring_point(line.from);
  const RingVector b = ring_point(line.to);
  const RingVector d{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  const RingVector m = cross(a, b);
  return along(*this, [&](const WeightedPoint& x, const WeightedPoint& y) {
    return side(x, y, d, m);
  });
}

std::array<Quadratic<Ring>, 4> ExactSwath::trace(const PlaneThrough& plane) const {
  const PlaneValue value(plane);
  std::array<Quadratic<Ring>, 4> out;
  for (int i = 0; i < 4; ++i) {
    out[i] = along(*this, [&](const WeightedPoint& x, const WeightedPoint& y) {
      const WeightedPoint z = combination(value(y), x, value(x), y);
      return i < 3 ? z.x[i] : z.w;
    });
  }
  return out;
}

std::array<Ring, 2> values(const PlaneThrough& plane, const MovingPoint& x) {
  const PlaneValue value(plane);
  return {value(x[0]), value(x[1])};
}

ExactSwath exact_swath(const Eigen::Vector3d& vertex, const LineThrough& edge) {
  return {{weighted(vertex), weighted(vertex)}, {weighted(edge.from), weighted(edge.to)}};
}

ExactSwath exact_swath(const LineThrough& first, const LineThrough& middle,
                       const LineThrough& last) {
  // f[a][b] = orient3d(P_a, Q_b, M0, M1), so F_b is f[0][b], f[1][b] at the ends.
  const BilinearForm<Ring> form = ring_form(first, last, middle);
  const auto y = [&](int a) {
    return combination(form.f[a][0], weighted(last.to), form.f[a][1],
                       weighted(last.from));
  };
  return {{weighted(first.from), weighted(first.to)}, {y(0), y(1)}};
}

}  // namespace sightline::internal
