// Points of the picture: where a point of the scene, or a position on a line, is seen.

#pragma once

#include <memory>
#include <span>
#include <vector>

#include "linespace/picture/eye_space.h"
#include "linespace/picture/line_cut.h"

namespace sightline::internal {

/// A point of the picture.  Its exact vector is computed when it is first asked for.
class PicturePoint {
 public:
  /// Where a point of the scene is seen.
  PicturePoint(const EyeSpace& eye, int point);
  /// Where a position on a line is seen.  Start and Finish are the line's ends.
  PicturePoint(const EyeSpace& eye, int line, const LineCut& cut);
  /// A point of the picture given by its vector.
  PicturePoint(const EyeSpace& eye, const ExactPoint& vector);

  /// The scene point that is seen there; -1 for others.
  [[nodiscard]] int point() const { return point_; }
  /// The line on which it is a position, and the position, unless it is a scene point.
  [[nodiscard]] int line() const { return line_; }
  [[nodiscard]] const LineCut& cut() const { return cut_; }

  /// The picture vector: for an eye of length 1, for a direction with a last component 1.
  [[nodiscard]] const LongVector& vector() const { return vector_; }
  /// Bound on the error of each component of vector().
  [[nodiscard]] long double error() const { return error_; }
  /// A positive multiple of the true vector.
  [[nodiscard]] const ExactPoint& exact() const;

 private:
  void set(const LongVector& v, long double relative_error);

  const EyeSpace* eye_;
  int point_ = -1, line_ = -1;
  LineCut cut_{};
  LongVector vector_;
  long double error_;
  mutable std::shared_ptr<const ExactPoint> exact_;
};

/// Point r lies on the left (Positive) of the line from p to q in the picture.
[[nodiscard]] Sign orient(const PicturePoint& p, const PicturePoint& q,
                          const PicturePoint& r);
/// The two are one point of the picture.
[[nodiscard]] bool same_point(const PicturePoint& p, const PicturePoint& q);
/// For each point the first in the list that is the same.  Cost: n log n, where few are
/// nearly the same.
[[nodiscard]] std::vector<int> number_points(std::span<const PicturePoint> points);

}  // namespace sightline::internal
