#include "shadows/planar/arcs/exact_parameter.h"

#include <CGAL/Gmpq.h>
#include <CGAL/Gmpz.h>
#include <gmp.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "shadows/planar/plane_curve.h"

namespace sightline::internal {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Sign sign(int x) { return x < 0 ? Sign::Negative : x > 0 ? Sign::Positive : Sign::Zero; }

// n 2^-k - m 2^-l.
int compare_dyadic(const Dyadic& x, const Dyadic& y) {
  const int k = std::max(x.k, y.k);
  return Integer((x.n << (k - x.k)) - (y.n << (k - y.k))).sign();
}

// f has exactly one root, or none, in the interval, and none at its ends.
bool changes(const Polynomial1& f, const Dyadic& lo, const Dyadic& hi) {
  return sign_at(f, lo) != sign_at(f, hi);
}

Sign compare_roots(PolynomialRoot x, PolynomialRoot y) {
  bool same_known = false;
  for (;;) {
    if (compare_dyadic(x.hi, y.lo) <= 0) return Sign::Negative;
    if (compare_dyadic(y.hi, x.lo) <= 0) return Sign::Positive;
    if (!same_known) {
      same_known = true;
      const Polynomial1 common = x.f == y.f ? x.f : greatest_divisor(x.f, y.f);
      if (common.size() > 1) {
        const Dyadic& lo = compare_dyadic(x.lo, y.lo) < 0 ? y.lo : x.lo;
        const Dyadic& hi = compare_dyadic(x.hi, y.hi) < 0 ? x.hi : y.hi;
        if (changes(common, lo, hi)) return Sign::Zero;
      }
    }
    const ExactParameter u = halved(x), v = halved(y);
    if (!std::holds_alternative<PolynomialRoot>(u) ||
        !std::holds_alternative<PolynomialRoot>(v)) {
      return compare(u, v);
    }
    x = std::get<PolynomialRoot>(u);
    y = std::get<PolynomialRoot>(v);
  }
}

Sign compare_mixed(const QuadraticRoot& x, PolynomialRoot y) {
  std::vector<Ring> f;
  for (const Integer& c : y.f) f.push_back(ring(c));
  const bool zero = is_zero(value_at(f, x), x.d);
  for (;;) {
    if (compare(x, quadratic_root(y.lo)) != Sign::Positive) return Sign::Negative;
    if (compare(x, quadratic_root(y.hi)) != Sign::Negative) return Sign::Positive;
    if (zero) return Sign::Zero;
    const ExactParameter v = halved(y);
    if (const auto* q = std::get_if<QuadraticRoot>(&v)) return compare(x, *q);
    y = std::get<PolynomialRoot>(v);
  }
}

}  // namespace

Sign compare(const ExactParameter& x, const ExactParameter& y) {
  const auto* p = std::get_if<QuadraticRoot>(&x);
  const auto* q = std::get_if<QuadraticRoot>(&y);
  if (p && q) return compare(*p, *q);
  if (p) return compare_mixed(*p, std::get<PolynomialRoot>(y));
  if (q) return -compare_mixed(*q, std::get<PolynomialRoot>(x));
  return compare_roots(std::get<PolynomialRoot>(x), std::get<PolynomialRoot>(y));
}

Sign sign_at(const Polynomial1& h, const ExactParameter& x) {
  if (h.empty()) return Sign::Zero;
  if (const auto* q = std::get_if<QuadraticRoot>(&x)) {
    std::vector<Ring> f;
    for (const Integer& c : h) f.push_back(ring(c));
    return sign_of(value_at(f, *q), q->d);
  }
  PolynomialRoot r = std::get<PolynomialRoot>(x);
  const Polynomial1 common = greatest_divisor(h, r.f);
  if (common.size() > 1 && changes(common, r.lo, r.hi)) return Sign::Zero;
  for (;;) {
    const int at_lo = sign_at(h, r.lo);
    if (at_lo != 0 && at_lo == sign_at(h, r.hi) &&
        separating_points({h}, r.lo, r.hi).size() == 1) {
      return sign(at_lo);
    }
    const ExactParameter half = halved(r);
    if (std::holds_alternative<QuadraticRoot>(half)) return sign_at(h, half);
    r = std::get<PolynomialRoot>(half);
  }
}

// Horner's scheme in numerators: times c^degree.
Surd value_at(std::span<const Ring> h, const QuadraticRoot& x) {
  const Surd s{x.a, x.b};
  Surd value{0, 0};
  Ring power = 1;
  for (std::size_t i = h.size(); i-- > 0;) {
    value = product(value, s, x.d);
    value.a = value.a + h[i] * power;
    if (i > 0) power = power * x.c;
  }
  return value;
}

