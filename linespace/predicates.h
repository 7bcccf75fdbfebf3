// Exact predicates on points, planes and lines in 3-space.
//
// Every function returns the sign that exact arithmetic would give for the doubles passed
// in, at nearly the cost of plain double arithmetic: a bounded floating-point attempt,
// then intervals, then exact numbers.  The stages are in numbers/predicates.h, which
// only tests and benchmarks include.  No symbolic perturbation: a degenerate input gives
// Sign::Zero, and the caller says what that means.
//
// All require coordinates that is_admissible() accepts (finite, each zero or of magnitude
// in [2^-140, 2^140]), so that nothing of degree 6 overflows and nothing of degree 3
// underflows; Scene refuses others.  All require round-to-nearest, the default of every
// thread.  docs/predicates.md derives the bounds and shows the measurements.

#pragma once

#include <Eigen/Core>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>

#include "linespace/request.h"

namespace sightline {

enum class Sign : std::int8_t { Negative = -1, Zero = 0, Positive = 1 };

constexpr Sign operator-(Sign s) { return static_cast<Sign>(-static_cast<int>(s)); }
constexpr Sign operator*(Sign s, Sign t) {
  return static_cast<Sign>(static_cast<int>(s) * static_cast<int>(t));
}

/// Coordinates that predicates accept: 0, or finite with 2^-140 <= |x| <= 2^140.
inline constexpr double kSmallestCoordinate = 0x1p-140;
inline constexpr double kLargestCoordinate = 0x1p140;
[[nodiscard]] constexpr bool is_admissible(double x) {
  const double m = x < 0 ? -x : x;  // a NaN fails both comparisons
  return m == 0 || (m >= kSmallestCoordinate && m <= kLargestCoordinate);
}

/// An oriented line, given by two different points it passes through, in that order.
struct LineThrough {
  Eigen::Vector3d from;
  Eigen::Vector3d to;
};

/// An oriented plane, given by three points that are not collinear; its front is where
/// they appear counter-clockwise.
struct PlaneThrough {
  Eigen::Vector3d a, b, c;
};

/// On which side of plane abc point d lies: Positive in front (a, b, c counter-clockwise
/// seen from d), Zero when the four points are coplanar.  Degree 3.
[[nodiscard]] Sign orient3d(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            const Eigen::Vector3d& c, const Eigen::Vector3d& d);

/// A point off the plane abc, on one of the axis-parallel lines through a.
[[nodiscard]] Eigen::Vector3d point_off_plane(const Eigen::Vector3d& a,
                                              const Eigen::Vector3d& b,
                                              const Eigen::Vector3d& c);

/// On which side of line l line m passes: Positive when m turns around l by the
/// right-hand rule, Zero exactly when the two are coplanar (they meet or are parallel).
/// Equals orient3d(l.from, l.to, m.from, m.to).  Laws: side(l,m) == side(m,l);
/// side(reversed l, m) == -side(l, m).  Degree 3.
[[nodiscard]] Sign side(const LineThrough& l, const LineThrough& m);

/// Order along an edge of its crossings with two planes.  Let s be the parameter (0 at
/// edge.from, 1 at edge.to) where plane p meets the edge's line, t where plane q does.
/// Returns the sign of s - t; Zero exactly when both planes cross in the same point.
/// Independent of the planes' orientation; reversing the edge negates it.  Requires that
/// neither plane is parallel to the edge (its orient3d values at the two ends differ);
/// Zero otherwise.  Degree 6.
[[nodiscard]] Sign compare_crossings(const LineThrough& edge, const PlaneThrough& p,
                                     const PlaneThrough& q);

/// True when the three points lie on one line, exactly (also when two coincide).
/// Degree 2.
[[nodiscard]] bool collinear(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                             const Eigen::Vector3d& c);

/// The double value of the determinant whose sign orient3d gives, det(b-a, c-a, d-a) (six
/// times the signed volume of the tetrahedron, in cubed scene units), with a rigorous
/// bound: |value - exact| <= error.  error == 0 means that value is 0, exactly.
struct BoundedValue {
  double value;
  double error;
};
[[nodiscard]] BoundedValue orient3d_value(const Eigen::Vector3d& a,
                                          const Eigen::Vector3d& b,
                                          const Eigen::Vector3d& c,
                                          const Eigen::Vector3d& d);

namespace internal {

// Two doubles in one register (SSE2 on any x86-64), by the vector extension that g++ and
// clang share.
using Pair [[gnu::vector_size(16)]] = double;

// (b - a) x (c - a), rounded, and the sums of absolute values of what was added for it.
struct Minors {
  Pair value01, permanent01;  // components 0 and 1
  Pair component2;            // value, permanent
};

}  // namespace internal

/// A plane prepared for many points: plane(p) == orient3d(a, b, c, p), at about half the
/// cost.  Cheap to build (no allocation), a value.
class PlaneSide {
 public:
  explicit PlaneSide(const PlaneThrough& plane);
  [[nodiscard]] Sign operator()(const Eigen::Vector3d& p) const;
  /// The first stage alone: nullopt when its bound is too weak.  Not counted.
  [[nodiscard]] std::optional<Sign> triage(const Eigen::Vector3d& p) const;
  /// The value whose sign is asked, bounded as by orient3d_value(a, b, c, p), but rounded
  /// in another order.
  [[nodiscard]] BoundedValue value(const Eigen::Vector3d& p) const;

