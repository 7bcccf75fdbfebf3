// What makes a view an accident: things in one line of sight that lie apart in space, and
// facets and edges seen from their own plane and line.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "linespace/picture/picture_point.h"
#include "linespace/view/line_view.h"

namespace sightline::internal {

/// Where LineViewer suspects accidents, in the picture.
struct SuspectPoints {
  std::vector<PicturePoint> points;
  std::vector<std::uint8_t> in_stretch;  ///< of each: 1 in the middle of a stretch
};
[[nodiscard]] SuspectPoints suspect_points(const EyeSpace& eye, const LineViewer& viewer);

/// All accidents that an eye near by would see resolved, ascending, each once.  What is
/// hidden from all eyes near by makes none.
[[nodiscard]] std::vector<Accident> find_accidents(
    const EyeSpace& eye, const Window& window, LineViewer& viewer,
    const SuspectPoints& suspects, std::span<const std::uint8_t> possibly_seen);

/// Of a line that is seen on one side of this point of the picture and hidden beyond:
/// with all that is nearer gone it would only go straight on there, in itself or in lines
/// that continue it, seams left out.
[[nodiscard]] bool goes_straight_on(const EyeSpace& eye, const PicturePoint& point,
                                    int line,
                                    std::span<const std::uint8_t> possibly_seen);

}  // namespace sightline::internal
