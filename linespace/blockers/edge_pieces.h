// A long edge cut into pieces: few occluders hide something from all of it, and much lies
// between it and anything else.  For culling only: a piece is told by boxes around its
// ends.

#pragma once

#include <array>
#include <vector>

#include "linespace/silhouettes/silhouettes.h"
#include "linespace/space/shaft.h"

namespace sightline::internal {

/// A piece of an edge, or all of it.
struct EdgePiece {
  /// On the edge, as parameters from its first point (0) to its second (1).
  double from = 0, to = 1;
  /// Boxes around the two ends: the piece is in their hull.  Points, exactly, at vertices
  /// and on edges parallel to an axis (where they may be a little apart from the ends,
  /// outwards); else a few units in the last place wide.
  std::array<Box, 2> ends;

  /// A point of the box around an end.
  [[nodiscard]] Point point(int k) const {
    return {ends[k].min[0], ends[k].min[1], ends[k].min[2]};
  }
  /// How far other points of these boxes are from these, in each coordinate, at most.
  [[nodiscard]] std::array<double, 3> pad() const;
  /// Of both boxes, each once: the hull of these holds the piece.
  [[nodiscard]] std::vector<Point> corners() const;
};

/// The piece of the edge p0 p1 between two parameters, multiples of 1/64.
[[nodiscard]] EdgePiece piece_of(const Point& p0, const Point& p1, double from,
                                 double to);

/// Into how many pieces, of equal length, an edge is cut: powers of two up to 64.
class EdgeCutter {
 public:
  /// Compares with the usual length of the scene's ridges.
  explicit EdgeCutter(const Silhouettes& silhouettes);
  [[nodiscard]] int pieces(const Point& p0, const Point& p1) const;

 private:
  double usual_;
};

}  // namespace sightline::internal
