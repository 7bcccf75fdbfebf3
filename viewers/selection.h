// Parts of a skeleton: the arcs between two groups, or through one.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "skeleton/skeleton.h"

namespace sightline::viewers {

/// Which arcs are wanted; all when both are empty.
struct Selection {
  /// Vertex on one group and edge on the other.
  std::optional<std::array<std::string, 2>> between;
  /// Vertex or edge on this group.
  std::optional<std::string> through;
};

/// The asked part of the skeleton, in the order of the whole one: its arcs, the nodes at
/// their ends, and the other nodes that touch the groups in the same way.  Throws
/// InvalidInput for unknown groups.
[[nodiscard]] Skeleton build_selected(const Scene& scene, const SkeletonRequest& request,
                                      const Selection& selection);

}  // namespace sightline::viewers
