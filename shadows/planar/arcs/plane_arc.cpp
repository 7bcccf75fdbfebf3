#include "shadows/planar/arcs/plane_arc.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
#include <string>

#include "linespace/scene.h"

namespace sightline::internal {
namespace {

using IntegerMatrix = std::array<std::array<Integer, 3>, 3>;

// An input curve on its support, in the direction in which the support's parameter grows.
struct Prepared {
  int curve;
  PlaneSupport support;
  QuadraticRoot from, to;
  bool backwards = false;
  DoubleRange from_range, to_range;
};

[[noreturn]] void refuse(const PlaneCurve& curve, const char* why) {
  throw InvalidInput("curve " + std::to_string(curve.id) + " of a planar map " + why);
}

// Times a positive number, without common factors.
template <std::size_t N>
std::array<Integer, N> integers(const std::array<Rational, N>& values) {
  Integer common = 1;
  for (const Rational& x : values) common = lcm(common, Integer(denominator(x)));
  std::array<Integer, N> out;
  Integer divisor = 0;
  for (std::size_t i = 0; i < N; ++i) {
    out[i] = numerator(values[i]) * (common / denominator(values[i]));
    divisor = gcd(divisor, out[i]);
  }
  if (divisor > 1) {
    for (Integer& x : out) x /= divisor;
  }
  return out;
}

QuadraticRoot end_root(const PlaneCurve& curve, const CurveEnd& end) {
  const std::array<Integer, 3> f = integers(end.polynomial);
  const Ring c0 = ring(f[0]), c1 = ring(f[1]), c2 = ring(f[2]);
  if (f[2] == 0) {
    if (f[1] == 0) refuse(curve, "has an end that is no root");
    if (f[1] < 0) return {c0, 0, -c1, 0};
    return {-c0, 0, c1, 0};
  }
  const Ring d = c1 * c1 - 4 * c0 * c2;
  if (sign_of(d) == Sign::Negative) refuse(curve, "has an end that is no real root");
  const bool upwards = f[2] > 0;
  const Ring a = upwards ? -c1 : c1, c = upwards ? 2 * c2 : -2 * c2;
  const Ring b = end.larger ? 1 : -1;
  if (const std::optional<Ring> root = rational_root(d)) return {a + b * *root, 0, c, 0};
  return {a, b, c, d};
}

SurdPoint point_of(const IntegerMatrix& curve, const QuadraticRoot& s) {
  std::array<Surd, 3> x;
  for (int i = 0; i < 3; ++i) {
    const std::array<Ring, 3> c{ring(curve[i][0]), ring(curve[i][1]), ring(curve[i][2])};
    x[i] = value_at(c, s);
  }
  return {x[0], x[1], x[2], s.d};
}

// w has no zero from `from` to `to`.
bool finite(const std::array<Integer, 3>& w, const QuadraticRoot& from,
            const QuadraticRoot& to) {
  const std::array<Ring, 3> f{ring(w[0]), ring(w[1]), ring(w[2])};
  const Sign sign = sign_of(value_at(f, from), from.d);
  if (sign == Sign::Zero || sign_of(value_at(f, to), to.d) != sign) return false;
  if (w[2] == 0) return true;
  const Ring d = f[1] * f[1] - 4 * f[0] * f[2];
  if (sign_of(d) == Sign::Negative) return true;
  // The sign of the leading coefficient is that outside of both roots.  Where the ends
  // have it, either both roots lie between them, and the extremum with them, or none.
  if ((w[2] > 0) != (sign == Sign::Positive)) return true;
  const QuadraticRoot extremum = w[2] > 0 ? QuadraticRoot{-f[1], 0, 2 * f[2], 0}
                                          : QuadraticRoot{f[1], 0, -2 * f[2], 0};
  return compare(from, extremum) != Sign::Negative ||
         compare(extremum, to) != Sign::Negative;
}

Prepared prepared(const PlaneCurve& curve, int number) {
  std::array<Rational, 9> all;
  for (int k = 0; k < 3; ++k) {
    all[k] = curve.x[k];
    all[3 + k] = curve.y[k];
    all[6 + k] = curve.w[k];
  }
  const std::array<Integer, 9> whole = integers(all);
  IntegerMatrix m;
  for (int i = 0; i < 9; ++i) m[i / 3][i % 3] = whole[i];
  Prepared out;
  out.curve = number;
  out.from = end_root(curve, curve.from);
  out.to = end_root(curve, curve.to);
  if (compare(out.from, out.to) != Sign::Negative) refuse(curve, "has ends out of order");
  if (!finite(m[2], out.from, out.to)) refuse(curve, "leaves the plane at infinity");
  SurdPoint p = point_of(m, out.from);
  if (sign_of(p.w, p.d) == Sign::Negative) {
    for (auto& row : m) {
      for (Integer& x : row) x = -x;
    }
  }
  out.support = support_of(m);
  if (out.support.straight) {
    out.from = *parameter_of(out.support, point_of(m, out.from));
    out.to = *parameter_of(out.support, point_of(m, out.to));
    const Sign order = compare(out.from, out.to);
    if (order == Sign::Zero) refuse(curve, "returns to its first point");
    out.backwards = order == Sign::Positive;
    if (out.backwards) std::swap(out.from, out.to);
  }
  out.from_range = range(ball(out.from));
  out.to_range = range(ball(out.to));
  return out;
}

// Twice the area of a ring, positive when counter-clockwise.
Rational doubled_area(const std::vector<PlanePoint>& ring) {
  Rational sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const PlanePoint& p = ring[i];
    const PlanePoint& q = ring[(i + 1) % ring.size()];
    sum += p[0] * q[1] - p[1] * q[0];
  }
  return sum;
}

// The sides of the outline with the inside on their left: the outer ring, which has the
// largest area, counter-clockwise and the others clockwise.
std::vector<PlaneCurve> outline_sides(const PlaneOutline& outline) {
  std::vector<Rational> areas;
  for (const auto& r : outline) areas.push_back(doubled_area(r));
  std::size_t outer = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    if (areas[i] == 0)
      throw InvalidInput("a ring of the outline of a planar map has no area");
    if (abs(areas[i]) > abs(areas[outer])) outer = i;
  }
  if (outline.empty()) throw InvalidInput("a planar map has no outline");
  std::vector<PlaneCurve> sides;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    std::vector<PlanePoint> r = outline[i];
    if ((areas[i] > 0) != (i == outer)) std::ranges::reverse(r);
    for (std::size_t k = 0; k < r.size(); ++k) {
      const PlanePoint& q = r[(k + 1) % r.size()];
      if (r[k] == q) throw InvalidInput("the outline of a planar map repeats a corner");
      sides.push_back(plane_segment(-1 - static_cast<int>(sides.size()), r[k], q));
    }
  }
  return sides;
}

