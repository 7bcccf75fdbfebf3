#include "shadows/planar/planar_map.h"

#include "shadows/planar/map_edges.h"
#include "shadows/planar/map_faces.h"

namespace sightline::internal {

PlanarMap::PlanarMap(std::span<const PlaneCurve> curves, const PlaneOutline& outline) {
  CrossingCounts counts;
  auto map = std::make_shared<PlanarData>(vertices_and_edges(curves, outline, counts));
  find_faces(*map);
  data_ = std::move(map);
}

}  // namespace sightline::internal
