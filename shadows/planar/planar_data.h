// What a planar map is stored as; planar_map.h tells what it means.

#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "shadows/planar/arcs/plane_arc.h"

namespace sightline::internal {

/// A vertex, rounded.  Off by at most `error` in each coordinate, which is at most
/// kVertexError times the largest coordinate of the outline.
inline constexpr double kVertexError = 0x1p-44;
struct PlanarVertex {
  Eigen::Vector2d at;
  double error;
};

/// The geometry that maps made from one another share.
struct PlanarGeometry {
  PlaneArcs all;
  std::vector<PlaneCurve> curves;  ///< the input
  /// For each arc its vertices, ascending.
  std::vector<std::vector<ArcParameter>> positions;
  /// For each arc, ascending, the positions that are corners of the outline.
  std::vector<std::vector<int>> corners;
};

/// From its first vertex to its second the parameter of its arc grows.
struct PlanarEdge {
  std::array<int, 2> ends;
  int arc;
  std::array<int, 2> position;  ///< in the positions of the arc
  /// A side of the outline; and the inside is on the left of half-edge 0, or 1.
  bool outline = false;
  bool inside_of_first = false;
};

struct PlanarFace {
  int outer;
  std::vector<int> holes;
};

/// IndexLists of numbers, one after the other.
struct IndexLists {
  std::vector<int> first{0};  ///< of list i in `items`; and one more
  std::vector<int> items;

  void add(std::span<const int> list) {
    items.insert(items.end(), list.begin(), list.end());
    first.push_back(static_cast<int>(items.size()));
  }
  [[nodiscard]] std::span<const int> operator[](int i) const {
    return {items.data() + first[i], items.data() + first[i + 1]};
  }
};

struct PlanarData {
  std::shared_ptr<const PlanarGeometry> geometry;
  std::vector<PlanarVertex> vertices;
  std::vector<PlanarEdge> edges;
  IndexLists curves;  ///< ids of each edge
  IndexLists stars;   ///< half-edges of each vertex
  std::vector<int> next, face;
  std::vector<PlanarFace> faces;

  [[nodiscard]] const PlaneSupport& support_of_edge(int e) const {
    return geometry->all.supports[geometry->all.arcs[edges[e].arc].support];
  }
  [[nodiscard]] const ArcParameter& position(int e, int end) const {
    return geometry->positions[edges[e].arc][edges[e].position[end]];
  }
};

}  // namespace sightline::internal
