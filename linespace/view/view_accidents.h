// What makes a view an accident: things in one line of sight that lie apart in space, and
// facets and edges seen from their own plane and line.

#pragma once

#include <span>
#include <vector>

#include "linespace/view/line_view.h"

namespace sightline::internal {

/// All accidents that an eye near by would see resolved, ascending, each once.  What is
/// hidden from all eyes near by makes none.
[[nodiscard]] std::vector<Accident> find_accidents(
    const EyeSpace& eye, const Window& window, LineViewer& viewer,
    std::span<const std::uint8_t> possibly_seen);

}  // namespace sightline::internal
