// A convex polyhedron that half-spaces cut, in rational numbers.

#pragma once

#include <array>
#include <vector>

#include "linespace/numbers/rational.h"

namespace sightline::internal {

/// The points x with normal . x <= offset.
struct HalfSpace {
  ExactPoint normal;
  Rational offset;
  /// Negative inside.
  [[nodiscard]] int sign(const ExactPoint& x) const {
    return Rational(exact_dot(normal, x) - offset).sign();
  }
};

class CutPolyhedron {
 public:
  struct Facet {
    std::vector<int> corners;  ///< counter-clockwise seen from outside
    std::vector<int> planes;   ///< numbers of the half-spaces whose planes it lies in
  };

  /// The box between two corners; its half-spaces are number 0 to 5: x min, x max, y min,
  /// ...  Empty where it is flat.
  CutPolyhedron(const ExactPoint& low, const ExactPoint& high);

  /// Leaves what is in the half-space too; `number` is its own.
  void cut(const HalfSpace& half_space, int number);

  [[nodiscard]] bool empty() const { return facets_.empty(); }
  [[nodiscard]] const std::vector<ExactPoint>& points() const { return points_; }
  [[nodiscard]] const std::vector<Facet>& facets() const { return facets_; }
  [[nodiscard]] Rational volume() const;

 private:
  [[nodiscard]] std::vector<int> signs(const HalfSpace& half_space) const;
  void forget_unused_points();

  std::vector<ExactPoint> points_;
  std::vector<Facet> facets_;
};

}  // namespace sightline::internal
