// The horizon of a point with a normal: what lies at it or below is not seen.

#pragma once

#include "linespace/picture/eye_space.h"

namespace sightline::internal {

class Horizon {
 public:
  Horizon(ExactPoint eye, ExactPoint normal);

  [[nodiscard]] const ExactPoint& eye() const { return eye_; }
  [[nodiscard]] const ExactPoint& normal() const { return normal_; }
  /// Positive where the point lies above.
  [[nodiscard]] Sign above(const Point& x) const;
  [[nodiscard]] Rational height(const ExactPoint& x) const {
    return exact_dot(normal_, exact_difference(x, eye_));
  }

 private:
  ExactPoint eye_, normal_;
  LongVector rounded_eye_, rounded_normal_;  // each within 2^-62 of itself
};

}  // namespace sightline::internal
