// A viewpoint well inside a cell.

#pragma once

#include <array>
#include <span>
#include <vector>

#include "aspect/cells/sphere_cells.h"
#include "linespace/numbers/rational.h"

namespace sightline::internal {

/// An arc that bounds a cell on the sphere, which lies on its positive side or not.
struct SphereArc {
  bool positive;
  const SphereCells::Wall* wall;
};

struct InnerDirection {
  ExactPoint at;       ///< exactly inside
  double solid_angle;  ///< of the cell, sr, within 1e-14
  double clearance;    ///< from the nearest arc, rad
};
/// Near the centre of the largest disc in the cell.  Requires all arcs of the cell, at
/// least three.
[[nodiscard]] InnerDirection inner_direction(std::span<const CircleNormal> normals,
                                             std::span<const SphereArc> arcs);

/// A plane, on whose positive side the cell lies or not.
struct SignedPlane {
  const LightPlane* plane;
  bool positive;
};

struct InnerPoint {
  ExactPoint at;     ///< exactly inside
  double clearance;  ///< from the nearest plane, scene units
};
/// The centre of the largest ball in the cell; of one without a largest, a ball of the
/// size of the box.  A linear program in exact numbers: a millisecond or so.  Requires
/// planes that bound a cell.
[[nodiscard]] InnerPoint inner_point(std::span<const SignedPlane> sides,
                                     const std::array<Point, 2>& box);

/// The volume of the part of the box that lies in the cell.
[[nodiscard]] double volume_in(const std::array<Point, 2>& box,
                               std::span<const SignedPlane> sides);

}  // namespace sightline::internal
