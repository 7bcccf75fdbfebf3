// Quotients of exact numbers whose signs were decided before.

#pragma once

#include "linespace/rational_internal.h"

namespace sightline::internal {

/// x / y.  The signs that a caller knows say that y is not 0; at precision Double they
/// may be wrong, and then it is a half: any number keeps a wrong answer an answer.
[[nodiscard]] inline Rational quotient(const Rational& x, const Rational& y) {
  return y == 0 ? Rational(1, 2) : Rational(x / y);
}

}  // namespace sightline::internal