 private:
  friend void orient3d_batch(const PlaneThrough& plane, std::span<const double> x,
                             std::span<const double> y, std::span<const double> z,
                             std::span<Sign> signs);
  PlaneThrough plane_;
  internal::Minors normal_;  // the permanents already times the bound's constant
};

/// plane(p_i) for points given as three coordinate arrays of one length; `signs` has that
/// length too (asserted).  Vectorised.
void orient3d_batch(const PlaneThrough& plane, std::span<const double> x,
                    std::span<const double> y, std::span<const double> z,
                    std::span<Sign> signs);

/// How often each stage decided, on this thread since it started.
struct StageCounts {
  std::uint64_t by_double = 0;    ///< rounded arithmetic and its a-priori bound
  std::uint64_t by_interval = 0;  ///< a double-double value in an enclosing interval
  std::uint64_t by_exact = 0;     ///< integers
  friend bool operator==(const StageCounts&, const StageCounts&) = default;
};
[[nodiscard]] StageCounts& thread_stage_counts();

/// While it lives, predicates on this thread run at the given precision: with
/// Precision::Double the sign of the first stage's value is returned as it is (and
/// collinear() is true when no first-stage minor is certainly nonzero).
class PrecisionScope {
 public:
  explicit PrecisionScope(Precision precision);
  ~PrecisionScope();
  PrecisionScope(const PrecisionScope&) = delete;
  PrecisionScope& operator=(const PrecisionScope&) = delete;

