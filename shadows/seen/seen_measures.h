// Areas, form factors and gradients of the part of a source's plane that an eye sees.

#pragma once

#include <optional>

#include "shadows/seen/plane_frame.h"
#include "shadows/seen/seen_part.h"

namespace sightline::internal {

/// Scene units squared, within 1e-13 of itself.
[[nodiscard]] double seen_area(const PlaneFrame& frame, const SeenPart& part);

/// Integral of cos cos' / (pi r^2) over the part, for a unit normal at the eye; and its
/// gradient with the eye, where every edge is of one line in space.
struct SeenFormFactor {
  double value;
  std::optional<Eigen::Vector3d> gradient;
  /// Lines that are seen in one with others, one of each boundary edge where that is so.
  std::vector<int> in_line = {};
};
[[nodiscard]] SeenFormFactor seen_form_factor(const SourceView& view,
                                              const PlaneFrame& frame,
                                              const SeenPart& part,
                                              const LongEigen& normal, double area);

/// Of the union of the plane's faces, within 1e-13 of itself.
[[nodiscard]] double open_area(const SourceScene& source, const SourcePlane& plane);

}  // namespace sightline::internal
