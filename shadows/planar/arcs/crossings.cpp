#include "shadows/planar/arcs/crossings.h"

#include <algorithm>
#include <cmath>

#include "shadows/planar/arcs/ball_roots.h"

namespace sightline::internal {
namespace {

std::optional<Sign> certain_side(const PlaneSupport& support, const ArcEnd& p) {
  const SupportForms<BallNumber>& f = support.balls;
  const auto at_point = [&](const std::array<BallNumber, 3>& form) {
    return form[0] * p.x + form[1] * p.y + form[2] * p.w;
  };
  if (support.straight) return sign_of(at_point(f.line));
  const BallNumber z1 = at_point(f.inverse[1]);
  const std::optional<Sign> sign =
      sign_of(at_point(f.inverse[0]) * at_point(f.inverse[2]) - z1 * z1);
  if (!sign) return sign;
  return support.reversed ? -*sign : *sign;
}

Sign side_of_end(const PlaneSupport& support, const ArcEnd& p) {
  const std::optional<Sign> sign = certain_side(support, p);
  return sign && *sign != Sign::Zero ? *sign : side_of(support, p.point);
}

BallPolynomial polynomial(const Substitution<BallNumber>& s) { return {s.f, s.degree}; }

ArcParameter known(const ExactParameter& s) {
  return {range(s), -1, std::make_shared<const ExactParameter>(s)};
}

// A point of the curve of `arc` on the arc: at one of its ends, inside (a new parameter),
// or not at all.
std::optional<ArcParameter> on_arc(const PlaneArc& arc, const QuadraticRoot& s) {
  const DoubleRange r = range(ball(s));
  for (const int end : {0, 1}) {
    const ArcEnd& e = arc.ends[end];
    if (apart(r, e.at.range)) {
      if ((r.hi < e.at.range.lo) == (end == 0)) return std::nullopt;
      continue;
    }
    const Sign order = compare(s, e.exact);
    if (order == Sign::Zero) return e.at;
    if ((order == Sign::Negative) == (end == 0)) return std::nullopt;
  }
  return ArcParameter{r, -1, std::make_shared<const ExactParameter>(s)};
}

// ---- two lines

void append_crossing_of_lines(const PlaneArcs& all, const PlaneArc& a, const PlaneArc& b,
                              std::vector<ArcCrossing>& out) {
  const PlaneSupport& on_a = all.supports[a.support];
  const PlaneSupport& on_b = all.supports[b.support];
  const Sign a0 = side_of_end(on_b, a.ends[0]), a1 = side_of_end(on_b, a.ends[1]);
  if (a0 == a1) return;  // not both zero: the lines are different
  const Sign b0 = side_of_end(on_a, b.ends[0]), b1 = side_of_end(on_a, b.ends[1]);
  if (b0 == b1) return;
  const auto parameter = [&](const PlaneArc& own, const PlaneArc& other, Sign s0,
                             Sign s1) -> ArcParameter {
    if (s0 == Sign::Zero) return own.ends[0].at;
    if (s1 == Sign::Zero) return own.ends[1].at;
    const Substitution<BallNumber> s =
        substitute<BallNumber>(all.supports[own.support], all.supports[other.support]);
    if (const std::optional<DoubleRange> r = range_of_quotient(-s.f[0], s.f[1])) {
      return {*r, other.support, nullptr};
    }
    ArcParameter p{{}, other.support, nullptr};
    p.range = range(exact(all.supports, own.support, p));
    return p;
  };
  out.push_back({parameter(a, b, a0, a1), parameter(b, a, b0, b1)});
}

// ---- a conic and a line or another conic

// The pair in work: a is a conic.
struct ArcPair {
  const PlaneArcs& all;
  const PlaneArc& a;
  const PlaneArc& b;
  std::vector<ArcCrossing>& out;

