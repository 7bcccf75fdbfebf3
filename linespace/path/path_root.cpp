#include "linespace/path/path_root.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sightline::internal {
namespace {

using Integer = boost::multiprecision::number<boost::multiprecision::gmp_int,
                                              boost::multiprecision::et_off>;

// The square root of x >= 0 where it is rational.
std::optional<Rational> rational_root(const Rational& x) {
  const Integer n = numerator(x), m = denominator(x);
  const Integer a = sqrt(n), b = sqrt(m);
  if (a * a != n || b * b != m) return std::nullopt;
  return Rational(a) / Rational(b);
}

std::strong_ordering ordering(int sign) { return sign <=> 0; }

}  // namespace

PathRoot::PathRoot(Rational p, Rational d, int sign)
    : p_(std::move(p)), d_(std::move(d)), sign_(d_ == 0 ? 0 : sign) {
  if (sign_ != 0) {
    if (const auto root = rational_root(d_)) {
      p_ += sign_ * *root;
      d_ = 0;
      sign_ = 0;
    }
  }
  constexpr unsigned kBits = 64;
  const auto [low, high] = bounds(kBits);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  low_ = std::nextafter(nearest_double(low), -kInfinity);
  high_ = std::nextafter(nearest_double(high), kInfinity);
}

std::array<Rational, 2> PathRoot::bounds(unsigned bits) const {
  if (sign_ == 0) return {p_, p_};
  // sqrt(n / m) = sqrt(n m) / m.
  const Integer n = numerator(d_), m = denominator(d_);
  const Integer floor = sqrt(Integer((n * m) << (2 * bits)));
  const Rational below = Rational(floor) / Rational(Integer(m << bits));
  const Rational above = Rational(Integer(floor + 1)) / Rational(Integer(m << bits));
  if (sign_ > 0) return {p_ + below, p_ + above};
  return {p_ - above, p_ - below};
}

std::strong_ordering operator<=>(const PathRoot& x, const PathRoot& y) {
  if (x.high_ < y.low_) return std::strong_ordering::less;
  if (y.high_ < x.low_) return std::strong_ordering::greater;
  if (x.sign_ == 0 && y.sign_ == 0) return ordering(x.p_.compare(y.p_));
  // Irrational roots of two quadratics are equal only if they are the same expression.
  if (x.sign_ == y.sign_ && x.p_ == y.p_ && x.d_ == y.d_)
    return std::strong_ordering::equal;
  for (unsigned bits = 128;; bits *= 2) {
    const auto a = x.bounds(bits), b = y.bounds(bits);
    if (a[1] <= b[0]) return std::strong_ordering::less;
    if (b[1] <= a[0]) return std::strong_ordering::greater;
  }
}

std::optional<PathRoot> root_inside(const Rational& at0, const Rational& at1) {
  if (at0.sign() * at1.sign() >= 0) return std::nullopt;
  return PathRoot(at0 / (at0 - at1));
}

std::vector<PathRoot> roots_inside(const std::array<Rational, 3>& b) {
  // a u^2 + 2 h u + c.
  const Rational a = b[0] - 2 * b[1] + b[2];
  const Rational h = b[1] - b[0];
  const Rational& c = b[0];
  std::vector<PathRoot> found;
  if (a == 0) {
    if (h != 0) found.emplace_back(Rational(-c / (2 * h)));
  } else {
    const Rational p = -h / a;
    const Rational d = p * p - c / a;
    if (d < 0) return found;
    found.emplace_back(p, d, -1);
    if (d != 0) found.emplace_back(p, d, 1);
  }
  const PathRoot zero(0), one(1);
  std::erase_if(found, [&](const PathRoot& r) { return r <= zero || r >= one; });
  return found;
}

Rational between(const PathRoot& x, const PathRoot& y) {
  Rational low, high;
  unsigned bits = 32;
  do {
    low = x.bounds(bits)[1];
    high = y.bounds(bits)[0];
    bits *= 2;
  } while (low >= high);
  // The multiple of a power of two that is nearest to the middle.
  const Rational middle = (low + high) / 2;
  Rational power = 1;
  while (true) {
    const Rational scaled = middle * power + Rational(1, 2);
    Integer whole = numerator(scaled) / denominator(scaled);  // both positive
    const Rational candidate = Rational(whole) / power;
    if (low < candidate && candidate < high) return candidate;
    power *= 2;
  }
}

}  // namespace sightline::internal
