#include "aspect/views/estimate.h"

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <cmath>
#include <numeric>

namespace sightline::internal {
namespace {

constexpr double kNormal = 1.959963984540054;  // of 95 %

}  // namespace

std::array<double, 2> share_interval(int hits, int trials) {
  if (trials == 0) return {0, 1};
  const double k = hits, n = trials;
  using Beta = boost::math::beta_distribution<double>;
  return {hits == 0 ? 0 : boost::math::quantile(Beta(k, n - k + 1), 0.025),
          hits == trials ? 1 : boost::math::quantile(Beta(k + 1, n - k), 0.975)};
}

AspectEstimate estimate_of(const std::vector<int>& seen) {
  const double n = std::accumulate(seen.begin(), seen.end(), 0.0);
  const auto labels = static_cast<double>(seen.size());
  AspectEstimate out{};
  out.seen_once = static_cast<int>(std::ranges::count(seen, 1));
  out.seen_twice = static_cast<int>(std::ranges::count(seen, 2));
  const double once = out.seen_once, twice = out.seen_twice;
  // Samples that met a label alone are to all as the unseen share is to 1.
  out.unseen_weight = once / n;
  const double spread =
      kNormal * std::sqrt(std::max(0.0, once * (1 - once / n) + 2 * twice)) / n;
  const std::array<double, 2> by_chance =
      share_interval(out.seen_once, static_cast<int>(n));
  out.unseen_interval = {
      std::max(0.0, std::min(out.unseen_weight - spread, by_chance[0])),
      std::min(1.0, std::max(out.unseen_weight + spread, by_chance[1]))};
  const double more = (n - 1) / n * once * (once - 1) / (2 * (twice + 1));
  out.distinct_total = labels + more;
  if (more <= 0) {
    out.distinct_interval = {labels, labels + (once > 0 ? kNormal : 0)};
    return out;
  }
  const double r = once / std::max(1.0, twice);
  const double variance =
      std::max(1.0, twice) * (r * r / 2 + r * r * r + r * r * r * r / 4);
  const double k = std::exp(kNormal * std::sqrt(std::log1p(variance / (more * more))));
  out.distinct_interval = {labels + more / k, labels + more * k};
  return out;
}

}  // namespace sightline::internal
