#include <algorithm>

#include "skeleton/large_arrays_internal.h"
#include "skeleton/node_table_internal.h"

namespace sightline::internal {
namespace {

constexpr std::size_t kSmallest = 64;

// The same for all orders of the generators.
std::uint32_t hash_of(NodeKind kind, std::span<const Generator> generators,
                      std::uint32_t line = 0) {
  const auto mixed = [](std::uint64_t x) {  // SplitMix64 (Steele, Lea and Flood 2014)
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
  };
  std::uint64_t sum = std::uint64_t{line} << 8 | static_cast<std::uint64_t>(kind);
  for (const Generator& g : generators) {
    sum += mixed((static_cast<std::uint64_t>(g.kind) + 1) << 32 |
                 static_cast<std::uint32_t>(g.id));
  }
  return static_cast<std::uint32_t>(mixed(sum) >> 32);
}

}  // namespace

bool NodeTable::same_line(const SkeletonNode& known, const SkeletonNode& node,
                          std::span<const Generator> generators) const {
  if (known.kind != node.kind) return false;
  const auto own = skeleton_.generators(known);
  const bool same =
      std::equal(own.begin(), own.end(), generators.begin(), generators.end());
  const bool turned =
      std::equal(own.begin(), own.end(), generators.rbegin(), generators.rend());
  const bool same_end = skeleton_.events == EventMode::Polygon || known.end == node.end;
  switch (node.kind) {
    case NodeKind::VV:
      return same_end && (same || turned);
    case NodeKind::FvE:
      return same_end && std::is_permutation(own.begin(), own.end(), generators.begin(),
                                             generators.end());
    case NodeKind::Degenerate:
      return known.second == node.second && (same || turned);
    default:
      return known.second == node.second && same;
  }
}

std::uint32_t NodeTable::find_or_add(const SkeletonNode& node,
                                     std::span<const Generator> generators,
                                     std::uint32_t line, std::uint32_t next) {
  if (2 * used_ >= places_.size()) grow();
  const std::uint32_t hash = hash_of(node.kind, generators, line);
  std::size_t at = home(hash);
  for (; places_[at].node != kFree; at = after(at)) {
    const Place& place = places_[at];
    if (place.hash == hash && same_line(skeleton_.nodes[place.node], node, generators)) {
      return place.node;
    }
  }
  places_[at] = {hash, next};
  ++used_;
  return next;
}

void NodeTable::expect(NodeKind kind, std::span<const Generator> generators) const {
  if (places_.empty()) return;
  __builtin_prefetch(&places_[home(hash_of(kind, generators))]);
}

void NodeTable::expect_known(NodeKind kind, std::span<const Generator> generators) const {
  if (places_.empty()) return;
  const std::uint32_t hash = hash_of(kind, generators);
  const Place& place = places_[home(hash)];
  if (place.hash == hash && place.node < skeleton_.nodes.size()) {
    __builtin_prefetch(&skeleton_.nodes[place.node]);
  }
}

void NodeTable::clear() {
  if (used_ == 0) return;
  // Else one that was large once would cost as much to clear ever after.
  if (16 * used_ < places_.size()) places_.resize(places_.size() / 4);
  std::fill(places_.begin(), places_.end(), Place());
  used_ = 0;
}

void NodeTable::grow() {
  std::vector<Place> old;
  old.swap(places_);
  const std::size_t size = std::max(kSmallest, 2 * old.size());
  make_room(places_, size);
  places_.resize(size);
  for (const Place& place : old) {
    if (place.node == kFree) continue;
    std::size_t at = home(place.hash);
    while (places_[at].node != kFree) at = after(at);
    places_[at] = place;
  }
}

}  // namespace sightline::internal
