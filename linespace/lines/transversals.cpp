#include "linespace/transversals.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "linespace/lines/transversals.h"
#include "linespace/numbers/exact_numbers.h"

namespace sightline {

using internal::BilinearForm;
using internal::Quadratic;
using internal::Ring;
using internal::Surd;

int dimension(TransversalClass c) {
  switch (c) {
    case TransversalClass::None:
    case TransversalClass::Two:
    case TransversalClass::OneOtherAtInfinity:
    case TransversalClass::Double:
    case TransversalClass::DoubleAtInfinity:
      return 0;
    case TransversalClass::Pencil:
    case TransversalClass::TwoPencils:
    case TransversalClass::Regulus:
      return 1;
    case TransversalClass::ThroughPoint:
    case TransversalClass::InPlane:
    case TransversalClass::ThroughPointAndInPlane:
    case TransversalClass::MeetingTwoLines:
      return 2;
    case TransversalClass::MeetingOneLine:
      return 3;
  }
  return 0;
}

int isolated_lines(TransversalClass c) {
  if (c == TransversalClass::Two) return 2;
  return c == TransversalClass::OneOtherAtInfinity || c == TransversalClass::Double ? 1
                                                                                    : 0;
}

namespace internal {
namespace {

template <class T>
using Four = std::array<T, 4>;
using FourLines = Four<const LineThrough*>;

// ---- forms of a skew pair -----------------------------------------------------------

bool all_zero(const BilinearForm<Ring>& f) {
  return is_zero(f.f[0][0]) && is_zero(f.f[0][1]) && is_zero(f.f[1][0]) &&
         is_zero(f.f[1][1]);
}

// A product of a form in x and one in y: the third line meets one of the two.
bool reducible(const BilinearForm<Ring>& f) {
  return is_zero(f.f[0][0] * f.f[1][1] - f.f[0][1] * f.f[1][0]);
}

bool proportional(const BilinearForm<Ring>& f, const BilinearForm<Ring>& g) {
  const Four<const Ring*> a{&f.f[0][0], &f.f[0][1], &f.f[1][0], &f.f[1][1]};
  const Four<const Ring*> b{&g.f[0][0], &g.f[0][1], &g.f[1][0], &g.f[1][1]};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < i; ++j) {
      if (!is_zero(*a[i] * *b[j] - *a[j] * *b[i])) return false;
    }
  }
  return true;
}

// y with F(x, y) = 0, or (0, 0) when x is a factor of F.
std::array<Surd, 2> other_parameter(const BilinearForm<Ring>& f,
                                    const std::array<Surd, 2>& x) {
  return {x[0] * f.f[0][1] + x[1] * f.f[1][1], -(x[0] * f.f[0][0] + x[1] * f.f[1][0])};
}

bool both_zero(const std::array<Surd, 2>& y, const Ring& radicand) {
  return is_zero(y[0], radicand) && is_zero(y[1], radicand);
}

}  // namespace

RingVector ring_difference(const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
  return {Ring(p.x()) - Ring(q.x()), Ring(p.y()) - Ring(q.y()),
          Ring(p.z()) - Ring(q.z())};
}

Ring ring_orient3d(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                   const Eigen::Vector3d& c, const Eigen::Vector3d& d) {
  const RingVector u = ring_difference(b, a);
  const RingVector v = ring_difference(c, a);
  const RingVector w = ring_difference(d, a);
  return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
         u[2] * (v[0] * w[1] - v[1] * w[0]);
}

BilinearForm<Ring> ring_form(const LineThrough& l, const LineThrough& m,
                             const LineThrough& third) {
  const auto at = [&third](const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
    return ring_orient3d(p, q, third.from, third.to);
  };
  return {{{at(l.from, m.from), at(l.from, m.to)}, {at(l.to, m.from), at(l.to, m.to)}}};
}

