// The lines from a point, or from the points of a segment, to a source: which boxes and
// edges they certainly miss, before the point and beyond it.

#pragma once

#include <array>
#include <span>
#include <vector>

#include "linespace/scene.h"
#include "linespace/space/bvh.h"

namespace sightline::internal {

/// Rounded, with margins that make "misses" a proof.
class SourceShaft {
 public:
  /// `hull`: a convex polygon around the source, counter-clockwise seen from the segment
  /// from..to; the two are the same for a point.  `size`: of the scene.
  SourceShaft(const Point& from, const Point& to, std::span<const Point> hull,
              double size);

  /// Some line from the segment to the source may meet it: between the two, or beyond the
  /// segment as seen from the source.
  [[nodiscard]] bool may_meet_before(const Box& box) const;
  [[nodiscard]] bool may_meet_beyond(const Box& box) const;
  [[nodiscard]] bool may_meet_before(const Point& p, const Point& q) const;
  [[nodiscard]] bool may_meet_beyond(const Point& p, const Point& q) const;

 private:
  // Through a side of the hull and an end of the segment; positive on the hull's side.
  struct Side {
    Point normal, base;
    double margin;
  };
  // By side of the hull, by end.
  std::vector<std::array<Side, 2>> sides_;
};

}  // namespace sightline::internal
