// Which part of a side has air before it, and not the material of a closed object.

#pragma once

#include <vector>

#include "linespace/scene.h"
#include "linespace/scene/solid_index.h"
#include "linespace/space/bvh.h"
#include "shadows/factors/convex_merge.h"

namespace sightline::internal {

/// Keeps a reference to the scene.  Immutable.
class ExposedParts {
 public:
  explicit ExposedParts(const Scene& scene);

  /// Disjoint convex parts of the polygon's front that are not at once inside a closed
  /// object; the polygon itself where none is.  Sets `buried` where some part is.  Which
  /// parts are buried is asked at points 2^-40 of their size before them.
  [[nodiscard]] std::vector<PointList> of(const PointList& polygon, bool& buried) const;

 private:
  [[nodiscard]] std::vector<PointList> cells(const PointList& polygon) const;
  [[nodiscard]] bool is_buried(const PointList& part) const;

  const Scene& scene_;
  SolidIndex solids_;
  std::vector<int> faces_;  // with material behind them
  Bvh tree_;                // over these
};

}  // namespace sightline::internal