int lexicographic(std::span<const Integer> a, std::span<const Integer> b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const int order = a[i].compare(b[i]);
    if (order != 0) return order;
  }
  return 0;
}

Sign compare_ranged(const QuadraticRoot& x, const DoubleRange& x_range,
                    const QuadraticRoot& y, const DoubleRange& y_range) {
  if (x_range.hi < y_range.lo) return Sign::Negative;
  if (y_range.hi < x_range.lo) return Sign::Positive;
  return compare(x, y);
}

// By support; of one line by where they begin; of one conic by anything that does not
// depend on the order of the input.
bool comes_before(const Prepared& a, const Prepared& b) {
  if (const int order = lexicographic(a.support.implicit, b.support.implicit)) {
    return order < 0;
  }
  if (!a.support.straight) {
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        const Sign order =
            sign_of(Ring(a.support.exact.curve[i][k] - b.support.exact.curve[i][k]));
        if (order != Sign::Zero) return order == Sign::Negative;
      }
    }
  }
  Sign order = compare_ranged(a.from, a.from_range, b.from, b.from_range);
  if (order == Sign::Zero) order = compare_ranged(a.to, a.to_range, b.to, b.to_range);
  return order == Sign::Zero ? a.curve < b.curve : order == Sign::Negative;
}

ArcParameter parameter(const QuadraticRoot& s, const DoubleRange& range) {
  return {range, -1, std::make_shared<const ExactParameter>(s)};
}

ArcEnd arc_end(const PlaneSupport& support, const ArcParameter& at) {
  ArcEnd end;
  end.at = at;
  end.exact = std::get<QuadraticRoot>(*at.exact);
  end.point = point_at(support, end.exact);
  end.parameter = ball(end.exact);
  const auto& c = support.balls.curve;
  const auto value = [&](int i) {
    const BallNumber& s = end.parameter;
    return support.straight ? c[i][0] + c[i][1] * s
                            : c[i][0] + s * (c[i][1] + s * c[i][2]);
  };
  end.x = value(0);
  end.y = value(1);
  end.w = value(2);
  const std::optional<PointRange> box = point_range(support, end.parameter);
  if (!box) throw InvalidInput("an end of a curve of a planar map is too far away");
  end.box_x = box->x;
  end.box_y = box->y;
  return end;
}

