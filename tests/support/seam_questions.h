// Two triangles and a wall of two pieces between them that nearly meet, or just overlap:
// the questions of which nothing should cost more than any other.

#pragma once

#include <cstdint>
#include <optional>

#include "tests/support/naive_polygon_visibility.h"

namespace sightline::testing {

enum class SeamKind {
  Overlap,        ///< by 2^-54 to 2^-20
  CommonCorners,  ///< the pieces end at the same two points
  OneUlp,         ///< the second piece begins at the next double
  Gap             ///< of 2^-54 to 2^-20
};

struct SeamQuestion {
  SeamKind kind;
  /// Of the gap before anything was turned; negative: overlap.
  double width;
  /// All triangles, so that each is planar after it was turned in doubles.
  VisibilityInstance instance;
  /// All coordinates were multiplied by 2 to this, the last step.
  int exponent;
  /// The answer, where it is known: the gap is 0, or wider than what turning rounds.
  std::optional<bool> visible;
};

/// Everything is about 1 in size, then turned by a rotation in doubles (every fourth
/// seed: not turned), then multiplied by a power of two from 2^-80 to 2^80.
[[nodiscard]] SeamQuestion seam_question(std::uint64_t seed);

}  // namespace sightline::testing
