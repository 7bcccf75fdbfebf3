// The image of a scene as its lights shine on it.

#pragma once

#include <vector>

#include "shadows/lit_picture.h"
#include "viewers/picture.h"

namespace sightline::viewers {

/// Surfaces in grey, as bright as the light that arrives; sources in warm white; nothing
/// in dark blue.  Brightest is the value that this share of the surfaces' pixels do not
/// exceed: 1 for the largest; less where a spot beside the light would leave all else
/// dark.
[[nodiscard]] Image lit_image(const std::vector<LitPixel>& pixels, int width, int height,
                              double share = 1);

}  // namespace sightline::viewers
