// Points, planes and lines in homogeneous coordinates, over rounded numbers with a bound
// and over exact ones.
//
// A point is (x, y, z, w), a plane the same with value n . x + k w, positive in front; a
// line is its direction and its moment.  Each formula is written once, for both number
// types: first rounded, and exactly where the bound leaves the sign open.

#pragma once

#include <array>
#include <cmath>

#include "linespace/numbers/surd.h"
#include "linespace/scene.h"
#include "linespace/swaths/exact_swath.h"

namespace sightline::internal {

/// A double and a bound on its error.  Every operation adds its own rounding, 2^-53 of
/// the result, and enough for that of the bound itself and for underflow.
struct Approx {
  double v = 0, e = 0;
};

inline constexpr double kHalfUlp = 0x1p-53;
inline constexpr double kBoundRounding = 1 + 0x1p-48;
inline constexpr double kUnderflow = 0x1p-1000;

[[nodiscard]] inline Approx operator+(const Approx& a, const Approx& b) {
  const double v = a.v + b.v;
  return {v, (a.e + b.e + std::abs(v) * kHalfUlp) * kBoundRounding};
}
[[nodiscard]] inline Approx operator-(const Approx& a, const Approx& b) {
  const double v = a.v - b.v;
  return {v, (a.e + b.e + std::abs(v) * kHalfUlp) * kBoundRounding};
}
[[nodiscard]] inline Approx operator*(const Approx& a, const Approx& b) {
  const double v = a.v * b.v;
  return {v, (std::abs(a.v) * b.e + std::abs(b.v) * a.e + a.e * b.e +
              std::abs(v) * kHalfUlp) *
                     kBoundRounding +
                 kUnderflow};
}
/// Certainly not zero; a NaN is not.
[[nodiscard]] inline bool is_certain(const Approx& a) { return std::abs(a.v) > a.e; }
/// Requires is_certain(b).
[[nodiscard]] inline Approx operator/(const Approx& a, const Approx& b) {
  const double v = a.v / b.v;
  const double least = std::abs(b.v) - b.e;
  return {v, ((a.e + std::abs(v) * b.e) / least + std::abs(v) * 2 * kHalfUlp) *
                     kBoundRounding +
                 kUnderflow};
}

template <class T>
using Four = std::array<T, 4>;
template <class T>
using Six = std::array<T, 6>;

template <class T>
[[nodiscard]] Six<T> join(const Four<T>& a, const Four<T>& b) {
  return {a[3] * b[0] - b[3] * a[0], a[3] * b[1] - b[3] * a[1],
          a[3] * b[2] - b[3] * a[2], a[1] * b[2] - a[2] * b[1],
          a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Zero where two lines meet; for lines ab and cd the sign of det(a, b, c, d).
template <class T>
[[nodiscard]] T side(const Six<T>& l, const Six<T>& m) {
  return l[0] * m[3] + l[1] * m[4] + l[2] * m[5] + l[3] * m[0] + l[4] * m[1] +
         l[5] * m[2];
}

template <class T>
[[nodiscard]] T value(const Four<T>& plane, const Four<T>& x) {
  return plane[0] * x[0] + plane[1] * x[1] + plane[2] * x[2] + plane[3] * x[3];
}

/// The plane of a line and a point; of points a, b, c it is positive where they turn
/// counter-clockwise.
template <class T>
[[nodiscard]] Four<T> plane_of(const Six<T>& l, const Four<T>& c) {
  return {l[1] * c[2] - l[2] * c[1] + c[3] * l[3],
          l[2] * c[0] - l[0] * c[2] + c[3] * l[4],
          l[0] * c[1] - l[1] * c[0] + c[3] * l[5],
          T{} - (l[3] * c[0] + l[4] * c[1] + l[5] * c[2])};
}

/// u p - v q.
template <class T>
[[nodiscard]] Four<T> combination(const T& u, const Four<T>& p, const T& v,
                                  const Four<T>& q) {
  return {u * p[0] - v * q[0], u * p[1] - v * q[1], u * p[2] - v * q[2],
          u * p[3] - v * q[3]};
}

/// A point of the scene, or one that is constructed; its weight is positive.
struct LightPoint {
  Four<Approx> near;  ///< of weight 1, which is exact
  Four<Ring> exact;
  Point rounded;
};

[[nodiscard]] LightPoint light_point(const Point& p);
/// Requires a weight other than 0.
[[nodiscard]] LightPoint light_point(const Four<Ring>& p);

struct LightPlane {
  Four<Approx> near;
  Four<Ring> exact;
};
[[nodiscard]] LightPlane light_plane(const LightPoint& a, const LightPoint& b,
                                     const LightPoint& c);
[[nodiscard]] Sign sign_at(const LightPlane& plane, const LightPoint& p);

/// A segment with the line that it lies on.
struct LightLine {
  std::array<const LightPoint*, 2> ends;
  Six<Approx> near;
  Six<Ring> exact;
};
[[nodiscard]] LightLine light_line(const LightPoint& from, const LightPoint& to);
/// Zero where the two lines are in one plane.
[[nodiscard]] Sign sign_between(const LightLine& l, const LightLine& m);

/// The sign of a rounded value, or of what exact() gives where its bound leaves it open.
template <class Exact>
[[nodiscard]] Sign decide(const Approx& a, Exact&& exact) {
  if (is_certain(a)) return a.v > 0 ? Sign::Positive : Sign::Negative;
  return sign_of(Ring(exact()));
}

}  // namespace sightline::internal
