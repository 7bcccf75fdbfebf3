// What tells a node from all others, for joining those that several parts find.

#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "skeleton/skeleton.h"

namespace sightline::internal {

/// A node of at most four generators, Degenerate ones aside.
struct LineKey {
  std::array<std::int32_t, 4> ids{-1, -1, -1, -1};
  std::uint32_t tag = 0;
  friend bool operator==(const LineKey&, const LineKey&) = default;
};

struct LineHash {
  std::size_t operator()(const LineKey& k) const {
    std::uint64_t h = k.tag;
    for (const std::int32_t id : k.ids) {
      h = (h ^ static_cast<std::uint32_t>(id)) * 0x9e3779b97f4a7c15u;
      h ^= h >> 29;
    }
    return h;
  }
};

/// By kind, generators in order, which of them are faces, and which of two lines.
[[nodiscard]] inline LineKey line_key(NodeKind kind, bool second,
                                      std::span<const Generator> generators) {
  LineKey key;
  key.tag = static_cast<std::uint32_t>(kind) | (second ? 256u : 0u);
  for (std::size_t i = 0; i < generators.size() && i < key.ids.size(); ++i) {
    key.ids[i] = generators[i].id;
    if (generators[i].kind == GeneratorKind::Face) key.tag |= 1024u << i;
  }
  return key;
}

/// Of an FvE node, told from its vertex or from its edge: by its vertex, edge and facet.
[[nodiscard]] inline LineKey face_line_key(bool end,
                                           std::span<const Generator> generators) {
  LineKey key;
  key.tag = static_cast<std::uint32_t>(NodeKind::FvE) | (end ? 256u : 0u);
  for (const Generator& x : generators) key.ids[static_cast<std::size_t>(x.kind)] = x.id;
  return key;
}

}  // namespace sightline::internal
