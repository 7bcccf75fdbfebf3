// The map of a view: the graph of visible pieces without its seams, straight pieces
// joined, vertices and edges named by what they are in the scene.

#pragma once

#include "linespace/view/view_graph.h"

namespace sightline::internal {

/// The map's parts as PointView tells them; in addition what stands behind them.
struct ViewMap {
  std::vector<MapVertex> vertices;
  std::vector<MapEdge> edges;
  std::vector<MapRegion> regions;  ///< without their measures
  int components = 0, background_pieces = 0, seams = 0;
  /// Of regions of the graph: the map's region they are a part of; -1 where sight runs
  /// into material.
  std::vector<int> region_of;
  /// Of vertices of the map: their point in the graph, and lines that end or cross there:
  /// of a T the near one and the far one; else of the smallest numbers.
  std::vector<int> point_of_vertex;
  std::vector<std::array<int, 2>> lines_of_vertex;
  std::vector<int> line_of_edge;  ///< whose name the edge has
  /// Of each seam its two end points in the graph, and its first line.
  struct Seam {
    std::array<int, 2> ends;
    int line;
  };
  std::vector<Seam> seam_pieces;
};

/// `suspects`: all points of the picture in which more than two lines that lie apart in
/// space may be seen, and perhaps others.
[[nodiscard]] ViewMap make_map(const EyeSpace& eye, const ViewGraph& graph,
                               std::span<const PicturePoint> suspects,
                               std::span<const std::uint8_t> possibly_seen);

}  // namespace sightline::internal
