// What corners that are near each other have around them, found once for all of them.

#pragma once

#include <span>

#include "linespace/blockers/blocker_list.h"
#include "linespace/blockers/facing_faces.h"
#include "linespace/silhouettes/silhouettes.h"
#include "linespace/space/shaft.h"

namespace sightline::internal {

/// Found when asked for and kept, so one per thread.
class Surroundings {
 public:
  explicit Surroundings(const Silhouettes& silhouettes)
      : facing_(silhouettes), between_(silhouettes) {}

  /// Of all points of these points' hull.
  void begin(std::span<const Point> corners) {
    corners_ = box_of(corners);
    facing_.begin(corners);
  }
  /// At a group of edges: those inside the box.
  void look_at(const Box& group) {
    group_ = group;
    between_.forget();
  }

  /// The blockers between the corners and the group.
  [[nodiscard]] const BlockerList& between() {
    if (!between_.listed()) {
      between_.list({corners_, group_}, centre(group_) - centre(corners_));
    }
    return between_;
  }
  /// By which faces lines from the corners can enter a convex solid (FacingFaces::of).
  [[nodiscard]] std::span<const std::int32_t> facing(int object) {
    return facing_.of(object);
  }

 private:
  Box corners_{}, group_{};
  FacingFaces facing_;
  BlockerList between_;
};

}  // namespace sightline::internal
