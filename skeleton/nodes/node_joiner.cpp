#include "skeleton/nodes/node_joiner.h"

#include <array>
#include <utility>

#include "linespace/work/large_arrays.h"

namespace sightline::internal {

std::uint32_t NodeJoiner::join_in(NodeTable& table, const SkeletonNode& node,
                                  std::span<const Generator> generators, bool grazes,
                                  std::string_view line) {
  const auto next = static_cast<std::uint32_t>(out_.nodes.size());
  const std::uint32_t known = table.find_or_add(node, generators, line, next);
  if (known == next) return add(node, generators, grazes);
  found_again(known, node, generators, grazes);
  return known;
}

std::uint32_t NodeJoiner::add(SkeletonNode node, std::span<const Generator> generators,
                              bool grazes) {
  node.first_generator = static_cast<std::uint32_t>(out_.generator_pool.size());
  node.generator_count = static_cast<std::uint32_t>(generators.size());
  make_room(out_.generator_pool, generators.size());
  out_.generator_pool.insert(out_.generator_pool.end(), generators.begin(),
                             generators.end());
  if (node.kind == NodeKind::VV && generators[1] < generators[0]) {
    // One direction, whichever end it was found from.
    std::iter_swap(out_.generator_pool.end() - 2, out_.generator_pool.end() - 1);
    std::swap(node.segment[0], node.segment[1]);
    std::swap(node.ends[0], node.ends[1]);
  }
  make_room(out_.nodes, 1);
  out_.nodes.push_back(node);
  grazes_.push_back(grazes);
  return static_cast<std::uint32_t>(out_.nodes.size() - 1);
}

void NodeJoiner::add_if_new(const SkeletonNode& node,
                            std::span<const Generator> generators,
                            std::string_view line) {
  const auto next = static_cast<std::uint32_t>(out_.nodes.size());
  if (lines_.find_or_add(node, generators, line, next) == next)
    add(node, generators, true);
}

void NodeJoiner::found_again(std::uint32_t number, const SkeletonNode& node,
                             std::span<const Generator> generators, bool grazes) {
  SkeletonNode& known = out_.nodes[number];
  if (out_.events == EventMode::Solid) {
    // From another contact of the line: that it ends at one of them counts.
    if (known.kind == NodeKind::Degenerate || known.kind == NodeKind::EEEE)
      known.end |= node.end;
    return;
  }
  if (grazes_[number] && !grazes) return;
  std::array<bool, 2> ends = node.ends;
  if (out_.generators(known).front() != generators.front()) std::swap(ends[0], ends[1]);
  if (grazes && !grazes_[number]) {
    known.end = node.end;
    known.ends = ends;
    grazes_[number] = 1;
    return;
  }
  known.end |= node.end;
  known.ends = {known.ends[0] || ends[0], known.ends[1] || ends[1]};
}

void NodeJoiner::finish_ends() {
  if (out_.events == EventMode::Solid) return;
  for (std::size_t i = 0; i < grazes_.size(); ++i) {
    SkeletonNode& node = out_.nodes[i];
    if (!grazes_[i] && node.kind == NodeKind::Degenerate) node.end = true;
    if (!node.end) node.ends = {};
  }
}

}  // namespace sightline::internal
