// The surfaces between which form factors are asked.
//
// Neighbours: form_factors.h finds the factors.

#pragma once

#include <string>
#include <vector>

#include "linespace/scene.h"

namespace sightline {

/// Faces that send out and receive by one of their sides.
struct FormFactorSurface {
  std::string name;
  std::vector<int> faces;  ///< scene faces, ascending
  /// By the side on which the file lists them clockwise.
  bool back = false;
};

/// The groups of these names, or `#i-j` (Scene::faces_named); no names: all objects.
/// each_face: a surface for every polygon of the file among them, named GROUP/number.
/// Those of both_sides have a second surface behind them, their back: GROUP/back.  Throws
/// InvalidInput for a name that does not exist.
struct SurfaceWish {
  std::vector<std::string> groups, both_sides;
  bool each_face = false;
};
[[nodiscard]] std::vector<FormFactorSurface> surfaces_of(const Scene& scene,
                                                         const SurfaceWish& wish);

}  // namespace sightline
