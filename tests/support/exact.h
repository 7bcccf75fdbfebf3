// Rational vectors for the naive oracles: as plain as possible, sharing no code with the
// library but the number type.

#pragma once

#include <array>
#include <boost/multiprecision/gmp.hpp>
#include <compare>

#include "linespace/scene.h"

namespace sightline::testing {

using Rational = boost::multiprecision::number<boost::multiprecision::gmp_rational,
                                               boost::multiprecision::et_off>;

template <class T>
struct Vec : std::array<T, 3> {};
using Vec3 = Vec<Rational>;

template <class T>
Vec<T> operator+(const Vec<T>& a, const Vec<T>& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <class T>
Vec<T> operator-(const Vec<T>& a, const Vec<T>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class T>
Vec<T> operator*(const T& s, const Vec<T>& a) {
  return {s * a[0], s * a[1], s * a[2]};
}
template <class T>
T dot(const Vec<T>& a, const Vec<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class T>
Vec<T> cross(const Vec<T>& a, const Vec<T>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
          a[0] * b[1] - a[1] * b[0]};
}
inline int sgn(double x) { return (x > 0) - (x < 0); }
inline int sgn(const Rational& x) { return x.sign(); }
template <class T>
bool is_zero(const Vec<T>& a) {
  return sgn(a[0]) == 0 && sgn(a[1]) == 0 && sgn(a[2]) == 0;
}
inline Vec3 exact(const Point& p) {
  return {Rational(p[0]), Rational(p[1]), Rational(p[2])};
}

}  // namespace sightline::testing
