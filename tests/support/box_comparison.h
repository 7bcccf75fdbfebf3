// Views of a scene that a box cuts against views of the scene whose faces were cut
// beforehand.

#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "linespace/point_view.h"
#include "tests/support/exact.h"
#include "tests/support/naive_view.h"

namespace sightline::testing {

/// A scene, a box, and the scene that the box leaves of it.
class BoxComparison {
 public:
  /// Keeps a reference.
  BoxComparison(const Scene& scene, const std::array<Vec3, 2>& box);

  /// The cut scene can be written in doubles and has faces; and what is closed, and on
  /// which side its front is, is the same in both: not so where a group keeps whole
  /// closed parts alone, where a room is cut open, where the house around a hollow is.
  [[nodiscard]] bool usable() const { return cut_.has_value(); }
  [[nodiscard]] const Scene& cut_scene() const { return *cut_; }
  /// Some face lost a part.
  [[nodiscard]] bool cuts_a_face() const { return cuts_a_face_; }
  /// What the two views, and the naive one of the cut scene, do not have in common.
  [[nodiscard]] std::vector<std::string> differences(const NaiveEye& eye) const;

 private:
  void cut(const std::array<Vec3, 2>& box);

  const Scene* scene_;
  std::array<Vec3, 2> box_;
  bool cuts_a_face_ = false;
  std::optional<Scene> cut_;
  std::vector<int> facet_;  // of the cut scene's: facet of the scene
  std::optional<PointViewIndex> in_box_, of_cut_;
  std::optional<NaiveViewer> naive_;
};

}  // namespace sightline::testing
