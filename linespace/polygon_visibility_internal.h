// The common ground of polygon_visibility and FaceVisibility: two polygons cut into
// triangles, occluders from anywhere.

#pragma once

#include <functional>
#include <span>

#include "linespace/cover_search_internal.h"
#include "linespace/occluder_source_internal.h"
#include "linespace/polygon_visibility.h"
#include "linespace/visibility_cover_internal.h"

namespace sightline::internal {

struct PairTerms {
  OccluderSource& source;
  /// Polygons of the source to try first.
  std::span<const int> known;
  /// Asked of a segment that no occluder blocks; null: it is free.
  std::function<bool(const SightSpace&, const SightPoint&)> accept;
};

/// Pair after pair of triangles, until one is visible.
[[nodiscard]] VisibilityAnswer decide(std::span<const Triangle> a,
                                      std::span<const Triangle> b, const PairTerms& terms,
                                      const VisibilityRequest& request);

/// The triangles of a convex planar polygon; those without area are left out.
[[nodiscard]] std::vector<Triangle> fan(std::span<const Point> polygon);

/// The point of those weights, exactly.
[[nodiscard]] ExactPoint exact_mean(const Triangle& t, const Weights& w);

}  // namespace sightline::internal