// Appends the arcs of curves [begin, end), which lie on one line.
void add_stretches(std::span<const Prepared* const> curves, int support, PlaneArcs& out) {
  const PlaneSupport& line = out.supports[support];
  std::size_t i = 0;
  while (i < curves.size()) {
    PlaneArc arc;
    arc.support = support;
    const Prepared* last = curves[i];  // the one that reaches furthest
    std::size_t last_member = 0;
    for (; i < curves.size(); ++i) {
      const Prepared& c = *curves[i];
      if (!arc.members.empty() && compare_ranged(c.from, c.from_range, last->to,
                                                 last->to_range) == Sign::Positive) {
        break;
      }
      arc.members.push_back({c.curve, parameter(c.from, c.from_range),
                             parameter(c.to, c.to_range), c.backwards});
      if (compare_ranged(c.to, c.to_range, last->to, last->to_range) == Sign::Positive) {
        last = &c;
        last_member = arc.members.size() - 1;
      }
    }
    arc.ends = {arc_end(line, arc.members.front().from),
                arc_end(line, arc.members[last_member].to)};
    out.arcs.push_back(std::move(arc));
  }
}

}  // namespace

PlaneArcs plane_arcs(std::span<const PlaneCurve> curves, const PlaneOutline& outline) {
  const std::vector<PlaneCurve> sides = outline_sides(outline);
  std::vector<Prepared> all(curves.size() + sides.size());
  oneapi::tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    all[i] = i < curves.size()
                 ? prepared(curves[i], static_cast<int>(i))
                 : prepared(sides[i - curves.size()], sides[i - curves.size()].id);
  });
  std::vector<const Prepared*> order;
  for (const Prepared& c : all) order.push_back(&c);
  std::ranges::sort(
      order, [](const Prepared* a, const Prepared* b) { return comes_before(*a, *b); });
  PlaneArcs out;
  for (std::size_t i = 0; i < order.size();) {
    const int first = static_cast<int>(out.supports.size());
    const PlaneSupport& support = order[i]->support;
    std::size_t end = i + 1;
    while (end < order.size() && order[end]->support.implicit == support.implicit) ++end;
    const auto same = std::span(order).subspan(i, end - i);
    if (support.straight) {
      out.supports.push_back(support);
      out.conic.push_back(first);
      add_stretches(same, first, out);
    } else {
      for (const Prepared* c : same) {
        out.supports.push_back(c->support);
        out.conic.push_back(first);
        PlaneArc arc;
        arc.support = static_cast<int>(out.supports.size()) - 1;
        const ArcParameter from = parameter(c->from, c->from_range),
                           to = parameter(c->to, c->to_range);
        arc.members.push_back({c->curve, from, to, false});
        arc.ends = {arc_end(c->support, from), arc_end(c->support, to)};
        out.arcs.push_back(std::move(arc));
      }
    }
    i = end;
  }
  for (const PlaneArc& arc : out.arcs) {
    out.doubles.push_back(arc_doubles(out.supports[arc.support], arc.ends[0].parameter,
                                      arc.ends[1].parameter));
  }
  return out;
}

const ExactParameter& exact(const std::vector<PlaneSupport>& supports, int own,
                            ArcParameter& p) {
  if (p.exact) return *p.exact;
  const PlaneSupport& curve = supports[own];
  const Substitution<Ring> s = substitute<Ring>(curve, supports[p.crossing]);
  if (s.degree == 1) {
    const bool negative = sign_of(s.f[1]) == Sign::Negative;
    p.exact = std::make_shared<const ExactParameter>(
        negative ? QuadraticRoot{s.f[0], 0, -s.f[1], 0}
                 : QuadraticRoot{-s.f[0], 0, s.f[1], 0});
    return *p.exact;
  }
  PolynomialRoot root{integer_polynomial(std::span(s.f).first(s.degree + 1)),
                      dyadic(p.range.lo), dyadic(p.range.hi)};
  for (const Dyadic& x : {root.lo, root.hi}) {
    if (sign_at(root.f, x) != 0) continue;
    p.exact = std::make_shared<const ExactParameter>(quadratic_root(x));
    return *p.exact;
  }
  p.exact = std::make_shared<const ExactParameter>(std::move(root));
  return *p.exact;
}

Sign compare(const std::vector<PlaneSupport>& supports, int own, ArcParameter& p,
             ArcParameter& q) {
  if (p.range.hi < q.range.lo) return Sign::Negative;
  if (q.range.hi < p.range.lo) return Sign::Positive;
  if (p.exact && p.exact == q.exact) return Sign::Zero;
  if (p.crossing >= 0 && p.crossing == q.crossing && supports[own].straight &&
      supports[p.crossing].straight) {
    return Sign::Zero;
  }
  return compare(exact(supports, own, p), exact(supports, own, q));
}

}  // namespace sightline::internal