// The zeros of F and G on P1 x P1.  H vanishes identically exactly when they have a
// common factor in y, or are proportional, or one is zero; a common factor in x shows as
// a double root at which both leave y free.
CommonZeros common_zeros(const BilinearForm<Ring>& f, const BilinearForm<Ring>& g) {
  const bool no_f = all_zero(f);
  const bool no_g = all_zero(g);
  if (no_f && no_g) return {TransversalClass::MeetingTwoLines, {}};
  if (no_f || no_g || proportional(f, g)) {
    return {reducible(no_f ? g : f) ? TransversalClass::TwoPencils
                                    : TransversalClass::Regulus,
            {}};
  }
  const Quadratic<Ring> h = resultant(f, g);
  if (is_zero(h.h0) && is_zero(h.h1) && is_zero(h.h2)) {
    return {TransversalClass::Pencil, {}};
  }
  const Ring discriminant = h.h1 * h.h1 - h.h0 * h.h2 * 4;
  const Sign sign = sign_of(discriminant);
  if (sign == Sign::Negative) return {TransversalClass::None, {}};
  CommonZeros out{TransversalClass::Two, {}, discriminant};
  const auto add = [&](const std::array<Surd, 2>& x) {
    auto y = other_parameter(f, x);
    if (both_zero(y, discriminant)) y = other_parameter(g, x);
    if (both_zero(y, discriminant)) return false;
    out.zeros.push_back({x, y});
    return true;
  };
  if (sign == Sign::Zero) {
    out.kind = TransversalClass::Double;
    const bool at_one = is_zero(h.h2) && is_zero(h.h1);  // h0 x0^2
    const std::array<Surd, 2> x =
        at_one          ? std::array<Surd, 2>{Surd{0, 0}, Surd{1, 0}}
        : is_zero(h.h2) ? std::array<Surd, 2>{Surd{1, 0}, Surd{0, 0}}
                        : std::array<Surd, 2>{Surd{h.h2 * 2, 0}, Surd{-h.h1, 0}};
    if (!add(x)) out.kind = TransversalClass::Pencil;
    return out;
  }
  if (is_zero(h.h2)) {  // x0 (h0 x0 + h1 x1)
    add({Surd{0, 0}, Surd{1, 0}});
    add({Surd{h.h1, 0}, Surd{-h.h0, 0}});
    return out;
  }
  add({Surd{h.h2 * 2, 0}, Surd{-h.h1, 1}});
  add({Surd{h.h2 * 2, 0}, Surd{-h.h1, -1}});
  return out;
}

namespace {

// ---- four lines exactly
// -----------------------------------------------------------------

bool same_support(const LineThrough& l, const LineThrough& m) {
  return collinear(l.from, l.to, m.from) && collinear(l.from, l.to, m.to);
}

bool coplanar(const FourLines& l) {
  // Against one plane through l0 and a point off it.
  for (int i = 1; i < 4; ++i) {
    for (const Eigen::Vector3d* p : {&l[i]->from, &l[i]->to}) {
      if (collinear(l[0]->from, l[0]->to, *p)) continue;
      return std::ranges::all_of(l, [&](const LineThrough* m) {
        return orient3d(l[0]->from, l[0]->to, *p, m->from) == Sign::Zero &&
               orient3d(l[0]->from, l[0]->to, *p, m->to) == Sign::Zero;
      });
    }
  }
  return true;
}

// Lines of one plane, not all the same: whether they are of one pencil, so that their
// Pluecker vectors span two dimensions.  Three different lines of a plane are of one
// pencil iff their equations in the plane's coordinates have determinant zero.
bool concurrent_in_plane(const FourLines& l) {
  // Project along an axis that keeps the plane two-dimensional.
  std::optional<RingVector> normal;
  for (int i = 1; i < 4 && !normal; ++i) {
    for (const Eigen::Vector3d* p : {&l[i]->from, &l[i]->to}) {
      const RingVector u = ring_difference(l[0]->to, l[0]->from);
      const RingVector v = ring_difference(*p, l[0]->from);
      const RingVector n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                         u[0] * v[1] - u[1] * v[0]};
      if (!is_zero(n[0]) || !is_zero(n[1]) || !is_zero(n[2])) {
        normal = n;
        break;
      }
    }
  }
  assert(normal);
  const int axis = !is_zero((*normal)[0]) ? 0 : !is_zero((*normal)[1]) ? 1 : 2;
  const int s = (axis + 1) % 3;
  const int t = (axis + 2) % 3;
  Four<RingVector> e;
  for (int i = 0; i < 4; ++i) {
    const RingVector p = ring_point(l[i]->from);
    const RingVector q = ring_point(l[i]->to);
    e[i] = {p[t] - q[t], q[s] - p[s], p[s] * q[t] - p[t] * q[s]};
  }
  const auto det = [&](int i, int j, int k) {
    return e[i][0] * (e[j][1] * e[k][2] - e[j][2] * e[k][1]) +
           e[i][1] * (e[j][2] * e[k][0] - e[j][0] * e[k][2]) +
           e[i][2] * (e[j][0] * e[k][1] - e[j][1] * e[k][0]);
  };
  return is_zero(det(0, 1, 2)) && is_zero(det(0, 1, 3)) && is_zero(det(0, 2, 3)) &&
         is_zero(det(1, 2, 3));
}

// Four lines of which every two meet or are parallel.
TransversalClass pairwise_coplanar_class(const FourLines& l) {
  if (same_support(*l[0], *l[1]) && same_support(*l[0], *l[2]) &&
      same_support(*l[0], *l[3])) {
    return TransversalClass::MeetingOneLine;
  }
  if (!coplanar(l)) return TransversalClass::ThroughPoint;
  return concurrent_in_plane(l) ? TransversalClass::ThroughPointAndInPlane
                                : TransversalClass::InPlane;
}

