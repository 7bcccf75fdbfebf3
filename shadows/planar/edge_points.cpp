// Points on edges, and edges as parts of the input; the functions are told in
// planar_map.h.

#include <algorithm>
#include <cmath>

#include "shadows/planar/edge_bow.h"
#include "shadows/planar/planar_map.h"

namespace sightline::internal {
namespace {

// Appends what follows the first point.
void append_polyline(const EdgeBow& bow, double deviation, int depth,
                     std::vector<Eigen::Vector2d>& out) {
  constexpr int kMostDepth = 16;
  // A bow that turns by more than a right angle may be higher than its middle.
  const bool flat = bow.weight > 0.5 && bow.height() <= deviation;
  if (flat || depth == kMostDepth) {
    out.push_back(bow.q);
    return;
  }
  for (const EdgeBow& half : bow.halves()) {
    append_polyline(half, deviation, depth + 1, out);
  }
}

double value(const RationalQuadratic& f, double s) {
  return nearest_double(f[0]) + s * (nearest_double(f[1]) + s * nearest_double(f[2]));
}

double rounded(const CurveEnd& end) {
  const double a = nearest_double(end.polynomial[2]),
               b = nearest_double(end.polynomial[1]),
               c = nearest_double(end.polynomial[0]);
  if (a == 0) return -c / b;
  const double root = std::sqrt(std::max(0.0, b * b - 4 * a * c));
  const double q = -0.5 * (b + std::copysign(root, b));
  if (q == 0) return 0;
  const double s = q / a, t = c / q;
  return end.larger ? std::max(s, t) : std::min(s, t);
}

// The parameter of a point that lies on a curve, by bisection: the way along the chord
// grows with it on a line.
double parameter_on_line(const PlaneCurve& curve, const Eigen::Vector2d& p) {
  const auto at = [&](double s) -> Eigen::Vector2d {
    return Eigen::Vector2d(value(curve.x, s), value(curve.y, s)) / value(curve.w, s);
  };
  double lo = rounded(curve.from), hi = rounded(curve.to);
  const Eigen::Vector2d a = at(lo), way = at(hi) - a;
  const double wanted = way.dot(p - a);
  if (curve.x[2] == 0 && curve.y[2] == 0 && curve.w[1] == 0 && curve.w[2] == 0) {
    return lo + (hi - lo) * wanted / way.squaredNorm();
  }
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (lo + hi);
    (way.dot(at(middle) - a) < wanted ? lo : hi) = middle;
  }
  return 0.5 * (lo + hi);
}

}  // namespace

Eigen::Vector2d PlanarMap::point(int e, double t) const {
  return edge_bow(*data_, e).at(t);
}

PlanePoint PlanarMap::exact_point(int e) const {
  const auto& supports = data_->geometry->all.supports;
  const int own = data_->geometry->all.arcs[data_->edges[e].arc].support;
  ArcParameter from = data_->position(e, 0), to = data_->position(e, 1);
  const double middle = 0.5 * (from.range.hi + to.range.lo);
  const bool apart = from.range.hi < middle && middle < to.range.lo;
  const Dyadic s = apart ? dyadic(middle)
                         : between(exact(supports, own, from), exact(supports, own, to));
  const SurdPoint p = point_at(supports[own], quadratic_root(s));
  const Rational w = rational(p.w.a);
  return {rational(p.x.a) / w, rational(p.y.a) / w};
}

std::vector<Eigen::Vector2d> PlanarMap::polyline(int e, double deviation) const {
  const EdgeBow bow = edge_bow(*data_, e);
  std::vector<Eigen::Vector2d> out{bow.p};
  if (straight(e)) {
    out.push_back(bow.q);
  } else {
    append_polyline(bow, deviation, 0, out);
  }
  return out;
}

std::array<Rational, 6> PlanarMap::implicit_form(int e) const {
  const ImplicitForm& f = data_->support_of_edge(e).implicit;
  return {Rational(f[0]), Rational(f[1]), Rational(f[2]),
          Rational(f[3]), Rational(f[4]), Rational(f[5])};
}

CurvePart PlanarMap::part(int e, int id) const {
  const PlanarGeometry& geometry = *data_->geometry;
  const PlanarEdge& edge = data_->edges[e];
  const PlaneArc& own = geometry.all.arcs[edge.arc];
  const std::array<Eigen::Vector2d, 2> at{vertex(edge.ends[0]).at,
                                          vertex(edge.ends[1]).at};
  if (straight(e)) {
    const double middle =
        0.5 * (data_->position(e, 0).range.hi + data_->position(e, 1).range.lo);
    for (const ArcMember& m : own.members) {
      if (m.curve < 0 || geometry.curves[m.curve].id != id) continue;
      if (m.from.range.lo > middle || m.to.range.hi < middle) continue;
      const PlaneCurve& curve = geometry.curves[m.curve];
      return {id, parameter_on_line(curve, at[0]), parameter_on_line(curve, at[1])};
    }
    return {id, 0, 0};
  }
  if (geometry.curves[own.members[0].curve].id == id) {
    return {id, data_->position(e, 0).range.middle(),
            data_->position(e, 1).range.middle()};
  }
  const int conic = geometry.all.conic[own.support];
  const Eigen::Vector2d middle = point(e, 0.5);
  for (const PlaneArc& arc : geometry.all.arcs) {
    if (geometry.all.conic[arc.support] != conic ||
        geometry.curves[arc.members[0].curve].id != id) {
      continue;
    }
    const auto& z = geometry.all.supports[arc.support].balls.inverse;
    const auto parameter = [&](const Eigen::Vector2d& p) {
      const auto form = [&](int i) {
        return z[i][0].hi * p.x() + z[i][1].hi * p.y() + z[i][2].hi;
      };
      return form(1) / form(0);
    };
    const double s = parameter(middle);
    if (s < arc.ends[0].at.range.lo || s > arc.ends[1].at.range.hi) continue;
    return {id, parameter(at[0]), parameter(at[1])};
  }
  return {id, 0, 0};
}

}  // namespace sightline::internal
