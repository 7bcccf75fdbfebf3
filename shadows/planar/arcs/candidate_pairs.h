// Which arcs may meet: those that share a cell of a grid.

#pragma once

#include <span>
#include <vector>

#include "shadows/planar/arcs/plane_arc.h"

namespace sightline::internal {

class ArcGrid {
 public:
  /// Some cells for each arc.
  explicit ArcGrid(const PlaneArcs& all);

  /// Arcs with a number above a that share a cell with arc a, ascending.
  [[nodiscard]] std::vector<int> partners(int a) const;

 private:
  std::vector<std::vector<int>> cells_of_arc_;
  std::vector<std::vector<int>> arcs_of_cell_;
};

}  // namespace sightline::internal
