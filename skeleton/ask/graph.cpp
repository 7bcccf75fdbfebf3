#include "skeleton/graph.h"

namespace sightline {
namespace {

LineThrough line_of(const Scene& scene, int edge) {
  const auto& ends = scene.edges()[edge].points;
  return {scene.point(ends[0]), scene.point(ends[1])};
}

}  // namespace

std::optional<Swath> swath_of(const Scene& scene, const SkeletonArc& arc) {
  return Swath::through(scene.point(arc.vertex), line_of(scene, arc.edge));
}

std::optional<Swath> swath_of(const Scene& scene, const EeeArc& arc) {
  return Swath::through(line_of(scene, arc.edges[0]), line_of(scene, arc.edges[1]),
                        line_of(scene, arc.edges[2]));
}

}  // namespace sightline
