// The line or conic on which an arc lies, with what it takes to cross it with others.
//
// Notation.  X(s) is the parametrisation.  For a conic, X = M (1, s, s^2) with an
// invertible matrix M, so that z = adj(M) X is a multiple of (1, s, s^2): the inverse
// s = z1 / z0, and the implicit form z0 z2 - z1^2.  A line is parametrised by x or by y
// itself.  The implicit form F(X) is taken positive to the left of the curve, in the
// direction of growing s, wherever w > 0.

#pragma once

#include <array>

#include "shadows/planar/arcs/exact_parameter.h"
#include "shadows/planar/plane_curve.h"

namespace sightline::internal {

/// The polynomials of a line or conic over some number type.
template <class T>
struct SupportForms {
  std::array<std::array<T, 3>, 3> curve;    ///< of x, y, w: coefficients of s^k
  std::array<std::array<T, 3>, 3> inverse;  ///< of z0, z1, z2: coefficients of x, y, w
  std::array<T, 3> line;                    ///< F of a line: coefficients of x, y, w
};

/// x^2, x y, y^2, x w, y w, w^2: integers without a common factor, the first one that is
/// not zero positive.  The first three are zero for a line.
using ImplicitForm = std::array<Integer, 6>;

struct PlaneSupport {
  bool straight = true;
  bool by_x = true;       ///< of a line: s is x, and not y
  bool reversed = false;  ///< of a conic: F is -(z0 z2 - z1^2)
  SupportForms<Ring> exact;
  SupportForms<BallNumber> balls;
  ImplicitForm implicit;

  [[nodiscard]] int degree() const { return straight ? 1 : 2; }
  template <class T>
  [[nodiscard]] const SupportForms<T>& forms() const {
    if constexpr (std::is_same_v<T, Ring>) {
      return exact;
    } else {
      return balls;
    }
  }
};

/// u' w - u w' of two quadratics: the derivative of u / w times w^2.
template <class T>
[[nodiscard]] std::array<T, 3> slope(const std::array<T, 3>& u,
                                     const std::array<T, 3>& w) {
  const T second = u[2] * w[0] - u[0] * w[2];
  return {u[1] * w[0] - u[0] * w[1], second + second, u[2] * w[1] - u[1] * w[2]};
}

/// A homogeneous point over Q(sqrt d), w > 0.
struct SurdPoint {
  Surd x, y, w;
  Ring d;
};

[[nodiscard]] SurdPoint point_at(const PlaneSupport& support, const QuadraticRoot& s);
/// The sign of F at the point.
[[nodiscard]] Sign side_of(const PlaneSupport& support, const SurdPoint& p);
/// Of a point on the curve; nullopt for the point at s = infinity.
[[nodiscard]] std::optional<QuadraticRoot> parameter_of(const PlaneSupport& support,
                                                        const SurdPoint& p);

/// The curve X(s) of `own` in the coordinates of `other`: what a crossing is made of.
template <class T>
struct Substitution {
  std::array<std::array<T, 3>, 2> z;  ///< z0, z1 of `other`, in powers of s
  std::array<T, 5> f;                 ///< F of `other`, in powers of s
  int degree;                         ///< of f, at most
};
template <class T>
[[nodiscard]] Substitution<T> substitute(const PlaneSupport& own,
                                         const PlaneSupport& other);

/// The line through two points, or a x + b y + c w = 0.
[[nodiscard]] PlaneSupport line_support(const std::array<Integer, 3>& line);
/// The line or conic of a curve; throws InvalidInput where it is a single point.
/// w: its sign on the arc.
[[nodiscard]] PlaneSupport support_of(const std::array<std::array<Integer, 3>, 3>& curve);

}  // namespace sightline::internal
