// Coordinates brought to size 1 by a power of two, so that a question costs the same at
// any scale: rounded arithmetic then does the very same steps.

#pragma once

#include <span>

#include "linespace/numbers/rational.h"
#include "linespace/predicates.h"
#include "linespace/scene.h"

namespace sightline::internal {

/// The power of two that brings the largest of the coordinates added so far into
/// [1/2, 1); a larger one where the smallest would fall below kSmallestCoordinate.  So
/// scaled coordinates are exact and admissible, and they are the same whatever power of
/// two the coordinates added were multiplied by.
class UnitScale {
 public:
  /// Admissible coordinates.
  void add(std::span<const Point> points);

  /// Coordinates are multiplied by 2 to this.
  [[nodiscard]] int exponent() const;

 private:
  double largest_ = 0, smallest_ = 0;  // magnitudes of coordinates other than 0
};

/// The point times 2^exponent.
[[nodiscard]] Point scaled(const Point& p, int exponent);

}  // namespace sightline::internal
