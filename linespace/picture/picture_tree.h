// Straight pieces of the picture in a tree: which may contain a point, which may an arc
// cross?

#pragma once

#include <span>

#include "linespace/picture/picture_point.h"
#include "linespace/space/bvh.h"

namespace sightline::internal {

class PictureTree {
 public:
  struct Piece {
    const PicturePoint *from, *to;
  };
  /// Of a direction's picture pieces are straight; of an eye's they are arcs of the unit
  /// sphere.
  PictureTree(std::span<const Piece> pieces, bool is_direction);

  /// Calls visit(piece number) for all pieces that may contain the point.
  template <class Visit>
  void at(const PicturePoint& p, Visit&& visit) const {
    const auto near = [&](const Box& box) {
      for (int i = 0; i < 3; ++i) {
        const auto x = static_cast<double>(p.vector()[i]);
        const double slack = kSlack * (1 + std::abs(x)) + static_cast<double>(p.error());
        if (box.min[i] > x + slack || box.max[i] < x - slack) return false;
      }
      return true;
    };
    tree_.traverse(near, [&](std::uint32_t i) {
      if (near(boxes_[i])) visit(static_cast<int>(i));
    });
  }

  /// Calls visit(piece number) for all pieces that may meet the straight line in the
  /// picture through p and q.
  template <class Visit>
  void across(const PicturePoint& p, const PicturePoint& q, Visit&& visit) const {
    const LongVector n = cross(p.vector(), q.vector());
    const auto meets = [&](const Box& box) {
      long double low = 0, high = 0, size = 0;
      for (int i = 0; i < 3; ++i) {
        low += n[i] * (n[i] > 0 ? box.min[i] : box.max[i]);
        high += n[i] * (n[i] > 0 ? box.max[i] : box.min[i]);
        size += std::abs(n[i]) * (std::abs(box.min[i]) + std::abs(box.max[i]));
      }
      const long double slack = kSlack * size + 4 * (p.error() + q.error()) * (1 + size);
      return low <= slack && high >= -slack;
    };
    tree_.traverse(meets, [&](std::uint32_t i) {
      if (meets(boxes_[i])) visit(static_cast<int>(i));
    });
  }

 private:
  // Far above the rounding of a few operations on coordinates of size 1.
  static constexpr double kSlack = 0x1p-46;

  std::vector<Box> boxes_;
  Bvh tree_;
};

}  // namespace sightline::internal
