// Where a horizontal or vertical line crosses edges of a map, for the question what lies
// beside what.

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "shadows/planar/map_data.h"

namespace sightline::internal {

/// The line y = at (then positions on it are x), or x = at (then they are y).
struct ScanLine {
  bool horizontal = true;
  Rational at;

  [[nodiscard]] PlaneSupport support() const;
};

/// A crossing of a scan line with an edge.
struct ScanHit {
  /// The half-edge of the edge that has its left side before the crossing, in the order
  /// of positions, and so its twin's left side after it.
  int half_edge;
  Range range;
  std::optional<QuadraticRoot> exact;  ///< always there of exact_hits()
};

/// All crossings, in no order.  nullopt where doubles cannot tell, among others where
/// the line passes a vertex.  at: the line's, a double.
[[nodiscard]] std::optional<std::vector<ScanHit>> hits_by_doubles(
    const MapData& map, std::span<const int> edges, bool horizontal, double at);

/// All crossings, in no order.  nullopt where the line passes a vertex or touches an
/// edge.
[[nodiscard]] std::optional<std::vector<ScanHit>> exact_hits(const MapData& map,
                                                             std::span<const int> edges,
                                                             const ScanLine& line);

}  // namespace sightline::internal
