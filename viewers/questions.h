// The questions that commands read from JSON files instead of a scene, checked as far as
// can be before anything is computed.

#pragma once

#include <array>
#include <string>
#include <vector>

#include "linespace/point_view.h"
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

/// Of `look`: what is seen from here?
struct ViewQuestion {
  Viewpoint eye;
  std::array<std::string, 3> asked;  ///< the coordinates as they were written
  std::string where;                 ///< "FILE: views[3]" or "--from 1,2,3", for messages
};

/// {"views": [{"from": [x, y, z]} | {"direction": [x, y, z]}, ...]}; coordinates are
/// numbers or strings "p/q".  Throws InvalidInput that names the element.
[[nodiscard]] std::vector<ViewQuestion> view_questions(const JsonInput& file);

/// The same from text "x,y,z" of an option.  Throws InvalidInput that names the option.
[[nodiscard]] ViewQuestion view_question(Viewpoint::Kind kind, const std::string& option,
                                         const std::string& text);

/// Of `look`: the box that cuts the scene.
struct BoxQuestion {
  ViewBox box;
  std::array<std::string, 6> asked;  ///< the bounds as they were written
};
/// From text "x0,y0,z0,x1,y1,z1" of an option.  Throws InvalidInput that names it.
[[nodiscard]] BoxQuestion box_question(const std::string& option,
                                       const std::string& text);

/// {"points": [[x, y, z], ...]} or {"directions": [...]}, at least two, coordinates as
/// above.  Throws InvalidInput that names the element.
[[nodiscard]] std::vector<Viewpoint> path_question(const JsonInput& file);

}  // namespace sightline::viewers
