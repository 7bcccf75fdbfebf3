// Where an edge runs inside the material of solids: no line that touches it there is
// free.

#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace sightline::internal {

/// A closed stretch of an edge whose inside lies in material.  It ends where the edge
/// passes through a face, or at an end of the edge.
struct BuriedStretch {
  /// The faces at its two ends; -1 where it begins at the edge's first end, ends at the
  /// second.
  std::int32_t from, to;
  /// Parameters on the edge of the stretch's two ends, each rounded into the stretch: all
  /// of the edge between `low` and `high` is certainly buried.
  double low, high;
};

/// A range of parameters outside of which the edge is certainly buried; empty (first not
/// below second) when all of it is.  From the stretches that reach an end of the edge.
[[nodiscard]] std::array<double, 2> visible_range(std::span<const BuriedStretch> buried);

}  // namespace sightline::internal
