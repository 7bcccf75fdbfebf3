// A bounding volume hierarchy over boxes, for the shafts that Embree has no query for.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "linespace/scene.h"

namespace sightline::internal {

/// Double coordinates, exact: every item's box contains its points as given.
struct Box {
  std::array<double, 3> min, max;
};

[[nodiscard]] Box box_of(std::span<const Point> points);
/// The closed boxes have a point in common.
[[nodiscard]] bool boxes_meet(const Box& a, const Box& b);
/// Rounded.
[[nodiscard]] inline Point centre(const Box& box) {
  Point c;
  for (int i = 0; i < 3; ++i) c[i] = 0.5 * (box.min[i] + box.max[i]);
  return c;
}

/// Binary tree; nodes are stored so that the two children of a node are neighbours.
class Bvh {
 public:
  struct Node {
    Box box;
    std::uint32_t first;  ///< left child, or first position in items() of a leaf
    std::uint32_t count;  ///< 0 for an inner node, else number of items of the leaf
  };

  explicit Bvh(std::span<const Box> boxes, int leaf_size = 4);

  [[nodiscard]] bool empty() const { return nodes_.empty(); }
  [[nodiscard]] const Node& node(std::uint32_t i) const { return nodes_[i]; }
  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
  /// Item numbers in leaf order.
  [[nodiscard]] std::span<const std::uint32_t> items() const { return items_; }

  /// Visits every item whose leaf `enter` lets in: enter(box) -> bool for nodes,
  /// visit(item) for items.
  template <class Enter, class Visit>
  void traverse(Enter&& enter, Visit&& visit) const {
    walk([](const Box&, const Box&) { return true; }, enter,
         [&](std::uint32_t item) {
           visit(item);
           return false;
         });
  }

  /// The same until visit(item) -> bool returns true, which is returned: of two nodes the
  /// one first whose box has its middle less far along `toward`.
  template <class Enter, class Visit>
  bool any_towards(const Point& toward, Enter&& enter, Visit&& visit) const {
    const auto depth = [&](const Box& box) {
      double d = 0;
      for (int i = 0; i < 3; ++i) d += toward[i] * (box.min[i] + box.max[i]);
      return d;
    };
    return walk(
        [&](const Box& left, const Box& right) { return depth(left) <= depth(right); },
        enter, visit);
  }

 private:
  // Until a visit returns true; of two children the left one first if left_first(boxes).
  template <class LeftFirst, class Enter, class Visit>
  bool walk(LeftFirst&& left_first, Enter&& enter, Visit&& visit) const {
    if (nodes_.empty()) return false;
    std::uint32_t stack[128];
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
      const Node& n = nodes_[stack[--top]];
      if (!enter(n.box)) continue;
      for (std::uint32_t i = 0; i < n.count; ++i) {
        if (visit(items_[n.first + i])) return true;
      }
      if (n.count > 0) continue;
      const bool left = left_first(nodes_[n.first].box, nodes_[n.first + 1].box);
      stack[top++] = n.first + (left ? 1 : 0);
      stack[top++] = n.first + (left ? 0 : 1);
    }
    return false;
  }

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
};

}  // namespace sightline::internal
