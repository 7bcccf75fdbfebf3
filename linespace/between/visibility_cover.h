// What a VisibilityCover holds.

#pragma once

#include <vector>

#include "linespace/between/cover_search.h"
#include "linespace/visibility_cover.h"

namespace sightline::internal {

/// A question cut into triangles (a and b) and convex planar pieces (occluders).
struct CutQuestion {
  std::vector<Triangle> a, b;
  std::vector<Piece> pieces;
  /// Occluders without area: the segment between their outermost points, which may
  /// coincide.
  std::vector<std::array<Point, 2>> slivers;
};

/// Deterministic.  Throws InvalidInput as polygon_visibility does.
[[nodiscard]] CutQuestion cut(const VisibilityQuestion& question);

}  // namespace sightline::internal

namespace sightline {

struct VisibilityCover::Data {
  /// The cover of one pair of triangles, with the names by which its nodes call forms and
  /// blockers.
  struct PairCover {
    internal::Triangle a, b;
    std::vector<internal::FormName> forms;
    std::vector<internal::Blocker> blockers;
    std::vector<std::vector<internal::FacingPiece>> patches;
    internal::Cover cover;
  };
  std::vector<PairCover> pairs;
};

}  // namespace sightline
