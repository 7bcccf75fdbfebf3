// The picture of a star for the lines from its corner to the points of an edge: where on
// the edge it changes, and whether the star leaves a gap in between.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "linespace/silhouettes/silhouettes.h"
#include "linespace/swaths/edge_cuts.h"

namespace sightline::internal {

/// The picture changes where the line lies in a plane of two rays of the star, and
/// nowhere else.  Keeps references.  Cost: the square of the number of rays.
class StarTurns {
 public:
  StarTurns(const Scene& scene, const Star& star, const Point& e0, const Point& e1);

  /// An end of the edge lies in the plane of two rays.  Then the rest is not told.
  [[nodiscard]] bool degenerate() const { return degenerate_; }
  /// Some pair of rays that is turned over has two faces between them.
  [[nodiscard]] bool doubled() const { return doubled_; }
  /// In order along the edge: Support where a face is edge-on, Saddle elsewhere.
  [[nodiscard]] std::span<const Cut> cuts() const { return cuts_; }
  /// Whether lines to the points between the cut `from` and the next cut pass the star:
  /// its faces, seen along such a line, leave some direction free.  To ask from the
  /// edge's start on, `from` is the start.  Example: a line that grazes a box's corner
  /// passes. Cost: the square of the number of rays, times that of faces.
  [[nodiscard]] bool leaves_gap(const Cut& from);

 private:
  struct Turn {
    Sign before, after;  // at the edge's ends
    Cut cut;
  };
  void add(std::size_t i, std::size_t j, const Point& e0, const Point& e1);
  [[nodiscard]] bool covered(std::size_t ray) const;

  const Scene& scene_;
  const Star& star_;
  LineThrough edge_;
  std::size_t rays_;
  bool degenerate_ = false, doubled_ = false;
  std::vector<Turn> turns_;         // of rays i < j, at i rays_ + j
  std::vector<std::int8_t> signs_;  // of all pairs, where last asked
  std::vector<Cut> cuts_;
};

}  // namespace sightline::internal