// A permutation that puts a skew pair first.
std::optional<FourLines> skew_first(const FourLines& l) {
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      if (side(*l[i], *l[j]) == Sign::Zero) continue;
      FourLines out = l;
      std::swap(out[0], out[i]);
      std::swap(out[1], out[j]);
      return out;
    }
  }
  return std::nullopt;
}

LineTransversals exact_transversals(const FourLines& lines) {
  const auto l = skew_first(lines);
  if (!l) return {pairwise_coplanar_class(lines), {}};
  const auto& [a, b, c, d] = *l;
  const CommonZeros common = common_zeros(ring_form(*a, *b, *c), ring_form(*a, *b, *d));
  LineTransversals out{common.kind, {}};
  for (const auto& [x, y] : common.zeros) {
    if (auto line = joining(*a, x, *b, y, common.radicand)) {
      out.lines.push_back(std::move(*line));
    }
  }
  if (out.kind == TransversalClass::Double && out.lines.empty()) {
    out.kind = TransversalClass::DoubleAtInfinity;
  }
  if (out.kind == TransversalClass::Two && out.lines.size() == 1) {
    out.kind = TransversalClass::OneOtherAtInfinity;
  }
  return out;
}

}  // namespace

TransversalClass exact_transversal_class(const FourLines& l) {
  return exact_transversals(l).kind;
}

// ---- the discriminant in stages
// ---------------------------------------------------------

