// The drawing of a view as pixels.

#pragma once

#include "viewers/picture.h"
#include "viewers/pictures/view_drawing.h"

namespace sightline::viewers {

/// The drawing's window, its longer side `pixels` long (at least 16), with nine samples a
/// pixel.  Of the request, stop, budget and progress count: throws Stopped.  Cost: the
/// samples covered.
[[nodiscard]] Image view_image(const ViewDrawing& drawing, const PointView& view,
                               int pixels, const Request& request = {});

}  // namespace sightline::viewers
