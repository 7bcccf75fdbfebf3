// Small scenes aimed at trouble for form factors, on which they are compared with a
// second way.

#pragma once

#include <string>
#include <vector>

#include "linespace/scene.h"

namespace sightline::testing {

struct FormFactorScene {
  std::string name;
  PolygonSoup soup;  ///< about 1 wide; convex faces
  /// Groups whose faces exchange, each face by itself; of some also their backs.
  std::vector<std::string> surfaces, both_sides = {};
};

/// 56 seeded scenes of 3 to 30 faces: in general position, aligned
/// boxes, slivers, slits of 2^-20, fins on a side or corner of a surface, touching,
/// coplanar, partly behind, sheets that cross, both sides, solids, rooms.  In every
/// second one of a kind no plane is across an axis, and coordinates are still exact.
[[nodiscard]] std::vector<FormFactorScene> form_factor_scenes();

/// A unit room, each wall n x n squares, and as many boxes of random places and sizes
/// whose coordinates are multiples of 1/64, some standing on walls; every face belongs to
/// "room" or "boxes".
[[nodiscard]] PolygonSoup enclosure_with_boxes(int n, int boxes, unsigned seed);

}  // namespace sightline::testing
