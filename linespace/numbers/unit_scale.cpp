#include "linespace/numbers/unit_scale.h"

#include <algorithm>
#include <cmath>

namespace sightline::internal {

void UnitScale::add(std::span<const Point> points) {
  for (const Point& p : points) {
    for (const double x : p) {
      const double size = std::abs(x);
      if (size == 0) continue;
      largest_ = std::max(largest_, size);
      smallest_ = smallest_ == 0 ? size : std::min(smallest_, size);
    }
  }
}

int UnitScale::exponent() const {
  if (largest_ == 0) return 0;
  int of_largest, of_smallest, of_limit;
  std::frexp(largest_, &of_largest);
  std::frexp(smallest_, &of_smallest);
  std::frexp(kSmallestCoordinate, &of_limit);
  return std::max(-of_largest, of_limit - of_smallest);
}

Point scaled(const Point& p, int exponent) {
  return {std::ldexp(p.x(), exponent), std::ldexp(p.y(), exponent),
          std::ldexp(p.z(), exponent)};
}

}  // namespace sightline::internal
