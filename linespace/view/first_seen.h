// What is seen along one ray of the picture, or just beside a line: the faces nearest to
// the eye.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "linespace/picture/picture_point.h"

namespace sightline::internal {

/// A direction of sight just beside a point of the picture: at + e (beside[0] + e
/// (beside[1]
/// + ...)) for every small e > 0.
struct PictureRay {
  PicturePoint at;
  std::vector<ExactPoint> beside;  ///< picture vectors
};

/// The face is seen along the ray, nothing else being there.
[[nodiscard]] bool contains(const EyeSpace& eye, int face, const PictureRay& ray);

/// Faces, not edge-on, whose closed picture may contain the point; those marked 0 are
/// left out.
[[nodiscard]] std::vector<int> faces_near(const EyeSpace& eye, const PicturePoint& at,
                                          std::span<const std::uint8_t> possibly_seen);

/// How near a face's plane is, as a linear function of the picture vector: at one vector
/// what is larger is nearer.
class Nearness {
 public:
  Nearness(const EyeSpace& eye, int face);
  [[nodiscard]] Rational at(const ExactPoint& v) const { return exact_dot(gradient_, v); }

 private:
  ExactPoint gradient_{};
};

/// The faces met first, those that coincide together; none: the background.  The ray must
/// lie on no side of a face.  Faces marked 0 are not asked.
[[nodiscard]] std::vector<int> first_seen(const EyeSpace& eye, const PictureRay& ray,
                                          std::span<const std::uint8_t> possibly_seen);

}  // namespace sightline::internal
