#include "shadows/planar/half_edge_order.h"

#include <algorithm>
#include <cassert>

namespace sightline::internal {
namespace {

Sign sign_of_slope(const PlaneSupport& support, int coordinate, const ExactParameter& s) {
  const auto& curve = support.exact.curve;
  return sign_at(integer_polynomial(slope(curve[coordinate], curve[2])), s);
}

Polynomial1 derivative(const Polynomial1& f) {
  Polynomial1 d;
  for (std::size_t k = 1; k < f.size(); ++k) d.push_back(f[k] * static_cast<int>(k));
  return d;
}

}  // namespace

ExactParameter HalfEdgeOrder::exact_position(const Direction& d) const {
  ArcParameter at = geometry_.positions[d.arc][d.position];
  return exact(geometry_.all.supports, geometry_.all.arcs[d.arc].support, at);
}

HalfEdgeOrder::Direction HalfEdgeOrder::direction(int half_edge) const {
  const PlanarEdge& edge = edges_[half_edge >> 1];
  Direction d;
  d.half_edge = half_edge;
  d.arc = edge.arc;
  d.position = edge.position[half_edge & 1];
  d.forwards = (half_edge & 1) == 0;
  const auto& curve = support(d).balls.curve;
  const BallNumber s = ball(geometry_.positions[d.arc][d.position].range);
  const auto value = [&](int i) {
    const std::array<BallNumber, 3> c = slope(curve[i], curve[2]);
    const BallNumber v = support(d).straight ? c[0] : c[0] + s * (c[1] + s * c[2]);
    return d.forwards ? v : -v;
  };
  d.x = value(0);
  d.y = value(1);
  d.upper = upper(d);
  return d;
}

bool HalfEdgeOrder::upper(const Direction& d) const {
  if (const std::optional<Sign> y = sign_of(d.y)) return *y == Sign::Positive;
  const ExactParameter s = exact_position(d);
  const Sign way = d.forwards ? Sign::Positive : Sign::Negative;
  const Sign y = way * sign_of_slope(support(d), 1, s);
  if (y != Sign::Zero) return y == Sign::Positive;
  return way * sign_of_slope(support(d), 0, s) == Sign::Positive;
}

bool HalfEdgeOrder::before(const Direction& g, const Direction& h) const {
  if (g.half_edge == h.half_edge) return false;
  if (g.upper != h.upper) return g.upper;
  if (const std::optional<Sign> turn = sign_of(g.x * h.y - g.y * h.x)) {
    return *turn == Sign::Positive;
  }
  return exactly_before(g, h);
}

// Both point into one half-plane: h comes after g where h's curve, just after the
// vertex, lies to the left of g's.  That also holds where they touch.
bool HalfEdgeOrder::exactly_before(const Direction& g, const Direction& h) const {
  const Substitution<Ring> s = substitute<Ring>(support(h), support(g));
  Polynomial1 f = integer_polynomial(s.f);
  assert(!f.empty());
  const ExactParameter at = exact_position(h);
  // The first derivative that is not zero tells the sign beside the root.
  Sign beside = Sign::Zero;
  for (bool odd = true; beside == Sign::Zero; odd = !odd) {
    f = derivative(f);
    assert(!f.empty());
    beside = sign_at(f, at);
    if (odd && !h.forwards) beside = -beside;
  }
  return (beside == Sign::Positive) == g.forwards;
}

void HalfEdgeOrder::sort(std::vector<int>& half_edges) const {
  std::vector<Direction> all;
  for (const int h : half_edges) all.push_back(direction(h));
  std::ranges::sort(all,
                    [&](const Direction& g, const Direction& h) { return before(g, h); });
  for (std::size_t i = 0; i < all.size(); ++i) half_edges[i] = all[i].half_edge;
}

}  // namespace sightline::internal
