// The picture that naive_view.h reads the map from: convex cells, each with what is seen
// in it.

#pragma once

#include <array>
#include <optional>
#include <vector>

#include "tests/support/naive_cones.h"
#include "tests/support/naive_view.h"

namespace sightline::testing {

/// From space to the picture.  For an eye the picture of a point is the vector to it; for
/// a direction it is (u, v, 1), where u and v are two coordinates of the point moved
/// along the direction until the third is 0.  Of points on one ray the one with the
/// larger `nearness` is seen first: it is a linear function of the picture on every
/// plane.
class Lens {
 public:
  explicit Lens(const NaiveEye& eye);
  [[nodiscard]] bool is_direction() const { return direction_; }
  [[nodiscard]] const Vec3& at() const { return at_; }
  [[nodiscard]] Vec3 picture(const Vec3& point) const;
  /// For the very vector picture(point).
  [[nodiscard]] Rational nearness(const Vec3& point) const;
  /// The point of the ray where the linear function gives its nearness.
  [[nodiscard]] Vec3 in_space(const Ray& ray, const Vec3& nearness) const;
  /// Rays with a positive determinant are counter-clockwise as the eye sees them.
  [[nodiscard]] bool counterclockwise() const {
    return direction_ && at_[drop_].sign() > 0;
  }
  /// Area across the direction times its length, of a cone.
  [[nodiscard]] Rational scaled_area(const Cone& cone) const;
  [[nodiscard]] double length() const;

 private:
  bool direction_;
  Vec3 at_;
  int drop_ = 0;  ///< the coordinate that is left out
};

struct PictureCell {
  Cone cone;
  std::vector<int> faces;  ///< all that is seen here; empty for the background
  /// What the picture's vectors times this is their nearness; for faces only.
  Vec3 nearness;
  bool blocked = false;  ///< the rays run into a solid where the eye touches it
  bool infinite = false;
};

struct Picture {
  std::vector<PictureCell> cells;
  std::vector<char> front;  ///< per face: the eye is in front of its plane
};

/// Of all faces, or of those alone that hold a point.
[[nodiscard]] Picture picture(const Scene& scene, const Lens& lens,
                              const std::optional<Vec3>& point = std::nullopt);

/// Objects in whose material lies what comes right behind `origin` in direction `along`;
/// nullopt if the ray meets an edge.
[[nodiscard]] std::optional<std::vector<int>> material(const Scene& scene,
                                                       const Vec3& origin,
                                                       const Vec3& along);

/// Towards the face's front.
[[nodiscard]] Ray face_normal(const Scene& scene, int face);
/// The face's object is not closed.
[[nodiscard]] bool is_sheet(const Scene& scene, int face);
/// The convex face holds the point, its outline included.
[[nodiscard]] bool face_holds(const Scene& scene, int face, const Vec3& point);
/// The segment holds the point, its ends included.
[[nodiscard]] bool segment_holds(const Vec3& a, const Vec3& b, const Vec3& point);

}  // namespace sightline::testing
