// Which of n things are one: union-find.

#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace sightline::internal {

class Classes {
 public:
  explicit Classes(std::size_t n) : parent_(n) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  /// The smallest of the things that are one with x.
  int root(int x) {
    while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
    return x;
  }
  /// False when they were one already.
  bool join(int x, int y) {
    x = root(x);
    y = root(y);
    parent_[std::max(x, y)] = std::min(x, y);
    return x != y;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace sightline::internal
