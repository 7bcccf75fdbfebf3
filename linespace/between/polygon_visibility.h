// The common ground of polygon_visibility and FaceVisibility: two polygons cut into
// triangles, occluders from anywhere.

#pragma once

#include <functional>
#include <limits>
#include <span>

#include "linespace/between/cover_search.h"
#include "linespace/between/occluder_source.h"
#include "linespace/between/visibility_cover.h"
#include "linespace/polygon_visibility.h"

namespace sightline::internal {

struct PairTerms {
  OccluderSource& source;
  /// Polygons of the source to try first.
  std::span<const int> known;
  /// Asked of a segment that no occluder blocks; null: it is free.
  std::function<bool(const SightSpace&, const SightPoint&)> accept;
  /// The source's polygons are those of the question times 2^scaled_by.
  int scaled_by = 0;
  /// For each pair of triangles.
  std::int64_t most_cells = std::numeric_limits<std::int64_t>::max();
  /// Asked now and then; true ends the work.  Null: never.
  std::function<bool()> stop;
};

struct Decision {
  VisibilityAnswer answer;
  /// Undecided, and more cells may decide it.
  bool out_of_effort = false;
};

/// Pair after pair of triangles, in the units of the question, until one is visible.
/// Budget and stop of the request are left to `terms.stop`.  Occluders of the answer are
/// numbers of pieces.
[[nodiscard]] Decision decide(std::span<const Triangle> a, std::span<const Triangle> b,
                              const PairTerms& terms, const VisibilityRequest& request);

/// Replaces numbers of pieces by those of occluders.
void name_occluders(VisibilityAnswer& answer,
                    const std::function<int(int)>& occluder_of_piece);

/// True once the request's stop is requested or its budget is spent, counted from now.
[[nodiscard]] std::function<bool()> stop_of(const VisibilityRequest& request);

/// The triangles of a convex planar polygon; those without area are left out.
[[nodiscard]] std::vector<Triangle> fan(std::span<const Point> polygon);

/// The point of those weights, exactly.
[[nodiscard]] ExactPoint exact_mean(const Triangle& t, const ExactWeights& w);

}  // namespace sightline::internal
