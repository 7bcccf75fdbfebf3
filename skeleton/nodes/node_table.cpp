#include "skeleton/nodes/node_table.h"

#include <algorithm>
#include <functional>

#include "linespace/work/large_arrays.h"

namespace sightline::internal {
namespace {

constexpr std::size_t kSmallest = 64;

std::uint64_t mixed(std::uint64_t x) {  // SplitMix64 (Steele, Lea and Flood 2014)
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

}  // namespace

// The same for all orders of the generators.
std::uint32_t NodeTable::hash_of(NodeKind kind, std::span<const Generator> generators,
                                 std::string_view line) const {
  const std::uint64_t of_line = line.empty() ? 0 : std::hash<std::string_view>()(line);
  std::uint64_t sum = of_line << 8 | static_cast<std::uint64_t>(kind);
  for (const Generator& g : generators) {
    sum += mixed((static_cast<std::uint64_t>(g.kind) + 1) << 32 |
                 static_cast<std::uint32_t>(g.id));
  }
  return static_cast<std::uint32_t>(mixed(sum) >> 32) & hash_mask_;
}

std::string_view NodeTable::name_of(std::uint32_t node) const {
  const auto at = std::lower_bound(
      named_.begin(), named_.end(), node,
      [](const Named& named, std::uint32_t number) { return named.node < number; });
  if (at == named_.end() || at->node != node) return {};
  const std::size_t end = at + 1 == named_.end() ? names_.size() : (at + 1)->start;
  return std::string_view(names_).substr(at->start, end - at->start);
}

bool NodeTable::same_line(std::uint32_t number, const SkeletonNode& node,
                          std::span<const Generator> generators,
                          std::string_view line) const {
  const SkeletonNode& known = skeleton_.nodes[number];
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
      return known.second == node.second && (same || turned) && name_of(number) == line;
    default:
      return known.second == node.second && same;
  }
}

std::uint32_t NodeTable::find_or_add(const SkeletonNode& node,
                                     std::span<const Generator> generators,
                                     std::string_view line, std::uint32_t next) {
  if (2 * used_ >= places_.size()) grow();
  const std::uint32_t hash = hash_of(node.kind, generators, line);
  std::size_t at = home(hash);
  for (; places_[at].node != kFree; at = after(at)) {
    const Place& place = places_[at];
    if (place.hash == hash && same_line(place.node, node, generators, line)) {
      return place.node;
    }
  }
  places_[at] = {hash, next};
  ++used_;
  if (!line.empty()) {
    make_room(named_, 1);
    named_.push_back({next, names_.size()});
    names_.append(line);
  }
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
  named_.clear();
  names_.clear();
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
