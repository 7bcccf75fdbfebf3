// The exchange area of two convex surfaces among blockers, to a tolerance.

#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "linespace/scene.h"

namespace sightline::internal {

struct ExchangeArea {
  double value = 0;  ///< scene units squared
  double error = 0;  ///< a bound; docs/form_factors.md says which part of it is proved
  std::int64_t evaluations = 0;
};

struct ExchangeGeometry;

/// Of a prepared pair, in units of its frame.
[[nodiscard]] ExchangeArea integrate_exchange(const ExchangeGeometry& geometry,
                                              double tolerance);

/// A F of sender and target: the integral over points x and y of them that see each
/// other, each before the other's front, of cos cos' / (pi r^2).  Polygons are convex and
/// exactly planar, counter-clockwise as seen from their fronts; blockers hide from both
/// sides, but not where they lie in the sender's or the target's plane.
/// tolerance: scene units squared.  up: only lines from sender to target count that rise
/// along it, which must not be 0.
[[nodiscard]] ExchangeArea exchange_area(
    std::span<const Point> sender, std::span<const Point> target,
    std::span<const std::span<const Point>> blockers, double tolerance,
    const std::optional<Eigen::Vector3d>& up = std::nullopt);

}  // namespace sightline::internal
