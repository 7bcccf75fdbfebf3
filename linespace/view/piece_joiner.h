// From pieces of lines to the points and edges of a graph: ends that are one point become
// one, pieces are split where another ends on them, and doubles go.

#pragma once

#include <vector>

#include "linespace/picture/picture_point.h"
#include "linespace/view/line_view.h"

namespace sightline::internal {

/// An edge with what its piece said of its sides.
struct JoinedEdge {
  int line;
  std::array<int, 2> ends;
  int piece;  ///< the piece it is a part of
};

struct JoinedPieces {
  std::vector<PicturePoint> points;
  std::vector<std::vector<int>> scene_points;  ///< as in ViewGraph
  std::vector<JoinedEdge> edges;
};

/// Of several edges between the same two points one stays, unless all are to be kept.
enum class Doubles : std::uint8_t { Drop, Keep };
[[nodiscard]] JoinedPieces join_ends(const EyeSpace& eye,
                                     const std::vector<LinePiece>& pieces,
                                     Doubles doubles = Doubles::Drop);

}  // namespace sightline::internal
