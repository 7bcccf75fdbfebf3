// Numbers a + b sqrt(root) over the lazy rationals, for naive oracles: exact signs, and
// an exact order also between numbers of different roots.

#pragma once

#include <stdexcept>
#include <utility>

#include "tests/support/naive_solids_internal.h"

namespace sightline::testing {

/// root > 0 where there is one.  Arithmetic is between numbers of one root, and with
/// rationals.
struct Surd {
  Number a, b, root;
  bool rational = true;

  Surd() = default;
  explicit Surd(Number x) : a(std::move(x)) {}
  Surd(Number x, Number y, Number r)
      : a(std::move(x)), b(std::move(y)), root(std::move(r)), rational(false) {}

  friend Surd operator-(const Surd& x) {
    return x.rational ? Surd(-x.a) : Surd(-x.a, -x.b, x.root);
  }
  friend Surd operator+(const Surd& x, const Surd& y) {
    if (y.rational) return x.rational ? Surd(x.a + y.a) : Surd(x.a + y.a, x.b, x.root);
    if (x.rational) return {x.a + y.a, y.b, y.root};
    return {x.a + y.a, x.b + y.b, x.root};
  }
  friend Surd operator-(const Surd& x, const Surd& y) { return x + -y; }
  friend Surd operator*(const Surd& x, const Surd& y) {
    if (y.rational)
      return x.rational ? Surd(x.a * y.a) : Surd(x.a * y.a, x.b * y.a, x.root);
    if (x.rational) return {x.a * y.a, x.a * y.b, y.root};
    return {x.a * y.a + x.b * y.b * x.root, x.a * y.b + x.b * y.a, x.root};
  }
  friend Surd operator/(const Surd& x, const Surd& y) {
    if (y.rational) return x * Surd(1 / y.a);
    const Number norm = y.a * y.a - y.b * y.b * y.root;
    return x * Surd(y.a / norm, -y.b / norm, y.root);
  }
};

inline int sign_of(const Surd& x) {
  const int a = sign_of(x.a), b = x.rational ? 0 : sign_of(x.b);
  if (b == 0 || a == b) return a;
  if (a == 0) return b;
  return a * sign_of(x.a * x.a - x.b * x.b * x.root);  // |a| against |b| sqrt(root)
}

/// The sign of x - y.
inline int compare(const Surd& x, const Surd& y) {
  if (x.rational || y.rational) return sign_of(x - y);
  // u = (x.a - y.a) + x.b sqrt(x.root) against v = y.b sqrt(y.root)
  const Surd u(x.a - y.a, x.b, x.root);
  const int sign_u = sign_of(u), sign_v = sign_of(y.b);
  if (sign_u != sign_v) return sign_u < sign_v ? -1 : 1;
  return sign_u * sign_of(u * u - Surd(y.b * y.b * y.root));
}

}  // namespace sightline::testing
