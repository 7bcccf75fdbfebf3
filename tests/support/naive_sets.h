// Sets of small numbers, for the naive oracles.

#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace sightline::testing {

/// Disjoint sets of 0, ..., n - 1.
class Sets {
 public:
  explicit Sets(std::size_t n) : parent_(n) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int find(int i) const {
    while (parent_[i] != i) i = parent_[i];
    return i;
  }
  /// The smallest number stands for its set.
  void join(int i, int j) {
    const int a = find(i), b = find(j);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

template <class T>
[[nodiscard]] std::vector<T> sorted_set(std::vector<T> v) {
  std::ranges::sort(v);
  v.erase(std::ranges::unique(v).begin(), v.end());
  return v;
}

}  // namespace sightline::testing
