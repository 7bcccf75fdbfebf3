// The triangle that sight from the eye to a line of the scene fills: which boxes
// certainly miss it.

#pragma once

#include "linespace/picture/eye_space.h"
#include "linespace/space/bvh.h"

namespace sightline::internal {

/// From a direction, the half-infinite strip on the eye's side of the line.
///
/// A second box test beside Shaft (linespace/space/shaft.h), which vertex views use: a
/// Shaft is the hull of points that are doubles.  This has no end on a direction's side,
/// and all of its corners may be rounded.
class SightTriangle {
 public:
  SightTriangle(const EyeSpace& eye, int line);

  /// Certainly no point in common; by rounded arithmetic with a margin.
  [[nodiscard]] bool misses(const Box& box) const;

 private:
  // A half-space normal . x <= offset that contains the triangle.
  struct HalfSpace {
    Eigen::Vector3d normal;
    double offset;  // enlarged by the margin
    double margin;  // for each unit of |x|, component by component, times |normal|
  };
  void add(const Eigen::Vector3d& normal, double offset, double size);

  Box around_;  // of the triangle; infinite towards the eye of a direction
  std::array<HalfSpace, 4> sides_;
  int count_ = 0;
};

}  // namespace sightline::internal
