// The shape of a view: its map with all names forgotten, kinds and orientation kept.

#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "linespace/visibility_map.h"

namespace sightline::internal {

/// A map on the sphere or in the plane.  Dart 2 e runs along edge e, dart 2 e + 1 against
/// it.
struct ShapeMap {
  struct Edge {
    std::array<int, 2> ends;  ///< vertices
    std::uint8_t kind;
  };
  struct Region {
    std::uint8_t kind;
    /// Closed walks of darts, the region on their left.
    std::vector<std::vector<int>> boundary;
  };
  std::vector<std::uint8_t> vertex_kinds;
  std::vector<Edge> edges;
  std::vector<Region> regions;
};

[[nodiscard]] ShapeMap shape_map(const PointView& view);

/// Equal for two maps iff there is an isomorphism that keeps kinds and orientation (equal
/// by chance: one in 2^128).  Cost: edges times the darts that look alike.
[[nodiscard]] std::string shape_of(const ShapeMap& map);

}  // namespace sightline::internal
