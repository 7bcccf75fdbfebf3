// The cells into which planes cut space.
//
// Exact: planes through one line or point, and parallel ones, are told from those that
// nearly are.  Cost: n^3 log n.

#pragma once

#include <array>
#include <span>
#include <vector>

#include "aspect/cells/sign_table.h"
#include "linespace/light/homogeneous.h"

namespace sightline::internal {

struct SpaceCells {
  SignTable cells;  ///< by plane: positive where its value is
  /// A piece of a plane between two cells.
  struct Wall {
    int plane;
    int negative, positive;  ///< cells
    friend auto operator<=>(const Wall&, const Wall&) = default;
  };
  std::vector<Wall> walls;
  std::vector<bool> unbounded;  ///< by cell
  std::size_t vertices = 0, edges = 0;
};

/// Requires planes that differ, with three normals that are linearly independent.
[[nodiscard]] SpaceCells space_cells(std::span<const LightPlane> planes,
                                     const Request& request);

}  // namespace sightline::internal
