// A small tree over very many boxes, asked which of them a segment may meet: 20 bytes a
// box and four for its item.
//
// Boxes live on a grid over a little more than [-1, 1]^3 and are rounded outward to it.
// They are kept in Morton order of their centres (Morton 1966; Lauterbach et al. 2009,
// "Fast BVH construction on GPUs"), eight neighbours to a node, eight nodes to the next:
// so nothing but boxes is stored.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "linespace/space/bvh.h"

namespace sightline::internal {

/// On the grid, closed.
struct GridBox {
  std::array<std::uint16_t, 3> min, max;
};

/// Between two parallel planes: low <= n x <= high in steps, for thin things that lie
/// obliquely in their boxes.  n has |n_0| + |n_1| + |n_2| = 1 and is told by two numbers
/// (the octahedron unfolded to a square; Cigolle et al. 2014, "A survey of efficient
/// representations for independent unit vectors").
struct Slab {
  std::int8_t u = 0, v = 0;
  std::int16_t low = -32768, high = 32767;

  static constexpr double kSteps = 32000;
  [[nodiscard]] Point normal() const;
  /// With the representable normal nearest to that direction or its opposite, whichever
  /// points up; any if it is zero.
  [[nodiscard]] static Slab across(const Point& direction);
  /// Rounded outward; of what is within a little more than [-1, 1]^3.
  void set(double lowest, double highest);
};

struct BoxItem {
  GridBox box;
  Slab slab;
  std::uint32_t item;
};

/// The smallest box of the grid around one in coordinates; what is beyond the grid is cut
/// off: nullopt where nothing is left.
[[nodiscard]] std::optional<GridBox> grid_box(const Box& box);

/// Immutable; may be shared between threads.
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(std::vector<BoxItem> items);

  /// Appends the items of all boxes that the closed segment meets with a slab that it
  /// meets, and of some that it misses by a step of the grid; an item as often as it has
  /// such boxes.  Requires coordinates of the ends of magnitude at most 4.
  void meeting(const Point& from, const Point& to,
               std::vector<std::uint32_t>& items) const;

  [[nodiscard]] std::size_t size() const { return items_.size(); }
  [[nodiscard]] std::size_t bytes() const;

 private:
  std::vector<std::uint32_t> items_;
  std::vector<Slab> slabs_;
  // levels_[0] are the items' boxes; box i of the next is around eight from 8 i on.
  std::vector<std::vector<GridBox>> levels_;
};

/// How far the ends of a segment may be off, in each coordinate.
inline constexpr double kSegmentSlack = 0x1p-24;

}  // namespace sightline::internal
