// How often pairs were found, for many pairs, in little memory.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace sightline::internal {

/// From surface `from` to `to`, which may be one of Elsewhere or kSky; of one line, or
/// summed up over many.
struct PairCount {
  std::int32_t from, to;
  std::int64_t count;
  std::int64_t squares;  ///< sum of the squared counts of single lines

  [[nodiscard]] bool same_pair(const PairCount& other) const {
    return from == other.from && to == other.to;
  }
};

/// Sorts by pairs and adds up counts of the same.
void add_up(std::vector<PairCount>& counts);

/// Sums of all that was added, in any order: whole numbers, so that order does not
/// matter.
class PairTally {
 public:
  void add(std::span<const PairCount> counts);
  /// By pairs, ascending.
  [[nodiscard]] const std::vector<PairCount>& sums();

 private:
  std::vector<PairCount> sums_, waiting_;
};

}  // namespace sightline::internal
