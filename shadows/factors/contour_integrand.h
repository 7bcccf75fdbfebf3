// The exchange area as an integral along lines in space.
//
// By Lambert the form factor of a point x to what it sees is an integral along the
// boundary of what is seen,
//   f(x) = 1 / 2 pi * integral of n . (r x dq) / r^2,   r = q - x,
// where q may run on any curve in space that x sees as that boundary: along sides of the
// target, and along sides of blockers beside which the target is seen.  Integrated over
// the sender, with the order changed, each such side contributes
//   1 / 2 pi * integral dq . (integral over R(q) of n x r / r^2 dx),
// R(q) the points of the sender that see q as a point of the boundary: a polygon, which
// is found by cutting.  The inner integral has a closed form, with ln |q - x| around the
// boundary of R(q) by Green's theorem.  So the integral over four dimensions becomes one
// over a single one, of a function that is analytic but for the positions q at which the
// polygon R(q) changes its structure.

#pragma once

#include <cstdint>

#include "shadows/factors/exchange_geometry.h"
#include "shadows/factors/plane_regions.h"

namespace sightline::internal {

/// Evaluates the function to be integrated; keeps a reference to the geometry, and
/// scratch: one a thread.
class ContourIntegrand {
 public:
  explicit ContourIntegrand(const ExchangeGeometry& geometry) : g_(geometry) {}

  /// At this position along the piece, per length: the exchange area is the sum over all
  /// pieces of the integral of this.  Units of the frame.
  [[nodiscard]] double at(const ContourPiece& piece, double position);
  /// With `up`, what is seen ends at the horizon across it, too: per angle in [0, 2 pi]
  /// along that circle.  Added to the sum over pieces.
  [[nodiscard]] double at_horizon(double angle);
  /// Of the last call: equal for positions at which the polygon R(q) was cut in
  /// the same way, but for chance.
  [[nodiscard]] std::uint64_t structure() const { return structure_; }

 private:
  double over_part(const ContourPiece& piece, const Eigen::Vector3d& q, double sign);
  void keep_before_target(const Eigen::Vector3d& q);
  void remove_shadow(const Plate& plate, const Eigen::Vector3d& q, bool beyond);
  void find_parallel_cone(const Plate& plate, const Eigen::Vector3d& direction);

  const ExchangeGeometry& g_;
  std::uint64_t structure_ = 0;
  PlaneRegions seen_;
  std::vector<HalfPlane> cone_;
};

/// Around a convex polygon in z = 0, counter-clockwise: the integral of
/// -ln |q - x| t . dx, which is that of t . (n x r) / r^2 over its inside.
[[nodiscard]] double log_contour(std::span<const FlatPoint> polygon,
                                 const Eigen::Vector3d& q, const Eigen::Vector3d& t);

}  // namespace sightline::internal
