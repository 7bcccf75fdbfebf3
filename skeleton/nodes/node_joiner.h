// Gives a skeleton its nodes, one for each line however often it is found, and settles
// what those who find it say of its ends.

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "skeleton/graph.h"
#include "skeleton/nodes/node_table.h"

namespace sightline::internal {

class NodeJoiner {
 public:
  /// Keeps a reference, whose nodes and generators come from here alone.
  explicit NodeJoiner(Skeleton& skeleton, std::uint32_t hash_mask = NodeTable::kAllBits)
      : out_(skeleton), lines_(skeleton, hash_mask), eeee_(skeleton, hash_mask) {}

  /// The number of the line's node.  A new line gets `node` as its node, with its own
  /// place in the generator pool.  `grazes`: an arc of solid mode ends in the line.  If
  /// any such arc does, only what these arcs say of `end` and `ends` counts; else what
  /// the others say.  `line` is NodeContacts::line.
  std::uint32_t join(const SkeletonNode& node, std::span<const Generator> generators,
                     bool grazes, std::string_view line = {}) {
    return join_in(lines_, node, generators, grazes, line);
  }
  /// The same of an EEEE line that is not found again once forget_eeee() was called.
  std::uint32_t join_eeee(const SkeletonNode& node, std::span<const Generator> generators,
                          bool grazes) {
    return join_in(eeee_, node, generators, grazes, {});
  }
  /// The same of a line that is found but once.
  std::uint32_t add(SkeletonNode node, std::span<const Generator> generators,
                    bool grazes);
  /// Calls join(i) for i = 0, ..., count - 1, which is to join a node of the kind and
  /// generators that name(i) tells as a pair; faster than one by one where many are
  /// known.
  template <class Name, class Join>
  void join_each(std::size_t count, Name&& name, Join&& join) {
    constexpr std::size_t kAhead = 64;
    for (std::size_t first = 0; first < count; first += kAhead) {
      const std::size_t end = std::min(count, first + kAhead);
      for (std::size_t i = first; i < end; ++i) {
        const auto [kind, generators] = name(i);
        table_of(kind).expect(kind, generators);
      }
      for (std::size_t i = first; i < end; ++i) {
        const auto [kind, generators] = name(i);
        table_of(kind).expect_known(kind, generators);
      }
      for (std::size_t i = first; i < end; ++i) join(i);
    }
  }

  /// Adds the node if its line is new.
  void add_if_new(const SkeletonNode& node, std::span<const Generator> generators,
                  std::string_view line);
  /// From now on join_eeee() is not called with a line that was told it before.
  void forget_eeee() { eeee_.clear(); }

  /// Once all arcs are found.  In polygon mode a degenerate line that grazes everywhere,
  /// but in which no arc of solid mode ends, is none of its nodes.
  void finish_ends();

 private:
  /// Where a node of this kind is looked for first.
  [[nodiscard]] NodeTable& table_of(NodeKind kind) {
    return kind == NodeKind::EEEE ? eeee_ : lines_;
  }
  std::uint32_t join_in(NodeTable& table, const SkeletonNode& node,
                        std::span<const Generator> generators, bool grazes,
                        std::string_view line);
  void found_again(std::uint32_t number, const SkeletonNode& node,
                   std::span<const Generator> generators, bool grazes);

  Skeleton& out_;
  NodeTable lines_, eeee_;
  std::vector<std::uint8_t> grazes_;  // by node
};

}  // namespace sightline::internal
