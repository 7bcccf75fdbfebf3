// Exchange areas by the area of free lines of each direction, integrated over
// directions: a second way to form factors that shares no code, clipping or formula with
// the module `shadows`.
//
// Lines of one direction w that leave polygon i by its front and meet polygon j by its
// front first fill an area A(w), measured on i's plane.  With theta the angle of w to i's
// normal and phi its azimuth,
//   A_i F_ij = 1 / pi * integral of A(w) cos(theta) dw
//            = 1 / 2 pi * integral dphi of integral dtheta of A sin(2 theta).
// All polygons are moved along w into i's plane.  There A(w) is the area that i and j
// share and no polygon between them covers, summed up in strips between neighbouring
// corners and crossings.
//
// A(w) has kinks where a corner crosses a side and where three sides meet.  On a meridian
// (phi fixed) these are roots of linear and quadratic polynomials, found before Gauss'
// rule is used from root to root.  Over phi intervals are halved until nothing changes.
//
// What is missed: where a surface is some 2^-12 as wide as it is long, what happens
// within that angle of a kink may fall between all nodes; the result is then off by some
// 1e-7 of itself.
//
// Beside upright sheets results are off by up to 8e-10, for a reason not found yet: they
// move by 1e-10 when the tolerance goes from 1e-10 to 1e-12.
//
// Cost: some seconds for a pair of rectangles among four others, to 1e-11.

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "linespace/scene.h"

namespace sightline::testing {

struct FreeBlocker {
  std::vector<Point> corners;
  /// The face of a closed object, which lies behind the face's front: where it stands on
  /// `from` or `to`, nothing can leave or arrive.
  bool solid = false;
};

struct FreeLines {
  double exchange = 0;  ///< A_i F_ij, scene units squared
  double change = 0;    ///< what the last halving changed, summed up over all intervals
  long long directions = 0;  ///< for which the area was found
};

/// Polygons are convex, exactly plane, counter-clockwise seen from their fronts.
/// Blockers hide from both sides, but sheets not where they lie in the plane of `from` or
/// `to`.
/// up: only lines count that rise along it.  tolerance: of the exchange area.
[[nodiscard]] FreeLines free_lines(std::span<const Point> from, std::span<const Point> to,
                                   std::span<const FreeBlocker> blockers,
                                   double tolerance,
                                   const std::optional<Point>& up = std::nullopt);

/// The faces that may stand between the two: those not wholly beyond a plane that has
/// both polygons on its other side.  Scene units of about the size of the polygons.
[[nodiscard]] std::vector<FreeBlocker> faces_between(std::span<const Point> from,
                                                     std::span<const Point> to,
                                                     std::span<const FreeBlocker> faces);

}  // namespace sightline::testing
