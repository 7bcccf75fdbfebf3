// Points with normals that ask what they see of a light, read from JSON or text.

#pragma once

#include <array>
#include <string>
#include <vector>

#include "shadows/backprojection.h"
#include "viewers/json_input.h"

namespace sightline::viewers {

struct ShadowQuestion {
  ShadowPoint point;
  std::array<std::string, 3> asked;  ///< the coordinates as they were written
  std::string where;                 ///< "FILE: points[3]" or "FILE:4", for messages
};

/// A `.json` file: {"points": [[x,y,z], ...], "normals": [[x,y,z] | null, ...], "on":
/// [polygon number | null, ...]}, the last two left out at will.  Else text: a row
/// `x,y,z` or `x,y,z,nx,ny,nz` a point, commas or blanks; empty rows and what follows a
/// `#` are skipped.  Coordinates are numbers, read as doubles, or "p/q".  "on" moves its
/// point along the polygon's normal onto its plane, and gives it that normal.
/// Throws InvalidInput that names the element.
[[nodiscard]] std::vector<ShadowQuestion> shadow_questions(const Scene& scene,
                                                           const std::string& file);
/// The same of a file's bytes; its name says by the extension how to read them.
[[nodiscard]] std::vector<ShadowQuestion> shadow_questions(const Scene& scene,
                                                           const std::string& name,
                                                           const std::string& bytes);

}  // namespace sightline::viewers
