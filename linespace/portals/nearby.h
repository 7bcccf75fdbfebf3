// Lines near a line M, to first order: on which side they pass the edges that M touches.
//
// A line near M crosses two planes across M in points that M's are moved by a and by a +
// w: four numbers.  On which side of an edge h it passes is, to first order, a linear
// form of these: c_h = ((d x u), (H - A) x u), with d the direction of M, A a point of
// it, u and H those of the edge, and of each product the two components across M.  The
// lines that touch three edges skew to each other move M along one way n, the product of
// their three forms, or against it.  Lines of a family that ends at M pass every other
// edge on the side that its portal allows, so the signs of n c_h must not contradict
// that.

#pragma once

#include <array>
#include <vector>

#include "linespace/transversals.h"

namespace sightline::internal {

/// What a portal allows beside one of its edges that M touches.
enum class AllowedSide {
  Positive,  ///< lines on which side(edge) is positive, or Zero
  Negative,
  None,  ///< a slit: the edge must be touched
  Any
};

class NearbyLines {
 public:
  /// The edges that the line touches, in any order.
  struct Edge {
    LineThrough edge;
    AllowedSide allowed;
  };
  NearbyLines(const ExactLine& line, const std::vector<Edge>& edges);

  /// The way in which lines that touch the three edges move M.
  using Way = std::array<double, 4>;
  [[nodiscard]] Way way(int i, int j, int k) const;
  /// Whether lines that M is moved to this way, or against it, may pass all edges on an
  /// allowed side.  False is certain; true may be a matter of the second order.
  [[nodiscard]] bool may_pass(const Way& way) const;
  /// Whether they may touch that edge too.  False is certain.
  [[nodiscard]] bool may_touch(const Way& way, int edge) const;

 private:
  [[nodiscard]] double value(const Way& way, int edge) const;

  std::vector<std::array<double, 4>> forms_;
  std::vector<AllowedSide> allowed_;
  double error_ = 0;  // of value()
};

}  // namespace sightline::internal
