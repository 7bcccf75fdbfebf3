// A convex polygon or polyhedron of the scene: its corners, sides and the planes of its
// faces.

#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "linespace/light/source_patches.h"
#include "linespace/scene.h"

namespace sightline::internal {

struct ConvexBody {
  struct Corner {
    Point at;
    int point;  ///< id
  };
  struct Side {
    std::array<int, 2> ends;  ///< positions in `corners`
    int edge;                 ///< scene edge id; -1: none, as of a diagonal
  };
  struct Plane {
    std::array<Point, 3> points;  ///< counter-clockwise seen from outside
    int facet;
  };
  /// All corners of a closed body's faces, also such as lie on a side.
  std::vector<Corner> corners;
  std::vector<Side> sides;
  /// Of a polygon two: the first in front.
  std::vector<Plane> planes;
  bool flat = false;
};

/// The body that the faces make.  side: on which the front of a polygon is.
/// `what` names it in messages: "the source", "the solid".  Throws InvalidInput where
/// they are neither one convex polygon nor all faces of a closed convex object.
[[nodiscard]] ConvexBody convex_body(const Scene& scene, std::span<const int> faces,
                                     FaceSide side, const std::string& what);

}  // namespace sightline::internal
