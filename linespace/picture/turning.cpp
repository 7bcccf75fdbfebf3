#include "linespace/picture/turning.h"

#include <algorithm>
#include <numeric>

namespace sightline::internal {

std::vector<std::size_t> order_around(const PicturePoint& at,
                                      std::span<const PicturePoint> far,
                                      std::span<const int> lines) {
  const auto turn = [&](std::size_t i, std::size_t j) {
    return lines[i] == lines[j] ? Sign::Zero : orient(at, far[i], far[j]);
  };
  // From the first: 0 itself, 1 less than half a turn, 2 half a turn, 3 more.
  std::vector<int> sector(far.size());
  for (std::size_t i = 1; i < far.size(); ++i) {
    const Sign s = turn(0, i);
    sector[i] = s == Sign::Positive ? 1 : s == Sign::Zero ? 2 : 3;
  }
  std::vector<std::size_t> order(far.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t i, std::size_t j) {
    if (sector[i] != sector[j]) return sector[i] < sector[j];
    return i != j && turn(i, j) == Sign::Positive;
  });
  return order;
}

}  // namespace sightline::internal
