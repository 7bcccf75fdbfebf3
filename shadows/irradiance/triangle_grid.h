// A grid that finds the triangle in which a point of the plane lies.

#pragma once

#include <optional>
#include <vector>

#include "shadows/irradiance/element_tree.h"

namespace sightline::internal {

/// Immutable.  About as many cells as triangles; each lists those that meet it.
class TriangleGrid {
 public:
  TriangleGrid() = default;
  /// Triangles with corners counter-clockwise, which do not overlap.
  explicit TriangleGrid(const std::vector<Corners>& triangles);

  struct Found {
    int triangle;
    Barycentric place;
  };
  /// Between triangles that rounding parts the nearer one answers; nullopt elsewhere
  /// outside of all.  Cost: constant where triangles are not much longer than wide.
  [[nodiscard]] std::optional<Found> find(const Eigen::Vector2d& p) const;

 private:
  // Coordinates 1 and 2 in a triangle: x . (p - corner 0), y . (p - corner 0).
  struct Place {
    Eigen::Vector2d corner, x, y;
  };

  [[nodiscard]] int column(int axis, double x) const;
  void list_cells(const Corners& t, std::vector<int>& cells) const;

  std::vector<Place> places_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero(), step_ = Eigen::Vector2d::Ones();
  int side_ = 1;
  std::vector<int> starts_, listed_;  // by cell
};

}  // namespace sightline::internal
