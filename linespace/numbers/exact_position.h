// Exact points for whoever asked.

#pragma once

#include "linespace/exact_position.h"
#include "linespace/numbers/rational.h"

namespace sightline::internal {

[[nodiscard]] inline ExactPosition exact_position(const ExactPoint& p) {
  ExactPosition out;
  for (int axis = 0; axis < 3; ++axis) {
    out.nearest[axis] = static_cast<double>(p[axis]);
    out.exact[axis] = p[axis].str();
    out.is_double[axis] = Rational(out.nearest[axis]) == p[axis];
  }
  return out;
}

[[nodiscard]] inline ExactPoint exact_point(const ExactPosition& at) {
  ExactPoint p;
  for (int i = 0; i < 3; ++i)
    p[i] = at.is_double[i] ? Rational(at.nearest[i]) : Rational(at.exact[i]);
  return p;
}

}  // namespace sightline::internal