QuadraticRoot exact_ratio(const Surd& n, const Surd& m, const Ring& d) {
  const Surd conjugate{m.a, -m.b};
  const Surd up = product(n, conjugate, d);
  const Ring down = m.a * m.a - m.b * m.b * d;
  assert(!is_zero(down));
  const bool rational = is_zero(up.b);
  const Ring radicand = rational ? Ring(0) : d;
  if (sign_of(down) == Sign::Negative) return {-up.a, -up.b, -down, radicand};
  return {up.a, up.b, down, radicand};
}

ExactParameter halved(const PolynomialRoot& x) {
  const int k = std::max(x.lo.k, x.hi.k);
  const Dyadic middle{(x.lo.n << (k - x.lo.k)) + (x.hi.n << (k - x.hi.k)), k + 1};
  const int at_middle = sign_at(x.f, middle);
  if (at_middle == 0) return quadratic_root(middle);
  if (at_middle == sign_at(x.f, x.lo)) return PolynomialRoot{x.f, middle, x.hi};
  return PolynomialRoot{x.f, x.lo, middle};
}

std::vector<PolynomialRoot> roots_between(const Polynomial1& f, const Dyadic& lo,
                                          const Dyadic& hi) {
  const Polynomial1 simple = with_simple_roots(f);
  const std::vector<Dyadic> points = separating_points({simple}, lo, hi);
  std::vector<PolynomialRoot> roots;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    roots.push_back({simple, points[i], points[i + 1]});
  }
  return roots;
}

Dyadic between(const ExactParameter& x, const ExactParameter& y) {
  const DoubleRange a = range(x), b = range(y);
  if (a.hi < b.lo) {
    const double middle = 0.5 * (a.hi + b.lo);
    if (a.hi < middle && middle < b.lo) return dyadic(middle);
  }
  // The first number above x of a grid that gets finer.
  const Dyadic below = dyadic(a.lo), above = dyadic(b.hi);
  for (int k = std::max({64, below.k, above.k});; k *= 2) {
    Integer low = (below.n << (k - below.k)) - 1;
    Integer high = (above.n << (k - above.k)) + 1;
    while (high - low > 1) {
      const Integer middle = (low + high) >> 1;
      const ExactParameter at = quadratic_root(Dyadic{middle, k});
      (compare(at, x) == Sign::Positive ? high : low) = middle;
    }
    const Dyadic candidate{high, k};
    if (compare(ExactParameter(quadratic_root(candidate)), y) == Sign::Negative) {
      return candidate;
    }
  }
}

Dyadic dyadic(double x) {
  if (x == 0) return {0, 0};
  int exponent = 0;
  const double mantissa = std::frexp(x, &exponent);
  Integer n = static_cast<std::int64_t>(std::ldexp(mantissa, 53));
  int k = 53 - exponent;
  if (k < 0) {
    n <<= -k;
    k = 0;
  }
  return {n, k};
}

Rational rational(const Dyadic& x) { return Rational(x.n, Integer(1) << x.k); }

QuadraticRoot quadratic_root(const Dyadic& x) {
  return {ring(x.n), 0, ring(Integer(1) << x.k), 0};
}
QuadraticRoot quadratic_root(const Rational& x) {
  return {ring(numerator(x)), 0, ring(denominator(x)), 0};
}

// CGAL 5.5's conversion loses the sign and hangs at 0.
Ring ring(const Integer& x) {
  if (x == 0) return 0;
  const CGAL::Gmpz magnitude(Integer(abs(x)).backend().data());
  const Ring out(magnitude);
  return x < 0 ? -out : out;
}

Polynomial1 integer_polynomial(std::span<const Ring> coefficients) {
  std::vector<CGAL::Gmpq> all;
  Integer common = 1;
  for (const Ring& c : coefficients) {
    all.emplace_back(is_zero(c) ? CGAL::Gmpq(0) : CGAL::Gmpq(c));
    Integer denominator;
    mpz_set(denominator.backend().data(), mpq_denref(all.back().mpq()));
    common = lcm(common, denominator);
  }
  Polynomial1 f;
  for (const CGAL::Gmpq& q : all) {
    Integer n, m;
    mpz_set(n.backend().data(), mpq_numref(q.mpq()));
    mpz_set(m.backend().data(), mpq_denref(q.mpq()));
    f.push_back(n * (common / m));
  }
  while (!f.empty() && f.back() == 0) f.pop_back();
  return f;
}

DoubleRange range(const BallNumber& x) {
  const double spread = std::abs(x.lo) + x.radius;
  if (spread == 0) return {x.hi, x.hi};
  return {std::nextafter(x.hi - spread, -kInfinity),
          std::nextafter(x.hi + spread, kInfinity)};
}

