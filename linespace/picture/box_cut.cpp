#include "linespace/picture/box_cut.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sightline::internal {

BoxCut::BoxCut(const ExactPoint& low, const ExactPoint& high)
    : bounds_{low[0], low[1], low[2], high[0], high[1], high[2]},
      low_(rounded(low)),
      high_(rounded(high)) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(low[axis] < high[axis]))
      throw InvalidInput("the box: its low corner must be below its high corner");
    rounding_[axis] = Rational(Rational(low_[axis]) - low[axis]).sign();
    rounding_[3 + axis] = Rational(Rational(high_[axis]) - high[axis]).sign();
  }
}

Sign BoxCut::within(int side, const Point& p) const {
  const double bound = side < 3 ? low_[side] : high_[side - 3];
  const double x = p[side % 3];
  // Where x is the rounded bound, it lies as that does beside the bound.
  const int above = x > bound ? 1 : x < bound ? -1 : rounding_[side];
  return static_cast<Sign>(side < 3 ? above : -above);
}

Rational BoxCut::depth(int side, const ExactPoint& p) const {
  return side < 3 ? p[side] - bounds_[side] : bounds_[side] - p[side - 3];
}

bool BoxCut::misses(const Box& box) const {
  for (int axis = 0; axis < 3; ++axis) {
    if (box.max[axis] < low_[axis] || box.min[axis] > high_[axis]) return true;
  }
  return false;
}

// Sutherland and Hodgman's step (Reentrant polygon clipping, 1974) for a convex polygon:
// one side at most is made anew.
std::vector<CutCorner> BoxCut::clip(std::vector<CutCorner> polygon, int side) const {
  const std::size_t n = polygon.size();
  std::vector<Rational> depths;
  bool any_within = false, any_beyond = false;
  for (const CutCorner& c : polygon) {
    depths.push_back(depth(side, c.at));
    any_within |= depths.back() > 0;
    any_beyond |= depths.back() < 0;
  }
  if (!any_within) return any_beyond ? std::vector<CutCorner>{} : polygon;
  std::vector<CutCorner> left;
  for (std::size_t k = 0; k < n; ++k) {
    const CutCorner& from = polygon[k];
    const CutCorner& to = polygon[(k + 1) % n];
    const Rational &here = depths[k], &next = depths[(k + 1) % n];
    if (here >= 0) {
      left.push_back(from);
      if (here == 0 && next < 0) {
        left.back().side = -1;
        left.back().flat = false;
        left.back().box_side = side;
      } else if (here == 0 && next == 0 && from.flat) {
        left.back().flat = false;
        left.back().box_side = side;
      }
    }
    if (here.sign() * next.sign() >= 0) continue;
    CutCorner on{along(from.at, to.at, Rational(here / (here - next))), -1, -1};
    if (here > 0) {
      on.box_side = side;
    } else {
      on.side = from.side;
      on.flat = from.flat;
      on.box_side = from.box_side;
    }
    left.push_back(std::move(on));
  }
  return left;
}

std::vector<CutCorner> BoxCut::clip(std::vector<CutCorner> polygon) const {
  for (int side = 0; side < kSides && !polygon.empty(); ++side)
    polygon = clip(std::move(polygon), side);
  return polygon;
}

std::optional<std::array<ExactPoint, 2>> BoxCut::clip(
    std::array<ExactPoint, 2> segment) const {
  for (int side = 0; side < kSides; ++side) {
    const Rational a = depth(side, segment[0]), b = depth(side, segment[1]);
    if (a >= 0 && b >= 0) continue;
    if (a <= 0 && b <= 0) return std::nullopt;
    segment[a < 0 ? 0 : 1] = along(segment[0], segment[1], Rational(a / (a - b)));
  }
  return segment;
}

bool BoxCut::in_a_side(const std::array<ExactPoint, 2>& segment) const {
  for (int side = 0; side < kSides; ++side) {
    if (depth(side, segment[0]) == 0 && depth(side, segment[1]) == 0) return true;
  }
  return false;
}

}  // namespace sightline::internal