  [[nodiscard]] const PlaneSupport& on_a() const { return all.supports[a.support]; }
  [[nodiscard]] const PlaneSupport& on_b() const { return all.supports[b.support]; }
};

// Appends the crossings at ends of the arcs; returns where on a's conic, ends of a
// included, ends lie on the other curve.
std::vector<QuadraticRoot> append_ends(const ArcPair& pair) {
  std::vector<QuadraticRoot> roots;
  for (const ArcEnd& end : pair.a.ends) {
    if (side_of_end(pair.on_b(), end) != Sign::Zero) continue;
    roots.push_back(end.exact);
    const std::optional<QuadraticRoot> t = parameter_of(pair.on_b(), end.point);
    if (!t) continue;
    if (const std::optional<ArcParameter> on_b = on_arc(pair.b, *t)) {
      pair.out.push_back({end.at, *on_b});
    }
  }
  for (const ArcEnd& end : pair.b.ends) {
    if (side_of_end(pair.on_a(), end) != Sign::Zero) continue;
    const std::optional<QuadraticRoot> s = parameter_of(pair.on_a(), end.point);
    if (!s) continue;
    const std::optional<ArcParameter> on_a = on_arc(pair.a, *s);
    if (!on_a || on_a->exact == pair.a.ends[0].at.exact ||
        on_a->exact == pair.a.ends[1].at.exact) {
      continue;
    }
    pair.out.push_back({*on_a, end.at});
    roots.push_back(*s);
  }
  return roots;
}

// Appends all other crossings; false, and none, where doubles cannot tell.
bool append_by_doubles(const ArcPair& pair,
                       const std::vector<QuadraticRoot>& known_roots) {
  const Substitution<BallNumber> s = substitute<BallNumber>(pair.on_a(), pair.on_b());
  const BallPolynomial f = polynomial(s);
  BallPolynomial rest = f;
  for (const QuadraticRoot& root : known_roots) {
    if (rest.degree == 0) return true;
    rest = without_root(rest, ball(root));
  }
  if (rest.degree == 0) return true;
  const auto roots =
      simple_roots(rest, pair.a.ends[0].at.range.lo, pair.a.ends[1].at.range.hi);
  if (!roots) return false;
  if (roots->empty()) return true;
  std::vector<ArcCrossing> found;
  const BallPolynomial g = polynomial(substitute<BallNumber>(pair.on_b(), pair.on_a()));
  for (const DoubleRange& root : *roots) {
    if (!(pair.a.ends[0].at.range.hi < root.lo && root.hi < pair.a.ends[1].at.range.lo)) {
      return false;
    }
    const BallNumber at = ball(root);
    const auto z = [&](int i) { return s.z[i][0] + at * (s.z[i][1] + at * s.z[i][2]); };
    const std::optional<DoubleRange> t = range_of_quotient(z(1), z(0));
    if (!t) return false;
    const DoubleRange from = pair.b.ends[0].at.range, to = pair.b.ends[1].at.range;
    if (t->hi < from.lo || to.hi < t->lo) continue;
    if (!(from.hi < t->lo && t->hi < to.lo)) return false;
    if (!monotone(f, root) || !monotone(g, *t)) return false;
    found.push_back({{root, pair.b.support, nullptr}, {*t, pair.a.support, nullptr}});
  }
  pair.out.insert(pair.out.end(), found.begin(), found.end());
  return true;
}

// ---- the same in exact arithmetic

struct RationalRange {
  Rational lo, hi;
};
RationalRange operator+(const RationalRange& x, const Rational& y) {
  return {x.lo + y, x.hi + y};
}
RationalRange operator*(const RationalRange& x, const RationalRange& y) {
  const std::array<Rational, 4> p{x.lo * y.lo, x.lo * y.hi, x.hi * y.lo, x.hi * y.hi};
  return {*std::ranges::min_element(p), *std::ranges::max_element(p)};
}

RationalRange range_over(const std::array<Ring, 3>& f, const PolynomialRoot& s) {
  const RationalRange at{rational(s.lo), rational(s.hi)};
  const RationalRange lead{rational(f[2]), rational(f[2])};
  return (lead * at + rational(f[1])) * at + rational(f[0]);
}

// The root t = z1(s) / z0(s) of g among `candidates`, which are all roots in a window;
// nullopt where it is none of them.
std::optional<ExactParameter> matching(ExactParameter s, const Substitution<Ring>& sub,
                                       std::vector<ExactParameter> candidates,
                                       const Dyadic& lo, const Dyadic& hi) {
  const Polynomial1 z0 = integer_polynomial(sub.z[0]);
  if (sign_at(z0, s) == Sign::Zero) return std::nullopt;
  for (;;) {
    if (const auto* q = std::get_if<QuadraticRoot>(&s)) {
      return exact_ratio(value_at(sub.z[1], *q), value_at(sub.z[0], *q), q->d);
    }
    const PolynomialRoot& r = std::get<PolynomialRoot>(s);
    const RationalRange up = range_over(sub.z[1], r), down = range_over(sub.z[0], r);
    if (down.lo > 0 || down.hi < 0) {
      const RationalRange t = up * RationalRange{1 / down.hi, 1 / down.lo};
      if (t.hi < rational(lo) || t.lo > rational(hi)) return std::nullopt;
      std::vector<ExactParameter> left;
      for (const ExactParameter& c : candidates) {
        const ExactParameter from = quadratic_root(t.lo), to = quadratic_root(t.hi);
        if (compare(c, from) != Sign::Negative && compare(c, to) != Sign::Positive) {
          left.push_back(c);
        }
      }
      if (left.empty()) return std::nullopt;
      if (left.size() == 1 && t.lo > rational(lo) && t.hi < rational(hi)) return left[0];
    }
    s = halved(r);
  }
}

Dyadic outwards(double x, double by) { return dyadic(x + by); }

bool strictly_inside(const PlaneArc& arc, const ExactParameter& s) {
  return compare(s, ExactParameter(arc.ends[0].exact)) == Sign::Positive &&
         compare(s, ExactParameter(arc.ends[1].exact)) == Sign::Negative;
}

void append_exactly(const ArcPair& pair, const std::vector<QuadraticRoot>& known_roots) {
  const Substitution<Ring> s = substitute<Ring>(pair.on_a(), pair.on_b());
  const Substitution<Ring> back = substitute<Ring>(pair.on_b(), pair.on_a());
  const auto window = [](const PlaneArc& arc) {
    const double from = arc.ends[0].at.range.lo, to = arc.ends[1].at.range.hi;
    // Wider than the enclosures of the ends.
    const double margin = 0x1p-10 * (to - from) +
                          0x1p-40 * std::max({std::abs(from), std::abs(to), 0x1p-20});
    return std::array{outwards(from, -margin), outwards(to, margin)};
  };
  const auto [a_lo, a_hi] = window(pair.a);
  const auto [b_lo, b_hi] = window(pair.b);
  const Polynomial1 f = integer_polynomial(s.f), g = integer_polynomial(back.f);
  std::vector<ExactParameter> candidates;
  for (const PolynomialRoot& r : roots_between(g, b_lo, b_hi)) candidates.emplace_back(r);
  for (const PolynomialRoot& r : roots_between(f, a_lo, a_hi)) {
    const ExactParameter root = r;
    if (!strictly_inside(pair.a, root)) continue;
    const bool is_known = std::ranges::any_of(known_roots, [&](const QuadraticRoot& k) {
      return compare(ExactParameter(k), root) == Sign::Zero;
    });
    if (is_known) continue;
    const std::optional<ExactParameter> t = matching(root, s, candidates, b_lo, b_hi);
    if (!t || !strictly_inside(pair.b, *t)) continue;
    pair.out.push_back({known(root), known(*t)});
  }
}

// ---- two arcs of one conic

void append_overlap(const ArcPair& pair) {
  for (const ArcEnd& end : pair.a.ends) {
    const std::optional<QuadraticRoot> t = parameter_of(pair.on_b(), end.point);
    if (!t) continue;
    if (const auto on_b = on_arc(pair.b, *t)) pair.out.push_back({end.at, *on_b});
  }
  for (const ArcEnd& end : pair.b.ends) {
    const std::optional<QuadraticRoot> s = parameter_of(pair.on_a(), end.point);
    if (!s) continue;
    if (const auto on_a = on_arc(pair.a, *s)) pair.out.push_back({*on_a, end.at});
  }
}

}  // namespace

void append_crossings(const PlaneArcs& all, int a, int b, std::vector<ArcCrossing>& out,
                      CrossingCounts& counts) {
  ++counts.pairs;
  const PlaneArc& first = all.arcs[a];
  const PlaneArc& second = all.arcs[b];
  if (first.support == second.support) return;
  if (certainly_beside(all.doubles[a], all.doubles[b]) ||
      certainly_beside(all.doubles[b], all.doubles[a])) {
    ++counts.by_filter;
    return;
  }
  const bool a_straight = all.supports[first.support].straight;
  if (a_straight && all.supports[second.support].straight) {
    append_crossing_of_lines(all, first, second, out);
    return;
  }
  if (a_straight) {
    const std::size_t before = out.size();
    append_crossings(all, b, a, out, counts);
    --counts.pairs;
    for (std::size_t i = before; i < out.size(); ++i) std::swap(out[i].on_a, out[i].on_b);
    return;
  }
  const ArcPair pair{all, first, second, out};
  if (all.conic[first.support] == all.conic[second.support]) {
    append_overlap(pair);
    return;
  }
  const std::vector<QuadraticRoot> roots = append_ends(pair);
  if (!roots.empty()) ++counts.by_end;
  if (append_by_doubles(pair, roots)) return;
  ++counts.by_exact;
  append_exactly(pair, roots);
}

}  // namespace sightline::internal
