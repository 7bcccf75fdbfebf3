// The views of corners that are near each other, group by group of edges: what is between
// a group and one of them is mostly what is between it and the others, and listed once.

#pragma once

#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "linespace/blockers/surroundings.h"
#include "skeleton/build/vertex_view.h"
#include "skeleton/nodes/known_lines.h"

namespace sightline::internal {

/// Cuts stars into runs to look from at once: few, all of one object.
[[nodiscard]] std::vector<std::span<const int>> near_each_other(
    const Silhouettes& silhouettes, std::span<const int> stars);

/// Keeps scratch, so one per thread.
class CornerViews {
 public:
  /// As VertexViewer.
  CornerViews(const Silhouettes& silhouettes, const EvPart& part,
              const SkeletonLines* lines, double feature_size);

  /// The view of each star, the same whichever come together; breaks off, with some of
  /// their arcs, once `stop` says so.
  [[nodiscard]] std::vector<VertexView> views(std::span<const int> stars,
                                              const std::function<bool()>& stop);

 private:
  const Silhouettes& g_;
  const EvPart& part_;
  const SkeletonLines* lines_;
  double feature_size_;
  Surroundings around_;
  KnownLines known_;
  std::deque<VertexViewer> viewers_;
};

}  // namespace sightline::internal
