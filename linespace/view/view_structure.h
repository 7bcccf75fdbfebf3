// The labelled structure of a view as a short text.

#pragma once

#include <string>

#include "linespace/view/view_map.h"

namespace sightline::internal {

/// Equal for two views of a scene whose maps have the same vertices, edges and regions,
/// each with the scene element that it comes from, and the same incidences; different for
/// others (but for one pair in 2^128: it is a hash).  Requires a view without accidents.
[[nodiscard]] std::string structure_of(const ViewScene& scene, const ViewMap& map);

}  // namespace sightline::internal
