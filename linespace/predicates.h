// Exact predicates on points, planes and lines in 3-space.
//
// Every function returns the sign that exact arithmetic would give for the doubles passed
// in, at nearly the cost of plain double arithmetic: a bounded floating-point attempt,
// then intervals, then exact numbers.  The stages are in predicates_internal.h, which
// only tests and benchmarks include.  No symbolic perturbation: a degenerate input gives
// Sign::Zero, and the caller says what that means.
//
// All require coordinates that is_admissible() accepts (finite, each zero or of magnitude
// in [2^-140, 2^140]), so that nothing of degree 6 overflows and nothing of degree 3
// underflows; Scene refuses others.  All require round-to-nearest, the default of every
// thread.  docs/predicates.md derives the bounds and shows the measurements.

#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
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

/// A plane prepared for many points: plane(p) == orient3d(a, b, c, p), at about a third
/// of the cost.  Cheap to build (no allocation), a value.
class PlaneSide {
 public:
  explicit PlaneSide(const PlaneThrough& plane);
  [[nodiscard]] Sign operator()(const Eigen::Vector3d& p) const;
  /// The first stage alone: nullopt when its bound is too weak.  Not counted.
  [[nodiscard]] std::optional<Sign> triage(const Eigen::Vector3d& p) const;
  /// The value whose sign is asked, as orient3d_value(a, b, c, p) gives it.
  [[nodiscard]] BoundedValue value(const Eigen::Vector3d& p) const;

 private:
  friend void orient3d_batch(const PlaneThrough& plane, std::span<const double> x,
                             std::span<const double> y, std::span<const double> z,
                             std::span<Sign> signs);
  PlaneThrough plane_;
  double normal_[3];  // (b - a) x (c - a), rounded
  double weight_[3];  // |value - exact| <= sum of weight_[i] |p[i] - a[i]|
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

// Let e = 2^-53.  In w . (u x v), with u, v, w differences of coordinates, each of the
// six terms passes at most 8 roundings: three differences, a product, the difference of a
// minor, another product, two additions.  So the sum S satisfies
//     |S - exact| <= ((1 + e)^8 - 1) P,   P the same sum of absolute values, exact,
// and P in turn is at most its own rounded value / (1 - e)^8.  The constant covers this
// and the rounding of (constant * P): ((1 + e)^8 - 1) (1 + e) / (1 - e)^8 < 8 e + 128
// e^2. A compiler that fuses a product into an addition leaves out a rounding, which
// keeps the bound.  Nothing underflows: differences are 0 or at least 2^-192, since
// admissible coordinates are multiples of 2^-192; so a product of three is 0 or at least
// 2^-576. For the same reason P == 0 only if all six terms are 0, and then so is the
// determinant.
inline constexpr double kUnit = std::numeric_limits<double>::epsilon() / 2;
inline constexpr double kTripleProductBound = (8 + 128 * kUnit) * kUnit;

// The normal of a plane, or rather (b - a) x (c - a), and the same with absolute values.
struct Minors {
  double value[3];
  double permanent[3];
};
[[nodiscard]] inline Minors minors(const double* a, const double* b, const double* c) {
  const double u0 = b[0] - a[0], u1 = b[1] - a[1], u2 = b[2] - a[2];
  const double v0 = c[0] - a[0], v1 = c[1] - a[1], v2 = c[2] - a[2];
  const double u1v2 = u1 * v2, u2v1 = u2 * v1;
  const double u2v0 = u2 * v0, u0v2 = u0 * v2;
  const double u0v1 = u0 * v1, u1v0 = u1 * v0;
  return {{u1v2 - u2v1, u2v0 - u0v2, u0v1 - u1v0},
          {std::abs(u1v2) + std::abs(u2v1), std::abs(u2v0) + std::abs(u0v2),
           std::abs(u0v1) + std::abs(u1v0)}};
}

// Stages after the first; they count which of them decided.  `value` is the first
// stage's.
[[nodiscard]] Sign decide_orient3d(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                   const Eigen::Vector3d& c, const Eigen::Vector3d& d,
                                   double value);

[[nodiscard]] inline Sign sign_of(double x) {
  return static_cast<Sign>(static_cast<int>(x > 0) - static_cast<int>(x < 0));
}

}  // namespace internal

inline StageCounts& thread_stage_counts() { return internal::stage_counts; }

inline BoundedValue orient3d_value(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                   const Eigen::Vector3d& c, const Eigen::Vector3d& d) {
  const auto n = internal::minors(a.data(), b.data(), c.data());
  const double w0 = d.data()[0] - a.data()[0];
  const double w1 = d.data()[1] - a.data()[1];
  const double w2 = d.data()[2] - a.data()[2];
  const double permanent = std::abs(w0) * n.permanent[0] + std::abs(w1) * n.permanent[1] +
                           std::abs(w2) * n.permanent[2];
  return {w0 * n.value[0] + w1 * n.value[1] + w2 * n.value[2],
          internal::kTripleProductBound * permanent};
}

inline Sign orient3d(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                     const Eigen::Vector3d& c, const Eigen::Vector3d& d) {
  const auto [value, error] = orient3d_value(a, b, c, d);
  if (std::abs(value) > error || error == 0) [[likely]] {
    ++internal::stage_counts.by_double;
    return internal::sign_of(value);
  }
  return internal::decide_orient3d(a, b, c, d, value);
}

inline Sign side(const LineThrough& l, const LineThrough& m) {
  return orient3d(l.from, l.to, m.from, m.to);
}

inline PlaneSide::PlaneSide(const PlaneThrough& plane) : plane_(plane) {
  const auto n = internal::minors(plane.a.data(), plane.b.data(), plane.c.data());
  for (int i = 0; i < 3; ++i) {
    normal_[i] = n.value[i];
    weight_[i] = internal::kTripleProductBound * n.permanent[i];
  }
}

inline BoundedValue PlaneSide::value(const Eigen::Vector3d& p) const {
  const double w0 = p.data()[0] - plane_.a.data()[0];
  const double w1 = p.data()[1] - plane_.a.data()[1];
  const double w2 = p.data()[2] - plane_.a.data()[2];
  return {
      w0 * normal_[0] + w1 * normal_[1] + w2 * normal_[2],
      std::abs(w0) * weight_[0] + std::abs(w1) * weight_[1] + std::abs(w2) * weight_[2]};
}

inline std::optional<Sign> PlaneSide::triage(const Eigen::Vector3d& p) const {
  const auto [v, error] = value(p);
  if (std::abs(v) > error || error == 0) return internal::sign_of(v);
  return std::nullopt;
}

inline Sign PlaneSide::operator()(const Eigen::Vector3d& p) const {
  const auto [v, error] = value(p);
  if (std::abs(v) > error || error == 0) [[likely]] {
    ++internal::stage_counts.by_double;
    return internal::sign_of(v);
  }
  return internal::decide_orient3d(plane_.a, plane_.b, plane_.c, p, v);
}

}  // namespace sightline
