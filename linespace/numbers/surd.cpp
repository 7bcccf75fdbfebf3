#include "linespace/numbers/surd.h"

#include <CGAL/Gmpq.h>
#include <gmp.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace sightline::internal {
namespace {

// mantissa * 2^exponent, |mantissa| in [1/2, 1) or 0: a double without limits.
struct Scaled {
  double mantissa = 0;
  long exponent = 0;
};

Scaled normal(double x, long exponent) {
  int e = 0;
  const double m = std::frexp(x, &e);
  return m == 0 ? Scaled{} : Scaled{m, exponent + e};
}

// Truncated to 53 bits by mpz_get_d_2exp: off by at most 2^-52 of itself.
Scaled scaled(const Ring& x) {
  const double direct = CGAL::to_double(x);
  if (std::abs(direct) > 0x1p-900 && std::abs(direct) < 0x1p900) return normal(direct, 0);
  if (is_zero(x)) return {};
  const CGAL::Gmpq q(x);
  long up = 0;
  long down = 0;
  const double n = mpz_get_d_2exp(&up, mpq_numref(q.mpq()));
  const double m = mpz_get_d_2exp(&down, mpq_denref(q.mpq()));
  return normal(n / m, up - down);
}

Scaled times(const Scaled& x, const Scaled& y) {
  return normal(x.mantissa * y.mantissa, x.exponent + y.exponent);
}
Scaled over(const Scaled& x, const Scaled& y) {
  return normal(x.mantissa / y.mantissa, x.exponent - y.exponent);
}
Scaled plus(const Scaled& x, const Scaled& y) {
  if (x.mantissa == 0) return y;
  if (y.mantissa == 0) return x;
  const long top = std::max(x.exponent, y.exponent);
  const auto part = [top](const Scaled& z) {
    return std::ldexp(z.mantissa, static_cast<int>(std::max(z.exponent - top, -2000L)));
  };
  return normal(part(x) + part(y), top);
}
// Off by e and by half of what x is off.
Scaled root(const Scaled& x) {
  const bool odd = x.exponent % 2 != 0;
  return normal(std::sqrt(odd ? x.mantissa * 2 : x.mantissa),
                (odd ? x.exponent - 1 : x.exponent) / 2);
}

double to_double(const Scaled& x) {
  const long e = std::clamp(x.exponent, -4000L, 4000L);
  return std::ldexp(x.mantissa, static_cast<int>(e));
}

// a + b sqrt(D) without cancellation: where a and b sqrt(D) have opposite signs, as
// (a^2 - b^2 D) / (a - b sqrt(D)).  In units of e = 2^-53: a ring's value is off by 2 (it
// is truncated), sqrt(D) by 2, b sqrt(D) by 5, the sum by 6, the quotient by 9.
Scaled scaled(const Surd& x, const Ring& d) {
  if (is_zero(x.b)) return scaled(x.a);
  const Scaled a = scaled(x.a);
  Scaled br = times(scaled(x.b), root(scaled(d)));
  if (sign_of(x.a) * sign_of(x.b) != Sign::Negative) return plus(a, br);
  br.mantissa = -br.mantissa;
  return over(scaled(Ring(x.a * x.a - x.b * x.b * d)), plus(a, br));
}

}  // namespace

Rational rational(const Ring& x) {
  Rational out;
  if (!is_zero(x)) mpq_set(out.backend().data(), CGAL::Gmpq(x).mpq());
  return out;
}

Sign sign_of(const Surd& x, const Ring& d) {
  const Sign a = sign_of(x.a);
  const Sign b = is_zero(d) ? Sign::Zero : sign_of(x.b);
  if (b == Sign::Zero || a == b) return a;
  if (a == Sign::Zero) return b;
  return a * sign_of(Ring(x.a * x.a - x.b * x.b * d));
}

Sign sign_of_sum(const Surd& x, const Surd& y, const Ring& d, const Ring& e) {
  const Sign s = sign_of(x, d);
  const Sign t = is_zero(e) ? Sign::Zero : sign_of(y, d);
  if (t == Sign::Zero || s == t) return s;
  if (s == Sign::Zero) return t;
  return s * sign_of(product(x, x, d) - product(y, y, d) * e, d);
}

std::optional<Ring> rational_root(const Ring& d) {
  if (is_zero(d)) return Ring(0);
  const CGAL::Gmpq q(d);
  const auto* up = mpq_numref(q.mpq());
  const auto* down = mpq_denref(q.mpq());
  if (mpz_perfect_square_p(up) == 0 || mpz_perfect_square_p(down) == 0) {
    return std::nullopt;
  }
  CGAL::Gmpz r;
  mpz_sqrt(r.mpz(), up);
  Ring out(r);
  // The denominator is a power of four.
  for (long k = static_cast<long>(mpz_sizeinbase(down, 2) - 1) / 2; k > 0; k -= 500) {
    out = out * Ring(std::ldexp(1.0, -static_cast<int>(std::min(k, 500L))));
  }
  return out;
}

// Each of the two is off by at most 9 e, their quotient by 20 e < 2^-48.
double quotient(const Surd& x, const Surd& y, const Ring& d) {
  return to_double(over(scaled(x, d), scaled(y, d)));
}

template <std::size_t N>
std::array<double, N> scaled(const std::array<Surd, N>& values, const Ring& d) {
  std::array<Scaled, N> all;
  long top = std::numeric_limits<long>::min();
  for (std::size_t i = 0; i < N; ++i) {
    all[i] = scaled(values[i], d);
    if (all[i].mantissa != 0) top = std::max(top, all[i].exponent);
  }
  std::array<double, N> out{};
  for (std::size_t i = 0; i < N; ++i) {
    all[i].exponent -= top;
    if (all[i].exponent > -1000) out[i] = to_double(all[i]);
  }
  return out;
}
template std::array<double, 3> scaled(const std::array<Surd, 3>&, const Ring&);
template std::array<double, 6> scaled(const std::array<Surd, 6>&, const Ring&);
template std::array<double, 12> scaled(const std::array<Surd, 12>&, const Ring&);

}  // namespace sightline::internal
