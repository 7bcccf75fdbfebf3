// Which edges in front of a source may lie behind each other on lines to it, as far as
// one occluder at a time, and the edges' own faces, tell.

#pragma once

#include <cstdint>
#include <vector>

#include "linespace/light/hiding_solids.h"
#include "linespace/light/patch_space.h"
#include "linespace/request.h"
#include "linespace/work/stage.h"

namespace sightline::internal {

/// Immutable; keeps references.
class SourceSight {
 public:
  /// Cost: for each edge the others between it and the source.  Budget and stop of the
  /// stage are heard.  Throws Stopped.
  SourceSight(const PatchSpace& at, const HidingSolids& solids, const Request& request,
              Stage& stage);

  /// Not certain that one occluder hides all of the source from all of the edge.
  [[nodiscard]] bool sees_source(int edge) const { return sees_source_[edge] != 0; }
  /// Edges, ascending, that some line may graze on its way from the edge to the source.
  [[nodiscard]] const std::vector<int>& nearer(int edge) const { return nearer_[edge]; }
  /// Not certain that one occluder hides all of the source from the point.
  [[nodiscard]] bool sees_source(const LightPoint& p) const;
  /// Some line through the point and the edge may be free between them.
  [[nodiscard]] bool may_see(const LightPoint& p, int edge) const;

 private:
  [[nodiscard]] std::vector<int> find_nearer(int edge) const;
  [[nodiscard]] std::vector<int> hiding_source(const LightPoint& p) const;

  const PatchSpace& at_;
  const HidingSolids& solids_;
  std::vector<LightPoint> hull_;
  std::vector<std::uint8_t> sees_source_;
  std::vector<std::vector<int>> nearer_;
};

}  // namespace sightline::internal
