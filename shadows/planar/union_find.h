// Disjoint sets of the numbers 0, ..., n - 1.

#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace sightline::internal {

class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  /// The smallest number of the set.
  [[nodiscard]] int find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(int i, int j) {
    const int a = find(i), b = find(j);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

}  // namespace sightline::internal
