// The mesh of one facet of a receiver: the planar map of all curves on it, without those
// along which nothing changes.

#pragma once

#include <map>

#include "shadows/backprojection.h"
#include "shadows/mesh/receiver_curves.h"
#include "shadows/planar/planar_map.h"

namespace sightline::internal {

/// Numbers for what is seen: equal ones for equal structures.
class StructureTable {
 public:
  int number_of(std::vector<SeenBoundary> boundaries);
  [[nodiscard]] std::vector<std::vector<SeenBoundary>> take();

 private:
  using Key = std::vector<std::pair<int, std::vector<std::vector<SeenSide>>>>;
  std::map<Key, int> numbers_;
  std::vector<std::vector<SeenBoundary>> structures_;
};

struct MeshAndAreas {
  ShadowMesh mesh;
  std::array<double, 3> areas{};  ///< by ShadowClass
  double away_area = 0, error_bound = 0;
  int umbra_components = 0;
};

/// The request's threads are used, its budget and stop heard; throws Stopped.
[[nodiscard]] MeshAndAreas make_mesh(const ReceiverPlane& plane,
                                     const ReceiverCurves& curves, int facet,
                                     const LightEvents& events,
                                     const BackprojectionIndex& light,
                                     StructureTable& structures, const Request& request);

}  // namespace sightline::internal
