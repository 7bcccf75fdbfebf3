// A group of polygons with a name, for scenes that tests write down by hand.

#pragma once

#include <string>
#include <vector>

#include "linespace/scene.h"

namespace sightline::testing {

/// Appends the polygons, given by their corners, as a group.
inline void add_polygons(PolygonSoup& soup, const std::string& name,
                         const std::vector<std::vector<Point>>& polygons) {
  PolygonSoup::Group group{.name = name, .faces = {}};
  for (const std::vector<Point>& polygon : polygons) {
    group.faces.push_back(static_cast<int>(soup.polygons.size()));
    soup.polygons.emplace_back();
    for (const Point& p : polygon) {
      soup.polygons.back().push_back(static_cast<int>(soup.vertices.size()));
      soup.vertices.push_back(p);
    }
  }
  soup.groups.push_back(std::move(group));
}

/// A square "lamp" of side 2 that shines down from a height of 4 onto a square "ground"
/// of side 16, their middles on the z axis.
inline PolygonSoup lamp_and_ground() {
  PolygonSoup soup;
  add_polygons(soup, "lamp", {{{-1, -1, 4}, {-1, 1, 4}, {1, 1, 4}, {1, -1, 4}}});
  add_polygons(soup, "ground", {{{-8, -8, 0}, {8, -8, 0}, {8, 8, 0}, {-8, 8, 0}}});
  return soup;
}

}  // namespace sightline::testing
