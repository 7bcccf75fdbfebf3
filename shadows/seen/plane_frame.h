// A plane of the source as an eye sees it: where points of the picture lie on it.

#pragma once

#include "linespace/picture/picture_point.h"
#include "shadows/seen/source_scene.h"

namespace sightline::internal {

using LongEigen = Eigen::Matrix<long double, 3, 1>;

[[nodiscard]] inline LongEigen long_eigen(const LongVector& v) {
  return {v[0], v[1], v[2]};
}
[[nodiscard]] inline LongEigen long_eigen(const ExactPoint& v) {
  return {long_double(v[0]), long_double(v[1]), long_double(v[2])};
}

/// The plane of the source with its normal towards the eye, and points of the picture on
/// it.
class PlaneFrame {
 public:
  PlaneFrame(const SourceScene& source, const SourcePlane& plane, const EyeSpace& eye);

  /// Rounded.
  [[nodiscard]] Point on_plane(const PicturePoint& p) const;
  /// From corner 0 of the plane's first face, with a bound on the error of each
  /// coordinate.
  struct Placed {
    LongEigen at;
    long double error;
  };
  [[nodiscard]] Placed place(const PicturePoint& p) const;
  [[nodiscard]] ExactPoint exact_place(const PicturePoint& p) const;
  /// How far away the plane is along a unit vector.
  [[nodiscard]] long double distance(const LongEigen& way) const {
    return -height_ / normal_.dot(way);
  }
  [[nodiscard]] const LongEigen& normal() const { return normal_; }
  [[nodiscard]] const ExactPoint& exact_normal() const { return exact_normal_; }

 private:
  const SourceScene* source_;
  const SourcePlane* plane_;
  const EyeSpace* eye_;
  ExactPoint origin_, exact_normal_;
  LongEigen normal_;    // of length 1
  LongEigen apex_;      // the eye, from the origin
  long double height_;  // of the eye above the plane, scene units
};

}  // namespace sightline::internal
