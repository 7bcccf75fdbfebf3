// ExactLine: predicates on a line whose Pluecker coordinates lie in Q(sqrt D).

#include <algorithm>
#include <cassert>
#include <cmath>

#include "linespace/lines/transversals.h"

namespace sightline {

using internal::is_zero;
using internal::Ring;
using internal::ring_difference;
using internal::ring_point;
using internal::RingVector;
using internal::sign_of;
using internal::Surd;
using internal::SurdVector;

namespace {

using internal::cross;
using internal::dot;

SurdVector operator-(const SurdVector& u, const SurdVector& v) {
  return {u[0] - v[0], u[1] - v[1], u[2] - v[2]};
}

bool all_zero(const SurdVector& v, const Ring& d) {
  return is_zero(v[0], d) && is_zero(v[1], d) && is_zero(v[2], d);
}
SurdVector surds(const RingVector& v) {
  return {Surd{v[0], 0}, Surd{v[1], 0}, Surd{v[2], 0}};
}
void negate(SurdVector& v) {
  for (Surd& x : v) x = -x;
}

enum class Orientation { AsGiven, Canonical };

ExactLine make_line(SurdVector d, SurdVector m, Ring radicand, Orientation orientation) {
  if (orientation == Orientation::Canonical) {
    Sign first = Sign::Zero;
    for (int i = 0; i < 3 && first == Sign::Zero; ++i) first = sign_of(d[i], radicand);
    if (first == Sign::Negative) {
      negate(d);
      negate(m);
    }
  }
  ExactLine::Coordinates c{std::move(d), std::move(m), std::move(radicand), {}};
  c.rounded =
      internal::scaled<6>({c.d[0], c.d[1], c.d[2], c.m[0], c.m[1], c.m[2]}, c.radicand);
  return ExactLine(std::make_shared<const ExactLine::Coordinates>(std::move(c)));
}

// Where a line meets m, as w = num / den on m.from + w (m.to - m.from); den == 0 when it
// is parallel.  A point X is on the line iff X x d - moment = 0; along m that vector
// keeps its direction, so one component in which it changes tells w.
struct Parameter {
  Surd num, den;
};
Parameter parameter(const ExactLine::Coordinates& c, const LineThrough& m) {
  const SurdVector slope = cross(ring_difference(m.to, m.from), c.d);
  for (int i = 0; i < 3; ++i) {
    if (is_zero(slope[i], c.radicand)) continue;
    const SurdVector at = c.m - cross(ring_point(m.from), c.d);
    return {at[i], slope[i]};
  }
  return {};
}

int axis_of(const ExactLine::Coordinates& c) {
  for (int i = 0; i < 2; ++i) {
    if (!is_zero(c.d[i], c.radicand)) return i;
  }
  return 2;
}

// The contact with m, as numerators over one denominator.
struct PointOnLine {
  SurdVector at;
  Surd den;
};
PointOnLine contact_of(const ExactLine::Coordinates& c, const LineThrough& m) {
  const Parameter w = parameter(c, m);
  const RingVector p = ring_point(m.from);
  const RingVector along = ring_difference(m.to, m.from);
  PointOnLine out{{}, w.den};
  for (int i = 0; i < 3; ++i) out.at[i] = w.den * p[i] + w.num * along[i];
  return out;
}

Sign order_along(const ExactLine::Coordinates& c, const PointOnLine& a,
                 const PointOnLine& b) {
  const int i = axis_of(c);
  const Ring& d = c.radicand;
  const Surd ahead = product(a.at[i], b.den, d) - product(b.at[i], a.den, d);
  return sign_of(ahead, d) * sign_of(a.den, d) * sign_of(b.den, d) * sign_of(c.d[i], d);
}

RoundedPoint rounded(const SurdVector& at, const Surd& den, const Ring& d) {
  Eigen::Vector3d p;
  for (int i = 0; i < 3; ++i) {
    p[i] = is_zero(at[i], d) ? 0 : internal::quotient(at[i], den, d);
  }
  return {p, internal::kQuotientError};
}

// The sign of side() from rounded coordinates.  With e = 2^-53: a component of d or m is
// off by kValueError = 16 e, of m.to - m.from by e, a component of the moment passes
// three roundings (3 e of the sum of its two products' magnitudes); a product and five
// additions add 6 e.  All are relative to magnitudes that are added up in `size`: 16 + 3
// + 6 + a few for second order and for the rounding of `size` itself stay below 32.
// Nothing that is not 0 underflows: a coordinate that rounds to 0 is below 2^-1000, which
// times 2^281 is below 32 e of any size above 2^-600.
std::optional<Sign> rounded_side(const std::array<double, 6>& c, const LineThrough& m) {
  double value = 0;
  double size = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    const double x = m.from[j] * m.to[k];
    const double y = m.from[k] * m.to[j];
    const double z = c[3 + i] * (m.to[i] - m.from[i]);
    value += c[i] * (x - y) + z;
    size += std::abs(c[i]) * (std::abs(x) + std::abs(y)) + std::abs(z);
  }
  if (size > 0x1p-600 && std::abs(value) > 32 * internal::kUnit * size) {
    return internal::sign_of(value);
  }
  return std::nullopt;
}

Surd exact_side(const ExactLine::Coordinates& c, const LineThrough& m) {
  return dot(c.d, cross(ring_point(m.from), ring_point(m.to))) +
         dot(c.m, ring_difference(m.to, m.from));
}

}  // namespace

