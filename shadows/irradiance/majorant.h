// Upper bounds of a function's derivatives over a disc, and how sums, products and
// quotients of functions inherit them.

#pragma once

#include <algorithm>
#include <array>
#include <limits>

namespace sightline::internal {

/// a[j] is at least |D^j f| / j!, for all points of the disc |x| <= 1 and all directions
/// of length 1; of a vector the length counts.  Infinite where nothing is known.
///
/// Law: a product, of numbers or vectors (dot or cross), has the majorant x * y, by
/// Leibniz's rule.
struct Majorant {
  static constexpr int kTerms = 4;
  std::array<double, kTerms> a{};

  static constexpr double kUnknown = std::numeric_limits<double>::infinity();
  [[nodiscard]] static Majorant unknown() {
    return {{kUnknown, kUnknown, kUnknown, kUnknown}};
  }
};

[[nodiscard]] inline Majorant operator+(const Majorant& x, const Majorant& y) {
  Majorant sum;
  for (int j = 0; j < Majorant::kTerms; ++j) sum.a[j] = x.a[j] + y.a[j];
  return sum;
}

[[nodiscard]] inline Majorant operator*(const Majorant& x, const Majorant& y) {
  Majorant product;
  for (int i = 0; i < Majorant::kTerms; ++i) {
    for (int j = 0; i + j < Majorant::kTerms; ++j) product.a[i + j] += x.a[i] * y.a[j];
  }
  return product;
}

[[nodiscard]] inline Majorant operator*(double factor, const Majorant& x) {
  Majorant scaled = x;
  for (double& a : scaled.a) a *= factor;
  return scaled;
}

/// Of the larger of the two in each term.
[[nodiscard]] inline Majorant larger(const Majorant& x, const Majorant& y) {
  Majorant most;
  for (int j = 0; j < Majorant::kTerms; ++j) most.a[j] = std::max(x.a[j], y.a[j]);
  return most;
}

/// Of 1 / f, for a function whose magnitude is nowhere below `least` > 0: the derivatives
/// of f (1 / f) = 1 are 0.
[[nodiscard]] inline Majorant reciprocal(const Majorant& f, double least) {
  Majorant quotient;
  quotient.a[0] = 1 / least;
  for (int j = 1; j < Majorant::kTerms; ++j) {
    double sum = 0;
    for (int i = 1; i <= j; ++i) sum += f.a[i] * quotient.a[j - i];
    quotient.a[j] = sum / least;
  }
  return quotient;
}

}  // namespace sightline::internal
