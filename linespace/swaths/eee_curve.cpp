#include "linespace/swaths/eee_curve.h"

#include <CGAL/Gmpq.h>
#include <CGAL/Gmpz.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "linespace/generator.h"
#include "linespace/lines/rounded_root.h"
#include "linespace/numbers/predicates.h"

namespace sightline::internal {
namespace {

[[nodiscard]] bool in_double() { return thread_precision == Precision::Double; }

// Sum of the roundings of H's coefficients and of their inputs' errors: each coefficient
// is a sum of two products (the middle one of four, halved), |f g| <= largest^2.
[[nodiscard]] double product_error(const BoundedForm& f, const BoundedForm& g) {
  return 2.5 * (f.largest * g.error + f.error * g.largest + f.error * g.error +
                4 * kUnit * f.largest * g.largest);
}

// H in Bernstein form: value at 0, blossom (0, 1), value at 1.
struct Bernstein {
  double h0, h1, h2;
  double error;

  [[nodiscard]] double blossom(double a, double b) const {
    const double l = h0 + (h1 - h0) * a;
    const double r = h1 + (h2 - h1) * a;
    return l + (r - l) * b;
  }
};

[[nodiscard]] Bernstein quadratic(const BoundedForm& f, const BoundedForm& g) {
  Bernstein h{};
  h.h0 = f.f[0][0] * g.f[0][1] - f.f[0][1] * g.f[0][0];
  h.h1 = 0.5 * ((f.f[0][0] * g.f[1][1] + f.f[1][0] * g.f[0][1]) -
                (f.f[0][1] * g.f[1][0] + f.f[1][1] * g.f[0][0]));
  h.h2 = f.f[1][0] * g.f[1][1] - f.f[1][1] * g.f[1][0];
  // Six roundings of a blossom, each of at most twice the largest coefficient.
  // A margin beyond [0, 1], 1 / 100 at most, adds less than a tenth.
  h.error = 1.1 * product_error(f, g) +
            20 * kUnit * (std::abs(h.h0) + std::abs(h.h1) + std::abs(h.h2));
  return h;
}

}  // namespace

BoundedForm OuterPair::form(const Carrier& g) const {
  BoundedForm out{};
  const Point& g0 = at(g.points[0]);
  const Point& g1 = at(g.points[1]);
  for (int a = 0; a < 2; ++a) {
    // orient3d(P, Q, G0, G1) == orient3d(P, G0, G1, Q), an even permutation.
    const PlaneSide plane({at(p[a]), g0, g1});
    for (int b = 0; b < 2; ++b) {
      const BoundedValue v = plane.value(at(q[b]));
      out.f[a][b] = v.value;
      out.zero[a][b] = v.error == 0;
      out.error = std::max(out.error, v.error);
      out.largest = std::max(out.largest, std::abs(v.value));
    }
  }
  return out;
}

BilinearForm<Ring> OuterPair::exact_form(const Carrier& g) const {
  return ring_form({at(p[0]), at(p[1])}, {at(q[0]), at(q[1])},
                   {at(g.points[0]), at(g.points[1])});
}

void enclose_root(const BoundedLinear& l, CurveCut& cut) {
  const auto [lo, hi] = enclosed_root(l.at0, l.error0, l.at1, l.error1);
  cut.lo = lo;
  cut.hi = hi;
}

const BilinearForm<Ring>& EeeCurve::exact_form() const {
  if (!exact_form_) exact_form_ = pair_.exact_form(carriers_[middle_]);
  return *exact_form_;
}

// Values at 0 and 1 of the linear polynomial whose root the cut is, by numbers of any
// type: orient(plane, point) gives them, and form() those of the curve.
template <class Orient, class CurveForm>
auto EeeCurve::linear(const CurveCut& cut, const Orient& orient,
                      const CurveForm& form) const {
  using T = decltype(orient(cut.plane, 0));
  const auto& g = carriers_[middle_].points;
  const auto along_first = [&](const std::array<std::int32_t, 3>& plane) {
    return std::array<T, 2>{orient(plane, pair_.p[0]), orient(plane, pair_.p[1])};
  };
  switch (cut.kind) {
    case CurveCutKind::Far:
      return along_first({cut.feature, g[0], g[1]});
    case CurveCutKind::Middle:
      return along_first({pair_.q[0], pair_.q[1], cut.feature});
    case CurveCutKind::OnPlane:
      return along_first(cut.plane);
    default: {
      const T a0 = orient(cut.plane, pair_.q[0]);
      const T a1 = orient(cut.plane, pair_.q[1]);
      const BilinearForm<T>& f = form();
      return std::array<T, 2>{a1 * f.f[0][0] - a0 * f.f[0][1],
                              a1 * f.f[1][0] - a0 * f.f[1][1]};
    }
  }
}

std::array<Ring, 2> EeeCurve::exact_linear(const CurveCut& cut) const {
  const auto orient = [&](const std::array<std::int32_t, 3>& plane, std::int32_t point) {
    return ring_orient3d(pair_.at(plane[0]), pair_.at(plane[1]), pair_.at(plane[2]),
                         pair_.at(point));
  };
  return linear(cut, orient, [&]() -> const BilinearForm<Ring>& { return exact_form(); });
}

BilinearForm<BallNumber> EeeCurve::ball_form(int carrier) const {
  const auto& g = carriers_[carrier].points;
  BilinearForm<BallNumber> form;
  for (int a = 0; a < 2; ++a) {
    for (int b = 0; b < 2; ++b) {
      form.f[a][b] = ball_orient3d(pair_.at(pair_.p[a]), pair_.at(pair_.q[b]),
                                   pair_.at(g[0]), pair_.at(g[1]));
    }
  }
  return form;
}

// nullopt: not accurate enough.
std::optional<double> EeeCurve::rounded_from_balls(const CurveCut& cut) const {
  if (cut.kind == CurveCutKind::Crossing) {
    return rounded_root(resultant(ball_form(middle_), ball_form(cut.feature)),
                        cut.rising == (middle_ < cut.feature));
  }
  const auto orient = [&](const std::array<std::int32_t, 3>& plane, std::int32_t point) {
    return ball_orient3d(pair_.at(plane[0]), pair_.at(plane[1]), pair_.at(plane[2]),
                         pair_.at(point));
  };
  const auto [at0, at1] = linear(cut, orient, [&] { return ball_form(middle_); });
  return rounded_root(at0, at1);
}

// Coefficients of H = h0 (1-s)^2 + h1 s (1-s) + h2 s^2.
Quadratic<Ring> EeeCurve::exact_quadratic(int carrier) const {
  return resultant(exact_form(), pair_.exact_form(carriers_[carrier]));
}

QuadraticRoot EeeCurve::exact(const CurveCut& cut) const {
  if (cut.kind == CurveCutKind::Start) return {0, 0, 1, 0};
  if (cut.kind == CurveCutKind::End) return {1, 0, 1, 0};
  if (cut.kind == CurveCutKind::Given) {
    const Rational& s = given_[static_cast<std::size_t>(cut.feature)];
    const auto ring = [](const auto& x) { return Ring(CGAL::Gmpz(x.backend().data())); };
    return {ring(numerator(s)), 0, ring(denominator(s)), 0};
  }
  if (cut.kind != CurveCutKind::Crossing) {
    const auto [x, y] = exact_linear(cut);
    return linear_root(x, y);
  }
  // Where H rises, taken in order of carriers: H as it is may be turned.
  return root(exact_quadratic(cut.feature), cut.rising == (middle_ < cut.feature));
}

bool EeeCurve::rises_at(int carrier, const std::optional<Rational>& s,
                        bool larger) const {
  const auto h = exact_quadratic(carrier);
  const Ring a = h.h0 - h.h1 + h.h2;
  const Ring b = h.h1 - 2 * h.h0;
  Sign slope = larger ? sign_of(a) : -sign_of(a);
  if (s) {
    const auto ring = [](const auto& x) { return Ring(CGAL::Gmpz(x.backend().data())); };
    slope = sign_of(b * ring(denominator(*s)) + 2 * a * ring(numerator(*s)));
  }
  return slope == (middle_ < carrier ? Sign::Positive : Sign::Negative);
}

CurveCut EeeCurve::cut_at(const Rational& s) const {
  constexpr double slack = 16 * kUnit;
  const double near = s.convert_to<double>();
  CurveCut cut{CurveCutKind::Given};
  cut.feature = static_cast<std::int32_t>(given_.size());
  cut.lo = near * (1 - slack);
  cut.hi = std::min(1.0, near * (1 + slack));
  given_.push_back(s);
  return cut;
}

Sign EeeCurve::compare(const CurveCut& a, const CurveCut& b) const {
  const auto fixed = [](const CurveCut& c) {
    return c.kind == CurveCutKind::Start ? -1 : c.kind == CurveCutKind::End ? 1 : 0;
  };
  const int fa = fixed(a);
  const int fb = fixed(b);
  if (fa != 0 || fb != 0) return static_cast<Sign>((fa > fb) - (fa < fb));
  if (a.same_as(b)) return Sign::Zero;
  if (a.hi < b.lo) return Sign::Negative;
  if (a.lo > b.hi) return Sign::Positive;
  if (in_double()) return sign_of(a.parameter() - b.parameter());
  ++stage_counts.by_exact;
  return internal::compare(exact(a), exact(b));
}

BoundedLinear EeeCurve::at_last_edge(const BoundedValue& a0, const BoundedValue& a1,
                                     const std::array<std::int32_t, 3>& plane) const {
  BoundedLinear l{};
  const double largest = std::max(std::abs(a0.value), std::abs(a1.value));
  const double error = std::max(a0.error, a1.error);
  l.at0 = a1.value * form_.f[0][0] - a0.value * form_.f[0][1];
  l.at1 = a1.value * form_.f[1][0] - a0.value * form_.f[1][1];
  l.error0 = l.error1 = 2.5 * (largest * form_.error + error * form_.largest +
                               error * form_.error + 4 * kUnit * largest * form_.largest);
  l.sign0 = certain_sign(l.at0, l.error0);
  l.sign1 = certain_sign(l.at1, l.error1);
  if (l.sign0 != Sign::Zero && l.sign1 != Sign::Zero) return l;
  if (in_double()) {
    l.sign0 = sign_of(l.at0);
    l.sign1 = sign_of(l.at1);
    return l;
  }
  ++stage_counts.by_exact;
  CurveCut cut{CurveCutKind::OnFar};
  cut.plane = plane;
  const auto [x, y] = exact_linear(cut);
  l.sign0 = sign_of(x);
  l.sign1 = sign_of(y);
  return l;
}

bool EeeCurve::misses(const CurveCut& cut, const BoundedForm& form) const {
  const Bernstein h = quadratic(form_, form);
  const Sign at_lo = certain_sign(h.blossom(cut.lo, cut.lo), h.error);
  // Of one sign at both ends of so short an enclosure, and flat enough between.
  const double between = h.blossom(cut.lo, cut.hi);
  return at_lo != Sign::Zero && at_lo == certain_sign(between, h.error) &&
         at_lo == certain_sign(h.blossom(cut.hi, cut.hi), h.error);
}

bool EeeCurve::may_vanish(const BoundedForm& form) const {
  const Bernstein h = quadratic(form_, form);
  return std::max({std::abs(h.h0), std::abs(h.h1), std::abs(h.h2)}) <= h.error;
}

namespace {}  // namespace

std::optional<Rational> EeeCurve::rational_parameter(const CurveCut& cut) const {
  const QuadraticRoot root = exact(cut);
  // Only where a sign was left to rounding has the cut no place of its own.
  if (is_zero(root.c)) return Rational(cut.parameter());
  Rational s = rational(root.a);
  if (!is_zero(root.b) && !is_zero(root.d)) {
    const auto r = rational_root(root.d);
    if (!r) return std::nullopt;
    s += rational(root.b) * rational(*r);
  }
  return Rational(s / rational(root.c));
}

std::optional<std::array<ExactPoint, 2>> EeeCurve::points_at(const CurveCut& cut) const {
  const auto s = rational_parameter(cut);
  if (!s) return std::nullopt;
  return points_at(*s);
}

std::optional<std::array<ExactPoint, 2>> EeeCurve::points_at(const Rational& s) const {
  const auto point = [](const Point& a, const Point& b, const Rational& x) {
    const ExactPoint p = exact_point(a);
    const ExactPoint q = exact_point(b);
    return ExactPoint{p[0] + x * (q[0] - p[0]), p[1] + x * (q[1] - p[1]),
                      p[2] + x * (q[2] - p[2])};
  };
  const auto& f = exact_form().f;
  Rational f0 = rational(f[0][0]) * (1 - s) + rational(f[1][0]) * s;
  Rational f1 = rational(f[0][1]) * (1 - s) + rational(f[1][1]) * s;
  if (f0 == 0 && f1 == 0) {
    // P(s) is on the middle edge's line, which is coplanar with the first: t is constant.
    f0 = rational(f[1][0]) - rational(f[0][0]);
    f1 = rational(f[1][1]) - rational(f[0][1]);
  }
  if (f0 == f1) return std::nullopt;
  const Rational t = f0 / (f0 - f1);
  return std::array<ExactPoint, 2>{point(pair_.at(pair_.p[0]), pair_.at(pair_.p[1]), s),
                                   point(pair_.at(pair_.q[0]), pair_.at(pair_.q[1]), t)};
}

// With x = (x0 : x1) on the first edge, y = (F1(x) : -F0(x)) on the last.
std::optional<ExactLine> EeeCurve::line_at(const CurveCut& cut) const {
  const QuadraticRoot r = exact(cut);
  const std::array<Surd, 2> x{Surd{r.c - r.a, -r.b}, Surd{r.a, r.b}};
  const auto& f = exact_form().f;
  const std::array<Surd, 2> y{x[0] * f[0][1] + x[1] * f[1][1],
                              -(x[0] * f[0][0] + x[1] * f[1][0])};
  return joining({pair_.at(pair_.p[0]), pair_.at(pair_.p[1])}, x,
                 {pair_.at(pair_.q[0]), pair_.at(pair_.q[1])}, y, r.d);
}

std::optional<Rational> EeeCurve::between(const CurveCut& a, const CurveCut& b) const {
  if (a.hi < b.lo) {
    const double middle = a.hi + 0.5 * (b.lo - a.hi);
    if (middle > a.hi && middle < b.lo) return Rational(middle);
  }
  const auto s = rational_parameter(a);
  const auto t = rational_parameter(b);
  if (!s || !t) return std::nullopt;
  return Rational((*s + *t) / 2);
}

double EeeCurve::rounded(const CurveCut& cut) const {
  if (cut.hi - cut.lo <= kRangeError || in_double()) return cut.parameter();
  if (const auto s = rounded_from_balls(cut)) return *s;
  const QuadraticRoot r = exact(cut);
  return quotient({r.a, r.b}, {r.c, 0}, r.d);
}

// t = |F0| / (|F0| + |F1|), F0 and F1 being linear in s.
std::array<double, 2> EeeCurve::enclose_last(const CurveCut& cut) const {
  double low[2];
  double high[2];
  for (int b = 0; b < 2; ++b) {
    const double error = form_.error + 8 * kUnit * form_.largest;
    const double at_lo = form_.f[0][b] * (1 - cut.lo) + form_.f[1][b] * cut.lo;
    const double at_hi = form_.f[0][b] * (1 - cut.hi) + form_.f[1][b] * cut.hi;
    const double x = std::abs(at_lo);
    const double y = std::abs(at_hi);
    low[b] = (at_lo > 0) == (at_hi > 0) ? std::max(0.0, std::min(x, y) - error) : 0;
    high[b] = std::max(x, y) + error;
  }
  return enclosed_share(low[0], high[0], low[1], high[1]);
}

double EeeCurve::last_parameter(double s) const {
  const double f0 = form_.f[0][0] * (1 - s) + form_.f[1][0] * s;
  const double f1 = form_.f[0][1] * (1 - s) + form_.f[1][1] * s;
  const double t = f0 / (f0 - f1);
  return std::isfinite(t) ? std::clamp(t, 0.0, 1.0) : 0.5;
}

// Roots in order, alternately leaving and entering `wanted`; parts outside `in` cut off.
void EeeCurve::keep(const CurveInterval& in, const CurveCut* roots, int count, Sign first,
                    Sign wanted, std::vector<CurveInterval>& out) const {
  CurveCut from = in.from;
  Sign here = first;
  for (int i = 0; i <= count; ++i) {
    CurveCut to = i < count ? roots[i] : in.to;
    if (i < count && compare(in.to, to) == Sign::Negative) to = in.to;
    if (here == wanted && compare(from, to) == Sign::Negative) out.push_back({from, to});
    if (i < count && compare(from, to) == Sign::Negative) from = to;
    here = -here;
  }
}

namespace {

// H along [a, b] in doubles: its values at both ends and the blossom between, that is the
// middle coefficient of H over [a, b], with their signs, zero where they are not certain.
struct QuadraticOnInterval {
  const Bernstein& h;
  double a, b;
  double at_a, middle, at_b;
  Sign sign_a, sign_middle, sign_b;

