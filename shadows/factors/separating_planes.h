// Whether a polygon lies beside all segments from a piece of a line to another polygon.

#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace sightline::internal {

/// Half-spaces, normal . x <= limit, that hold a segment and a convex polygon, and so all
/// segments between the two; for lines in space and polygons about 1 wide.
class SeparatingPlanes {
 public:
  SeparatingPlanes(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                   std::span<const Eigen::Vector3d> polygon);

  /// True: no corner is inside some half-space, so that the polygon has no point strictly
  /// inside the hull, but for rounding (some 1e-16).  False proves nothing.
  [[nodiscard]] bool beside(std::span<const Eigen::Vector3d> corners) const;

 private:
  void add(const Eigen::Vector3d& normal, std::span<const Eigen::Vector3d> polygon,
           const Eigen::Vector3d& from, const Eigen::Vector3d& to);

  struct HalfSpace {
    Eigen::Vector3d normal;
    double limit;
  };
  std::vector<HalfSpace> half_spaces_;
};

}  // namespace sightline::internal
