// Viewpoints as JSON, in the words of CONTRACT.md, section viewpoints; and aspect graphs
// read back for them.

#pragma once

#include <string>
#include <vector>

#include "aspect/viewpoints.h"
#include "viewers/answer.h"
#include "viewers/json_input.h"

namespace sightline::viewers {

[[nodiscard]] Json best_json(const Scene& scene, const BestViews& best);
[[nodiscard]] Json cover_json(const Scene& scene, const ViewCover& cover);

/// An aspect of a saved graph: the answer of `sightline aspects --list --json FILE`.
struct SavedAspect {
  Viewpoint at;
  std::string structure;
  std::string where;  ///< for messages
};

/// Throws InvalidInput that names the element.
[[nodiscard]] std::vector<SavedAspect> saved_aspects(const JsonInput& file,
                                                     Projection projection);

/// The viewpoints of these.  Throws InvalidInput for a view that is not what the graph
/// says: the graph is of another scene, or of the other projection.
[[nodiscard]] std::vector<Viewpoint> viewpoints_of(const Scene& scene,
                                                   const std::vector<SavedAspect>& graph,
                                                   const Request& request);

}  // namespace sightline::viewers
