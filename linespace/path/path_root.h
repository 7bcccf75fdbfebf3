// Exact positions on a path's segment: roots of linear and quadratic polynomials.

#pragma once

#include <array>
#include <compare>
#include <optional>
#include <vector>

#include "linespace/numbers/rational.h"

namespace sightline::internal {

/// A rational number, or an irrational root p + sqrt(d) or p - sqrt(d).
class PathRoot {
 public:
  explicit PathRoot(const Rational& value) : PathRoot(value, 0, 0) {}
  /// p + sign sqrt(d).  Requires d >= 0.
  PathRoot(Rational p, Rational d, int sign);

  [[nodiscard]] bool is_rational() const { return sign_ == 0; }
  /// Requires is_rational().
  [[nodiscard]] const Rational& rational() const { return p_; }
  /// Within 2^-52 of itself, or of 1.
  [[nodiscard]] double rounded() const { return (low_ + high_) / 2; }
  /// Two numbers at most 2^-bits apart, between which it lies strictly; twice itself
  /// where it is rational.
  [[nodiscard]] std::array<Rational, 2> bounds(unsigned bits) const;

  friend std::strong_ordering operator<=>(const PathRoot& x, const PathRoot& y);
  friend bool operator==(const PathRoot& x, const PathRoot& y) {
    return (x <=> y) == std::strong_ordering::equal;
  }

 private:
  Rational p_, d_;
  int sign_;
  double low_, high_;  // it lies between them
};

/// The zero of at0 (1 - u) + at1 u in the open interval (0, 1); nullopt where there is
/// none, or where all is zero.
[[nodiscard]] std::optional<PathRoot> root_inside(const Rational& at0,
                                                  const Rational& at1);
/// All zeros of b0 (1 - u)^2 + 2 b1 u (1 - u) + b2 u^2 in (0, 1), ascending; none where
/// all is zero.
[[nodiscard]] std::vector<PathRoot> roots_inside(const std::array<Rational, 3>& b);

/// A rational number with a small denominator, strictly between two roots, x < y.
[[nodiscard]] Rational between(const PathRoot& x, const PathRoot& y);

}  // namespace sightline::internal
