// Convex cones in exact integers, for the naive views: a picture seen from an eye is a
// set of rays, and the picture of a convex polygon is a cone with one side per edge.

#pragma once

#include <array>
#include <boost/multiprecision/gmp.hpp>
#include <compare>
#include <memory>
#include <optional>
#include <vector>

#include "tests/support/exact.h"

namespace sightline::testing {

using Integer = boost::multiprecision::number<boost::multiprecision::gmp_int,
                                              boost::multiprecision::et_off>;

/// A vector up to a positive factor: a ray, or a half-space by its inward normal.  Kept
/// as integers without a common divisor, so that equal rays have equal numbers.
class Ray {
 public:
  /// Requires a vector other than 0.
  explicit Ray(const std::array<Integer, 3>& v);
  explicit Ray(const Vec3& v);

  [[nodiscard]] const std::array<Integer, 3>& exact() const { return data_->exact; }
  [[nodiscard]] Vec3 rational() const;
  /// The vector over its longest coordinate, each rounded to within 2^-52 of itself.
  [[nodiscard]] const std::array<double, 3>& near() const { return data_->near; }
  [[nodiscard]] Ray operator-() const;

  friend bool operator==(const Ray& a, const Ray& b) { return a.exact() == b.exact(); }
  friend bool operator<(const Ray& a, const Ray& b) { return a.exact() < b.exact(); }

 private:
  struct Data {
    std::array<Integer, 3> exact;
    std::array<double, 3> near;
  };
  std::shared_ptr<const Data> data_;
};

/// Sign of the scalar product; exact, doubles only where they prove it.
[[nodiscard]] int side(const Ray& half_space, const Ray& ray);
/// Sign of det(a, b, c).
[[nodiscard]] int orientation(const Ray& a, const Ray& b, const Ray& c);
/// Whether the first coordinate that is not 0 is negative; of a plane's two normals, one.
[[nodiscard]] bool reversed(const Ray& r);
/// The one of r and -r that is not reversed.
[[nodiscard]] Ray canonical(const Ray& r);
/// a x b; nullopt for parallel ones.
[[nodiscard]] std::optional<Ray> normal(const Ray& a, const Ray& b);
/// A ray strictly between two that are neither equal nor opposite; inside a cone, for all
/// its corners.
[[nodiscard]] Ray between(const std::vector<Ray>& rays);

/// A convex cone with inside, less than a half-space: corners in a cyclic order with
/// positive determinants, none between its neighbours; side i holds corners i and i + 1.
struct Cone {
  std::vector<Ray> corners;
  /// Inward normals.
  std::vector<Ray> sides;
};

/// The cone of rays in convex position, in either order; rays on sides are dropped.
/// nullopt for one without inside.
[[nodiscard]] std::optional<Cone> cone_of(std::vector<Ray> rays);

/// What of the cone lies in the half-space; nullopt without inside.
[[nodiscard]] std::optional<Cone> clip(const Cone& cone, const Ray& half_space);

/// The cone cut along a convex set, the meet of half-spaces.
struct Cut {
  std::optional<Cone> inside;
  std::vector<Cone> outside;  ///< disjoint
};
/// A cone that does not meet the inside of the set stays whole.
[[nodiscard]] Cut cut(const Cone& cone, const std::vector<Ray>& half_spaces);

/// The solid angle, to some 1e-15 of itself.
[[nodiscard]] double solid_angle(const Cone& cone);

}  // namespace sightline::testing
