#include "skeleton/end_index.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include "linespace/work/parallel.h"
#include "skeleton/skeleton_lines.h"

namespace sightline {
namespace {

std::uint64_t key_of(std::int32_t a, std::int32_t b) {
  const auto [low, high] = std::minmax(a, b);
  return (static_cast<std::uint64_t>(low + 1) << 32) |
         static_cast<std::uint32_t>(high + 1);
}

// Ids of the facets of some faces, kOutside for none; ascending.
std::vector<std::int32_t> facets_of(const Scene& scene, const std::vector<int>& faces) {
  if (faces.empty()) return {kOutside};
  std::vector<std::int32_t> facets;
  for (const int f : faces) facets.push_back(scene.faces()[f].facet);
  std::sort(facets.begin(), facets.end());
  facets.erase(std::unique(facets.begin(), facets.end()), facets.end());
  return facets;
}

using Ends = std::vector<SkeletonLines::EndPiece>;

}  // namespace

EndIndex::EndIndex(const Scene& scene, const Skeleton& skeleton, const Request& request)
    : skeleton_(skeleton) {
  const internal::Deadline deadline(request);
  std::optional<SkeletonLines> lines;
  try {
    lines.emplace(scene, request);
  } catch (const Stopped&) {  // nothing is found then: not complete
  }
  const std::size_t count = skeleton.arcs.size();
  constexpr std::size_t kArcsAtOnce = 64;
  std::vector<Entry> by_facets, by_objects, by_facet;
  piece_starts_.assign(1, 0);

  const auto object_of = [&](std::int32_t facet) {
    return facet == kOutside ? kOutside : scene.facets()[facet].object;
  };
  const auto add = [&](std::uint32_t arc, const Ends& ends) {
    const std::size_t first = pieces_.size();
    for (const auto& end : ends) {
      const auto before = facets_of(scene, end.faces[0]);
      const auto beyond = facets_of(scene, end.faces[1]);
      for (const std::int32_t a : before) {
        by_facet.push_back({key_of(kOutside, a), arc});
        for (const std::int32_t b : beyond) {
          by_facets.push_back({key_of(a, b), arc});
          by_objects.push_back({key_of(object_of(a), object_of(b)), arc});
        }
      }
      for (const std::int32_t b : beyond) {
        by_facet.push_back({key_of(kOutside, b), arc});
      }
      const std::array<std::int32_t, 2> facets{before.front(), beyond.front()};
      if (pieces_.size() > first && pieces_.back().facets == facets) continue;
      pieces_.push_back({end.range[0], facets});
    }
    piece_starts_.push_back(static_cast<std::uint32_t>(pieces_.size()));
    bounds_all_.push_back(!ends.empty() && ends.front().bounds_all);
  };

  struct Nothing {};
  StageCounts counts;
  internal::for_each_parallel(
      lines ? (count + kArcsAtOnce - 1) / kArcsAtOnce : 0, request, deadline, "far ends",
      counts, [] { return std::make_unique<Nothing>(); },
      [&](Nothing&, std::size_t batch) {
        std::vector<Ends> found;
        const std::size_t from = batch * kArcsAtOnce;
        for (std::size_t i = from; i < std::min(count, from + kArcsAtOnce); ++i) {
          found.push_back(lines->ends(skeleton.arcs[i]));
        }
        return found;
      },
      [&](std::size_t batch, std::vector<Ends>&& found) {
        for (std::size_t k = 0; k < found.size(); ++k) {
          add(static_cast<std::uint32_t>(batch * kArcsAtOnce + k), found[k]);
        }
        return true;
      });
  complete_ = piece_starts_.size() == count + 1;
  piece_starts_.resize(count + 1, static_cast<std::uint32_t>(pieces_.size()));
  bounds_all_.resize(count, false);
  pieces_.shrink_to_fit();
  facet_pairs_ = grouped(by_facets);
  object_pairs_ = grouped(by_objects);
  facets_ = grouped(by_facet);
}

EndIndex::Pairs EndIndex::grouped(std::vector<Entry>& entries) {
  std::sort(entries.begin(), entries.end());
  entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
  Pairs out;
  out.arcs.reserve(entries.size());
  for (const Entry& entry : entries) {
    if (out.keys.empty() || out.keys.back() != entry.key) {
      out.keys.push_back(entry.key);
      out.starts.push_back(static_cast<std::uint32_t>(out.arcs.size()));
    }
    out.arcs.push_back(entry.arc);
  }
  out.starts.push_back(static_cast<std::uint32_t>(out.arcs.size()));
  return out;
}

std::span<const std::uint32_t> EndIndex::Pairs::find(std::int32_t a,
                                                     std::int32_t b) const {
  const std::uint64_t key = key_of(a, b);
  const auto at = std::lower_bound(keys.begin(), keys.end(), key);
  if (at == keys.end() || *at != key) return {};
  const auto k = static_cast<std::size_t>(at - keys.begin());
  return {arcs.data() + starts[k], starts[k + 1] - starts[k]};
}

std::span<const std::uint32_t> EndIndex::seen_from(std::int32_t facet) const {
  return facets_.find(kOutside, facet);
}

std::span<const EndIndex::Piece> EndIndex::pieces(std::uint32_t arc) const {
  return {pieces_.data() + piece_starts_[arc],
          piece_starts_[arc + 1] - piece_starts_[arc]};
}

double EndIndex::end_of(std::uint32_t arc, std::size_t piece) const {
  const auto all = pieces(arc);
  if (piece + 1 < all.size()) return all[piece + 1].from;
  return skeleton_.arcs[arc].range[1];
}

std::size_t EndIndex::bytes() const {
  std::size_t sum = sizeof *this + piece_starts_.capacity() * sizeof(std::uint32_t) +
                    pieces_.capacity() * sizeof(Piece) + bounds_all_.capacity() / 8;
  for (const Pairs* pairs : {&facet_pairs_, &object_pairs_, &facets_}) {
    sum += pairs->keys.capacity() * sizeof(std::uint64_t) +
           pairs->starts.capacity() * sizeof(std::uint32_t) +
           pairs->arcs.capacity() * sizeof(std::uint32_t);
  }
  return sum;
}

}  // namespace sightline