  QuadraticOnInterval(const Bernstein& quadratic, double from, double to)
      : h(quadratic),
        a(from),
        b(to),
        at_a(h.blossom(a, a)),
        middle(h.blossom(a, b)),
        at_b(h.blossom(b, b)),
        sign_a(certain_sign(at_a, h.error)),
        sign_middle(certain_sign(middle, h.error)),
        sign_b(certain_sign(at_b, h.error)) {}

  // Takes the signs of the rounded values for the true ones.
  void believe() {
    sign_a = sign_of(at_a);
    sign_middle = sign_of(middle);
    sign_b = sign_of(at_b);
  }
  [[nodiscard]] bool of_one_sign() const {
    return sign_a == sign_middle && sign_middle == sign_b && sign_a != Sign::Zero;
  }
};

// How many roots H has in the interval, whose ends have certain signs; -1: not certain.
int count_roots(const QuadraticOnInterval& q, double discriminant) {
  if (q.sign_a != q.sign_b) return 1;
  // Two roots between need the middle coefficient on the other side.
  if (q.sign_middle == q.sign_a) return 0;
  const double size = std::abs(q.at_a) + std::abs(q.middle) + std::abs(q.at_b);
  const double error = 4 * q.h.error * size + 8 * kUnit * size * size;
  if (discriminant < -error || (in_double() && discriminant <= 0)) return 0;
  if (discriminant <= error && !in_double()) return -1;
  return q.sign_middle == Sign::Zero ? -1 : 2;
}

// Encloses the root of H at a + (b - a) u / (1 + u) and tells whether H rises there;
// `before`: the sign of H just before it, `root`: of the discriminant.  False when the
// enclosure is not certain.
bool enclose(const QuadraticOnInterval& q, double u, double root, Sign before,
             CurveCut& cut) {
  const double width = q.b - q.a;
  const double s = q.a + width * (std::isfinite(u) ? u / (1 + u) : 1.0);
  cut.rising = before == Sign::Negative;
  if (in_double()) {
    cut.lo = cut.hi = s;
    return true;
  }
  double margin = 4 * kUnit + 4 * q.h.error * width / root;
  for (int tries = 0; tries < 3; ++tries, margin *= 16) {
    cut.lo = s - margin;
    cut.hi = s + margin;
    const Sign at_lo = certain_sign(q.h.blossom(cut.lo, cut.lo), q.h.error);
    const Sign at_hi = certain_sign(q.h.blossom(cut.hi, cut.hi), q.h.error);
    if (at_lo == before && at_hi == -before && cut.lo > -0.01 && cut.hi < 1.01) {
      return true;
    }
  }
  return false;
}

// Encloses the roots of H in the interval, one or two, in order; false when that is not
// certain.
bool enclose_roots(const QuadraticOnInterval& q, int count, double discriminant,
                   CurveCut* cuts) {
  // By the formulas for an H that is positive at a.
  const double flip = q.sign_a == Sign::Positive ? 1 : -1;
  const double x = flip * q.at_a;
  const double y = flip * q.middle;
  const double z = flip * q.at_b;
  const double root = std::sqrt(std::max(0.0, discriminant));
  if (count == 1) {  // x > 0 > z
    const double u = y >= 0 ? (y + root) / -z : x / (root - y);
    return enclose(q, u, root, q.sign_a, cuts[0]);
  }
  const double w = -y + root;  // x, z > 0 > y
  return enclose(q, x / w, root, q.sign_a, cuts[0]) &&
         enclose(q, w / z, root, -q.sign_a, cuts[1]) && cuts[0].hi < cuts[1].lo;
}

}  // namespace

void EeeCurve::where(int carrier, const BoundedForm& form, Sign wanted,
                     const CurveInterval& in, std::vector<CurveInterval>& out,
                     bool& degenerate) const {
  const Bernstein h = quadratic(form_, form);
  QuadraticOnInterval q(h, in.from.lo, in.to.hi);
  // H vanishes at an end of the edge when a factor of either product does.
  const auto vanishes = [&](int k) {
    return (form_.zero[k][0] || form.zero[k][1]) && (form_.zero[k][1] || form.zero[k][0]);
  };
  // Then what is left is linear, and has the sign of the middle coefficient there.
  if (q.a == 0 && vanishes(0)) q.sign_a = q.sign_middle;
  if (q.b == 1 && vanishes(1)) q.sign_b = q.sign_middle;
  const auto has_no_root = [&] {
    ++stage_counts.by_double;
    if (q.sign_a == wanted) out.push_back(in);
  };
  if (q.of_one_sign()) return has_no_root();
  if (in_double()) q.believe();
  if (q.sign_a == Sign::Zero || q.sign_b == Sign::Zero) {
    if (!in_double()) where_exactly(carrier, wanted, in, out, degenerate);
    return;
  }
  const double discriminant = q.middle * q.middle - q.at_a * q.at_b;
  const int roots = count_roots(q, discriminant);
  if (roots == 0) return has_no_root();
  CurveCut cuts[2];
  const bool sure = roots > 0 && enclose_roots(q, roots, discriminant, cuts);
  if (roots < 0 || (!sure && !in_double())) {
    return where_exactly(carrier, wanted, in, out, degenerate);
  }
  for (CurveCut& cut : cuts) {
    cut.kind = CurveCutKind::Crossing;
    cut.feature = carrier;
    // Of H taken in order of carriers.
    cut.rising = cut.rising == (middle_ < carrier);
  }
  ++stage_counts.by_double;
  keep(in, cuts, roots, q.sign_a, wanted, out);
}

// The same, with H's exact coefficients.
void EeeCurve::where_exactly(int carrier, Sign wanted, const CurveInterval& in,
                             std::vector<CurveInterval>& out, bool& degenerate) const {
  ++stage_counts.by_exact;
  const auto h = exact_quadratic(carrier);
  const Ring a = h.h0 - h.h1 + h.h2;
  const Ring b = h.h1 - 2 * h.h0;
  const Sign sign_a = sign_of(a);
  const Sign sign_b = sign_of(b);
  if (sign_a == Sign::Zero && sign_b == Sign::Zero) {
    const Sign s = sign_of(h.h0);
    if (s == Sign::Zero) degenerate = true;
    if (s == wanted) out.push_back(in);
    return;
  }
  const Ring d = b * b - 4 * a * h.h0;
  if (sign_a != Sign::Zero && sign_of(d) != Sign::Positive) {
    if (sign_a == wanted) out.push_back(in);  // at most touched
    return;
  }
  // The roots of H on the whole line, in order; from left to right a positive leading
  // coefficient first falls.
  CurveCut roots[2];
  int count = 0;
  if (sign_a == Sign::Zero) {
    roots[count++] = exact_crossing(carrier, sign_b == Sign::Positive);
  } else {
    roots[count++] = exact_crossing(carrier, sign_a != Sign::Positive);
    roots[count++] = exact_crossing(carrier, sign_a == Sign::Positive);
  }
  // Sign before the first root; roots at or before the start are passed.
  Sign first = roots[0].rising == (middle_ < carrier) ? Sign::Negative : Sign::Positive;
  const CurveCut* next = roots;
  while (count > 0 && !is_before(in.from, *next)) {
    ++next;
    --count;
    first = -first;
  }
  while (count > 0 && !is_before(next[count - 1], in.to)) --count;
  keep(in, next, count, first, wanted, out);
}

// The root at which H of the carrier rises, or falls, wherever it lies.
CurveCut EeeCurve::exact_crossing(int carrier, bool rises) const {
  CurveCut cut{CurveCutKind::Crossing, rises == (middle_ < carrier), carrier};
  const QuadraticRoot r = exact(cut);
  const double s = quotient({r.a, r.b}, {r.c, 0}, r.d);
  const double margin = std::abs(s) * 2 * kQuotientError + 0x1p-1000;
  cut.lo = s - margin;
  cut.hi = s + margin;
  return cut;
}

// a lies before b, one of which may be a root of H beyond the ends of the first edge,
// where compare() does not look.
bool EeeCurve::is_before(const CurveCut& a, const CurveCut& b) const {
  if (a.kind == CurveCutKind::Start) {
    const QuadraticRoot r = exact(b);
    return sign_of(Surd{r.a, r.b}, r.d) == Sign::Positive;
  }
  if (b.kind == CurveCutKind::End) {
    const QuadraticRoot r = exact(a);
    return sign_of(Surd{r.a - r.c, r.b}, r.d) == Sign::Negative;
  }
  return compare(a, b) == Sign::Negative;
}

// The sign of (F0 - F1) c_g - (G0 - G1) c_f at a cut, in doubles: Zero where it is not
// certain; at precision Double as computed.  c as in order_at().
Sign EeeCurve::rounded_order_at(const CurveCut& cut, int carrier,
                                const BoundedForm& form) const {
  const auto value = [&](const Carrier& g) {
    return orient3d_value(pair_.at(pair_.q[0]), pair_.at(pair_.q[1]),
                          pair_.at(g.points[0]), pair_.at(g.points[1]));
  };
  const BoundedValue cf = value(carriers_[middle_]);
  const BoundedValue cg = value(carriers_[carrier]);
  const auto at = [&](double s) {
    const double df =
        (form_.f[0][0] - form_.f[0][1]) * (1 - s) + (form_.f[1][0] - form_.f[1][1]) * s;
    const double dg =
        (form.f[0][0] - form.f[0][1]) * (1 - s) + (form.f[1][0] - form.f[1][1]) * s;
    return df * cg.value - dg * cf.value;
  };
  if (in_double()) return sign_of(at(cut.lo));
  const double c_error = std::max(cf.error, cg.error);
  const double c = std::max(std::abs(cf.value), std::abs(cg.value)) + c_error;
  const double error = 4 * ((form_.error + form.error) * c +
                            (form_.largest + form.largest) * (c_error + 8 * kUnit * c));
  const Sign at_lo = certain_sign(at(cut.lo), error);
  return at_lo == certain_sign(at(cut.hi), error) ? at_lo : Sign::Zero;
}

// A contact at P + mu (Q - P) has mu / (1 - mu) = (F0 - F1) / c with c = orient3d(Q0, Q1,
// line): P's and Q's values in the plane of Q0 and the line are -F0 and t c.
Sign EeeCurve::order_at(const CurveCut& cut, int carrier, const BoundedForm& form) const {
  const Carrier& f_line = carriers_[middle_];
  const Carrier& g_line = carriers_[carrier];
  const auto beside = [&](const std::array<std::int32_t, 2>& edge, const Carrier& g) {
    return orient3d(pair_.at(edge[0]), pair_.at(edge[1]), pair_.at(g.points[0]),
                    pair_.at(g.points[1]));
  };
  const Sign sign_f = beside(pair_.q, f_line);
  const Sign sign_g = beside(pair_.q, g_line);
  if (sign_g != Sign::Zero) {
    const Sign rounded = rounded_order_at(cut, carrier, form);
    if (rounded != Sign::Zero || in_double()) return rounded * sign_f * sign_g;
  }
  ++stage_counts.by_exact;
  const auto& f = exact_form().f;
  const BilinearForm<Ring> exact_g = pair_.exact_form(g_line);
  const auto& g = exact_g.f;
  const auto exact_beside = [&](const std::array<std::int32_t, 2>& edge,
                                const Carrier& line) {
    return ring_orient3d(pair_.at(edge[0]), pair_.at(edge[1]), pair_.at(line.points[0]),
                         pair_.at(line.points[1]));
  };
  const QuadraticRoot r = exact(cut);
  // (w0 (c - r) + w1 r) / c at r = a + b sqrt(d)
  const auto sign_at = [&](const Ring& w0, const Ring& w1) {
    return sign_of(Surd{w0 * (r.c - r.a) + w1 * r.a, (w1 - w0) * r.b}, r.d);
  };
  const Ring cf = exact_beside(pair_.q, f_line);
  if (sign_g != Sign::Zero) {
    const Ring cg = exact_beside(pair_.q, g_line);
    const Ring w0 = (f[0][0] - f[0][1]) * cg - (g[0][0] - g[0][1]) * cf;
    const Ring w1 = (f[1][0] - f[1][1]) * cg - (g[1][0] - g[1][1]) * cf;
    return sign_at(w0, w1) * sign_f * sign_g;
  }
  // g and the last edge are coplanar.  Seen from the other end g has (1 - mu) / mu =
  // -(G(0, t) - G(1, t)) / c', c' = orient3d(P0, P1, line), and with t = F0 / (F0 - F1)
  // the difference is X / (F0 - F1) for the linear X below.
  const Ring c = exact_beside(pair_.p, g_line);
  const auto x = [&](int a) {
    return Ring((g[0][1] - g[1][1]) * f[a][0] - (g[0][0] - g[1][0]) * f[a][1]);
  };
  const Ring x0 = x(0);
  const Ring x1 = x(1);
  const Ring product = c * cf;
  return sign_at(x0 + product, x1 + product) * sign_at(x0, x1);
}

}  // namespace sightline::internal