 private:
  Precision previous_;
};

// ---- inline first stages --------------------------------------------------------------

#ifdef __FAST_MATH__
#error "The bounds below need IEEE arithmetic: do not compile with -ffast-math."
#endif

namespace internal {

inline constinit thread_local StageCounts stage_counts{};
inline constinit thread_local Precision thread_precision = Precision::Exact;

// Let e = 2^-53.  The determinant of three differences u, v, w is a sum of six terms,
// each of which passes at most 8 roundings: three differences, two products, three
// additions (orient3d adds up u2 (v x w) + v2 (w x u) + w2 (u x v) pair by pair,
// PlaneSide forms the minors u x v first: both have 8).  So the computed value satisfies
//     |value - exact| <= ((1 + e)^8 - 1) P,   P the same sum of absolute values, exact,
// and P is at most its own rounded value / (1 - e)^8.  The constant covers this and the
// rounding of (constant * P):  ((1 + e)^8 - 1) (1 + e) / (1 - e)^8 < 8 e + 128 e^2.
// A compiler that fuses a product into an addition leaves out a rounding, which keeps the
// bound.  Nothing underflows: admissible coordinates are multiples of 2^-192, so that
// differences are 0 or at least that, and products of three 0 or at least 2^-576.  For
// the same reason P == 0 only if all six terms are 0, and then so is the determinant.
inline constexpr double kUnit = std::numeric_limits<double>::epsilon() / 2;
inline constexpr double kTripleProductBound = (8 + 128 * kUnit) * kUnit;

using PairBits [[gnu::vector_size(16)]] = std::int64_t;

[[nodiscard]] inline Pair load_pair(const double* p) {
  Pair x;
  std::memcpy(&x, p, sizeof x);
  return x;
}
[[nodiscard]] inline Pair both(double x) { return Pair{x, x}; }
[[nodiscard]] inline Pair swapped(Pair x) { return __builtin_shufflevector(x, x, 1, 0); }
[[nodiscard]] inline Pair low(Pair x, Pair y) {
  return __builtin_shufflevector(x, y, 0, 2);
}
[[nodiscard]] inline Pair high(Pair x, Pair y) {
  return __builtin_shufflevector(x, y, 1, 3);
}
[[nodiscard]] inline Pair absolute(Pair x) {
  return reinterpret_cast<Pair>(reinterpret_cast<PairBits>(x) &
                                PairBits{INT64_MAX, INT64_MAX});
}
[[nodiscard]] inline Pair absolute_high(Pair x) {
  return reinterpret_cast<Pair>(reinterpret_cast<PairBits>(x) & PairBits{-1, INT64_MAX});
}

[[nodiscard]] inline Minors minors(const double* a, const double* b, const double* c) {
  const double u0 = b[0] - a[0], u1 = b[1] - a[1], u2 = b[2] - a[2];
  const double v0 = c[0] - a[0], v1 = c[1] - a[1], v2 = c[2] - a[2];
  const Pair x = Pair{u1, u2} * Pair{v2, v0}, y = Pair{u2, u0} * Pair{v1, v2};
  const double u0v1 = u0 * v1, u1v0 = u1 * v0;
  return {x - y, absolute(x) + absolute(y),
          Pair{u0v1 - u1v0, std::abs(u0v1) + std::abs(u1v0)}};
}

// A value that is off by at most kTripleProductBound * permanent.
struct ValueAndPermanent {
  double value, permanent;
};

// (p - q) . normal.
[[nodiscard]] inline ValueAndPermanent triple_product(const Minors& normal,
                                                      const double* p, const double* q) {
  const Pair w01 = load_pair(p) - load_pair(q);
  const Pair value = w01 * normal.value01;
  const Pair permanent = absolute(w01) * normal.permanent01;
  const Pair sum = (low(value, permanent) + high(value, permanent)) +
                   absolute_high(both(p[2] - q[2])) * normal.component2;
  return {sum[0], sum[1]};
}

// det(b - a, c - a, d - a).  In x each lane sums up three of the six terms.
[[nodiscard]] inline ValueAndPermanent determinant(const double* a, const double* b,
                                                   const double* c, const double* d) {
  const Pair a01 = load_pair(a);
  const Pair u01 = load_pair(b) - a01, v01 = load_pair(c) - a01, w01 = load_pair(d) - a01;
  const Pair vw = v01 * swapped(w01) * both(b[2] - a[2]);
  const Pair wu = w01 * swapped(u01) * both(c[2] - a[2]);
  const Pair uv = u01 * swapped(v01) * both(d[2] - a[2]);
  const Pair x = (vw + wu) + uv;
  const Pair y = (absolute(vw) + absolute(wu)) + absolute(uv);
  return {x[0] - x[1], y[0] + y[1]};
}

// |value| > error for error >= 0, on the bits, where that order is the same: integer
// units are idle while others multiply.
[[nodiscard]] inline bool exceeds(double value, std::uint64_t error_bits) {
  return std::bit_cast<std::uint64_t>(value) << 1 >> 1 > error_bits;
}
// A double at least kTripleProductBound * permanent: 2^-50 = 8 e is 50 off the exponent,
// and 64 units in the last place are at least a factor 1 + 64 e.  For permanent == 0,
// wraps to what nothing exceeds.
[[nodiscard]] inline std::uint64_t error_bits(double permanent) {
  return std::bit_cast<std::uint64_t>(permanent) - (std::uint64_t{50} << 52) + 64;
}

[[nodiscard]] inline Sign sign_of(double x) {
  return static_cast<Sign>(static_cast<int>(x > 0) - static_cast<int>(x < 0));
}
// The sign of x, which is not 0.
[[nodiscard]] inline Sign sign_of_nonzero(double x) {
  return static_cast<Sign>((std::bit_cast<std::int64_t>(x) >> 63) | 1);
}

// Stages after the first; they count which of them decided.  `value` is the first
// stage's.
[[nodiscard]] Sign decide_orient3d(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                   const Eigen::Vector3d& c, const Eigen::Vector3d& d,
                                   double value);

}  // namespace internal

inline StageCounts& thread_stage_counts() { return internal::stage_counts; }

inline BoundedValue orient3d_value(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                   const Eigen::Vector3d& c, const Eigen::Vector3d& d) {
  const auto [value, permanent] =
      internal::determinant(a.data(), b.data(), c.data(), d.data());
  return {value, internal::kTripleProductBound * permanent};
}

inline Sign orient3d(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                     const Eigen::Vector3d& c, const Eigen::Vector3d& d) {
  const auto [value, permanent] =
      internal::determinant(a.data(), b.data(), c.data(), d.data());
  if (internal::exceeds(value, internal::error_bits(permanent))) [[likely]] {
    ++internal::stage_counts.by_double;
    return internal::sign_of_nonzero(value);
  }
  if (permanent == 0) {
    ++internal::stage_counts.by_double;
    return Sign::Zero;
  }
  return internal::decide_orient3d(a, b, c, d, value);
}

inline Sign side(const LineThrough& l, const LineThrough& m) {
  return orient3d(l.from, l.to, m.from, m.to);
}

inline PlaneSide::PlaneSide(const PlaneThrough& plane)
    : plane_(plane),
      normal_(internal::minors(plane.a.data(), plane.b.data(), plane.c.data())) {
  normal_.permanent01 *= internal::kTripleProductBound;
  normal_.component2 *= internal::Pair{1, internal::kTripleProductBound};
}

inline BoundedValue PlaneSide::value(const Eigen::Vector3d& p) const {
  const auto v = internal::triple_product(normal_, p.data(), plane_.a.data());
  return {v.value, v.permanent};
}

inline std::optional<Sign> PlaneSide::triage(const Eigen::Vector3d& p) const {
  const auto [v, error] = value(p);
  if (std::abs(v) > error || error == 0) return internal::sign_of(v);
  return std::nullopt;
}

inline Sign PlaneSide::operator()(const Eigen::Vector3d& p) const {
  const auto [v, error] = value(p);
  if (internal::exceeds(v, std::bit_cast<std::uint64_t>(error))) [[likely]] {
    ++internal::stage_counts.by_double;
    return internal::sign_of_nonzero(v);
  }
  if (error == 0) {
    ++internal::stage_counts.by_double;
    return Sign::Zero;
  }
  return internal::decide_orient3d(plane_.a, plane_.b, plane_.c, p, v);
}

}  // namespace sightline
