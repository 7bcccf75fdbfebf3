// How many arcs a node of general position ends: the catalogue of either mode.

#pragma once

#include <optional>

#include "linespace/scene.h"
#include "skeleton/graph.h"

namespace sightline::internal {

/// EV and EEE arcs, each counted as often as it ends.
struct NodeStructure {
  int ev = 0, eee = 0;
};

/// What the catalogue (skeleton_index.h, docs/polygon_mode.md) says of a node; nullopt
/// for nodes that it does not speak of.
[[nodiscard]] std::optional<NodeStructure> node_structure(const Scene& scene,
                                                          const Skeleton& skeleton,
                                                          const SkeletonNode& node);

}  // namespace sightline::internal
