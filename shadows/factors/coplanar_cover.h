// Polygons by their planes: what of a polygon is not covered by others that lie in its
// plane and face alike.

#pragma once

#include <map>
#include <vector>

#include "shadows/factors/convex_merge.h"

namespace sightline::internal {

class CoplanarCover {
 public:
  /// Convex polygons, counter-clockwise as seen from where they face.
  explicit CoplanarCover(std::vector<PointList> polygons);
  void add(PointList polygon);

  /// Some polygon lies in the plane and may overlap.
  [[nodiscard]] bool touches(const PointList& polygon) const;
  /// Disjoint convex parts; their corners are rounded where they had to be found.  Parts
  /// of less than 1e-14 of the polygon's area are left out.
  [[nodiscard]] std::vector<PointList> uncovered(const PointList& polygon) const;

 private:
  struct Box {
    Point low, high;
  };
  [[nodiscard]] std::vector<const PointList*> in_plane(const PointList& polygon) const;

  std::vector<PointList> polygons_;
  std::vector<Box> boxes_;
  // Polygons by a rounded number of their plane, so that few are looked at.
  std::multimap<long long, std::size_t> by_plane_;
};

}  // namespace sightline::internal
