// The patches of a scene as things to be seen: from which side, how large, parallel to
// which.

#pragma once

#include <array>
#include <vector>

#include "aspect/viewpoints.h"
#include "linespace/point_view.h"
#include "linespace/predicates.h"

namespace sightline::internal {

/// A patch, by its number in PointViewIndex: seen from in front of its plane alone.
struct PatchSide {
  int patch = -1;
  std::vector<int> facets;
  std::vector<int> faces;  ///< of these facets, ascending
  bool front = true;       ///< of its first facet it is the front
  double area = 0;
  /// Three corners, counter-clockwise for who sees them.
  std::array<Point, 3> plane{Point::Zero(), Point::Zero(), Point::Zero()};
  Point on = Point::Zero();  ///< the first of them
  /// Towards those who see it; not of length 1.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  /// The normal's rounding errors are within kSlack of this.
  Eigen::Vector3d slack = Eigen::Vector3d::Zero();
  int group = 0;      ///< patches with exactly parallel planes have one
  bool along = true;  ///< faces the way the first of its group does
  int rank = 0;       ///< of its plane in the group, along the first one's normal
  int solid = -1;     ///< the convex closed object that it belongs to; else -1
};

/// Of PatchSide::slack, and of a value of its plane.  A component of the normal is the
/// difference of two products of differences: with unit roundoff u = 2^-53 its error is
/// below 7 u (1 + u)^6 times the sum of the products' magnitudes.  A plane's value adds
/// three products of it with differences: below 16 u of the sum of magnitudes.
inline constexpr double kSlack = 32 * kUnit;

/// The sides that somebody outside closed objects may see, of patches with a wanted face;
/// what faces into the material of its own object is left out.  By group, then by rank.
[[nodiscard]] std::vector<PatchSide> patch_sides(const PointViewIndex& index,
                                                 const ViewpointRequest& request);

}  // namespace sightline::internal
