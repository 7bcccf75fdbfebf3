// An area light: faces of the scene that emit light from their fronts.
//
// Neighbours: backprojection.h finds which part of it a point sees.

#pragma once

#include <span>
#include <string>
#include <vector>

#include "linespace/scene.h"

namespace sightline {

struct LightSource {
  /// Scene faces, ascending.  Each emits from the side on which the file lists it
  /// counter-clockwise, also where Scene turned it round (Scene::turned).
  std::vector<int> faces;
  /// Those of them that emit from both sides, ascending.
  std::vector<int> both_sides;
};

/// The faces of these objects, groups or polygon numbers `#i-j` (Scene::faces_named).
/// both_sides may name other faces too.  Throws InvalidInput for a name that does not
/// exist, and for a source without a face that has an area.
[[nodiscard]] LightSource light_source(const Scene& scene,
                                       std::span<const std::string> names,
                                       std::span<const std::string> both_sides = {});

}  // namespace sightline
