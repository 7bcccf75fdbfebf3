// Solid angles and projected areas of what is seen, in closed form, and their gradients.

#pragma once

#include <optional>
#include <vector>

#include "linespace/view/view_graph.h"

namespace sightline::internal {

/// Measures by number: of facets the sides 2 f and 2 f + 1, ascending; of map regions
/// all.
struct ViewMeasures {
  struct OfFacet {
    int side;
    int pieces;
    double measure;
    Eigen::Vector3d gradient;  ///< of the solid angle with the eye; 0 for a direction
  };
  std::vector<OfFacet> facets;
  std::vector<std::optional<double>> regions;  ///< nullopt: infinite
};

/// `region_of` gives the map's region of each region of the graph; `background` which of
/// the map's regions are background.  Solid angles are within 1e-12 of themselves or
/// 1e-15 sr, areas within 1e-12 of themselves.
[[nodiscard]] ViewMeasures measure(const EyeSpace& eye, const ViewGraph& graph,
                                   const std::vector<int>& region_of,
                                   const std::vector<bool>& background);

}  // namespace sightline::internal
