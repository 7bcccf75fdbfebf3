#include "linespace/transversals.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "linespace/transversals_internal.h"

namespace sightline {

using internal::Form;
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

bool all_zero(const Form<Ring>& f) {
  return is_zero(f.f[0][0]) && is_zero(f.f[0][1]) && is_zero(f.f[1][0]) &&
         is_zero(f.f[1][1]);
}

// A product of a form in x and one in y: the third line meets one of the two.
bool reducible(const Form<Ring>& f) {
  return is_zero(f.f[0][0] * f.f[1][1] - f.f[0][1] * f.f[1][0]);
}

bool proportional(const Form<Ring>& f, const Form<Ring>& g) {
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
std::array<Surd, 2> other_parameter(const Form<Ring>& f, const std::array<Surd, 2>& x) {
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

Form<Ring> ring_form(const LineThrough& l, const LineThrough& m,
                     const LineThrough& third) {
  const auto at = [&third](const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
    return ring_orient3d(p, q, third.from, third.to);
  };
  return {{{at(l.from, m.from), at(l.from, m.to)}, {at(l.to, m.from), at(l.to, m.to)}}};
}

// The zeros of F and G on P1 x P1.  H vanishes identically exactly when they have a
// common factor in y, or are proportional, or one is zero; a common factor in x shows as
// a double root at which both leave y free.
CommonZeros common_zeros(const Form<Ring>& f, const Form<Ring>& g) {
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

}  // namespace internal

TransversalClass transversal_class(const LineThrough& l0, const LineThrough& l1,
                                   const LineThrough& l2, const LineThrough& l3) {
  return internal::exact_transversal_class({&l0, &l1, &l2, &l3});
}

LineTransversals transversals(const LineThrough& l0, const LineThrough& l1,
                              const LineThrough& l2, const LineThrough& l3) {
  return internal::exact_transversals({&l0, &l1, &l2, &l3});
}

}  // namespace sightline
