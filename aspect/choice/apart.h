// Proofs that no view sees a patch, or two patches at once.

#pragma once

#include <vector>

#include "aspect/choice/view_regions.h"
#include "linespace/occlusion.h"

namespace sightline::internal {

/// Keeps references to the scene, the space and the sides.
class SightProofs {
 public:
  SightProofs(const Scene& scene, const ViewSpace& space,
              const std::vector<PatchSide>& sides);

  /// View space is the union of regions in each of which a is not seen or b is not;
  /// proved with at most so many of them.  a = b: a is never seen.
  [[nodiscard]] bool never_both(int a, int b, int most_regions) const;

  /// A solid's face in its plane lies on all of it: nobody sees it.
  [[nodiscard]] bool buried(const PatchSide& side) const;

 private:
  [[nodiscard]] bool unseen(const ViewRegion& region, int side) const;
  [[nodiscard]] bool hidden(const ViewRegion& region, const PatchSide& side) const;
  // All segments from the region to the polygon cross the face.
  [[nodiscard]] bool hides(int face, const ViewRegion& region,
                           std::span<const Point> polygon) const;
  [[nodiscard]] bool face_hidden(const ViewRegion& region, std::span<const Point> polygon,
                                 const PatchSide& side, int halvings) const;

  const Scene* scene_;
  const ViewSpace* space_;
  const std::vector<PatchSide>* sides_;
  OcclusionIndex occlusion_;
};

}  // namespace sightline::internal
