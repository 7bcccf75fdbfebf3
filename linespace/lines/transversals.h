// What stands behind linespace/transversals.h: exact Pluecker coordinates, and lines that
// meet two skew lines as points of a square.
//
// Notation.  On a line through P0 and P1, (x0 : x1) is the point (x0 P0 + x1 P1) / (x0 +
// x1); the segment is x0, x1 >= 0, and x0 + x1 = 0 the point at infinity.  For two skew
// lines with points X(x) and Y(y), a third line R0R1 is met where the form
//   F(x, y) = sum f_ab x_a y_b,   f_ab = orient3d(P_a, Q_b, R0, R1),
// is zero.  Two such forms f and g have a common zero over the roots x of the quadratic
//   H(x) = (f00 x0 + f10 x1)(g01 x0 + g11 x1) - (f01 x0 + f11 x1)(g00 x0 + g10 x1).

#pragma once

#include <array>
#include <memory>
#include <optional>

#include "linespace/numbers/surd.h"
#include "linespace/transversals.h"

namespace sightline {

/// direction d and moment X x d, X any point of the line, up to a common factor > 0; and
/// the same in doubles, each off by at most kValueError of itself.
struct ExactLine::Coordinates {
  internal::SurdVector d, m;
  internal::Ring radicand = 0;  // D
  std::array<double, 6> rounded{};
};

namespace internal {

[[nodiscard]] inline RingVector ring_point(const Eigen::Vector3d& p) {
  return {Ring(p.x()), Ring(p.y()), Ring(p.z())};
}
[[nodiscard]] RingVector ring_difference(const Eigen::Vector3d& p,
                                         const Eigen::Vector3d& q);
[[nodiscard]] Ring ring_orient3d(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                 const Eigen::Vector3d& c, const Eigen::Vector3d& d);

/// f[a][b] of the notation above.
template <class T>
struct BilinearForm {
  T f[2][2];
};
/// h0 x0^2 + h1 x0 x1 + h2 x1^2.
template <class T>
struct Quadratic {
  T h0, h1, h2;
};

template <class T>
[[nodiscard]] Quadratic<T> resultant(const BilinearForm<T>& f, const BilinearForm<T>& g) {
  return {f.f[0][0] * g.f[0][1] - f.f[0][1] * g.f[0][0],
          (f.f[0][0] * g.f[1][1] + f.f[1][0] * g.f[0][1]) -
              (f.f[0][1] * g.f[1][0] + f.f[1][1] * g.f[0][0]),
          f.f[1][0] * g.f[1][1] - f.f[1][1] * g.f[1][0]};
}

[[nodiscard]] BilinearForm<Ring> ring_form(const LineThrough& l, const LineThrough& m,
                                           const LineThrough& third);

/// The line through the points (x0 : x1) of l and (y0 : y1) of m, in Q(sqrt D); nullopt
/// when both are at infinity.
[[nodiscard]] std::optional<ExactLine> joining(const LineThrough& l,
                                               const std::array<Surd, 2>& x,
                                               const LineThrough& m,
                                               const std::array<Surd, 2>& y,
                                               const Ring& radicand);

/// Of four lines, l and m being skew, the common zeros of the others' forms.
struct CommonZeros {
  TransversalClass kind;  // of a skew pair: never ThroughPoint, InPlane, both or OneLine
  std::vector<std::array<std::array<Surd, 2>, 2>> zeros;  // x and y, finite or not
  Ring radicand = 0;
};
[[nodiscard]] CommonZeros common_zeros(const BilinearForm<Ring>& f,
                                       const BilinearForm<Ring>& g);

/// The stages of transversal_class(), for tests and benchmarks: nullopt is undecided, and
/// of the integers also "does not fit" or "not by the discriminant alone".
[[nodiscard]] std::optional<TransversalClass> double_transversal_class(
    const std::array<const LineThrough*, 4>& l);
[[nodiscard]] std::optional<TransversalClass> interval_transversal_class(
    const std::array<const LineThrough*, 4>& l);
[[nodiscard]] std::optional<TransversalClass> integer_transversal_class(
    const std::array<const LineThrough*, 4>& l);
[[nodiscard]] TransversalClass exact_transversal_class(
    const std::array<const LineThrough*, 4>& l);

}  // namespace internal
}  // namespace sightline
