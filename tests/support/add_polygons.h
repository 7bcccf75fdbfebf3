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

}  // namespace sightline::testing