ExactLine::ExactLine(std::shared_ptr<const Coordinates> coordinates)
    : coordinates_(std::move(coordinates)) {}

ExactLine ExactLine::through(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return make_line(surds(ring_difference(b, a)),
                   surds(cross(ring_point(a), ring_point(b))), 0, Orientation::AsGiven);
}

std::optional<ExactLine> ExactLine::through(const Eigen::Vector3d& v,
                                            const LineThrough& l, const LineThrough& m) {
  const RingVector d = cross(cross(ring_difference(l.from, v), ring_difference(l.to, v)),
                             cross(ring_difference(m.from, v), ring_difference(m.to, v)));
  if (std::ranges::all_of(d, [](const Ring& x) { return is_zero(x); })) return {};
  return make_line(surds(d), surds(cross(ring_point(v), d)), 0, Orientation::Canonical);
}

std::optional<ExactLine> ExactLine::in_planes(const PlaneThrough& p,
                                              const PlaneThrough& q) {
  const auto normal = [](const PlaneThrough& plane) {
    return cross(ring_difference(plane.b, plane.a), ring_difference(plane.c, plane.a));
  };
  const RingVector n = normal(p);
  const RingVector o = normal(q);
  const RingVector d = cross(n, o);
  if (std::ranges::all_of(d, [](const Ring& x) { return is_zero(x); })) return {};
  // X x (n x o) = n (X . o) - o (X . n) for a point X of both planes.
  const Ring at_n = dot(ring_point(p.a), n);
  const Ring at_o = dot(ring_point(q.a), o);
  RingVector m;
  for (int i = 0; i < 3; ++i) m[i] = n[i] * at_o - o[i] * at_n;
  return make_line(surds(d), surds(m), 0, Orientation::Canonical);
}

ExactLine ExactLine::reversed() const {
  Coordinates c = *coordinates_;
  negate(c.d);
  negate(c.m);
  for (double& x : c.rounded) x = -x;
  return ExactLine(std::make_shared<const Coordinates>(std::move(c)));
}

bool ExactLine::is_rational() const { return is_zero(coordinates_->radicand); }

std::array<Sign, 3> ExactLine::direction_signs() const {
  const Coordinates& c = *coordinates_;
  return {sign_of(c.d[0], c.radicand), sign_of(c.d[1], c.radicand),
          sign_of(c.d[2], c.radicand)};
}

Sign ExactLine::side(const LineThrough& m) const {
  if (const auto s = rounded_side(coordinates_->rounded, m)) {
    ++internal::stage_counts.by_double;
    return *s;
  }
  ++internal::stage_counts.by_exact;
  return sign_of(exact_side(*coordinates_, m), coordinates_->radicand);
}

