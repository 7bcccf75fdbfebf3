#include "shadows/seen/horizon.h"

#include <cmath>
#include <utility>

namespace sightline::internal {

Horizon::Horizon(ExactPoint eye, ExactPoint normal)
    : eye_(std::move(eye)), normal_(std::move(normal)) {
  for (int i = 0; i < 3; ++i) {
    rounded_eye_[i] = long_double(eye_[i]);
    rounded_normal_[i] = long_double(normal_[i]);
  }
}

Sign Horizon::above(const Point& x) const {
  long double value = 0, size = 0;
  for (int i = 0; i < 3; ++i) {
    value += rounded_normal_[i] * (x[i] - rounded_eye_[i]);
    size += std::abs(rounded_normal_[i]) * (std::abs(x[i]) + std::abs(rounded_eye_[i]));
  }
  // Each factor is off by 2^-62 of itself, and so are difference, product and sums.
  if (std::abs(value) > 0x1p-58L * size)
    return value > 0 ? Sign::Positive : Sign::Negative;
  return static_cast<Sign>(height(exact_point(x)).sign());
}

}  // namespace sightline::internal
