// The lines through three edges, as a curve in the parameters of the outer two.
//
// Notation.  P(s) runs over the first edge, Q(t) over the last, 0 <= s, t <= 1.  A third
// line G0G1 has the form
//   F(s, t) = sum f_ab x_a y_b,  f_ab = orient3d(P_a, Q_b, G0, G1),  x = (1-s, s),
//   y = (1-t, t),
// zero where PQ meets it.  Write F0(s) = F(s, 0), F1(s) = F(s, 1).  Through the middle
// edge, F = 0, passes the curve t = F0 / (F0 - F1), which lies in the square where F0 and
// F1 have opposite signs.  On it another form G has the value H / (F0 - F1) with
//   H(s) = F0 G1 - F1 G0,
// a quadratic.  So all that can change along the curve are roots in s of linear and
// quadratic polynomials whose coefficients are products of orient3d values: the cuts.

#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "linespace/lines/transversals.h"
#include "linespace/numbers/exact_numbers.h"
#include "linespace/numbers/rational.h"
#include "linespace/predicates.h"
#include "linespace/scene.h"
#include "linespace/space/shaft.h"
#include "linespace/swaths/quadratic_root.h"

namespace sightline::internal {

/// The sign of what `value` is off by at most `error`; Zero when it is not certain.
[[nodiscard]] inline Sign certain_sign(double value, double error) {
  return value > error ? Sign::Positive : value < -error ? Sign::Negative : Sign::Zero;
}

/// A line that forms are asked of, by two of its points.
struct Carrier {
  std::array<std::int32_t, 2> points;  ///< point ids, the smaller first
  std::int32_t edge;                   ///< scene edge, -1 for a flat side
};

/// The corner values of a form, each off by at most `error`, some known to be 0 exactly;
/// magnitudes at most `largest`.
struct BoundedForm {
  double f[2][2];
  bool zero[2][2];
  double error;
  double largest;

  /// Known to be zero everywhere: all lines of the pair meet the carrier.
  [[nodiscard]] bool vanishes() const {
    return zero[0][0] && zero[0][1] && zero[1][0] && zero[1][1];
  }
};

/// The two outer edges, by point ids.
struct OuterPair {
  const Scene* scene;
  std::array<std::int32_t, 2> p, q;

  [[nodiscard]] const Point& at(std::int32_t id) const { return scene->point(id); }
  [[nodiscard]] BoundedForm form(const Carrier& g) const;
  [[nodiscard]] BilinearForm<Ring> exact_form(const Carrier& g) const;
};

/// What cuts the curve at a position.
enum class CurveCutKind : std::uint8_t {
  Start,     ///< the first end point of the first edge
  End,       ///< its second
  Far,       ///< an end point of the last edge
  Middle,    ///< an end point of the middle edge
  OnFirst,   ///< the line lies in the plane of a face at the first edge
  OnPlane,   ///< the first edge's point lies in a plane: of a face at the middle or last
             ///< edge, or of a face that the first edge enters
  OnFar,     ///< the last edge's point lies in the plane of a face that this edge enters
  Crossing,  ///< the line meets a fourth one
  Given      ///< at a parameter that was told: of EeeCurve::cut_at()
};

/// A position on the curve.  Two cuts with the same kind, feature and `rising` are equal.
struct CurveCut {
  CurveCutKind kind;
  /// Crossing: H has two roots.  True: the cut is the root at which H rises; false: the
  /// one at which it falls.  Of the two forms of H, that of the carrier with the smaller
  /// number comes first, so that the sign of H does not depend on who asks.
  bool rising = false;
  /// Far, Middle: point id; OnFirst, OnPlane, OnFar: facet id; Crossing: carrier;
  /// Given: number.
  std::int32_t feature = -1;
  /// OnFirst, OnPlane, OnFar: three points of the plane.
  std::array<std::int32_t, 3> plane{-1, -1, -1};
  /// Enclosure of s.
  double lo = 0, hi = 0;

  [[nodiscard]] double parameter() const { return 0.5 * (lo + hi); }
  [[nodiscard]] bool same_as(const CurveCut& other) const {
    return kind == other.kind && feature == other.feature && rising == other.rising;
  }
};
inline CurveCut curve_start() {
  return {CurveCutKind::Start, false, -1, {-1, -1, -1}, 0, 0};
}
inline CurveCut curve_end() { return {CurveCutKind::End, false, -1, {-1, -1, -1}, 1, 1}; }

struct CurveInterval {
  CurveCut from, to;
};

/// A polynomial of degree 1 in s by its values at 0 and 1, each with a bound, and their
/// exact signs.
struct BoundedLinear {
  double at0, at1;
  double error0, error1;
  Sign sign0, sign1;

  [[nodiscard]] bool constant() const { return sign0 == sign1; }
  /// Somewhere inside (0, 1) it has that sign.
  [[nodiscard]] bool ever(Sign s) const { return sign0 == s || sign1 == s; }
};

/// Encloses the root of a linear polynomial whose values at the ends differ in sign.
void enclose_root(const BoundedLinear& l, CurveCut& cut);

/// The curve of one triple.  Keeps references; scratch of one computation.
class EeeCurve {
 public:
  EeeCurve(const OuterPair& pair, const std::vector<Carrier>& carriers, int middle,
           const BoundedForm& form)
      : pair_(pair), carriers_(carriers), middle_(middle), form_(form) {}

