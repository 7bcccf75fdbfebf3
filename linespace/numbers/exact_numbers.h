// Two number types for the later stages of predicates: FixedInt, integers of a width
// known at compile time, and BallNumber, a double-double value with a rigorous radius.
//
// A polynomial written once over its number type (a template with `auto` for what it
// computes) runs on double, BallNumber and FixedInt alike.  Neither type allocates.

#pragma once

#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "linespace/predicates.h"

namespace sightline::internal {

// ---- FixedInt -------------------------------------------------------------------------

/// A signed integer of 64 N bits (two's complement, least limb first).  Sums stay in that
/// width; a product of N and M limbs has N + M, so products never overflow.
template <int N>
struct FixedInt {
  std::array<std::uint64_t, N> limbs{};

  [[nodiscard]] bool negative() const { return limbs[N - 1] >> 63 != 0; }
};

__extension__ typedef unsigned __int128 Uint128;
__extension__ typedef __int128 Int128;

template <int N>
[[nodiscard]] FixedInt<N> operator+(const FixedInt<N>& a, const FixedInt<N>& b) {
  FixedInt<N> sum;
  bool carry = false;
  for (int i = 0; i < N; ++i) {
    const Uint128 s = Uint128(a.limbs[i]) + b.limbs[i] + carry;
    sum.limbs[i] = static_cast<std::uint64_t>(s);
    carry = static_cast<bool>(s >> 64);
  }
  return sum;
}

template <int N>
[[nodiscard]] FixedInt<N> operator-(const FixedInt<N>& a, const FixedInt<N>& b) {
  FixedInt<N> difference;
  bool borrow = false;
  for (int i = 0; i < N; ++i) {
    const Uint128 d = Uint128(a.limbs[i]) - b.limbs[i] - borrow;
    difference.limbs[i] = static_cast<std::uint64_t>(d);
    borrow = static_cast<bool>((d >> 64) & 1);
  }
  return difference;
}

// One to three limbs, the narrow case of every predicate, in the machine's own 128 bits.
[[nodiscard]] inline Int128 as_int128(std::uint64_t low_limb, std::uint64_t high_limb) {
  return static_cast<Int128>(Uint128(high_limb) << 64 | low_limb);
}
[[nodiscard]] inline FixedInt<2> operator*(const FixedInt<1>& a, const FixedInt<1>& b) {
  const Int128 p = Int128(static_cast<std::int64_t>(a.limbs[0])) *
                   static_cast<std::int64_t>(b.limbs[0]);
  return {{static_cast<std::uint64_t>(p), static_cast<std::uint64_t>(p >> 64)}};
}
[[nodiscard]] inline FixedInt<2> operator-(const FixedInt<2>& a, const FixedInt<2>& b) {
  const auto d = Uint128(as_int128(a.limbs[0], a.limbs[1])) -
                 Uint128(as_int128(b.limbs[0], b.limbs[1]));
  return {{static_cast<std::uint64_t>(d), static_cast<std::uint64_t>(d >> 64)}};
}
[[nodiscard]] inline FixedInt<3> operator*(const FixedInt<1>& a, const FixedInt<2>& b) {
  const auto x = static_cast<std::int64_t>(a.limbs[0]);
  const Int128 p0 = Int128(x) * Int128(b.limbs[0]);
  const Int128 p1 = Int128(x) * static_cast<std::int64_t>(b.limbs[1]);
  const auto upper = static_cast<Uint128>((p0 >> 64) + p1);
  return {{static_cast<std::uint64_t>(p0), static_cast<std::uint64_t>(upper),
           static_cast<std::uint64_t>(upper >> 64)}};
}
[[nodiscard]] inline FixedInt<3> operator+(const FixedInt<3>& a, const FixedInt<3>& b) {
  std::uint64_t lowest;
  const bool carry = __builtin_add_overflow(a.limbs[0], b.limbs[0], &lowest);
  const Uint128 upper = Uint128(as_int128(a.limbs[1], a.limbs[2])) +
                        Uint128(as_int128(b.limbs[1], b.limbs[2])) + carry;
  return {{lowest, static_cast<std::uint64_t>(upper),
           static_cast<std::uint64_t>(upper >> 64)}};
}

// Read as unsigned, a negative operand of N limbs is too large by 2^(64 N): the
// schoolbook product is corrected by the other operand, N limbs up.
template <int N, int M>
[[nodiscard]] FixedInt<N + M> operator*(const FixedInt<N>& a, const FixedInt<M>& b) {
  FixedInt<N + M> product;
  for (int i = 0; i < N; ++i) {
    std::uint64_t carry = 0;
    for (int j = 0; j < M; ++j) {
      const Uint128 t = Uint128(a.limbs[i]) * b.limbs[j] + product.limbs[i + j] + carry;
      product.limbs[i + j] = static_cast<std::uint64_t>(t);
      carry = static_cast<std::uint64_t>(t >> 64);
    }
    product.limbs[i + M] = carry;
  }
  const auto subtract_high = [&product](const auto& x, int from, bool wanted) {
    const std::uint64_t mask = wanted ? ~std::uint64_t{0} : 0;
    bool borrow = false;
    for (int i = from; i < N + M; ++i) {
      const Uint128 d = Uint128(product.limbs[i]) - (x.limbs[i - from] & mask) - borrow;
      product.limbs[i] = static_cast<std::uint64_t>(d);
      borrow = static_cast<bool>((d >> 64) & 1);
    }
  };
  subtract_high(b, N, a.negative());
  subtract_high(a, M, b.negative());
  return product;
}

template <int N>
[[nodiscard]] Sign sign_of(const FixedInt<N>& x) {
  if (x.negative()) return Sign::Negative;
  std::uint64_t any = 0;
  for (const std::uint64_t limb : x.limbs) any |= limb;
  return any != 0 ? Sign::Positive : Sign::Zero;
}

/// One coordinate of every point, times a common power of two that makes all of them
/// integers below 2^(64 N - 3) in magnitude; false when no power does.  The three bits of
/// room are for a difference (1) and for the sums of a determinant (2).  Requires
/// admissible values; six limbs hold any of these: 140 + 192 + 1 bits < 64 * 6 - 3.
template <int N, std::size_t Count>
[[nodiscard]] bool to_integers(const std::array<double, Count>& values,
                               std::array<FixedInt<N>, Count>& integers) {
  constexpr int kBits = 64 * N - 3;
  double largest = 0;
  for (const double x : values) largest = std::max(largest, std::abs(x));
  if (largest == 0) {
    integers = {};
    return true;
  }
  const auto biased_exponent = [](double x) {
    return static_cast<int>(std::bit_cast<std::uint64_t>(x) >> 52) & 0x7ff;
  };
  // largest < 2^(top + 1)
  const int top = biased_exponent(largest) - 1023;
  if constexpr (N == 1) {
    const double scale =
        std::bit_cast<double>(static_cast<std::uint64_t>(1023 + kBits - 1 - top) << 52);
    bool fits = true;
    for (std::size_t i = 0; i < Count; ++i) {
      const double x = values[i] * scale;  // a power of two: exact
      const auto k = static_cast<std::int64_t>(x);
      fits &= static_cast<double>(k) == x;
      integers[i].limbs[0] = static_cast<std::uint64_t>(k);
    }
    return fits;
  } else {
    // Value i is mantissa * 2^exponent; the unit of all integers is 2^unit.
    const int unit = top + 1 - kBits;
    for (std::size_t i = 0; i < Count; ++i) {
      integers[i] = {};
      if (values[i] == 0) continue;
      const auto bits = std::bit_cast<std::uint64_t>(values[i]);
      std::uint64_t mantissa = (bits & ((std::uint64_t{1} << 52) - 1)) | std::uint64_t{1}
                                                                             << 52;
      int shift = biased_exponent(values[i]) - 1075 - unit;
      if (shift < 0) {
        if (std::countr_zero(mantissa) < -shift) return false;
        mantissa >>= -shift;
        shift = 0;
      }
      FixedInt<N> magnitude;
      const int limb = shift / 64;
      const int offset = shift % 64;
      magnitude.limbs[limb] = mantissa << offset;
      if (offset > 11) magnitude.limbs[limb + 1] = mantissa >> (64 - offset);
      integers[i] = values[i] < 0 ? FixedInt<N>{} - magnitude : magnitude;
    }
    return true;
  }
}

// ---- BallNumber
// -----------------------------------------------------------------------------

/// The real interval of that radius around hi + lo, |lo| <= e |hi| with e = 2^-53.
/// Each operation adds to the radius what its own roundings can amount to; radii
/// themselves are computed with a few roundings and enlarged to cover these.
/// Requires round-to-nearest and no contraction; magnitudes below 2^960.
struct BallNumber {
  double hi = 0;
  double lo = 0;
  double radius = 0;
};

// s + t == a + b exactly (Knuth).
struct DoublePair {
  double s, t;
};
[[nodiscard]] inline DoublePair two_sum(double a, double b) {
  const double s = a + b;
  const double b_part = s - a;
  const double a_part = s - b_part;
  return {s, (a - a_part) + (b - b_part)};
}

// s + t == a * b exactly, but for underflow (Dekker, with Veltkamp's splitting).
[[nodiscard]] inline DoublePair two_product(double a, double b) {
  const double p = a * b;
#ifdef __FMA__
  return {p, std::fma(a, b, -p)};
#else
  constexpr double kSplit = 0x1p27 + 1;
  const double a_big = kSplit * a;
  const double a_hi = a_big - (a_big - a);
  const double a_lo = a - a_hi;
  const double b_big = kSplit * b;
  const double b_hi = b_big - (b_big - b);
  const double b_lo = b - b_hi;
  return {p, a_lo * b_lo - (((p - a_hi * b_hi) - a_lo * b_hi) - a_hi * b_lo)};
#endif
}

// Radii are sums of at most a dozen nonnegative terms with at most 8 roundings each.
inline constexpr double kRadiusSlack = 1 + 16 * kUnit;

[[nodiscard]] inline BallNumber exact_difference(double p, double q) {
  const auto [s, t] = two_sum(p, -q);
  return {s, t, 0};
}

// Inexact are t and low, each off by at most e times itself.
[[nodiscard]] inline BallNumber operator+(const BallNumber& a, const BallNumber& b) {
  const auto [s, rest] = two_sum(a.hi, b.hi);
  const double t = a.lo + b.lo;
  const double low = rest + t;
  const auto [hi, lo] = two_sum(s, low);
  const double rounding = kUnit * (std::abs(t) + std::abs(low));
  return {hi, lo, (a.radius + b.radius + rounding) * kRadiusSlack};
}

[[nodiscard]] inline BallNumber operator-(const BallNumber& a) {
  return {-a.hi, -a.lo, a.radius};
}
[[nodiscard]] inline BallNumber operator-(const BallNumber& a, const BallNumber& b) {
  return a + -b;
}

// (a.hi + a.lo) (b.hi + b.lo): the first product is exact, a.lo b.lo is left out, and
// four operations round.  Products below 2^-900 may also underflow, which costs at most
// 2^-1074 for each of under twenty operations (2^-1000, still a normal number, covers
// all).
[[nodiscard]] inline BallNumber operator*(const BallNumber& a, const BallNumber& b) {
  const auto [p, rest] = two_product(a.hi, b.hi);
  const double ab = a.hi * b.lo;
  const double ba = a.lo * b.hi;
  const double t = ab + ba;
  const double low = rest + t;
  const auto [hi, lo] = two_sum(p, low);
  const double left_out = std::abs(a.lo * b.lo);
  const double rounding =
      kUnit * ((std::abs(ab) + std::abs(ba)) + (std::abs(t) + std::abs(low)));
  const double inherited = (std::abs(a.hi) + std::abs(a.lo)) * b.radius +
                           a.radius * (std::abs(b.hi) + std::abs(b.lo) + b.radius);
  return {hi, lo, (inherited + (left_out + rounding) + 0x1p-1000) * kRadiusSlack};
}

/// nullopt when the interval contains 0.
[[nodiscard]] inline std::optional<Sign> sign_of(const BallNumber& x) {
  // |hi + lo| >= |hi| (1 - e), and the right side rounds by less than 2 e.
  if (std::abs(x.hi) > x.radius * (1 + 4 * kUnit)) return sign_of(x.hi);
  return std::nullopt;
}

/// The double nearest to x / y; nullopt where the bounds leave a choice, or y may be 0.
/// Requires a quotient that is neither denormal nor infinite.
[[nodiscard]] inline std::optional<double> nearest_quotient(const BallNumber& x,
                                                            const BallNumber& y) {
  if (!sign_of(y)) return std::nullopt;
  // x / y = q + r / y, where r is the remainder of a first quotient q.
  const double q = x.hi / y.hi;
  const BallNumber r = x - BallNumber{q, 0, 0} * y;
  const double c = r.hi / y.hi;
  const double out = q + c;
  // What r / y is off by: its own radius and low part, and of r.hi / y.hi the share by
  // which y.hi is not y (less than 2^-50), doubled for roundings.
  const double least_y = std::abs(y.hi) * (1 - 4 * kUnit) - y.radius;
  if (!(least_y > 0)) return std::nullopt;
  const double error = 2 * ((r.radius + std::abs(r.lo)) / least_y +
                            std::abs(c) * (8 * kUnit + 2 * y.radius / least_y));
  // The rest of the sum q + c must stay nearer to `out` than half way to a neighbour,
  // which lies a unit in the last place away; below a power of two, half of that.
  const auto bits = std::bit_cast<std::uint64_t>(out);
  const double power = std::bit_cast<double>(bits & 0x7FF0'0000'0000'0000U);
  const bool is_power = (bits & 0x000F'FFFF'FFFF'FFFFU) == 0;
  const double half_way = power * kUnit * (is_power ? 0.5 : 1);
  const double rest = two_sum(q, c).t;
  if (!(std::abs(rest) + error < half_way)) return std::nullopt;
  return out;
}

}  // namespace sightline::internal