Sign ExactLine::heads(const PlaneThrough& plane) const {
  const RingVector n =
      cross(ring_difference(plane.b, plane.a), ring_difference(plane.c, plane.a));
  return sign_of(dot(coordinates_->d, n), coordinates_->radicand);
}

bool ExactLine::passes_through(const Eigen::Vector3d& p) const {
  const Coordinates& c = *coordinates_;
  return all_zero(c.m - cross(ring_point(p), c.d), c.radicand);
}

bool ExactLine::is_parallel(const LineThrough& m) const {
  const Coordinates& c = *coordinates_;
  return all_zero(cross(ring_difference(m.to, m.from), c.d), c.radicand);
}

// The two ends' distances from the line are parallel vectors when it meets m's line:
// equal directions mean that it passes beside the segment.
SegmentContact ExactLine::meets(const LineThrough& m) const {
  if (side(m) != Sign::Zero) return SegmentContact::None;
  const Coordinates& c = *coordinates_;
  const SurdVector from = c.m - cross(ring_point(m.from), c.d);
  const SurdVector to = c.m - cross(ring_point(m.to), c.d);
  bool at_from = true;
  bool at_to = true;
  for (int i = 0; i < 3; ++i) {
    const Sign f = sign_of(from[i], c.radicand);
    const Sign t = sign_of(to[i], c.radicand);
    if (f != Sign::Zero && f == t) return SegmentContact::None;
    at_from &= f == Sign::Zero;
    at_to &= t == Sign::Zero;
  }
  if (at_from && at_to) return SegmentContact::Along;
  return at_from || at_to ? SegmentContact::End : SegmentContact::Interior;
}

Sign ExactLine::contact_order(const LineThrough& l, const LineThrough& m) const {
  return order_along(*coordinates_, contact_of(*coordinates_, l),
                     contact_of(*coordinates_, m));
}

Sign ExactLine::contact_order(const LineThrough& m, const Eigen::Vector3d& p) const {
  return order_along(*coordinates_, contact_of(*coordinates_, m),
                     {surds(ring_point(p)), {1, 0}});
}

RoundedPoint ExactLine::contact(const LineThrough& m) const {
  const PointOnLine at = contact_of(*coordinates_, m);
  return rounded(at.at, at.den, coordinates_->radicand);
}

// For p = 0 that is d x m / d^2, since m = X x d.
RoundedPoint ExactLine::nearest(const Eigen::Vector3d& p) const {
  const Coordinates& c = *coordinates_;
  const Ring& r = c.radicand;
  const RingVector from = ring_point(p);
  SurdVector at = cross(c.d, c.m - cross(from, c.d), r);
  const Surd den = product(c.d[0], c.d[0], r) + product(c.d[1], c.d[1], r) +
                   product(c.d[2], c.d[2], r);
  for (int i = 0; i < 3; ++i) at[i] = at[i] + den * from[i];
  return rounded(at, den, r);
}

RoundedPoint ExactLine::direction() const {
  const Coordinates& c = *coordinates_;
  int largest = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(c.rounded[i]) > std::abs(c.rounded[largest])) largest = i;
  }
  const bool negative = sign_of(c.d[largest], c.radicand) == Sign::Negative;
  return rounded(c.d, negative ? -c.d[largest] : c.d[largest], c.radicand);
}

