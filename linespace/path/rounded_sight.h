// What an eye at a rounded position sees in line: for tests that may err on one side
// only.
//
// All tests have margins far above what rounding does, and where a configuration is too
// flat for that they say so.

#pragma once

#include <array>
#include <optional>

#include "linespace/path/sight_path.h"

namespace sightline::internal {

/// Margin of ratios on a line, and of depths over the scene's size.
inline constexpr double kRatioMargin = 0x1p-20, kDepthMargin = 0x1p-24;

/// The point of a line that is seen behind, or before, a given one.
struct SeenInLine {
  double ratio;  ///< 0 at the line's first point, 1 at its second
  Point at;
  double depth;  ///< how much farther it is from the eye than the given point
};

/// Where a line, known to pass x in the picture, is seen there.  nullopt where rounding
/// does not allow to say.
[[nodiscard]] std::optional<SeenInLine> seen_in_line(const RoundedEye& eye,
                                                     const PathLine& line, const Point& x,
                                                     double size);

/// The ratio of the point of `line` at which it is seen to cross `other`; nullopt where
/// rounding does not allow to say.
[[nodiscard]] std::optional<double> seen_crossing(const RoundedEye& eye,
                                                  const PathLine& line,
                                                  const PathLine& other, double size);

[[nodiscard]] inline Point at_ratio(const PathLine& line, double t) {
  return line.a.rounded + t * (line.b.rounded - line.a.rounded);
}

}  // namespace sightline::internal
