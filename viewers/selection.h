// Parts of a skeleton: the arcs between two groups, or through one.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "skeleton/graph.h"
#include "skeleton/request.h"

namespace sightline::viewers {

/// Which arcs are wanted; all when both are empty.
struct Selection {
  /// EV: vertex on one group and edge on the other; EEE: outer edges one on each.
  std::optional<std::array<std::string, 2>> between;
  /// Lines that meet this group.  EV: vertex or edge on it, or some lines that end on it;
  /// EEE: any of the three edges; FF: one of the two facets.
  std::optional<std::string> through;
};

/// The asked part of the skeleton, of the kinds in the request: its arcs in the order of
/// the whole one, the nodes at their ends, and those where two of its EV arcs line up
/// through a corner.  Nodes are numbered anew.  Throws InvalidInput for unknown groups.
[[nodiscard]] Skeleton build_selected(const Scene& scene, const SkeletonRequest& request,
                                      const Selection& selection);

}  // namespace sightline::viewers