// p_i q_j == p_j q_i for all coordinates, i one where neither is 0.
bool same_line(const ExactLine& a, const ExactLine& b) {
  const ExactLine::Coordinates& p = a.coordinates();
  const ExactLine::Coordinates& q = b.coordinates();
  if (&p == &q) return true;
  const std::array<const Surd*, 6> x{&p.d[0], &p.d[1], &p.d[2],
                                     &p.m[0], &p.m[1], &p.m[2]};
  const std::array<const Surd*, 6> y{&q.d[0], &q.d[1], &q.d[2],
                                     &q.m[0], &q.m[1], &q.m[2]};
  const int i = axis_of(p);
  if (i != axis_of(q)) return false;
  // In doubles first: either product is off by at most 36 e.
  const auto differ = [&](int j) {
    const double s = p.rounded[i] * q.rounded[j];
    const double t = p.rounded[j] * q.rounded[i];
    return std::abs(s - t) >
           64 * internal::kUnit * (std::abs(s) + std::abs(t)) + 0x1p-900;
  };
  for (int j = 0; j < 6; ++j) {
    if (differ(j)) return false;
  }
  const auto times = [&](const Surd& s, const Surd& t) {
    // In Q(sqrt D)(sqrt E): s t = (s t.a) + (s t.b) sqrt(E).
    return std::array{s * t.a, s * t.b};
  };
  for (int j = 0; j < 6; ++j) {
    const auto left = times(*x[i], *y[j]);
    const auto right = times(*x[j], *y[i]);
    if (internal::sign_of_sum(left[0] - right[0], left[1] - right[1], p.radicand,
                              q.radicand) != Sign::Zero) {
      return false;
    }
  }
  return true;
}

// num_a / den_a - num_b / den_b over the product of the denominators' signs.
Sign compare_along(const LineThrough& edge, const ExactLine& a, const ExactLine& b) {
  const Ring& d = a.coordinates().radicand;
  const Ring& e = b.coordinates().radicand;
  const Parameter s = parameter(a.coordinates(), edge);
  const Parameter t = parameter(b.coordinates(), edge);
  const Surd rational = s.num * t.den.a - s.den * t.num.a;
  const Surd irrational = s.num * t.den.b - s.den * t.num.b;
  return internal::sign_of_sum(rational, irrational, d, e) * sign_of(s.den, d) *
         sign_of(t.den, e);
}

// p is from + t (to - from): compared on an axis along which the edge runs.
Sign compare_along(const LineThrough& edge, const ExactLine& a,
                   const Eigen::Vector3d& p) {
  const RingVector along = ring_difference(edge.to, edge.from);
  const int i = !is_zero(along[0]) ? 0 : !is_zero(along[1]) ? 1 : 2;
  const Ring& d = a.coordinates().radicand;
  const Parameter s = parameter(a.coordinates(), edge);
  const Surd ahead = s.num * along[i] - s.den * ring_difference(p, edge.from)[i];
  return sign_of(ahead, d) * sign_of(s.den, d) * sign_of(along[i]);
}

namespace internal {

std::optional<ExactLine> joining(const LineThrough& l, const std::array<Surd, 2>& x,
                                 const LineThrough& m, const std::array<Surd, 2>& y,
                                 const Ring& radicand) {
  // Homogeneous points (at, weight).
  const auto point = [](const LineThrough& line, const std::array<Surd, 2>& t) {
    const RingVector p = ring_point(line.from);
    const RingVector q = ring_point(line.to);
    SurdVector at;
    for (int i = 0; i < 3; ++i) at[i] = t[0] * p[i] + t[1] * q[i];
    return at;
  };
  const SurdVector a = point(l, x);
  const SurdVector b = point(m, y);
  const Surd a_weight = x[0] + x[1];
  const Surd b_weight = y[0] + y[1];
  SurdVector d;
  for (int i = 0; i < 3; ++i) {
    d[i] = product(a_weight, b[i], radicand) - product(b_weight, a[i], radicand);
  }
  if (all_zero(d, radicand)) return std::nullopt;
  SurdVector moment = cross(a, b, radicand);
  if (is_zero(radicand)) return make_line(d, moment, 0, Orientation::Canonical);
  if (const auto root = rational_root(radicand)) {
    for (SurdVector* v : {&d, &moment}) {
      for (Surd& s : *v) s = {s.a + s.b * *root, 0};
    }
    return make_line(d, moment, 0, Orientation::Canonical);
  }
  return make_line(d, moment, radicand, Orientation::Canonical);
}

}  // namespace internal
}  // namespace sightline
