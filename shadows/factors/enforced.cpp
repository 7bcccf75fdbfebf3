#include <algorithm>
#include <cmath>
#include <vector>

#include "shadows/form_factors.h"

namespace sightline {
namespace {

/// Of a row with scales d: to the surfaces, and to the rest.
double scaled_sum(const FormFactorRow& row, const std::vector<double>& d, std::size_t i) {
  double sum = row.others + row.outside + row.backs;
  for (std::size_t k = 0; k < row.to.size(); ++k) sum += row.factor[k] * d[row.to[k]];
  return d[i] * sum;
}

/// Damped: half of what a row lacks is made up by itself, since its partners move too.
std::vector<double> scales(const FormFactors& factors) {
  constexpr int kMostSweeps = 200;
  constexpr double kAddsUp = 1e-15;  // some units of the last place of a row's sum
  std::vector<double> d(factors.rows.size(), 1);
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double largest = 0;
    for (std::size_t i = 0; i < d.size(); ++i) {
      const double sum = scaled_sum(factors.rows[i], d, i);
      if (!(sum > 0)) continue;
      largest = std::max(largest, std::abs(sum - 1));
      d[i] /= std::sqrt(sum);
    }
    if (largest < kAddsUp) break;
  }
  return d;
}

}  // namespace

EnforcedFactors enforced(const FormFactors& factors) {
  const std::vector<double> d = scales(factors);
  EnforcedFactors result{factors, 0, 0};
  const auto scale = [&](double& value, double by) {
    const double before = value;
    value *= by;
    result.moved = std::max(result.moved, std::abs(value - before));
  };
  for (std::size_t i = 0; i < d.size(); ++i) {
    FormFactorRow& row = result.factors.rows[i];
    for (std::size_t k = 0; k < row.to.size(); ++k) {
      scale(row.factor[k], d[i] * d[row.to[k]]);
    }
    for (double* rest : {&row.others, &row.outside, &row.backs, &row.sky}) {
      scale(*rest, d[i]);
    }
    const double sum = result.factors.row_sum(static_cast<int>(i)) + row.others +
                       row.outside + row.backs;
    result.left_over = std::max(result.left_over, std::abs(sum - 1));
  }
  return result;
}

}  // namespace sightline
