// Which lines graze a union of axis-aligned boxes, decided point by point from the
// definition of a contact alone, for boxes that touch, stack and line up.  Shares no code
// with the library.

#pragma once

#include <array>
#include <memory>

#include "linespace/scene.h"

namespace sightline::testing {

/// Axis-aligned boxes with disjoint interiors, one per group, as one closed solid.
class BoxUnion {
 public:
  /// Throws std::invalid_argument when a group is not an axis-aligned box.
  explicit BoxUnion(const PolygonSoup& soup);
  ~BoxUnion();
  BoxUnion(BoxUnion&&) noexcept;

  /// The union's surface has a vertex at p: it does not look the same along any axis.
  [[nodiscard]] bool is_corner(const Point& p) const;
  /// p lies inside a convex edge of the union parallel to that axis: one of the four
  /// quadrants around it is solid, on both sides along the axis.
  [[nodiscard]] bool is_ridge(const Point& p, int axis) const;

  struct Judgement {
    /// Every contact of the closed segment grazes: some nearby line, tilted ones
    /// included, touches nothing near it.
    bool free;
    /// The line lies in the plane of a face of some box that it touches there.
    bool edge_on;
  };
  /// Contacts are the connected components of what the closed segment ab has in common
  /// with the boxes.  A line that enters a box's interior there is blocked; for others
  /// nearby lines are tried, a few hundred at several scales, each exactly: one that
  /// touches nothing proves grazing, none in all is taken for blocked.
  [[nodiscard]] Judgement judge(const Point& a, const Point& b) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sightline::testing
