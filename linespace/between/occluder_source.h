// Occluders for a search, looked up only where a segment runs that nothing known blocks.

#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "linespace/between/cover_search.h"
#include "linespace/between/sight_space.h"
#include "linespace/polygon_visibility.h"
#include "linespace/space/bvh.h"

namespace sightline::internal {

/// Convex planar polygons with boxes, and a tree over them when they are many.
class OccluderSet {
 public:
  explicit OccluderSet(std::vector<Polygon> polygons);
  [[nodiscard]] std::span<const Polygon> polygons() const { return polygons_; }
  [[nodiscard]] const Polygon& operator[](int i) const { return polygons_[i]; }

  /// Polygons that the segment may meet: all that it does, and a few more.  Rounded
  /// arithmetic with bounds.
  [[nodiscard]] std::vector<int> near(const SightSpace& space, const SightPoint& s) const;

  /// Polygons whose boxes meet that one, in no order.
  [[nodiscard]] std::vector<int> meeting(const Box& box) const;

  /// The one other polygon that has this side, corner for corner, and which of its sides
  /// it is; nullopt for none or several.
  struct Side {
    int polygon, corner;
  };
  [[nodiscard]] std::optional<Side> neighbour(const Side& side) const;

 private:
  // Sides in order of a hash of their ends, so that equal ones are next to each other.
  struct HashedSide {
    std::uint64_t hash;
    Side side;
  };
  void index_sides() const;
  [[nodiscard]] std::array<Point, 2> ends(const Side& side) const;

  std::vector<Polygon> polygons_;
  std::vector<Box> boxes_;
  std::optional<Bvh> tree_;
  mutable std::once_flag sides_indexed_;
  mutable std::vector<HashedSide> sides_;
  mutable std::vector<std::size_t> first_side_, place_;  // of a side in sides_
};

/// Feeds a SightSpace from an OccluderSet.
class OccluderSource {
 public:
  /// How pieces are numbered in the space: as in the set, or as they were found.
  enum class Numbers { AsInSet, AsFound };
  /// skip(i): polygon i does not count.  May be null.
  OccluderSource(const OccluderSet& set, Numbers numbers, std::function<bool(int)> skip);

  /// Begins a space.  Returns the polygons to try first: all when they are few, otherwise
  /// `known` and what other spaces found.
  std::vector<int> start(std::span<const int> known);
  /// Adds the polygon to the space, once.
  void add(SightSpace& space, int i);
  /// Adds the surface around the polygon that blocks the segment, which the polygon does.
  void add_patch(SightSpace& space, int i, const SightPoint& s);
  /// Whether some patch of the space has the polygon.
  [[nodiscard]] bool in_patch(int i) const { return in_patch_[i]; }
  /// -1 when no polygon of the set that is not in the space yet blocks the segment;
  /// otherwise one that does, and it was added.
  int find_blocker(SightSpace& space, const SightPoint& s);
  [[nodiscard]] const OccluderSet& set() const { return set_; }
  /// In order of their numbers AsFound.
  [[nodiscard]] const std::vector<int>& found() const { return found_; }

 private:
  [[nodiscard]] int number(int i);

  const OccluderSet& set_;
  Numbers numbers_;
  std::function<bool(int)> skip_;
  std::vector<int> found_;
  std::unordered_map<int, int> number_;
  std::vector<bool> in_space_, in_patch_;
};

}  // namespace sightline::internal
