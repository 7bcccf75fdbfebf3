#include <algorithm>

#include "aspect/aspect_graph.h"
#include "aspect/convex/convex_aspects.h"
#include "aspect/exact/general_aspects.h"
#include "aspect/sampled/refined_aspects.h"
#include "aspect/sampled/sampled_aspects.h"

namespace sightline {

using namespace internal;

AspectGraph find_aspects(const Scene& scene, const AspectRequest& request) {
  if (request.samples < 1) throw InvalidInput("samples: at least one is needed");
  if (request.bounds &&
      !((*request.bounds)[0].array() < (*request.bounds)[1].array()).all()) {
    throw InvalidInput("bounds: the first corner must be below the second on all axes");
  }
  const PrecisionScope precision(request.precision);
  if (request.method == AspectMethod::Sampled) return sampled_aspects(scene, request);
  std::string why;
  if (request.method == AspectMethod::Exact) {
    if (!request.of.empty()) {
      why = "exact graphs are of all faces so far";
    } else if (const auto solid = convex_solid(scene)) {
      return convex_aspects(scene, *solid, request);
    } else {
      auto found = general_aspects(scene, request);
      if (auto* graph = std::get_if<AspectGraph>(&found)) return std::move(*graph);
      why = std::get<std::string>(found);
    }
  }
  AspectGraph out = refined_aspects(scene, request);
  out.why = why;
  return out;
}

}  // namespace sightline
