// From where a scene under its light is pictured.

#pragma once

#include <array>

#include "shadows/lit_picture.h"

namespace sightline::viewers {

/// Of eyes around this box, around the scene, and inside of both, the one from which most
/// facets that light falls on are seen, each the more the larger it appears.  Decided by
/// small pictures from random rays, the same ones each time.  up_axis: 0 to 2.  Threads,
/// budget and stop of the request are heard; throws Stopped.
[[nodiscard]] PictureCamera lit_camera(const OcclusionIndex& occlusion,
                                       const BackprojectionIndex& light,
                                       const LightSource& source,
                                       const std::array<Point, 2>& box, int up_axis,
                                       int width, int height, const Request& request);

}  // namespace sightline::viewers
