// The lines in space that can bound what is seen.

#pragma once

#include <array>

#include "linespace/visibility_map.h"

namespace sightline::internal {

/// A segment in space beside which something else may be seen on either side: an edge of
/// the scene, a side between two faces of one facet that is bent there by rounding, a
/// segment in which two faces cut through each other, or where a box cuts a face.
struct ViewLine {
  /// Point numbers, as ViewScene counts them; {-1, -1} where a box has cut all of an edge
  /// or a side away.
  std::array<int, 2> ends;
  MapLine name;
  /// Of a crossing: the two faces; else -1.
  std::array<int, 2> crossing{-1, -1};
};

}  // namespace sightline::internal
