#include "shadows/factors/contour_integrand.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace sightline::internal {
namespace {

using Vector = Eigen::Vector3d;

/// n . (x - q) as a function of points x in z = 0.
HalfPlane half_plane(const Vector& n, const Vector& q) {
  return {n.x(), n.y(), -n.dot(q)};
}

std::size_t farthest(std::span<const FlatPoint> polygon, const Vector& q) {
  std::size_t best = 0;
  double largest = -1;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const double x = polygon[i].x - q.x(), y = polygon[i].y - q.y();
    const double rr = x * x + y * y;
    if (rr > largest) {
      largest = rr;
      best = i;
    }
  }
  return best;
}

}  // namespace

double log_contour(std::span<const FlatPoint> polygon, const Vector& q, const Vector& t) {
  // Logarithms are taken of r / r0, r0 the distance of the farthest corner: a constant
  // adds nothing around a closed polygon, and what is left keeps its digits where the
  // polygon is small beside its distance.
  const std::size_t n = polygon.size();
  const double zz = q.z() * q.z();
  const std::size_t first = farthest(polygon, q);
  const FlatPoint& origin = polygon[first];
  const double x0 = origin.x - q.x(), y0 = origin.y - q.y();
  const double rr0 = x0 * x0 + y0 * y0 + zz;
  const auto half_log = [&](const FlatPoint& p) {
    const double dx = p.x - origin.x, dy = p.y - origin.y;
    const double change = (dx * (dx + 2 * x0) + dy * (dy + 2 * y0)) / rr0;
    return change > -1 ? 0.5 * std::log1p(change) : -700.0;
  };
  double sum = 0;
  double log_a = 0;
  for (std::size_t k = 0, i = first; k < n; ++k) {
    const FlatPoint& a = polygon[i];
    i = i + 1 < n ? i + 1 : 0;
    const FlatPoint& b = polygon[i];
    const double log_b = k + 1 < n ? half_log(b) : 0;
    const double ux = b.x - a.x, uy = b.y - a.y;
    const double length = std::sqrt(ux * ux + uy * uy);
    const double along = t.x() * ux + t.y() * uy;
    if (length > 0 && along != 0) {
      const double from = ((a.x - q.x()) * ux + (a.y - q.y()) * uy) / length;
      const double to = from + length;
      const double off = ((a.x - q.x()) * uy - (a.y - q.y()) * ux) / length;
      const double dd = off * off + zz;
      const double d = std::sqrt(dd);
      const double angle = std::atan2(d * length, dd + from * to);
      sum += along / length * (to * log_b - from * log_a + (d * angle - length));
    }
    log_a = log_b;
  }
  return -sum;
}

double ContourIntegrand::at(const ContourPiece& piece, double position) {
  const Vector q = piece.start + position * piece.direction;
  structure_ = 1;
  double sum = 0;
  if (piece.shows_positive) sum -= over_part(piece, q, -1);
  if (piece.shows_negative) sum += over_part(piece, q, 1);
  return sum / (2 * std::numbers::pi);
}

// Where all that is attached lies on the side of that sign, the other side is open.
double ContourIntegrand::over_part(const ContourPiece& piece, const Vector& q,
                                   double sign) {
  seen_.assign(g_.sender);
  for (const Vector& n : piece.attached) seen_.keep(half_plane(sign * n, q));
  if (g_.up) seen_.keep({-g_.up->x(), -g_.up->y(), g_.up->dot(q)});
  if (!piece.on_target) keep_before_target(q);
  for (const int b : piece.shading) {
    if (seen_.empty()) return 0;
    remove_shadow(g_.blockers[b], q, !piece.on_target);
  }
  double sum = 0;
  structure_ *= 31;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    sum += log_contour(seen_[i], q, piece.direction);
    structure_ = structure_ * 1000003 + seen_[i].size();
  }
  return sum;
}

// Through q the sender sees the target upside down: every side on its other side.
void ContourIntegrand::keep_before_target(const Vector& q) {
  const std::vector<Vector>& corners = g_.target.corners;
  for (std::size_t i = 0; i < corners.size() && !seen_.empty(); ++i) {
    const Vector& next = corners[i + 1 < corners.size() ? i + 1 : 0];
    // q lies before the target's front: its normal points to q, so that inside the cone
    // from q to the target these are negative.
    seen_.keep(half_plane((corners[i] - q).cross(next - q), q));
  }
}

void ContourIntegrand::remove_shadow(const Plate& plate, const Vector& q, bool beyond) {
  const double height = plate.height(q);
  if (height == 0) return;
  const double sign = height > 0 ? -1 : 1;
  cone_.clear();
  const std::vector<Vector>& corners = plate.corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector& next = corners[i + 1 < corners.size() ? i + 1 : 0];
    const HalfPlane half = half_plane(sign * (corners[i] - q).cross(next - q), q);
    // From a q in the sender's plane, a side in that plane cuts nothing off.
    if (half.a != 0 || half.b != 0 || half.c != 0) cone_.push_back(half);
  }
  if (beyond) {
    for (HalfPlane& half : cone_) half = half.complement();
    seen_.remove(cone_);
    for (HalfPlane& half : cone_) half = half.complement();
  }
  // Between q and x lies the plate's plane.
  cone_.push_back(
      {sign * plate.normal.x(), sign * plate.normal.y(), sign * plate.offset});
  seen_.remove(cone_);
}

// Of lines in one direction: the shadow of the plate, as cast from infinitely far away.
void ContourIntegrand::find_parallel_cone(const Plate& plate, const Vector& direction) {
  const double sign = plate.normal.dot(direction) > 0 ? -1 : 1;
  cone_.clear();
  const std::vector<Vector>& corners = plate.corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector& next = corners[i + 1 < corners.size() ? i + 1 : 0];
    const HalfPlane half =
        half_plane(sign * direction.cross(corners[i] - next), corners[i]);
    if (half.a != 0 || half.b != 0 || half.c != 0) cone_.push_back(half);
  }
}

double ContourIntegrand::at_horizon(double angle) {
  const Vector& up = *g_.up;
  const Vector x = up.unitOrthogonal();
  const Vector u = std::cos(angle) * x + std::sin(angle) * up.cross(x);
  structure_ = 1;
  if (!(u.z() > 0) || !(g_.target.normal.dot(u) < 0)) return 0;
  seen_.assign(g_.sender);
  find_parallel_cone(g_.target, u);
  for (const HalfPlane& half : cone_) seen_.keep(half);
  for (const Plate& plate : g_.blockers) {
    if (seen_.empty()) return 0;
    if (plate.normal.dot(u) == 0) continue;
    find_parallel_cone(plate, u);
    const double sign = plate.normal.dot(u) > 0 ? -1 : 1;
    cone_.push_back(
        {sign * plate.normal.x(), sign * plate.normal.y(), sign * plate.offset});
    seen_.remove(cone_);
  }
  double area = 0;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    area += 0.5 * doubled_area(seen_[i]);
    structure_ = structure_ * 1000003 + seen_[i].size();
  }
  return area * up.z() / (2 * std::numbers::pi);
}

}  // namespace sightline::internal
