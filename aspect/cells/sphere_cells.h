// The cells into which great circles cut the sphere of directions.
//
// Exact: circles through one point and circles that coincide are told from those that
// only come near.  Cost: n^2 log n.

#pragma once

#include <array>
#include <span>
#include <vector>

#include "aspect/cells/sign_table.h"
#include "linespace/light/homogeneous.h"

namespace sightline::internal {

/// A vector across a great circle's plane.
struct CircleNormal {
  std::array<Approx, 3> near;
  std::array<Ring, 3> exact;
};
/// The normal of the great circle parallel to the plane.
[[nodiscard]] CircleNormal normal_of(const LightPlane& plane);

struct SphereCells {
  /// By circle: positive where a direction has a positive product with its normal.
  SignTable cells;
  /// A vertex: the direction of normal a x normal b, or its opposite.
  struct Vertex {
    int a, b;
    bool opposite;
  };
  /// An arc between two cells, from a vertex on along the circle, counter-clockwise seen
  /// from the normal: the positive cell is on its left.
  struct Wall {
    int circle;
    int negative, positive;  ///< cells
    Vertex from, to;
  };
  std::vector<Wall> walls;
  std::size_t vertices = 0;
};

/// Requires circles that differ, three of them not through one point.
[[nodiscard]] SphereCells sphere_cells(std::span<const CircleNormal> normals);

}  // namespace sightline::internal
