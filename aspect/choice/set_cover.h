// The fewest of some sets that together hold all elements, by branch and bound.

#pragma once

#include <cstddef>
#include <vector>

namespace sightline::internal {

struct SetCover {
  std::vector<int> sets;  ///< chosen, ascending
  std::size_t steps = 0;  ///< nodes of the search
  bool finished = true;   ///< no fewer will do
};

/// `sets`: of elements 0, ..., elements - 1, each ascending; every element is in one.
/// After `most_steps` the best so far is returned.  At least `lower` sets are known to be
/// needed.  Branches over the sets that hold the element held by fewest (Christofides and
/// Korman 1975); bounded by elements no two of which a set shares.
[[nodiscard]] SetCover least_cover(std::vector<std::vector<int>> sets, int elements,
                                   int lower, std::size_t most_steps);

}  // namespace sightline::internal
