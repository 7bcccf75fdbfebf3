#include "shadows/polygon_form_factor.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "shadows/factors/contour_integrand.h"
#include "shadows/factors/exchange_area.h"
#include "shadows/factors/exchange_geometry.h"
#include "shadows/radiometry/segment_pair.h"

namespace sightline {
namespace {

using namespace internal;

double area_of_polygon(std::span<const Point> polygon) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    sum += (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  }
  return 0.5 * sum.norm();
}

void check(std::span<const Point> polygon, const char* name) {
  if (polygon.size() < 3 || !(area_of_polygon(polygon) > 0))
    throw InvalidInput(std::string(name) + ": a polygon of three corners and some area");
}

/// A F in units of the frame, from both boundaries.
ExchangeArea closed_form(const ExchangeGeometry& g) {
  std::vector<Point> sender;
  for (const FlatPoint& p : g.sender) sender.emplace_back(p.x, p.y, 0);
  const std::vector<Point>& target = g.target.corners;
  double sum = 0, size = 0;
  for (std::size_t i = 0; i < sender.size(); ++i) {
    const Point &a0 = sender[i], &a1 = sender[(i + 1) % sender.size()];
    if (a0 == a1) continue;
    for (std::size_t j = 0; j < target.size(); ++j) {
      const Point &b0 = target[j], &b1 = target[(j + 1) % target.size()];
      if (b0 == b1) continue;
      const double along = (a1 - a0).normalized().dot((b1 - b0).normalized());
      if (along == 0) continue;
      const LogIntegral part = log_integral(a0, a1, b0, b1);
      sum += along * part.value;
      size += std::abs(along) * part.size;
    }
  }
  constexpr double kRounding = 4e-15;
  const double two_pi = 2 * std::numbers::pi;
  return {sum / two_pi, kRounding * size / two_pi, 0};
}

}  // namespace

PolygonFormFactor polygon_form_factor(std::span<const Point> from,
                                      std::span<const Point> to) {
  check(from, "from");
  check(to, "to");
  const double area = area_of_polygon(from);
  const ExchangeGeometry g = open_geometry(from, to);
  if (g.nothing()) return {0, 0};
  const double scale = g.unit * g.unit;
  const double least = std::min(area, area_of_polygon(to)) / scale;
  ExchangeArea result = closed_form(g);
  constexpr double kWanted = 5e-13;
  if (!(result.error <= kWanted * least)) {
    const ExchangeArea other = integrate_exchange(g, kWanted * least);
    if (!(result.error <= other.error)) result = other;
  }
  return {result.value * scale / area, result.error * scale / area};
}

}  // namespace sightline