namespace {

template <class T>
using Vector = std::array<T, 3>;

template <class T>
auto minus(const Vector<T>& p, const Vector<T>& q) {
  return Vector<T>{p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}
template <class T>
auto cross_product(const Vector<T>& u, const Vector<T>& v) {
  return std::array{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                    u[0] * v[1] - u[1] * v[0]};
}
template <class S, class T>
auto dot_product(const Vector<S>& u, const Vector<T>& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

// a^2 + b^2 + c^2 - 2ab - 2ac - 2bc.
template <class T>
auto discriminant(const T& a, const T& b, const T& c) {
  const T x = a + b - c;
  const auto ab = a * b;
  const auto twice = ab + ab;
  return x * x - (twice + twice);
}

// The points of four lines over a number type, and what is asked of them.
template <class T>
struct Points {
  Four<Vector<T>> from, to;

  [[nodiscard]] auto side(int i, int j) const {
    return dot_product(minus(to[j], from[i]),
                       cross_product(minus(to[i], from[i]), minus(from[j], from[i])));
  }
  [[nodiscard]] auto discriminant_value() const {
    return discriminant(side(0, 1) * side(2, 3), side(0, 2) * side(1, 3),
                        side(0, 3) * side(1, 2));
  }
  [[nodiscard]] auto directions(int i, int j, int k) const {
    return dot_product(minus(to[i], from[i]),
                       cross_product(minus(to[j], from[j]), minus(to[k], from[k])));
  }
};

constexpr Four<std::array<int, 3>> kTriples{{{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}};

// By the magnitudes of the differences involved: beyond these, twelfth powers could
// leave the doubles' range.
constexpr double kLargestReach = 0x1p60;
constexpr double kSmallestReach = 0x1p-60;

struct DoubleCount {
  double discriminant, direction;  // the first three directions' determinant
  double reach;
};

// With the first line's `from` as origin its moment is 0.
inline DoubleCount double_count(const FourLines& l) {
  Four<Vector<double>> p, d, m;
  double reach = 0;
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 3; ++k) {
      p[i][k] = l[i]->from[k] - l[0]->from[k];
      d[i][k] = l[i]->to[k] - l[i]->from[k];
      reach = std::max(reach, std::max(std::abs(p[i][k]), std::abs(d[i][k])));
    }
    m[i] = cross_product(p[i], d[i]);
  }
  const auto side_of = [&](int i, int j) {
    return dot_product(d[i], m[j]) + dot_product(d[j], m[i]);
  };
  return {discriminant(dot_product(d[0], m[1]) * side_of(2, 3),
                       dot_product(d[0], m[2]) * side_of(1, 3),
                       dot_product(d[0], m[3]) * side_of(1, 2)),
          dot_product(d[0], cross_product(d[1], d[2])), reach};
}

// Let R be the largest magnitude of a difference that enters, and e = 2^-53.  A side
// product with the first line is a sum of 6 products of three differences, each of at
// most 8 roundings: at most 6 R^3, off by 48 e R^3; another has 12 with 9: at most 12
// R^3, off by 108 e R^3.  So a, b, c are at most 72 R^6 and off by (6 108 + 12 48 + 72) e
// R^6 = 1296 e R^6; x = a + b - c is at most 216 R^6 and off by (3 1296 + 2 216) e R^6 =
// 4320 e R^6; and x^2 - 4ab is off by
//   (2 216 4320 + 216^2 + 4 (2 72 1296 + 72^2) + 216^2 + 4 72^2) e R^12 < 2.8e6 e R^12.
// 2^22 covers that, the second order, and the rounding of the bound itself.  The
// directions' determinant is a sum of 6 products of 7 roundings: 42 e R^3.
constexpr double kDiscriminantBound = 0x1p22 * kUnit;
constexpr double kDirectionBound = 64 * kUnit;

inline std::optional<TransversalClass> certain_class(const DoubleCount& c) {
  const double r3 = c.reach * c.reach * c.reach;
  const double r6 = r3 * r3;
  if (!(std::abs(c.discriminant) > kDiscriminantBound * (r6 * r6)) ||
      c.reach > kLargestReach || c.reach < kSmallestReach) {
    return std::nullopt;
  }
  if (c.discriminant < 0) return TransversalClass::None;
  if (std::abs(c.direction) > kDirectionBound * r3) return TransversalClass::Two;
  return std::nullopt;
}

}  // namespace

std::optional<TransversalClass> double_transversal_class(const FourLines& l) {
  return certain_class(double_count(l));
}

std::optional<TransversalClass> interval_transversal_class(const FourLines& l) {
  if (const double reach = double_count(l).reach;
      reach > kLargestReach || reach < kSmallestReach) {
    return std::nullopt;
  }
  // The differences are exact, so l[0]->from can be the origin of all.
  const auto difference = [&l](const Eigen::Vector3d& p) {
    Vector<BallNumber> out;
    for (int k = 0; k < 3; ++k) out[k] = exact_difference(p[k], l[0]->from[k]);
    return out;
  };
  Points<BallNumber> p;
  for (int i = 0; i < 4; ++i) {
    p.from[i] = difference(l[i]->from);
    p.to[i] = difference(l[i]->to);
  }
  const auto sign = sign_of(p.discriminant_value());
  if (!sign) return std::nullopt;
  if (*sign == Sign::Negative) return TransversalClass::None;
  for (const auto& [i, j, k] : kTriples) {
    if (sign_of(p.directions(i, j, k))) return TransversalClass::Two;
  }
  return std::nullopt;
}

// 61 bits a coordinate: a side product has at most 189 bits and a sign, a, b and c 378,
// their sum 380 of the 384 of six limbs, and the discriminant 762 of 768.
std::optional<TransversalClass> integer_transversal_class(const FourLines& l) {
  Points<FixedInt<1>> p;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<double, 8> values;
    std::array<FixedInt<1>, 8> integers;
    for (int i = 0; i < 4; ++i) {
      values[2 * i] = l[i]->from[axis];
      values[2 * i + 1] = l[i]->to[axis];
    }
    if (!to_integers<1>(values, integers)) return std::nullopt;
    for (int i = 0; i < 4; ++i) {
      p.from[i][axis] = integers[2 * i];
      p.to[i][axis] = integers[2 * i + 1];
    }
  }
  const Sign sign = sign_of(p.discriminant_value());
  if (sign == Sign::Zero) return std::nullopt;
  if (sign == Sign::Negative) return TransversalClass::None;
  // The line at infinity of the planes parallel to all four meets them, if there are
  // such.
  for (const auto& [i, j, k] : kTriples) {
    if (sign_of(p.directions(i, j, k)) != Sign::Zero) return TransversalClass::Two;
  }
  return TransversalClass::OneOtherAtInfinity;
}

namespace {

TransversalClass decide_transversal_class(const FourLines& l, const DoubleCount& count) {
  if (thread_precision == Precision::Double) {
    ++stage_counts.by_double;
    return count.discriminant < 0   ? TransversalClass::None
           : count.discriminant > 0 ? TransversalClass::Two
                                    : TransversalClass::Double;
  }
  if (const auto c = integer_transversal_class(l)) {
    ++stage_counts.by_exact;
    return *c;
  }
  if (const auto c = interval_transversal_class(l)) {
    ++stage_counts.by_interval;
    return *c;
  }
  ++stage_counts.by_exact;
  return exact_transversal_class(l);
}

}  // namespace
}  // namespace internal

TransversalClass transversal_class(const LineThrough& l0, const LineThrough& l1,
                                   const LineThrough& l2, const LineThrough& l3) {
  using namespace internal;
  const FourLines l{&l0, &l1, &l2, &l3};
  const DoubleCount count = double_count(l);
  if (const auto c = certain_class(count)) {
    ++stage_counts.by_double;
    return *c;
  }
  return decide_transversal_class(l, count);
}

LineTransversals transversals(const LineThrough& l0, const LineThrough& l1,
                              const LineThrough& l2, const LineThrough& l3) {
  return internal::exact_transversals({&l0, &l1, &l2, &l3});
}

}  // namespace sightline
