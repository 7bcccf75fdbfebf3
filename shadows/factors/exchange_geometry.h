// Two convex surfaces and what stands between them, in a frame where the first one lies
// in the plane z = 0 and sends upwards: everything that an exchange area needs, prepared
// once for a pair.
//
// The exchange area of a pair is A F, the area of one surface times the form factor from
// it to the other (Hottel and Sarofim, Radiative transfer, 1967); it is the same both
// ways.

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "linespace/scene.h"
#include "shadows/factors/plane_regions.h"

namespace sightline::internal {

/// A convex polygon in the frame.
struct Plate {
  std::vector<Eigen::Vector3d> corners;
  Eigen::Vector3d normal;  ///< unit; counter-clockwise seen from its front
  double offset;           ///< normal . x + offset = 0 on its plane
  Eigen::Vector3d middle;  ///< of its corners
  /// In the plane: 1 / width in the direction in which it is long, and across.
  std::array<Eigen::Vector3d, 2> spans;

  /// How many times a distance in the plate that point lies beside its middle: by so much
  /// more than near the plate its height is uncertain, since the normal is.
  [[nodiscard]] double reach(const Eigen::Vector3d& x) const {
    return std::abs(spans[0].dot(x - middle)) + std::abs(spans[1].dot(x - middle));
  }
  [[nodiscard]] double height(const Eigen::Vector3d& x) const {
    return normal.dot(x) + offset;
  }
};

/// A piece of a line in space along which what is seen of the second surface may end:
/// part of a side of the second surface or of a blocker.
struct ContourPiece {
  Eigen::Vector3d start, direction;  ///< direction of length 1
  double length;
  /// Normals direction x d of the half-planes that the piece bounds, d pointing into the
  /// blocker there: a point x sees the blocker on the positive side of the line through q
  /// if this . (x - q) > 0, on the negative side if < 0.
  std::vector<Eigen::Vector3d> attached;
  /// Blockers that may cast a shadow from the piece or onto it.
  std::vector<int> shading;
  /// The piece lies in the second surface's plane, so that sight ends there.
  bool on_target = false;
  /// The second surface is seen beside the piece on the positive, the negative side.
  bool shows_positive = true, shows_negative = true;
  /// Positions strictly inside, ascending, where the piece passes through a blocker.
  std::vector<double> breaks;
};

/// What lies so far outside of the shaft counts as inside, in the frame's units: far
/// above rounding, since a blocker too many costs time only.
inline constexpr double kShaftSlack = 1e-10;

struct ExchangeGeometry {
  double unit = 1;              ///< scene units in a unit of the frame
  PlanePolygon sender;          ///< in z = 0, before the target's front
  Plate target;                 ///< above z = 0
  std::vector<Plate> blockers;  ///< above z = 0 and before the target's front
  /// Half-spaces that hold all segments between sender and target: (n, c) with
  /// n . x + c <= 0 there, n of length 1, but for rounding.
  std::vector<Eigen::Vector4d> shaft;
  std::vector<ContourPiece> pieces;
  /// Only lines count that rise along this unit vector.
  std::optional<Eigen::Vector3d> up;

  /// The part of the segment in the shaft, from 0 to 1, with slack; nothing where it has
  /// none.
  [[nodiscard]] std::optional<std::array<double, 2>> in_shaft(
      const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;

  /// Neither surface lies before the other's front: nothing is exchanged.
  [[nodiscard]] bool nothing() const {
    return sender.size() < 3 || target.corners.size() < 3;
  }
};

/// Corners counter-clockwise as seen from the front, exactly planar and convex.  On which
/// side of the planes of sender and target points lie is decided exactly.
[[nodiscard]] ExchangeGeometry exchange_geometry(
    std::span<const Point> sender, std::span<const Point> target,
    std::span<const std::span<const Point>> blockers,
    const std::optional<Eigen::Vector3d>& up = std::nullopt);

/// The same without blockers; the polygons need not be convex.
[[nodiscard]] ExchangeGeometry open_geometry(std::span<const Point> sender,
                                             std::span<const Point> target);

/// Three corners of a polygon that span its plane best, in cyclic order.
[[nodiscard]] std::array<Point, 3> spanning_corners(std::span<const Point> polygon);

}  // namespace sightline::internal
