// A source as its events see it: for each plane in which it shines to one side the
// outline of its faces there, and the feet of blockers on it.
//
// Faces that lie in one plane, face alike and overlap or touch along an edge are one: the
// outline has no diagonals and no T-junctions.

#pragma once

#include <deque>
#include <span>
#include <vector>

#include "linespace/light/homogeneous.h"
#include "linespace/scene.h"

namespace sightline::internal {

/// Which side of faces is meant.
enum class FaceSide : std::uint8_t { Front, Back };

/// All source faces of one plane that face alike.
struct SourcePatch {
  std::vector<int> faces;           ///< ascending
  FaceSide side = FaceSide::Front;  ///< on which they shine; below, that is called front
  LightPlane plane;                 ///< positive in front
  /// A side of the outline, the source on its left seen from the front, or the segment in
  /// which a face that reaches in front of the plane meets the plane, on the source or
  /// beside it.
  struct Side {
    std::array<const LightPoint*, 2> ends;
    int foot_of = -1;  ///< face id; -1: a side of the outline
  };
  std::vector<Side> sides;
  /// Ends of sides, and where sides cross; each once.
  std::vector<const LightPoint*> corners;
  /// Corners of a convex polygon that contains all of the patch: scene points,
  /// counter-clockwise.
  std::vector<Point> hull;
  std::deque<LightPoint> points;  ///< what the pointers above point to

  SourcePatch() = default;
  SourcePatch(SourcePatch&&) = default;  // a copy would point into the first
  SourcePatch& operator=(SourcePatch&&) = default;
};

/// Keeps nothing of the scene.  Cost: faces of one plane squared, times those near them.
[[nodiscard]] std::vector<SourcePatch> source_patches(const Scene& scene,
                                                      std::span<const int> faces,
                                                      FaceSide side = FaceSide::Front);

}  // namespace sightline::internal
