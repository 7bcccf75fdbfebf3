// Walks along random paths, checked by views computed anew.

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "linespace/view_path.h"

namespace sightline::testing {

struct PathRun {
  int paths;              ///< a scene
  std::uint64_t seed;     ///< another choice of paths
  int eyes = 20;          ///< at which the view is computed anew, a path
  int every = 1;          ///< only each scene of this many
  bool crossing = false;  ///< scenes whose faces cross, instead of the others
  int most_reports = 10;
};

/// What of a run was found right; and what was not, a text each.
struct PathReport {
  int paths = 0, changes = 0, events = 0, views = 0;
  std::vector<std::string> differences;
};

/// Segments and great circles in those of view_scenes() whose faces do not cross, or do.
/// A third of the viewpoints are small integers, a third fractions, a third any doubles.
[[nodiscard]] PathReport compare_paths(const PathRun& run);

}  // namespace sightline::testing
