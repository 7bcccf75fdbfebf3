// The exact line of a node, from its generators.

#pragma once

#include <array>
#include <optional>
#include <span>

#include "linespace/transversals.h"
#include "skeleton/graph.h"
#include "skeleton/nodes/node_contacts.h"

namespace sightline::internal {

/// A line by two different rational points, or, where it has none, by surds.
struct NodeLine {
  std::array<ExactPoint, 2> points;
  std::optional<ExactLine> irrational;
};

/// Two different points of a rational line, in the order of its orientation.
[[nodiscard]] std::array<ExactPoint, 2> points_of(const ExactLine& line);

/// The line that touches all the generators; nullopt where they leave it a choice
/// (Saddle nodes, and degenerate ones).  Of two lines through
/// the same edges it is the one nearer to the node's rounded segment.
[[nodiscard]] std::optional<NodeLine> line_of_node(const Scene& scene,
                                                   const Skeleton& skeleton,
                                                   const SkeletonNode& node);

}  // namespace sightline::internal