// The middle rounds by half a unit in its last place.
BallNumber ball(const DoubleRange& x) {
  if (x.lo == x.hi) return {x.lo, 0, 0};
  const double middle = x.middle();
  const double radius = std::max(middle - x.lo, x.hi - middle);
  return {middle, 0, std::nextafter(radius, kInfinity)};
}

// As nearest_quotient(), with the error told.
std::optional<DoubleRange> range_of_quotient(const BallNumber& x, const BallNumber& y) {
  const double least = std::abs(y.hi) * (1 - 4 * kUnit) - y.radius * (1 + 4 * kUnit);
  if (!(least > 0)) return std::nullopt;
  const double q = x.hi / y.hi;
  const BallNumber r = x - BallNumber{q, 0, 0} * y;
  const double c = r.hi / y.hi;
  const double error = 2 * ((r.radius + std::abs(r.lo)) / least +
                            std::abs(c) * (8 * kUnit + 2 * y.radius / least));
  const auto [out, rest] = two_sum(q, c);
  const double spread = std::abs(rest) + error;
  if (spread == 0) return DoubleRange{out, out};
  return DoubleRange{std::nextafter(out - spread, -kInfinity),
                     std::nextafter(out + spread, kInfinity)};
}

BallNumber ball(const QuadraticRoot& x) {
  const double q = x.rounded();
  const Surd rest{x.a - Ring(q) * x.c, x.b};
  if (is_zero(rest, x.d)) return {q, 0, 0};
  const double low = quotient(rest, Surd{x.c, 0}, x.d);
  const auto [hi, lo] = two_sum(q, low);
  return {hi, lo, 2 * kQuotientError * std::abs(low) + 0x1p-1000};
}

DoubleRange range(const ExactParameter& x) {
  if (const auto* q = std::get_if<QuadraticRoot>(&x)) return range(ball(*q));
  PolynomialRoot r = std::get<PolynomialRoot>(x);
  for (;;) {
    const double lo = nearest_double(rational(r.lo)), hi = nearest_double(rational(r.hi));
    if (hi - lo <= 4 * kUnit * std::max(std::abs(lo), std::abs(hi))) {
      return {std::nextafter(lo, -kInfinity), std::nextafter(hi, kInfinity)};
    }
    const ExactParameter half = halved(r);
    if (std::holds_alternative<QuadraticRoot>(half)) return range(half);
    r = std::get<PolynomialRoot>(half);
  }
}

BallNumber precise_ball(const ExactParameter& x) {
  if (const auto* q = std::get_if<QuadraticRoot>(&x)) return ball(*q);
  PolynomialRoot r = std::get<PolynomialRoot>(x);
  constexpr int kHalvings = 40;
  for (int i = 0; i < kHalvings; ++i) {
    const ExactParameter half = halved(r);
    if (std::holds_alternative<QuadraticRoot>(half)) return precise_ball(half);
    r = std::get<PolynomialRoot>(half);
  }
  const Rational lo = rational(r.lo), width = rational(r.hi) - lo;
  const double hi = nearest_double(lo);
  const double low = nearest_double(lo - Rational(hi));
  const auto [sum, rest] = two_sum(hi, low);
  return {sum, rest, 4 * kUnit * std::abs(low) + 2 * nearest_double(width) + 0x1p-1000};
}

std::vector<BallNumber> balls(std::span<const Integer> values) {
  long top = std::numeric_limits<long>::min();
  for (const Integer& x : values) {
    if (x != 0)
      top = std::max(top, static_cast<long>(mpz_sizeinbase(x.backend().data(), 2)));
  }
  std::vector<BallNumber> out;
  for (const Integer& x : values) {
    BallNumber b;
    Integer rest = x;
    // Two pieces of 53 bits each, cut off towards zero.
    for (double* part : {&b.hi, &b.lo}) {
      if (rest == 0) break;
      long exponent = 0;
      const double mantissa = mpz_get_d_2exp(&exponent, rest.backend().data());
      const Integer digits = static_cast<std::int64_t>(std::ldexp(mantissa, 53));
      rest -= exponent >= 53 ? Integer(digits << (exponent - 53))
                             : Integer(digits >> (53 - exponent));
      *part = std::ldexp(mantissa, static_cast<int>(std::max(exponent - top, -2000L)));
    }
    const auto [hi, lo] = two_sum(b.hi, b.lo);
    const double cut_off = rest == 0 ? 0 : 4 * kUnit * std::abs(lo);
    // Below 2^-900 the parts may have been denormal.
    const bool tiny = x != 0 && std::abs(hi) < 0x1p-900;
    out.push_back({hi, lo, cut_off + (tiny ? 0x1p-900 : 0)});
  }
  return out;
}

}  // namespace sightline::internal
