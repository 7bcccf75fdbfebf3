// Which faces receive light, and what is found on them within a budget.

#pragma once

#include <string>
#include <vector>

#include "shadows/shadow_mesh.h"

namespace sightline::viewers {

/// The groups of these names, by their fronts; no names: all objects that are no part of
/// the source.  Faces of `both_sides` among them are listed a second time, by their
/// backs, as GROUP/back.  Throws UsageError for a group of which no face is left, and
/// InvalidInput for a name that does not exist.
[[nodiscard]] std::vector<Receiver> receivers_of(
    const Scene& scene, const LightSource& light, const std::vector<std::string>& names,
    const std::vector<std::string>& both_sides = {});

/// find_shadows(), with all receivers missing where the request ended it before the first
/// was done.
[[nodiscard]] Shadows shadows_in_time(const Scene& scene, const LightSource& light,
                                      const std::vector<Receiver>& receivers,
                                      const Request& request);

}  // namespace sightline::viewers
