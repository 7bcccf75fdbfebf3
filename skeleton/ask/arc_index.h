// Which arcs a path of a viewpoint may cross: found in trees of boxes around the parts of
// their lines from which the generators are seen in line.

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "linespace/space/box_tree.h"
#include "skeleton/ask/viewing_part.h"

namespace sightline::internal {

/// Immutable; may be shared between threads.  Some 130 bytes an arc: five boxes
/// each, more only where arcs have more pieces.
class ArcIndex {
 public:
  ArcIndex(const Scene& scene, const Skeleton& skeleton, const EndIndex& ends);

  /// Numbers of arcs, ascending: all that ViewEvents may report on the
  /// segment from a to b, and others near it; nullopt where a point is so far out (2^20
  /// times the scene's size) that all may be.
  [[nodiscard]] std::optional<std::vector<std::uint32_t>> near(const Point& a,
                                                               const Point& b) const;

  [[nodiscard]] std::size_t boxes() const;
  [[nodiscard]] std::size_t bytes() const;

 private:
  Frame frame_;
  std::array<BoxTree, kCharts> trees_;
};

}  // namespace sightline::internal
