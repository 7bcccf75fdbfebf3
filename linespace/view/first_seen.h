// What is seen along one ray of the picture, or just beside a line: the faces nearest to
// the eye.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "linespace/picture/picture_point.h"

namespace sightline::internal {

/// A direction of sight, or one just beside it: at + e * beside for every small e > 0.
struct PictureRay {
  PicturePoint at;
  ExactPoint beside;  ///< a picture vector; null for the ray itself
};

/// The faces met first, those that coincide together; none: the background.  The ray must
/// lie on no side of a face.  Faces marked 0 are not asked.
[[nodiscard]] std::vector<int> first_seen(const EyeSpace& eye, const PictureRay& ray,
                                          std::span<const std::uint8_t> possibly_seen);

}  // namespace sightline::internal
