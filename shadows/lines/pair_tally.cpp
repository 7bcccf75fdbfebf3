#include "shadows/lines/pair_tally.h"

#include <algorithm>
#include <tuple>

namespace sightline::internal {

void add_up(std::vector<PairCount>& counts) {
  std::ranges::sort(counts, [](const PairCount& a, const PairCount& b) {
    return std::tie(a.from, a.to) < std::tie(b.from, b.to);
  });
  std::size_t kept = 0;
  for (const PairCount& c : counts) {
    if (kept > 0 && counts[kept - 1].same_pair(c)) {
      counts[kept - 1].count += c.count;
      counts[kept - 1].squares += c.squares;
    } else {
      counts[kept++] = c;
    }
  }
  counts.resize(kept);
}

void PairTally::add(std::span<const PairCount> counts) {
  constexpr std::size_t kFewest = 1 << 18;
  waiting_.insert(waiting_.end(), counts.begin(), counts.end());
  if (waiting_.size() >= std::max(kFewest, sums_.size())) (void)sums();
}

const std::vector<PairCount>& PairTally::sums() {
  sums_.insert(sums_.end(), waiting_.begin(), waiting_.end());
  waiting_.clear();
  add_up(sums_);
  return sums_;
}

}  // namespace sightline::internal
