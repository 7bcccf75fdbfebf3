// The questions that commands read from JSON files instead of a scene, checked as far as
// can be before anything is computed.

#pragma once

#include <vector>

#include "linespace/polygon_visibility.h"
#include "linespace/segment_transversals.h"
#include "viewers/json_input.h"

namespace sightline::viewers {

/// Of `transversals`: which lines meet four of these?
struct TransversalsQuestion {
  std::vector<LineThrough> segments, lines;
};

/// {"segments": [[p, q], ...], "lines": [[p, q], ...]}, of which one array may be
/// missing.  Throws InvalidInput that names the element.
[[nodiscard]] TransversalsQuestion transversals_question(const JsonInput& file);

/// Of `stab`: which lines pass these portals in order?  Each is a convex polygon.
using PortalsQuestion = std::vector<std::vector<Point>>;

/// {"portals": [[p, ...], ...]}.  Throws InvalidInput that names the element, also where
/// a portal is no convex polygon.
[[nodiscard]] PortalsQuestion portals_question(const JsonInput& file);

/// Of `visible` without groups: {"instances": [{"a": [p, ...], "b": [p, ...],
/// "occluders": [[p, ...], ...]}, ...]}; "occluders" may be missing.  Throws InvalidInput
/// that names the element; whether the polygons are convex is left to
/// polygon_visibility().
[[nodiscard]] std::vector<VisibilityQuestion> visibility_questions(const JsonInput& file);

}  // namespace sightline::viewers
