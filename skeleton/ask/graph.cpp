#include "skeleton/graph.h"

namespace sightline {
namespace {

LineThrough line_of(const Scene& scene, int edge) {
  const auto& ends = scene.edges()[edge].points;
  return {scene.point(ends[0]), scene.point(ends[1])};
}

}  // namespace

std::optional<Swath> swath_of(const Scene& scene, const SkeletonArc& arc) {
  if (arc.is_ev()) {
    return Swath::through(scene.point(arc.vertex()), line_of(scene, arc.edge()));
  }
  const auto& [first, middle, last] = arc.edges();
  return Swath::through(line_of(scene, first), line_of(scene, middle),
                        line_of(scene, last));
}

}  // namespace sightline
