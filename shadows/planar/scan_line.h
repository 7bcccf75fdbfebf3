// Where a horizontal or vertical line crosses edges of a map, for the question what lies
// beside what.

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "shadows/planar/planar_data.h"

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
  DoubleRange range;
  std::optional<QuadraticRoot> exact;  ///< always there of exact_hits()
};

/// Edges by where they lie, so that few have to be asked for a scan line.
class ScanIndex {
 public:
  /// Keeps a reference.  Of all edges.
  explicit ScanIndex(const PlanarData& map);

  /// All edges that a scan line may meet, ascending.
  [[nodiscard]] std::vector<int> edges_at(bool horizontal, double at) const;

 private:
  struct Rows {
    double from = 0, width = 1;
    std::vector<DoubleRange> ranges;  // of an edge
    std::vector<std::vector<int>> edges;

    [[nodiscard]] int row(double x) const;
  };
  [[nodiscard]] static Rows rows(std::vector<DoubleRange> ranges);

  Rows by_x_, by_y_;
};

/// All crossings, in no order.  nullopt where doubles cannot tell, among others where
/// the line passes a vertex.  at: the line's, a double.
[[nodiscard]] std::optional<std::vector<ScanHit>> hits_by_doubles(
    const PlanarData& map, std::span<const int> edges, bool horizontal, double at);

/// All crossings, in no order.  nullopt where the line passes a vertex or touches an
/// edge.
[[nodiscard]] std::optional<std::vector<ScanHit>> exact_hits(const PlanarData& map,
                                                             std::span<const int> edges,
                                                             const ScanLine& line);

}  // namespace sightline::internal
