// Polygon mode by the rule of docs/polygon_mode.md ("One rule"), for scenes of
// axis-parallel rectangles: what a line's end meets is read off the eight octants around
// it, so that solids and sheets may touch, overlap and share edges.  Shares no code with
// the library.

#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "linespace/scene.h"
#include "tests/support/exact.h"

namespace sightline::testing {

class GridScene {
 public:
  /// Groups whose name begins with "sheet" are open, all others solid inside.  Throws
  /// std::invalid_argument when a face is no axis-parallel rectangle.
  explicit GridScene(const PolygonSoup& soup);
  ~GridScene();
  GridScene(GridScene&&) noexcept;

  enum class Met { None, Graze, End };
  /// Looking from x along d at a corner x; at a point x inside an edge along that axis.
  /// None: from inside, or nothing is drawn there.  No component of d may be zero.
  [[nodiscard]] Met at_corner(const Vec3& x, const Vec3& d) const;
  /// `own`: points of the edge's own faces, off it; None where none of these is seen.
  [[nodiscard]] Met at_edge(const Vec3& x, int axis, const Vec3& d,
                            const std::vector<Point>& own) const;
  /// No face meets the open segment; nullopt when it touches some side of a face, or is
  /// parallel to an axis plane.  `passing`: a point inside an edge, which may be touched.
  [[nodiscard]] std::optional<bool> is_free(const Vec3& a, const Vec3& b,
                                            const Vec3* passing = nullptr) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sightline::testing
