// The EEE part of a skeleton: all pairs of outer edges, joined into one graph.

#pragma once

#include <array>
#include <chrono>

#include "linespace/silhouettes/silhouettes.h"
#include "skeleton/graph.h"
#include "skeleton/nodes/node_joiner.h"
#include "skeleton/request.h"

namespace sightline::internal {

/// Adds the EEE arcs and their nodes to a skeleton that holds the EV part of the same
/// request, whose VEE and EVE nodes are shared.
void add_eee(const Silhouettes& silhouettes, const SkeletonRequest& request,
             const Deadline& deadline, Skeleton& skeleton, NodeJoiner& nodes);

}  // namespace sightline::internal
