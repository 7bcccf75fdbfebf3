#include "shadows/factors/exchange_area.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "shadows/factors/adaptive_integral.h"
#include "shadows/factors/contour_events.h"
#include "shadows/factors/contour_integrand.h"
#include "shadows/factors/exchange_geometry.h"

namespace sightline::internal {
namespace {

/// Number of the function along the horizon, beside those along pieces.
constexpr int kHorizon = -1;

/// From event to event.
std::vector<Interval> first_intervals(const ExchangeGeometry& g) {
  std::vector<Interval> intervals;
  for (std::size_t p = 0; p < g.pieces.size(); ++p) {
    double from = 0;
    if (g.blockers.empty()) {
      intervals.push_back({static_cast<int>(p), 0, g.pieces[p].length, {}});
      continue;
    }
    for (const double s : contour_events(g, g.pieces[p])) {
      intervals.push_back({static_cast<int>(p), from, s, {}});
      from = s;
    }
    intervals.push_back({static_cast<int>(p), from, g.pieces[p].length, {}});
  }
  if (g.up && g.up->z() != 0) {
    constexpr int kParts = 8;
    for (int i = 0; i < kParts; ++i) {
      const double part = 2 * std::numbers::pi / kParts;
      intervals.push_back({kHorizon, i * part, (i + 1) * part, {}});
    }
  }
  return intervals;
}

/// What rounding may do: each value of the integrand is a sum over the boundary of a part
/// of the sender.
double rounding_error(const ExchangeGeometry& g) {
  double boundary = 0, lines = 0;
  for (std::size_t i = 0; i < g.sender.size(); ++i) {
    const FlatPoint& a = g.sender[i];
    const FlatPoint& b = g.sender[(i + 1) % g.sender.size()];
    boundary += std::hypot(b.x - a.x, b.y - a.y);
  }
  for (const ContourPiece& piece : g.pieces) lines += piece.length;
  // Some 40 roundings of 2^-53 for each unit of boundary and of line: measured on random
  // pairs, not proved (docs/form_factors.md).
  constexpr double kRounding = 5e-15;
  return kRounding * boundary * lines;
}

}  // namespace

ExchangeArea integrate_exchange(const ExchangeGeometry& g, double tolerance) {
  // Where the function has a kink inside, two rules may agree by chance; rules of few
  // nodes sooner.
  constexpr double kKinkCaution = 20, kCoarseCaution = 4;
  constexpr int kMostCuts = 20000;
  // Between events the function is smooth, and a rule of few nodes does for few digits.
  constexpr double kCoarse = 1e-10;
  const bool coarse = tolerance > kCoarse * std::abs(doubled_area(g.sender));

  ExchangeArea result;
  ContourIntegrand integrand(g);
  const double rounding = rounding_error(g);
  const auto sum = integrate_adaptively(
      first_intervals(g), std::max(tolerance - rounding, 0.5 * tolerance), kMostCuts,
      [&](int p, double from, double to) {
        std::uint64_t structure = 0;
        bool smooth = true;
        const auto f = [&](double s) {
          ++result.evaluations;
          const double value =
              p == kHorizon ? integrand.at_horizon(s) : integrand.at(g.pieces[p], s);
          if (structure == 0) structure = integrand.structure();
          smooth = smooth && structure == integrand.structure();
          return value;
        };
        IntegralEstimate estimate =
            coarse ? kronrod(kKronrod7, from, to, f) : kronrod(kKronrod15, from, to, f);
        if (coarse) estimate.error *= kCoarseCaution;
        if (!smooth) estimate.error *= kKinkCaution;
        return estimate;
      });
  result.value = sum.value;
  result.error = sum.error + rounding;
  return result;
}

ExchangeArea exchange_area(std::span<const Point> sender, std::span<const Point> target,
                           std::span<const std::span<const Point>> blockers,
                           double tolerance, const std::optional<Eigen::Vector3d>& up) {
  const ExchangeGeometry g = exchange_geometry(sender, target, blockers, up);
  if (g.nothing()) return {};
  const double scale = g.unit * g.unit;
  ExchangeArea result = integrate_exchange(g, tolerance / scale);
  result.value *= scale;
  result.error *= scale;
  return result;
}

}  // namespace sightline::internal
