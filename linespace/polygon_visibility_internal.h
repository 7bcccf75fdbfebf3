// The common ground of polygon_visibility and FaceVisibility: two polygons cut into
// triangles, occluders from anywhere.

#pragma once

#include <functional>
#include <span>

#include "linespace/cover_search_internal.h"
#include "linespace/polygon_visibility.h"
#include "linespace/visibility_cover_internal.h"

namespace sightline::internal {

struct PairTerms {
  /// Adds the occluders known from the start to the space of a pair of triangles.
  std::function<void(SightSpace&)> start;
  /// As SearchTerms::confirm.
  std::function<bool(SightSpace&, const SightPoint&)> confirm;
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
