// The plane across a line: what points are as seen along the line.
//
// Notation.  The line L is a + t (b - a).  With integers (or doubles) A, alpha > 0, D
// such that a = A / alpha and b - a = D / delta, every point p of the scene has
//   v(p) = alpha p - A,   u(p) = (v_i D_k - v_k D_i, v_j D_k - v_k D_j),
// where k is an axis with D_k != 0: u is, up to a linear map, the projection of p along L
// onto the plane across L, with L at the origin.  For a point on L, u = 0 and
// t = (delta / alpha) x with x = v_k / D_k.  All of it is ring arithmetic on doubles and
// integers, done in CGAL::Mpzf; nothing is divided before a position is handed out.
//
// For the files of this folder: the names are too short for others.

#pragma once

#include <CGAL/Gmpq.h>
#include <CGAL/Mpzf.h>

#include <cmath>
#include <limits>
#include <utility>

#include "linespace/numbers/rational.h"
#include "linespace/numbers/surd.h"
#include "linespace/predicates.h"

namespace sightline::internal::contacts {

using CGAL::Gmpq;

/// Added to bounds so that underflow cannot make them too small.  The smallest products
/// that matter are of degree 4 in coordinates of at least 2^-192 (differences of doubles
/// of at least 2^-140), that is 2^-768.
inline constexpr double kUnderflow = 1e-300;

/// Mpzf's own conversion expects a positive number.
inline Ring ring(const mpz_t z) {
  if (mpz_sgn(z) == 0) return Ring(0);
  CGAL::Gmpz absolute;
  mpz_abs(absolute.mpz(), z);
  Ring r(absolute);
  return mpz_sgn(z) < 0 ? -r : r;
}

inline Gmpq gmpq(const Ring& r) { return Gmpq(r); }
inline Rational rational(const Gmpq& q) { return Rational(q.mpq()); }

inline int sign_of(const Ring& r) { return static_cast<int>(CGAL::sign(r)); }

/// A direction in the plane across L, with its rounded coordinates (each within a
/// relative 2^-52; infinite when out of range) for a first look.
struct Ray {
  Ring x, y;
  double rx = 0, ry = 0;

  Ray() = default;
  Ray(Ring x_, Ring y_) : x(std::move(x_)), y(std::move(y_)) {
    rx = CGAL::to_double(x);
    ry = CGAL::to_double(y);
  }
  [[nodiscard]] bool zero() const { return sign_of(x) == 0 && sign_of(y) == 0; }
  Ray operator-() const {
    Ray r;
    r.x = -x;
    r.y = -y;
    r.rx = -rx;
    r.ry = -ry;
    return r;
  }
};

/// Sign of p * q + r * s.  The rounded factors are within 2 ulp each, so the rounded sum
/// is within (4 + 1 + 1) ulp of the exact one plus higher orders; 8 ulp bounds it.
template <class Exact>
int sum_sign(double p, double q, double r, double s, Exact&& exact) {
  const double pq = p * q, rs = r * s;
  const double sum = pq + rs;
  const double bound = 8 * kUnit * (std::abs(pq) + std::abs(rs)) + kUnderflow;
  if (sum > bound && bound < std::numeric_limits<double>::infinity()) return 1;
  if (sum < -bound && bound < std::numeric_limits<double>::infinity()) return -1;
  return exact();
}

inline int cross(const Ray& p, const Ray& q) {
  return sum_sign(p.rx, q.ry, -p.ry, q.rx,
                  [&] { return sign_of(Ring(p.x * q.y) - Ring(p.y * q.x)); });
}

inline int dot(const Ray& p, const Ray& q) {
  return sum_sign(p.rx, q.rx, p.ry, q.ry,
                  [&] { return sign_of(Ring(p.x * q.x) + Ring(p.y * q.y)); });
}

inline bool same_direction(const Ray& p, const Ray& q) {
  return cross(p, q) == 0 && dot(p, q) > 0;
}

/// A corner of a face as seen along L.
struct Corner {
  int point;
  Ring v;  // v_k
  Ray u;
};

}  // namespace sightline::internal::contacts
