// Roots of polynomials of low degree with enclosed coefficients, as far as doubles can
// prove them.

#pragma once

#include <array>
#include <optional>
#include <vector>

#include "shadows/planar/arcs/exact_parameter.h"

namespace sightline::internal {

inline constexpr int kMostDegree = 4;

/// Coefficients of s^0, ..., s^degree.
struct BallPolynomial {
  std::array<BallNumber, kMostDegree + 1> c{};
  int degree = 0;
};

/// f / (s - root), without the rest.
[[nodiscard]] BallPolynomial without_root(const BallPolynomial& f,
                                          const BallNumber& root);

/// Enclosures of all roots strictly between lo and hi, ascending and apart, each proved
/// to hold one root, a simple one.  nullopt where that cannot be proved, as for double
/// roots and for roots next to lo or hi.
/// By Bernstein's coefficients and bisection (Lane and Riesenfeld 1981).
[[nodiscard]] std::optional<std::vector<DoubleRange>> simple_roots(
    const BallPolynomial& f, double lo, double hi);

/// It has no stationary point in the range, for certain.
[[nodiscard]] bool monotone(const BallPolynomial& f, const DoubleRange& s);

[[nodiscard]] BallNumber value_at(const BallPolynomial& f, const BallNumber& s);

}  // namespace sightline::internal
