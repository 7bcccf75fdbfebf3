// Which closed walks of a planar graph in the picture bound one region: a region between
// components of the graph has a walk on each of them.

#pragma once

#include <array>
#include <vector>

#include "linespace/picture/classes.h"
#include "linespace/picture/picture_point.h"

namespace sightline::internal {

/// Half-edge 2 e runs from the first end of edge e to its second, 2 e + 1 back; each is
/// on one walk, which has its region on the left.
struct WalkedGraph {
  const std::vector<PicturePoint>* points;
  std::vector<std::array<int, 2>> ends;  ///< of edges: points
  std::vector<int> walks;                ///< of half-edges
  int walk_count = 0;
};

struct RegionLinks {
  Classes walks;   ///< those that bound one region are one
  int components;  ///< of the graph, points and edges together
};
[[nodiscard]] RegionLinks link_regions(const EyeSpace& eye, const WalkedGraph& graph);

/// A point of the picture inside an edge, another for each weight.
[[nodiscard]] PicturePoint point_inside(const EyeSpace& eye, const PicturePoint& p,
                                        const PicturePoint& q, int weight = 1);

}  // namespace sightline::internal
