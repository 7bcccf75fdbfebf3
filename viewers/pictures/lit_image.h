// The image of a scene as its lights shine on it.

#pragma once

#include <vector>

#include "shadows/lit_picture.h"
#include "viewers/picture.h"

namespace sightline::viewers {

/// Surfaces in grey, as bright as the light that arrives, brightest at the largest value
/// of the picture; sources in warm white; nothing in dark blue.
[[nodiscard]] Image lit_image(const std::vector<LitPixel>& pixels, int width, int height);

}  // namespace sightline::viewers
