#include "linespace/blockers/facing_faces.h"

#include <algorithm>

namespace sightline::internal {

FacingFaces::FacingFaces(const Silhouettes& silhouettes)
    : g_(silhouettes), parts_(silhouettes.scene().objects().size()) {}

void FacingFaces::begin(std::span<const Point> viewpoints) {
  viewpoints_.assign(viewpoints.begin(), viewpoints.end());
  box_ = box_of(viewpoints);
  ++stamp_;
  faces_.clear();
}

std::span<const std::int32_t> FacingFaces::of(int object) {
  Part& part = parts_[object];
  if (part.stamp != stamp_) {
    part = {stamp_, static_cast<std::uint32_t>(faces_.size()), 0};
    const bool beside = !boxes_meet(g_.object_box(object), box_);
    for (const int face : g_.scene().objects()[object].faces) {
      const PlaneSide& plane = g_.face_plane(face);
      const bool turned_away =
          beside &&
          std::all_of(viewpoints_.begin(), viewpoints_.end(),
                      [&](const auto& p) { return plane(p) == Sign::Negative; });
      if (!turned_away) faces_.push_back(face);
    }
    part.count = static_cast<std::uint32_t>(faces_.size()) - part.first;
  }
  return std::span(faces_).subspan(part.first, part.count);
}

}  // namespace sightline::internal
