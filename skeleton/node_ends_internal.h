// Nodes that several arcs find: whether they are nodes of solid mode, and which of their
// contacts end the line.

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "skeleton/skeleton.h"

namespace sightline::internal {

/// Keeps `end` and `ends` of a skeleton's nodes while it is built.  What arcs that graze
/// say of a node counts; only where none ends there, what the others say.
class NodeEnds {
 public:
  explicit NodeEnds(Skeleton& skeleton) : out_(skeleton) {}

  /// The last node of the skeleton is new; `grazes`: an arc of solid mode ends there.
  void add(bool grazes) { grazes_.push_back(grazes); }

  /// A node is found again, told with these generators.
  void found(std::uint32_t node, bool grazes, bool end, std::array<bool, 2> ends,
             std::span<const Generator> generators) {
    SkeletonNode& known = out_.nodes[node];
    if (out_.events == EventMode::Solid) {
      // From another contact of the line: that it ends at one of them counts.
      if (known.kind == NodeKind::Degenerate) known.end |= end;
      return;
    }
    if (grazes_[node] && !grazes) return;
    if (out_.generators(known).front() != generators.front()) std::swap(ends[0], ends[1]);
    if (grazes && !grazes_[node]) {
      known.end = end;
      known.ends = ends;
      grazes_[node] = 1;
      return;
    }
    known.end |= end;
    known.ends = {known.ends[0] || ends[0], known.ends[1] || ends[1]};
  }

  /// Polygon mode, once all are found: a degenerate line that grazes everywhere, but in
  /// which no arc of solid mode ends, is none of its nodes.
  void finish() {
    if (out_.events == EventMode::Solid) return;
    for (std::size_t i = 0; i < grazes_.size(); ++i) {
      SkeletonNode& node = out_.nodes[i];
      if (!grazes_[i] && node.kind == NodeKind::Degenerate) node.end = true;
      if (!node.end) node.ends = {};
    }
  }

 private:
  Skeleton& out_;
  std::vector<std::uint8_t> grazes_;
};

}  // namespace sightline::internal
