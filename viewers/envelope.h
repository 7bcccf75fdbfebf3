// Which objects are walls and ground: pictures cut them open and colour them neutrally.

#pragma once

#include <vector>

#include "linespace/scene.h"

namespace sightline::viewers {

/// True for objects that enclose or carry the others (walls, ground): thin in one
/// direction, by a tenth of the scene, and reaching the scene's bounding box.  Only for
/// looks.
[[nodiscard]] std::vector<char> envelope_objects(const Scene& scene);

}  // namespace sightline::viewers
