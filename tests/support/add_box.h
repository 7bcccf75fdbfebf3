// A box with a name, for scenes that tests write down by hand.

#pragma once

#include <array>

#include "linespace/scene.h"

namespace sightline::testing {

/// Appends the axis-aligned box between two corners as a group of six faces, fronts
/// outwards; requires low < high in each coordinate.
inline void add_box(PolygonSoup& soup, const char* name, const Point& low,
                    const Point& high) {
  const int v = static_cast<int>(soup.vertices.size());
  const int f = static_cast<int>(soup.polygons.size());
  for (int i = 0; i < 8; ++i) {
    soup.vertices.emplace_back((i & 1) ? high[0] : low[0], (i & 2) ? high[1] : low[1],
                               (i & 4) ? high[2] : low[2]);
  }
  for (const auto& face : {std::array{0, 4, 6, 2},
                           {1, 3, 7, 5},
                           {0, 1, 5, 4},
                           {2, 6, 7, 3},
                           {0, 2, 3, 1},
                           {4, 5, 7, 6}}) {
    soup.polygons.push_back({v + face[0], v + face[1], v + face[2], v + face[3]});
  }
  soup.groups.push_back({name, {f, f + 1, f + 2, f + 3, f + 4, f + 5}});
}

}  // namespace sightline::testing
