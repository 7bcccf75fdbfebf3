// The order of half-edges around a vertex, exactly.

#pragma once

#include "shadows/planar/planar_data.h"

namespace sightline::internal {

/// Half-edges that start at one vertex, and no two of which coincide.
class HalfEdgeOrder {
 public:
  /// Keeps references.
  HalfEdgeOrder(const PlanarGeometry& geometry, const std::vector<PlanarEdge>& edges)
      : geometry_(geometry), edges_(edges) {}

  /// Counter-clockwise, from the direction (1, 0) on.
  void sort(std::vector<int>& half_edges) const;

 private:
  struct Direction {
    int half_edge;
    int arc;
    int position;
    bool forwards;  ///< in the direction in which the arc's parameter grows
    BallNumber x, y;
    bool upper;  ///< its angle is in [0, pi)
  };

  [[nodiscard]] Direction direction(int half_edge) const;
  [[nodiscard]] bool upper(const Direction& d) const;
  [[nodiscard]] bool before(const Direction& g, const Direction& h) const;
  [[nodiscard]] bool exactly_before(const Direction& g, const Direction& h) const;
  [[nodiscard]] const PlaneSupport& support(const Direction& d) const {
    return geometry_.all.supports[geometry_.all.arcs[d.arc].support];
  }
  [[nodiscard]] ExactParameter exact_position(const Direction& d) const;

  const PlanarGeometry& geometry_;
  const std::vector<PlanarEdge>& edges_;
};

}  // namespace sightline::internal
