// Small scenes that tests of aspects and viewpoints share: upright prisms, an L, two
// boxes.

#pragma once

#include <array>
#include <vector>

#include "linespace/scene.h"
#include "tests/support/add_box.h"
#include "tests/support/add_polygons.h"

namespace sightline::testing {

/// Counter-clockwise seen from above.
using Outline = std::vector<std::array<double, 2>>;

/// The outline of a letter L, with one reflex corner.
inline const Outline kLetterL{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2.5}, {0, 2.5}};

/// Bottom, top and sides, fronts outwards.
inline std::vector<std::vector<Point>> prism(const Outline& outline, double z0,
                                             double z1) {
  std::vector<Point> low, high;
  for (const auto& [x, y] : outline) {
    low.emplace_back(x, y, z0);
    high.emplace_back(x, y, z1);
  }
  std::vector<std::vector<Point>> faces{{low.rbegin(), low.rend()}, high};
  for (std::size_t i = 0; i < low.size(); ++i) {
    const std::size_t j = (i + 1) % low.size();
    faces.push_back({low[i], low[j], high[j], high[i]});
  }
  return faces;
}

/// An L of thickness 1.2: one reflex edge.
inline Scene letter() {
  PolygonSoup soup;
  add_polygons(soup, "L", prism(kLetterL, 0, 1.2));
  return Scene(soup);
}

/// Boxes "a" and "b", apart and in no common plane.
inline Scene two_boxes() {
  PolygonSoup soup;
  add_box(soup, "a", {0, 0, 0}, {1, 1, 1});
  add_box(soup, "b", {2, 0.3, 0.2}, {3, 1.5, 1.7});
  return Scene(soup);
}

}  // namespace sightline::testing
