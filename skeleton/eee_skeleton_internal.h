// The EEE part of a skeleton: all pairs of outer edges, joined into one graph.

#pragma once

#include <array>
#include <chrono>

#include "skeleton/generators_internal.h"
#include "skeleton/node_joiner_internal.h"
#include "skeleton/skeleton.h"

namespace sightline::internal {

/// Adds the EEE arcs and their nodes to a skeleton that holds the EV part of the same
/// request, whose VEE and EVE nodes are shared.
void add_eee(const Generators& generators, const SkeletonRequest& request,
             const Deadline& deadline, Skeleton& skeleton, NodeJoiner& nodes);

}  // namespace sightline::internal
