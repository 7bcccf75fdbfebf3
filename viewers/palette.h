// One colour per kind of event, the same in pictures, VTK files and the page.

#pragma once

#include <string_view>

#include "viewers/picture.h"

namespace sightline::viewers {

/// The colour of an arc or node kind by its name in answers ("EV", "VV", "VEE_self",
/// ...); grey for an unknown one.
[[nodiscard]] Colour colour_of_kind(std::string_view kind);

/// "#rrggbb".
[[nodiscard]] std::string hex(const Colour& colour);

/// A tone for every object: neutral for walls and ground (envelope_objects), otherwise
/// one per first word of the name, so that the parts of a table match.
[[nodiscard]] std::vector<Colour> object_colours(const Scene& scene);

}  // namespace sightline::viewers
