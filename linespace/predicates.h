// Exact predicates on points, planes and lines in 3-space.
//
// Every function returns the sign that exact arithmetic would give for the doubles passed
// in, at nearly the cost of plain double arithmetic: a bounded floating-point attempt,
// then intervals, then exact numbers.  The stages are in predicates_internal.h, which
// only tests and benchmarks include.  No symbolic perturbation: a degenerate input gives
// Sign::Zero, and the caller says what that means.
//
// All require finite coordinates, each zero or of magnitude in [2^-140, 2^140], so that
// nothing of degree 6 overflows and nothing of degree 3 underflows; Scene refuses others.

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>

#include "linespace/request.h"

namespace sightline {

enum class Sign : std::int8_t { Negative = -1, Zero = 0, Positive = 1 };

constexpr Sign operator-(Sign s) { return static_cast<Sign>(-static_cast<int>(s)); }
constexpr Sign operator*(Sign s, Sign t) {
  return static_cast<Sign>(static_cast<int>(s) * static_cast<int>(t));
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

/// On which side of line l line m passes: Positive when m turns around l by the right-hand
/// rule, Zero exactly when the two are coplanar (they meet or are parallel).  Equals
/// orient3d(l.from, l.to, m.from, m.to).  Laws: side(l,m) == side(m,l);
/// side(reversed l, m) == -side(l, m).  Degree 3.
[[nodiscard]] Sign side(const LineThrough& l, const LineThrough& m);

/// Order along an edge of its crossings with two planes.  Let s be the parameter (0 at
/// edge.from, 1 at edge.to) where plane p meets the edge's line, t where plane q does.
/// Returns the sign of s - t.  Requires that neither plane is parallel to the edge (its
/// orient3d values at the two ends differ).  Degree 6.
[[nodiscard]] Sign compare_crossings(const LineThrough& edge, const PlaneThrough& p,
                                     const PlaneThrough& q);

/// True when the three points lie on one line, exactly.
[[nodiscard]] bool collinear(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                             const Eigen::Vector3d& c);

/// The double value of the determinant whose sign orient3d gives, with a rigorous bound:
/// |value - exact| <= error.
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
  /// The first stage alone: nullopt when its bound is too weak.
  [[nodiscard]] std::optional<Sign> triage(const Eigen::Vector3d& p) const;
};

/// plane(p_i) for points given as three coordinate arrays of one length; `signs` has that
/// length too.  Vectorised.
void orient3d_batch(const PlaneThrough& plane, std::span<const double> x,
                    std::span<const double> y, std::span<const double> z,
                    std::span<Sign> signs);

/// How often each stage decided, on this thread since it started.
struct StageCounts {
  std::uint64_t by_double = 0;
  std::uint64_t by_interval = 0;
  std::uint64_t by_exact = 0;
};
[[nodiscard]] StageCounts& thread_stage_counts();

/// While it lives, predicates on this thread run at the given precision: with
/// Precision::Double the sign of the first stage's value is returned as it is.
class PrecisionScope {
 public:
  explicit PrecisionScope(Precision precision);
  ~PrecisionScope();
  PrecisionScope(const PrecisionScope&) = delete;
  PrecisionScope& operator=(const PrecisionScope&) = delete;

 private:
  Precision previous_;
};

}  // namespace sightline
