// Where the eye is, and which rays leave it freely when it lies on the scene.
//
// An eye on the scene sees along rays that run neither in a face there nor into the
// material of a closed object.  The rays into material make cones, bounded by the planes
// of the faces on which the eye lies.

#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "linespace/picture/eye_space.h"

namespace sightline::internal {

class EyeStar {
 public:
  explicit EyeStar(const EyeSpace& eye);

  [[nodiscard]] EyePlace place() const { return place_; }
  /// What the eye lies on or in, as PointView::place_ids tells it.
  [[nodiscard]] const std::vector<int>& ids() const { return ids_; }
  /// Faces on which the eye lies, their boundary included, ascending.
  [[nodiscard]] std::span<const int> faces() const { return faces_; }
  /// Lines that are sides of the facets of these faces, ascending.
  [[nodiscard]] std::span<const int> sides() const { return sides_; }
  /// The line is one of them.
  [[nodiscard]] bool bounds(int line) const;

  /// Rays near the given one run into material.  The ray points along `way`, or just
  /// beside it along way + e beside for every small e > 0; it must not run in a face.
  [[nodiscard]] bool blocked(const ExactPoint& way, const ExactPoint& beside) const;

 private:
  void find_faces();
  void find_place();
  [[nodiscard]] bool holds(int face) const;
  [[nodiscard]] bool into_material(const ExactPoint& way) const;

  const EyeSpace* eye_;
  EyePlace place_ = EyePlace::Free;
  std::vector<int> ids_, faces_;
  std::vector<ExactPoint> normals_;  // of faces_
  std::vector<int> sides_;           // lines of their facets, ascending
  /// Whether rays with these signs against normals_ are blocked.
  mutable std::map<std::vector<int>, bool> known_;
};

}  // namespace sightline::internal
