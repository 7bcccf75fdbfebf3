// Which edges of a view lie opposite each other: a line through the viewpoint may meet
// both, one before it and one behind.  All arcs of a view are asked for all others, so
// they are found by a tree over their directions.  In bounded doubles: what is left out
// is proved to be.

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "linespace/bvh_internal.h"
#include "skeleton/shaft_internal.h"

namespace sightline::internal {

class OppositeEdges {
 public:
  OppositeEdges(const Point& viewpoint, std::span<const std::array<Point, 2>> edges);

  /// Replaces `found` by the edges of higher number that may lie opposite edge i,
  /// ascending.
  void above(std::size_t i, std::vector<std::uint32_t>& found) const;

 private:
  Point at_;
  std::span<const std::array<Point, 2>> edges_;
  std::vector<Box> boxes_;  // of their directions
  Bvh tree_;
};

}  // namespace sightline::internal