  [[nodiscard]] int middle() const { return middle_; }
  [[nodiscard]] const BoundedForm& form() const { return form_; }
  [[nodiscard]] const OuterPair& pair() const { return pair_; }

  /// The cut at a parameter strictly between 0 and 1, for this curve only.
  [[nodiscard]] CurveCut cut_at(const Rational& s) const;

  /// Order of two cuts: the sign of s(a) - s(b), exact.
  [[nodiscard]] Sign compare(const CurveCut& a, const CurveCut& b) const;

  /// The value at Q(t(s)) of a plane whose values at Q0, Q1 are a0, a1, times (F0 - F1):
  /// linear in s.
  [[nodiscard]] BoundedLinear at_last_edge(
      const BoundedValue& a0, const BoundedValue& a1,
      const std::array<std::int32_t, 3>& plane) const;

  /// Restricts the interval to where H of the carrier has the wanted sign; appends the
  /// parts, in order, to `out`.  `degenerate` is set when H is zero all along.
  void where(int carrier, const BoundedForm& form, Sign wanted, const CurveInterval& in,
             std::vector<CurveInterval>& out, bool& degenerate) const;

  /// Not certain that the form is anything but zero all along.
  [[nodiscard]] bool may_vanish(const BoundedForm& form) const;

  /// Positive when, at a cut where the line meets the carrier g between the outer edges,
  /// the middle edge's contact lies further along than g's; Zero when they coincide.
  [[nodiscard]] Sign order_at(const CurveCut& cut, int carrier,
                              const BoundedForm& form) const;

  /// Certain that the line at the cut does not meet the carrier's line.
  [[nodiscard]] bool misses(const CurveCut& cut, const BoundedForm& form) const;

  /// The points of the first and the last edge at the cut; nullopt where they are not
  /// rational.
  [[nodiscard]] std::optional<std::array<ExactPoint, 2>> points_at(
      const CurveCut& cut) const;

  [[nodiscard]] std::optional<std::array<ExactPoint, 2>> points_at(
      const Rational& s) const;

  /// H of the carrier, taken in order of carriers, rises at its root s; without s: at the
  /// larger, or the smaller one of two.
  [[nodiscard]] bool rises_at(int carrier, const std::optional<Rational>& s,
                              bool larger) const;

  /// The line at a crossing, wherever it lies.
  [[nodiscard]] std::optional<ExactLine> line_at(const CurveCut& cut) const;

  /// A rational parameter strictly between two cuts; nullopt where they are irrational
  /// and closer than doubles tell apart.
  [[nodiscard]] std::optional<Rational> between(const CurveCut& a,
                                                const CurveCut& b) const;

  /// The cut's s, off by at most kRangeError (at precision Double: as computed).
  [[nodiscard]] double rounded(const CurveCut& cut) const;

  /// An enclosure of t at a cut, within [0, 1].
  [[nodiscard]] std::array<double, 2> enclose_last(const CurveCut& cut) const;

  /// t at s, rounded.
  [[nodiscard]] double last_parameter(double s) const;

 private:
  [[nodiscard]] QuadraticRoot exact(const CurveCut& cut) const;
  [[nodiscard]] std::optional<Rational> rational_parameter(const CurveCut& cut) const;
  [[nodiscard]] const BilinearForm<Ring>& exact_form() const;
  template <class Orient, class CurveForm>
  [[nodiscard]] auto linear(const CurveCut& cut, const Orient& orient,
                            const CurveForm& form) const;
  [[nodiscard]] BilinearForm<BallNumber> ball_form(int carrier) const;
  [[nodiscard]] std::optional<double> rounded_from_balls(const CurveCut& cut) const;
  [[nodiscard]] std::array<Ring, 2> exact_linear(const CurveCut& cut) const;
  [[nodiscard]] Quadratic<Ring> exact_quadratic(int carrier) const;
  void where_exactly(int carrier, Sign wanted, const CurveInterval& in,
                     std::vector<CurveInterval>& out, bool& degenerate) const;
  [[nodiscard]] Sign rounded_order_at(const CurveCut& cut, int carrier,
                                      const BoundedForm& form) const;
  [[nodiscard]] CurveCut exact_crossing(int carrier, bool rises) const;
  [[nodiscard]] bool is_before(const CurveCut& a, const CurveCut& b) const;
  void keep(const CurveInterval& in, const CurveCut* roots, int count, Sign first,
            Sign wanted, std::vector<CurveInterval>& out) const;

  const OuterPair& pair_;
  const std::vector<Carrier>& carriers_;
  int middle_;
  BoundedForm form_;
  mutable std::optional<BilinearForm<Ring>> exact_form_;
  mutable std::vector<Rational> given_;
};

}  // namespace sightline::internal
