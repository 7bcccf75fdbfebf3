// The surface around an occluder that blocks a segment, as far as its outline keeps the
// segment on one hand.
//
// Polygons that share a side and that the segment's direction passes from the same side
// are added, one by one, as long as the segment stays on the inner hand of every side of
// the outline: seen along the segment, the patch is star-shaped around it.  On a convex
// solid that is all that faces the segment's start, and the outline is the silhouette.

#pragma once

#include <array>
#include <functional>
#include <map>
#include <vector>

#include "linespace/between/occluder_source.h"

namespace sightline::internal {

class PatchGrowth {
 public:
  struct Member {
    int polygon;
    std::int8_t front;  ///< as FacingPiece has it
  };
  /// Keeps references.  skip(i): polygon i does not count; may be null.
  PatchGrowth(const OccluderSet& set, const SightSpace& space, const SightPoint& s,
              const std::function<bool(int)>& skip);

  /// The polygon and what grew around it; nothing where the segment runs in its plane.
  /// In rounded arithmetic: a patch is a proposal that SightSpace::add_patch makes exact.
  [[nodiscard]] std::vector<Member> around(int polygon);

 private:
  [[nodiscard]] int front_of(int polygon) const;
  [[nodiscard]] bool fits(const Member& member) const;
  void add(const Member& member);

  const OccluderSet& set_;
  const SightSpace& space_;
  const std::function<bool(int)>& skip_;
  Point p_, q_;
  std::vector<Member> members_;
  std::map<int, std::int8_t> front_;  // of members
  int divided_ = 0;                   // members that add conditions
};

}  // namespace sightline::internal
