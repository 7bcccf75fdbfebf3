// The nodes of a skeleton by what determines their lines.

#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "skeleton/graph.h"

namespace sightline::internal {

/// A node is told from others by its kind and generators: of VV and Degenerate from
/// either end, of FvE in any order; of EEEE and Degenerate also by `second`; of VV and
/// FvE in solid mode by `end`; of Degenerate by the whole NodeContacts::line.
///
/// Open addressing with eight bytes a place, probed one after the other: skeletons have
/// tens of millions of nodes.  What determines a node is read from the skeleton itself,
/// but for the names of lines, which are kept here: for each Degenerate node 16 bytes and
/// its name, 17 bytes in a grid of whole numbers, 47 in a city of doubles (300 polygons
/// each).  A hash only says where to look: nodes with the same one are compared.
class NodeTable {
 public:
  static constexpr std::uint32_t kAllBits = 0xffffffff;
  /// Keeps a reference, to which nodes are only appended.  Of hashes the bits in the mask
  /// are used: all but in tests.
  explicit NodeTable(const Skeleton& skeleton, std::uint32_t hash_mask = kAllBits)
      : skeleton_(skeleton), hash_mask_(hash_mask) {}

  /// The number of the node that is known to be of this line; the first time `next`, the
  /// number of the node that is appended then.
  [[nodiscard]] std::uint32_t find_or_add(const SkeletonNode& node,
                                          std::span<const Generator> generators,
                                          std::string_view line, std::uint32_t next);
  void clear();

  /// Hints that a node will be asked for: to fetch its place, and then, a while later,
  /// what is known there, as both are far apart in memory.
  void expect(NodeKind kind, std::span<const Generator> generators) const;
  void expect_known(NodeKind kind, std::span<const Generator> generators) const;

 private:
  static constexpr std::uint32_t kFree = 0xffffffff;
  struct Place {
    std::uint32_t hash = 0, node = kFree;
  };

  [[nodiscard]] bool same_line(std::uint32_t number, const SkeletonNode& node,
                               std::span<const Generator> generators,
                               std::string_view line) const;
  [[nodiscard]] std::uint32_t hash_of(NodeKind kind,
                                      std::span<const Generator> generators,
                                      std::string_view line = {}) const;
  [[nodiscard]] std::string_view name_of(std::uint32_t node) const;
  /// Where to look first: in the order of hashes, so that growing goes from front to
  /// back.
  [[nodiscard]] std::size_t home(std::uint32_t hash) const {
    return static_cast<std::size_t>((hash * std::uint64_t{places_.size()}) >> 32);
  }
  [[nodiscard]] std::size_t after(std::size_t place) const {
    return place + 1 < places_.size() ? place + 1 : 0;
  }
  void grow();

  const Skeleton& skeleton_;
  std::uint32_t hash_mask_;
  std::vector<Place> places_;
  std::size_t used_ = 0;
  /// Nodes whose lines have names, ascending, and where these begin in `names_`.
  struct Named {
    std::uint32_t node;
    std::size_t start;
  };
  std::vector<Named> named_;
  std::string names_;
};

}  // namespace sightline::internal
