// A scene that is one convex solid: its planes and edges, and what is seen of it from
// where some of its facets show their fronts.

#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "aspect/shape/map_shape.h"
#include "linespace/light/homogeneous.h"
#include "linespace/scene.h"

namespace sightline::internal {

struct ConvexSolid {
  std::vector<LightPlane> planes;  ///< by facet of the scene, positive outside
  struct Edge {
    std::array<int, 2> corners;
    int left, right;  ///< facets, seen from outside
  };
  std::vector<Edge> edges;
  int corners = 0;
  /// By facet its sides, counter-clockwise: 2 e along edge e, 2 e + 1 against it.
  std::vector<std::vector<int>> walks;

  void find_walks();
  /// The map of the facets that show their fronts: all of each is seen.
  [[nodiscard]] ShapeMap map_of(const std::function<bool(int)>& shows) const;
};

/// nullopt where the scene is anything else.
[[nodiscard]] std::optional<ConvexSolid> convex_solid(const Scene& scene);

}  // namespace sightline::internal
