// A box that cuts convex polygons and segments, in rationals.

#pragma once

#include <array>
#include <optional>
#include <vector>

#include "linespace/numbers/rational.h"
#include "linespace/predicates.h"
#include "linespace/scene.h"
#include "linespace/space/bvh.h"

namespace sightline::internal {

/// A corner of a polygon, and the side from it to the next corner.
struct CutCorner {
  ExactPoint at;
  int point;  ///< its number in the scene; -1 where the box cuts a side
  int side;   ///< number of the side before the cut; -1 of a side that the box made
  bool flat = false;  ///< the polygon goes on beyond the side, in the same plane
  int box_side = -1;  ///< the side of the box that ends the polygon here
};

/// A closed box.  Its sides count x0, y0, z0, x1, y1, z1, from 0.
class BoxCut {
 public:
  static constexpr int kSides = 6;

  /// Throws InvalidInput unless each coordinate of `low` is below that of `high`.
  BoxCut(const ExactPoint& low, const ExactPoint& high);

  /// Within the side's half-space (Positive), on its plane, or beyond it.
  [[nodiscard]] Sign within(int side, const Point& p) const;
  /// How far within the side's half-space; negative beyond it.
  [[nodiscard]] Rational depth(int side, const ExactPoint& p) const;
  /// The boxes have no point in common.
  [[nodiscard]] bool misses(const Box& box) const;

  /// What of a convex polygon lies in the box; nothing where that has no area.  A flat
  /// side in a side of the box ends the polygon there, for what goes on is cut off.
  [[nodiscard]] std::vector<CutCorner> clip(std::vector<CutCorner> polygon) const;
  /// What of a segment lies in the box; nullopt where that is a point or nothing.
  [[nodiscard]] std::optional<std::array<ExactPoint, 2>> clip(
      std::array<ExactPoint, 2> segment) const;

  /// Both points lie on one side of the box.
  [[nodiscard]] bool in_a_side(const std::array<ExactPoint, 2>& segment) const;

 private:
  [[nodiscard]] std::vector<CutCorner> clip(std::vector<CutCorner> polygon,
                                            int side) const;

  std::array<Rational, kSides> bounds_;
  Point low_, high_;                  // rounded
  std::array<int, kSides> rounding_;  // sign of the rounded bound less the bound
};

}  // namespace sightline::internal
