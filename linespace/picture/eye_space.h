// The scene as one eye sees it: points as vectors of the picture, and the exact signs of
// their order there.
//
// A point is seen along a *picture vector* of three numbers, up to a positive factor. For
// an eye E the vector of P is E - P; for a direction d it is (x, y, 1), where x and y are
// coordinates across d.  In both cases the determinant of the vectors of P, Q and R is
// positive when R is seen on the left of the line from P to Q.  A point that divides PQ
// in the ratio t : 1 - t has the vector (1 - t) P + t Q.

#pragma once

#include <array>
#include <cstdlib>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "linespace/picture/view_scene.h"

namespace sightline::internal {

using LongVector = std::array<long double, 3>;

/// Its true value is within the error.
struct LongValue {
  long double value, error;
};

/// Nearest but for the last bit.
[[nodiscard]] long double long_double(const Rational& x);

class EyeSpace {
 public:
  /// Throws InvalidInput when a coordinate of the eye is not admissible (predicates.h).
  EyeSpace(const ViewScene& scene, const Viewpoint& eye);

  [[nodiscard]] const ViewScene& scene() const { return *scene_; }
  [[nodiscard]] bool is_direction() const { return direction_; }
  /// The eye, or the direction towards it.
  [[nodiscard]] const ExactPoint& eye() const { return eye_; }
  [[nodiscard]] const Point& rounded_eye() const { return rounded_eye_; }
  /// rounded_eye() is eye().
  [[nodiscard]] bool is_double() const { return is_double_; }

  /// Point r is seen on the left (Positive) of the line from p to q, or on it (Zero).
  [[nodiscard]] Sign orient(int p, int q, int r) const;
  /// The determinant whose sign that is.
  [[nodiscard]] LongValue orient_value(int p, int q, int r) const;
  [[nodiscard]] Rational exact_orient_value(int p, int q, int r) const;

  /// The picture vector of a point, each component within 2^-62 of itself.
  [[nodiscard]] const LongVector& vector(int point) const;
  [[nodiscard]] const ExactPoint& exact_vector(int point) const;
  [[nodiscard]] ExactPoint vector_to(const ExactPoint& p) const;
  /// What is nearer of two points seen in one: of P = a X + b Y in space the vector is
  /// a x + b y and the height a h + b k, and at one multiple of a vector the larger
  /// height is nearer.  1 for an eye; for a direction, how far along it the point is.
  [[nodiscard]] Rational exact_height(int point) const;
  [[nodiscard]] Rational height_of(const ExactPoint& p) const;
  /// What a picture vector means: the unit vector of the ray to it; or, for a direction,
  /// the point of the plane across it through the origin.
  [[nodiscard]] Point drawn_at(const LongVector& v) const;
  /// Areas of the projection, over areas in the picture's x and y.
  [[nodiscard]] long double area_factor() const { return area_factor_; }

  /// The eye is in front of the face (Positive), behind it, or in its plane.
  [[nodiscard]] Sign front(int face) const;
  /// The point lies on the eye's side of the face's plane (Positive), beyond it, or in
  /// it. Zero, too, for a face seen edge-on.
  [[nodiscard]] Sign before(int face, int point) const {
    return scene_->plane_side(face, point) * front(face);
  }
  /// All points of the line are seen in one.
  [[nodiscard]] bool end_on(int line) const;

 private:
  const ViewScene* scene_;
  bool direction_;
  ExactPoint eye_;
  Point rounded_eye_;
  bool is_double_;
  int axis_ = 0;                      // of a direction: its largest component
  std::array<ExactPoint, 2> across_;  // of a direction: the rows of x and y
  long double area_factor_ = 1;
  /// By point; null vectors where not asked yet.  Zeroed by the system when first
  /// touched, for a view touches few of all points.
  std::unique_ptr<LongVector[], decltype(&std::free)> vectors_;
  mutable std::unordered_map<int, ExactPoint> exact_vectors_;
  mutable std::vector<std::int8_t> fronts_;  // 2: not asked yet
};

}  // namespace sightline::internal
