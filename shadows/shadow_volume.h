// A shadow volume as a value: a convex polyhedron with what its sides pass through.
//
// Neighbours: shadow_volumes.h finds it.

#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "linespace/exact_position.h"

namespace sightline {

/// What a side of a shadow volume lies in the plane of.
enum class ShadowSideKind : std::uint8_t {
  Facet,         ///< a facet of the solid
  SourceCorner,  ///< a corner of the source and an edge of the solid
  SourceEdge,    ///< an edge of the source and a corner of the solid
  SourcePlane,   ///< the source itself: what lies behind it is no part of the volume
  Box            ///< a side of the box at which the volume is cut off
};
/// "facet", "source corner", "source edge", "source plane", "box".
[[nodiscard]] std::string_view name(ShadowSideKind kind);

/// A convex polyhedron; without vertices where it has no inside.
struct ShadowVolume {
  struct Side {
    /// Counter-clockwise seen from outside, none between two others on one line.
    std::vector<int> corners;
    /// Of several that apply the first.
    ShadowSideKind kind;
    /// All that lies in its plane, in words: "facet 7", "source vertex 3, edge 12",
    /// "source side 0-1, vertex 5" (corners by point ids), "source plane", "box x min".
    std::vector<std::string> generators;
  };
  std::vector<ExactPosition> vertices;
  std::vector<Side> sides;
  double volume = 0;  ///< scene units cubed; the nearest double
};

}  // namespace sightline
