#include "shadows/planar/arcs/ball_roots.h"

#include <cmath>

namespace sightline::internal {
namespace {

using Coefficients = std::array<BallNumber, kMostDegree + 1>;

BallNumber exactly(double x) { return {x, 0, 0}; }
BallNumber half(const BallNumber& x) { return {0.5 * x.hi, 0.5 * x.lo, 0.5 * x.radius}; }

// f(lo + width tau) in powers of tau.
BallPolynomial rescaled(const BallPolynomial& f, double lo, double hi) {
  BallPolynomial c = f;
  if (lo != 0) {
    for (int j = 0; j < c.degree; ++j) {
      for (int l = c.degree - 1; l >= j; --l) c.c[l] = c.c[l] + exactly(lo) * c.c[l + 1];
    }
  }
  const BallNumber width = exact_difference(hi, lo);
  BallNumber power = width;
  for (int k = 1; k <= c.degree; ++k) {
    c.c[k] = c.c[k] * power;
    if (k < c.degree) power = power * width;
  }
  return c;
}

// Times 12, so that all weights are integers.
Coefficients bernstein(const BallPolynomial& f) {
  constexpr int kBinomial[5][5] = {{1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}, {1, 4, 6, 4, 1}};
  const int n = f.degree;
  Coefficients b{};
  for (int i = 0; i <= n; ++i) {
    const BallNumber c = exactly(12.0 / kBinomial[n][i]) * f.c[i];
    for (int j = i; j <= n; ++j) b[j] = b[j] + exactly(kBinomial[j][i]) * c;
  }
  return b;
}

struct Variations {
  bool ends_certain;
  int least, most;
};

// 1, -1, or 0: not certain.
int certain_sign(const BallNumber& x) {
  const std::optional<Sign> sign = sign_of(x);
  return sign ? static_cast<int>(*sign) : 0;
}

// Sign changes, for any choice of signs that are not certain.
Variations variations(const Coefficients& b, int n) {
  constexpr int kNever = 100;
  const int first = certain_sign(b[0]), last = certain_sign(b[n]);
  if (first == 0 || last == 0) return {false, 0, kNever};
  // Least and most changes so far if the last coefficient is negative, or positive.
  std::array<int, 2> least{kNever, kNever}, most{-kNever, -kNever};
  least[first > 0] = most[first > 0] = 0;
  for (int i = 1; i <= n; ++i) {
    const int sign = certain_sign(b[i]);
    const std::array<int, 2> l = least, m = most;
    for (const int s : {0, 1}) {
      const bool possible = sign == 0 || (sign > 0) == (s == 1);
      least[s] = possible ? std::min(l[s], l[1 - s] + 1) : kNever;
      most[s] = possible ? std::max(m[s], m[1 - s] + 1) : -kNever;
    }
  }
  return {true, least[last > 0], most[last > 0]};
}

class Isolation {
 public:
  Isolation(const BallPolynomial& f, double lo, double hi)
      : f_(rescaled(f, lo, hi)), lo_(lo), width_(exact_difference(hi, lo)) {}

  std::optional<std::vector<DoubleRange>> run() {
    if (!divide(bernstein(f_), 0, 1, 0)) return std::nullopt;
    for (std::size_t i = 1; i < found_.size(); ++i) {
      if (!(found_[i - 1].hi < found_[i].lo)) return std::nullopt;
    }
    return std::move(found_);
  }

 private:
  bool divide(const Coefficients& b, double from, double to, int depth) {
    constexpr int kMostDepth = 30;
    const int n = f_.degree;
    const Variations v = variations(b, n);
    if (!v.ends_certain) return false;
    if (v.most == 0) return true;
    if (v.least == 1 && v.most == 1) return refine(sign_of(b[0].hi), from, to);
    if (depth == kMostDepth) return false;
    Coefficients left{}, right = b;
    for (int k = 0; k <= n; ++k) {
      left[k] = right[0];
      for (int i = 0; i < n - k; ++i) right[i] = half(right[i] + right[i + 1]);
    }
    // The triangle's last diagonal, in the order in which it is left behind.
    const double middle = 0.5 * (from + to);
    return divide(left, from, middle, depth + 1) && divide(right, middle, to, depth + 1);
  }

  // Encloses the one root between two ends at which the signs are certain.
  bool refine(Sign at_from, double from, double to) {
    double lo = from, hi = to, x = 0.5 * (from + to);
    for (int step = 0; step < 60 && hi - lo > 0x1p-54; ++step) {
      double value = f_.c[f_.degree].hi, slope = 0;
      for (int k = f_.degree - 1; k >= 0; --k) {
        slope = slope * x + value;
        value = value * x + f_.c[k].hi;
      }
      (sign_of(value) == at_from ? lo : hi) = x;
      const double newton = x - value / slope;
      const double last = x;
      x = newton > lo && newton < hi ? newton : 0.5 * (lo + hi);
      if (std::abs(x - last) < 0x1p-54) break;
    }
    for (double spread = 0x1p-52; spread < 0x1p-16; spread *= 8) {
      const double below = std::max(from, x - spread), above = std::min(to, x + spread);
      const bool below_certain = below == from || sign_at(below) == at_from;
      const bool above_certain = above == to || sign_at(above) == -at_from;
      if (!below_certain || !above_certain) continue;
      const double least = range(exactly(lo_) + width_ * exactly(below)).lo;
      const double most = range(exactly(lo_) + width_ * exactly(above)).hi;
      found_.push_back({least, most});
      return true;
    }
    return false;
  }

  [[nodiscard]] std::optional<Sign> sign_at(double tau) const {
    return sign_of(value_at(f_, exactly(tau)));
  }

  BallPolynomial f_;
  double lo_;
  BallNumber width_;
  std::vector<DoubleRange> found_;
};

}  // namespace

BallPolynomial without_root(const BallPolynomial& f, const BallNumber& root) {
  BallPolynomial g;
  g.degree = f.degree - 1;
  g.c[g.degree] = f.c[f.degree];
  for (int k = g.degree; k > 0; --k) g.c[k - 1] = f.c[k] + root * g.c[k];
  return g;
}

std::optional<std::vector<DoubleRange>> simple_roots(const BallPolynomial& f, double lo,
                                                     double hi) {
  return Isolation(f, lo, hi).run();
}

bool monotone(const BallPolynomial& f, const DoubleRange& s) {
  BallPolynomial slope;
  slope.degree = f.degree - 1;
  for (int k = 1; k <= f.degree; ++k) slope.c[k - 1] = exactly(k) * f.c[k];
  const std::optional<Sign> sign = sign_of(value_at(slope, ball(s)));
  return sign && *sign != Sign::Zero;
}

BallNumber value_at(const BallPolynomial& f, const BallNumber& s) {
  BallNumber value = f.c[f.degree];
  for (int k = f.degree - 1; k >= 0; --k) value = f.c[k] + value * s;
  return value;
}

}  // namespace sightline::internal
