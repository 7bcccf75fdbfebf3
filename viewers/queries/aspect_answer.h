// An aspect graph as JSON, in the words of CONTRACT.md, section aspects.

#pragma once

#include <string_view>
#include <vector>

#include "aspect/aspect_graph.h"
#include "viewers/answer.h"

namespace sightline::viewers {

[[nodiscard]] std::string_view name(AspectMethod method);

/// The numbers in the file of the facets' polygons, ascending, each once.
[[nodiscard]] std::vector<int> polygons_of(const Scene& scene,
                                           const std::vector<int>& facets);

[[nodiscard]] Json aspects_json(const Scene& scene, const AspectGraph& graph, bool list);

}  // namespace sightline::viewers
