#include "linespace/between/cover_cell.h"

#include <algorithm>
#include <cmath>

#include "linespace/numbers/exact_numbers.h"

namespace sightline::internal {
namespace {

std::int8_t certain_constant(const CornerValues& at) {
  const bool up = at.certainly(1), down = at.certainly(-1);
  return static_cast<std::int8_t>(up && down ? 2 : up ? 1 : down ? -1 : 0);
}

CornerValues halved(const CornerValues& at, const Halving& cut) {
  CornerValues out = at;
  for (int i = 0; i < 3; ++i) {
    const int m = cut.from ? 3 * cut.moved + i : 3 * i + cut.moved;
    const int o = cut.from ? 3 * cut.other + i : 3 * i + cut.other;
    const auto [sum, rest] = two_sum(at.value[m], at.value[o]);
    out.value[m] = sum / 2;
    double error = (at.error[m] + at.error[o]) / 2;
    if (error != 0 || rest != 0) error = (error + std::abs(rest) / 2) * (1 + 4 * kUnit);
    out.error[m] = error;
  }
  return out;
}

}  // namespace

double value_at(const CornerValues& at, const Weights& alpha, const Weights& beta) {
  double sum = 0;
  for (int j = 0; j < 3; ++j) {
    sum += alpha[j] * (at.value[3 * j] * beta[0] + at.value[3 * j + 1] * beta[1] +
                       at.value[3 * j + 2] * beta[2]);
  }
  return sum;
}

double normalising(const CornerValues& at) {
  double largest = 0;
  for (const double v : at.value) largest = std::max(largest, std::abs(v));
  if (largest == 0) return 1;
  int exponent;
  std::frexp(largest, &exponent);
  return std::ldexp(1.0, -exponent);
}

Weights mixed(const std::array<Weights, 3>& corners, const Weights& local) {
  Weights whole{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) whole[i] += local[j] * corners[j][i];
  }
  return whole;
}

std::optional<Weights> exact_weights(Weights w) {
  constexpr double kScale = 0x1p52;
  w[0] = std::nearbyint(w[0] * kScale) / kScale;
  w[1] = std::nearbyint(w[1] * kScale) / kScale;
  w[2] = (1 - w[0]) - w[1];
  if (w[0] <= 0 || w[1] <= 0 || w[2] <= 0) return std::nullopt;
  return w;
}

Domain& Domains::push() {
  if (used_ == domains_.size()) domains_.push_back(std::make_unique<Domain>());
  Domain& d = *domains_[used_++];
  d.slots.assign(space_.forms().size(), -1);
  d.live.clear();
  return d;
}

Domain& Domains::push_whole() {
  Domain& d = push();
  d.from = d.to = {Weights{1, 0, 0}, Weights{0, 1, 0}, Weights{0, 0, 1}};
  return d;
}

Domain& Domains::push_half(Domain& whole, const Halving& cut) {
  Domain& d = push();
  d.whole = &whole;
  d.cut = cut;
  d.from = whole.from;
  d.to = whole.to;
  d.halvings_from = whole.halvings_from + (cut.from ? 1 : 0);
  d.halvings_to = whole.halvings_to + (cut.from ? 0 : 1);
  auto& corners = cut.from ? d.from : d.to;
  for (int i = 0; i < 3; ++i) {
    corners[cut.moved][i] = (corners[cut.moved][i] + corners[cut.other][i]) / 2;
  }
  return d;
}

const Domain::Live& Domains::live(Domain& d, int form) const {
  if (d.slots.size() <= static_cast<std::size_t>(form)) {
    d.slots.resize(space_.forms().size(), -1);
  }
  if (d.slots[form] < 0) {
    Domain::Live made;
    if (d.whole == nullptr) {
      made.at = space_.forms()[form].at;
      made.constant = certain_constant(made.at);
    } else {
      made = live(*d.whole, form);
      if (made.constant == 0) {
        made.at = halved(made.at, d.cut);
        made.constant = certain_constant(made.at);
      }
    }
    d.slots[form] = static_cast<int>(d.live.size());
    d.live.push_back(made);
  }
  return d.live[d.slots[form]];
}

const std::array<Rational, 9>& Domains::exact_values(int form) {
  auto [entry, is_new] = exact_.try_emplace(form);
  if (is_new) entry->second = space_.exact(form);
  return entry->second;
}

std::array<Rational, 9> Domains::exact_values(Domain& d, int form) {
  const std::array<Rational, 9>& whole = exact_values(form);
  if (d.halvings() == 0) return whole;
  std::array<Rational, 9> half, out;
  for (int j = 0; j < 3; ++j) {
    for (int v = 0; v < 3; ++v) {
      half[3 * j + v] = Rational(d.from[j][0]) * whole[v] +
                        Rational(d.from[j][1]) * whole[3 + v] +
                        Rational(d.from[j][2]) * whole[6 + v];
    }
  }
  for (int j = 0; j < 3; ++j) {
    for (int k = 0; k < 3; ++k) {
      out[3 * j + k] = Rational(d.to[k][0]) * half[3 * j] +
                       Rational(d.to[k][1]) * half[3 * j + 1] +
                       Rational(d.to[k][2]) * half[3 * j + 2];
    }
  }
  return out;
}

Triangle corners(const Triangle& t, const std::array<Weights, 3>& weights) {
  Triangle out;
  for (int j = 0; j < 3; ++j) {
    out[j] = weights[j][0] * t[0] + weights[j][1] * t[1] + weights[j][2] * t[2];
  }
  return out;
}

std::array<ExactPoint, 3> exact_corners(const Triangle& t,
                                        const std::array<Weights, 3>& weights) {
  std::array<ExactPoint, 3> out;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        out[j][axis] += Rational(weights[j][i]) * Rational(t[i][axis]);
      }
    }
  }
  return out;
}

LocalPoint marginals(const std::array<double, 9>& gamma) {
  LocalPoint p{};
  double sum = 0;
  for (const double g : gamma) sum += g;
  for (int i = 0; i < 9; ++i) {
    p.alpha[i / 3] += gamma[i] / sum;
    p.beta[i % 3] += gamma[i] / sum;
  }
  return p;
}

}  // namespace sightline::internal
