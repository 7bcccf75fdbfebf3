// The tree of ridges cut into groups of neighbours, which share what is listed for them.

#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "linespace/space/bvh.h"

namespace sightline::internal {

struct RidgeGroup {           // by node of the tree
  std::int32_t highest = -1;  // of the ridges below
  bool begins = false;        // those below are a group
};

/// Groups of at most `largest`, save where a leaf has more.
[[nodiscard]] inline std::vector<RidgeGroup> ridge_groups(const Bvh& tree, int largest) {
  std::vector<RidgeGroup> groups(tree.nodes().size());
  std::vector<int> sizes(groups.size(), 0);
  // Children have higher numbers than their parent.
  for (std::size_t i = groups.size(); i-- > 0;) {
    const Bvh::Node& node = tree.node(static_cast<std::uint32_t>(i));
    groups[i].begins = true;
    if (node.count == 0) {
      sizes[i] = sizes[node.first] + sizes[node.first + 1];
      groups[i].begins = sizes[i] <= largest;
      for (const std::uint32_t child : {node.first, node.first + 1}) {
        if (groups[i].begins) groups[child].begins = false;
        groups[i].highest = std::max(groups[i].highest, groups[child].highest);
      }
      continue;
    }
    sizes[i] = static_cast<int>(node.count);
    for (std::uint32_t k = 0; k < node.count; ++k) {
      groups[i].highest = std::max(
          groups[i].highest, static_cast<std::int32_t>(tree.items()[node.first + k]));
    }
  }
  return groups;
}

}  // namespace sightline::internal
