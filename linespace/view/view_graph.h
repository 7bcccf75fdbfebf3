// The planar graph that the visible pieces of lines make in the picture, and its regions.
//
// Its regions are those of constant *label*: the facets that are seen there, with the
// side from which they are seen; several facets only where they coincide.  Seams between
// facets of one patch are still edges here.

#pragma once

#include <vector>

#include "linespace/picture/picture_point.h"
#include "linespace/view/line_view.h"

namespace sightline::internal {

/// Facets seen in one region: 2 f for the front of facet f, 2 f + 1 for its back;
/// ascending.  Empty: the background.  Only kNoSight: sight runs into material there.
using FacetSides = std::vector<int>;
inline constexpr int kNoSight = -1;

/// Half-edge 2 e runs along edge e from its first end to its second, 2 e + 1 back.
struct ViewGraph {
  struct Edge {
    int line;
    std::array<int, 2> ends;  ///< positions in `points`, in the line's own order
    /// A face that is seen beside the edge and contains it, on the left and on the right;
    /// -1 where what is seen lies behind.
    std::array<int, 2> faces;
  };
  std::vector<PicturePoint> points;
  /// Of each of them the points of the scene that are seen there and end a piece,
  /// ascending.
  std::vector<std::vector<int>> scene_points;
  std::vector<Edge> edges;
  /// Of a half-edge: the next one around the region on its left, and that region.
  std::vector<int> next, region;
  std::vector<FacetSides> regions;
  int components = 0;  ///< of points and edges

  [[nodiscard]] int origin(int half_edge) const {
    return edges[half_edge / 2].ends[half_edge % 2];
  }
  [[nodiscard]] int left(int edge) const { return region[2 * edge]; }
  [[nodiscard]] int right(int edge) const { return region[2 * edge + 1]; }
};

/// Joins pieces that LineViewer found.
[[nodiscard]] ViewGraph join_pieces(const EyeSpace& eye, const EyeStar& star,
                                    const std::vector<LinePiece>& pieces,
                                    std::span<const std::uint8_t> possibly_seen);

}  // namespace sightline::internal
