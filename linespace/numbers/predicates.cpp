#include "linespace/predicates.h"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <algorithm>
#include <array>
#include <cassert>
#include <cfenv>

#include "linespace/numbers/exact_numbers.h"
#include "linespace/numbers/predicates.h"
#include "linespace/numbers/vectors.h"

namespace sightline {
namespace internal {
namespace {

// ---- the polynomials, each written once over its number type
// ----------------------------

template <class T>
using Vector = std::array<T, 3>;

template <class T>
auto operator-(const Vector<T>& p, const Vector<T>& q) {
  return Vector<T>{p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}

// Where a plane crosses the line from + s along: s = -at_from / along.
template <class T>
struct Crossing {
  T at_from, along;
};

// The sign of s - t for s = -p.at_from / p.along and t likewise for q.
template <class T>
auto crossing_numerator(const Crossing<T>& p, const Crossing<T>& q) {
  return q.at_from * p.along - p.at_from * q.along;
}

// ---- points as balls and as integers
// ----------------------------------------------------

Vector<BallNumber> ball_difference(const Point3& p, const Point3& q) {
  return {exact_difference(p[0], q[0]), exact_difference(p[1], q[1]),
          exact_difference(p[2], q[2])};
}

// Every axis has a scale of its own: these predicates are homogeneous in each axis.
template <int N, std::size_t Count>
bool to_integers(const std::array<const Point3*, Count>& points,
                 std::array<Vector<FixedInt<N>>, Count>& out) {
  for (int axis = 0; axis < 3; ++axis) {
    std::array<double, Count> values;
    std::array<FixedInt<N>, Count> integers;
    for (std::size_t i = 0; i < Count; ++i) values[i] = points[i]->data()[axis];
    if (!to_integers<N>(values, integers)) return false;
    for (std::size_t i = 0; i < Count; ++i) out[i][axis] = integers[i];
  }
  return true;
}

// Counts which stage decides; the last always does.
template <class Decision>
struct Stages {
  template <class Interval, class Integer1, class Integer2, class Integer6>
  static Decision run(Integer1 integer1, Interval interval, Integer2 integer2,
                      Integer6 integer6) {
    assert(std::fegetround() == FE_TONEAREST);
    if (const auto s = integer1()) {
      ++stage_counts.by_exact;
      return *s;
    }
    if (const auto s = interval()) {
      ++stage_counts.by_interval;
      return *s;
    }
    ++stage_counts.by_exact;
    if (const auto s = integer2()) return *s;
    return integer6().value();  // throws only if coordinates are not admissible
  }
};

}  // namespace

// ---- orient3d
// ---------------------------------------------------------------------------

std::optional<Sign> double_orient3d(const Point3& a, const Point3& b, const Point3& c,
                                    const Point3& d) {
  const auto [value, error] = orient3d_value(a, b, c, d);
  if (std::abs(value) > error || error == 0) return sign_of(value);
  return std::nullopt;
}

BallNumber ball_orient3d(const Point3& a, const Point3& b, const Point3& c,
                         const Point3& d) {
  return dot(ball_difference(d, a), cross(ball_difference(b, a), ball_difference(c, a)));
}

std::optional<Sign> interval_orient3d(const Point3& a, const Point3& b, const Point3& c,
                                      const Point3& d) {
  return sign_of(ball_orient3d(a, b, c, d));
}

template <int Limbs>
std::optional<Sign> integer_orient3d(const Point3& a, const Point3& b, const Point3& c,
                                     const Point3& d) {
  std::array<Vector<FixedInt<Limbs>>, 4> p;
  if (!to_integers<Limbs, 4>({&a, &b, &c, &d}, p)) return std::nullopt;
  return sign_of(dot(p[3] - p[0], cross(p[1] - p[0], p[2] - p[0])));
}
template std::optional<Sign> integer_orient3d<1>(const Point3&, const Point3&,
                                                 const Point3&, const Point3&);
template std::optional<Sign> integer_orient3d<2>(const Point3&, const Point3&,
                                                 const Point3&, const Point3&);
template std::optional<Sign> integer_orient3d<6>(const Point3&, const Point3&,
                                                 const Point3&, const Point3&);

Sign decide_orient3d(const Point3& a, const Point3& b, const Point3& c, const Point3& d,
                     double value) {
  if (thread_precision == Precision::Double) {
    ++stage_counts.by_double;
    return sign_of(value);
  }
  return Stages<Sign>::run([&] { return integer_orient3d<1>(a, b, c, d); },
                           [&] { return interval_orient3d(a, b, c, d); },
                           [&] { return integer_orient3d<2>(a, b, c, d); },
                           [&] { return integer_orient3d<6>(a, b, c, d); });
}

// ---- compare_crossings
// ------------------------------------------------------------------

namespace {

// The first stage's values; each |value - exact| <= error.
Crossing<BoundedValue> double_crossing(const LineThrough& edge, const PlaneThrough& p) {
  const Minors n = minors(p.a.data(), p.b.data(), p.c.data());
  const auto bounded = [&n](const Point3& to, const Point3& from) -> BoundedValue {
    const auto v = triple_product(n, to.data(), from.data());
    return {v.value, kTripleProductBound * v.permanent};
  };
  return {bounded(edge.from, p.a), bounded(edge.to, edge.from)};
}

struct DoubleComparison {
  Sign sign;  // of the values as they are
  bool certain;
};

DoubleComparison compare_in_double(const LineThrough& edge, const PlaneThrough& p,
                                   const PlaneThrough& q) {
  const auto [f, df] = double_crossing(edge, p);
  const auto [g, dg] = double_crossing(edge, q);
  const double numerator = g.value * df.value - f.value * dg.value;
  const Sign sign = sign_of(numerator) * sign_of(df.value) * sign_of(dg.value);
  const bool crosses = std::abs(df.value) > df.error && std::abs(dg.value) > dg.error;
  // Both planes pass through edge.from for certain: s = t = 0.
  if (f.error == 0 && g.error == 0) return {Sign::Zero, crosses};
  // A product of two values x, y is off by at most |x| y' + |y| x' + x' y' for their
  // errors x', y'; evaluating the numerator adds e for either product and for their
  // difference, at most 2 e (1 + e) of the sum of both products.  This bound itself
  // passes at most 8 roundings (the factor) and, like the numerator, a few underflows of
  // 2^-1075 at most (the last term).
  const double f_dg = std::abs(f.value * dg.value);
  const double g_df = std::abs(g.value * df.value);
  const double inherited =
      (std::abs(g.value) + g.error) * df.error + g.error * std::abs(df.value) +
      ((std::abs(f.value) + f.error) * dg.error + f.error * std::abs(dg.value));
  const double bound =
      (inherited + 2 * kUnit * (f_dg + g_df)) * (1 + 16 * kUnit) + 0x1p-1000;
  return {sign, crosses && std::abs(numerator) > bound};
}

}  // namespace

std::optional<Sign> double_compare_crossings(const LineThrough& edge,
                                             const PlaneThrough& p,
                                             const PlaneThrough& q) {
  const auto [sign, certain] = compare_in_double(edge, p, q);
  if (certain) return sign;
  return std::nullopt;
}

std::optional<Sign> interval_compare_crossings(const LineThrough& edge,
                                               const PlaneThrough& p,
                                               const PlaneThrough& q) {
  const auto crossing = [&edge](const PlaneThrough& plane) -> Crossing<BallNumber> {
    const auto n =
        cross(ball_difference(plane.b, plane.a), ball_difference(plane.c, plane.a));
    return {dot(ball_difference(edge.from, plane.a), n),
            dot(ball_difference(edge.to, edge.from), n)};
  };
  const Crossing<BallNumber> at_p = crossing(p);
  const Crossing<BallNumber> at_q = crossing(q);
  const auto numerator = sign_of(crossing_numerator(at_p, at_q));
  const auto along_p = sign_of(at_p.along);
  const auto along_q = sign_of(at_q.along);
  if (numerator && along_p && along_q) return *numerator * *along_p * *along_q;
  return std::nullopt;
}

template <int Limbs>
std::optional<Sign> integer_compare_crossings(const LineThrough& edge,
                                              const PlaneThrough& p,
                                              const PlaneThrough& q) {
  std::array<Vector<FixedInt<Limbs>>, 8> v;
  if (!to_integers<Limbs, 8>({&edge.from, &edge.to, &p.a, &p.b, &p.c, &q.a, &q.b, &q.c},
                             v))
    return std::nullopt;
  const auto along = v[1] - v[0];
  const auto crossing = [&](int a) {
    const auto n = cross(v[a + 1] - v[a], v[a + 2] - v[a]);
    return Crossing<FixedInt<3 * Limbs>>{dot(v[0] - v[a], n), dot(along, n)};
  };
  const auto at_p = crossing(2);
  const auto at_q = crossing(5);
  return sign_of(crossing_numerator(at_p, at_q)) * sign_of(at_p.along) *
         sign_of(at_q.along);
}
template std::optional<Sign> integer_compare_crossings<1>(const LineThrough&,
                                                          const PlaneThrough&,
                                                          const PlaneThrough&);
template std::optional<Sign> integer_compare_crossings<2>(const LineThrough&,
                                                          const PlaneThrough&,
                                                          const PlaneThrough&);
template std::optional<Sign> integer_compare_crossings<6>(const LineThrough&,
                                                          const PlaneThrough&,
                                                          const PlaneThrough&);

// ---- collinear
// --------------------------------------------------------------------------

namespace {

// A minor passes 4 roundings: two differences, a product, a difference of products.  As
// for kTripleProductBound: ((1 + e)^4 - 1) (1 + e) / (1 - e)^4 < 4 e + 32 e^2.
constexpr double kMinorBound = (4 + 32 * kUnit) * kUnit;

}  // namespace

std::optional<bool> double_collinear(const Point3& a, const Point3& b, const Point3& c) {
  const Minors n = minors(a.data(), b.data(), c.data());
  const double value[] = {n.value01[0], n.value01[1], n.component2[0]};
  const double permanent[] = {n.permanent01[0], n.permanent01[1], n.component2[1]};
  bool all_zero = true;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(value[i]) > kMinorBound * permanent[i]) return false;
    all_zero &= permanent[i] == 0;
  }
  if (all_zero) return true;
  return std::nullopt;
}

std::optional<bool> interval_collinear(const Point3& a, const Point3& b,
                                       const Point3& c) {
  for (const BallNumber& minor : cross(ball_difference(b, a), ball_difference(c, a)))
    if (sign_of(minor)) return false;
  return std::nullopt;
}

template <int Limbs>
std::optional<bool> integer_collinear(const Point3& a, const Point3& b, const Point3& c) {
  std::array<Vector<FixedInt<Limbs>>, 3> p;
  if (!to_integers<Limbs, 3>({&a, &b, &c}, p)) return std::nullopt;
  return std::ranges::all_of(cross(p[1] - p[0], p[2] - p[0]), [](const auto& minor) {
    return sign_of(minor) == Sign::Zero;
  });
}
template std::optional<bool> integer_collinear<1>(const Point3&, const Point3&,
                                                  const Point3&);
template std::optional<bool> integer_collinear<2>(const Point3&, const Point3&,
                                                  const Point3&);
template std::optional<bool> integer_collinear<6>(const Point3&, const Point3&,
                                                  const Point3&);

}  // namespace internal

Sign compare_crossings(const LineThrough& edge, const PlaneThrough& p,
                       const PlaneThrough& q) {
  using namespace internal;
  const auto [sign, certain] = compare_in_double(edge, p, q);
  if (certain || thread_precision == Precision::Double) {
    ++stage_counts.by_double;
    return sign;
  }
  return Stages<Sign>::run([&] { return integer_compare_crossings<1>(edge, p, q); },
                           [&] { return interval_compare_crossings(edge, p, q); },
                           [&] { return integer_compare_crossings<2>(edge, p, q); },
                           [&] { return integer_compare_crossings<6>(edge, p, q); });
}

bool collinear(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
               const Eigen::Vector3d& c) {
  using namespace internal;
  const auto first = double_collinear(a, b, c);
  if (first || thread_precision == Precision::Double) {
    ++stage_counts.by_double;
    return first.value_or(true);
  }
  return Stages<bool>::run([&] { return integer_collinear<1>(a, b, c); },
                           [&] { return interval_collinear(a, b, c); },
                           [&] { return integer_collinear<2>(a, b, c); },
                           [&] { return integer_collinear<6>(a, b, c); });
}

namespace {

using internal::Pair;

// Bit 0 and 1: the sign bits of the lanes.
int sign_bits(Pair x) {
#ifdef __SSE2__
  return _mm_movemask_pd(x);
#else
  return (std::signbit(x[0]) ? 1 : 0) | (std::signbit(x[1]) ? 2 : 0);
#endif
}

// The signs of four values as they lie in memory, by 16 * (bit i: value i is certain) +
// (bit i: value i is negative); uncertain ones are Zero.
constexpr auto kFourSigns = [] {
  std::array<std::array<Sign, 4>, 256> table{};
  for (int index = 0; index < 256; ++index) {
    for (int i = 0; i < 4; ++i) {
      const bool certain = (index >> (4 + i) & 1) != 0;
      const bool negative = (index >> i & 1) != 0;
      table[index][i] = !certain   ? Sign::Zero
                        : negative ? Sign::Negative
                                   : Sign::Positive;
    }
  }
  return table;
}();

}  // namespace

// Four points at a time, in two pairs; what the first stage leaves open among the four
// goes through the single predicate, as does the rest at the end.
void orient3d_batch(const PlaneThrough& plane, std::span<const double> x,
                    std::span<const double> y, std::span<const double> z,
                    std::span<Sign> signs) {
  using namespace internal;
  assert(x.size() == y.size() && x.size() == z.size() && x.size() == signs.size());
  const PlaneSide on(plane);
  const Minors& n = on.normal_;
  const Pair a0 = both(plane.a[0]), a1 = both(plane.a[1]), a2 = both(plane.a[2]);
  const Pair n0 = both(n.value01[0]), n1 = both(n.value01[1]), n2 = both(n.component2[0]);
  const Pair e0 = both(n.permanent01[0]), e1 = both(n.permanent01[1]),
             e2 = both(n.component2[1]);
  const auto pair_at = [&](std::size_t i) {
    const Pair w0 = load_pair(&x[i]) - a0;
    const Pair w1 = load_pair(&y[i]) - a1;
    const Pair w2 = load_pair(&z[i]) - a2;
    const Pair value = (w0 * n0 + w1 * n1) + w2 * n2;
    const Pair error = (absolute(w0) * e0 + absolute(w1) * e1) + absolute(w2) * e2;
    const auto certain = reinterpret_cast<Pair>(absolute(value) > error);
    return std::array{sign_bits(value), sign_bits(certain)};
  };
  std::size_t singly = 0;
  std::size_t i = 0;
  for (; i + 4 <= x.size(); i += 4) {
    const auto [negative, certain] = pair_at(i);
    const auto [negative_up, certain_up] = pair_at(i + 2);
    const int all_certain = certain | certain_up << 2;
    std::memcpy(&signs[i], &kFourSigns[negative | negative_up << 2 | all_certain << 4],
                4 * sizeof(Sign));
    if (all_certain == 15) [[likely]]
      continue;
    for (std::size_t j = i; j < i + 4; ++j)
      if (signs[j] == Sign::Zero) {
        ++singly;
        signs[j] = on(Eigen::Vector3d(x[j], y[j], z[j]));
      }
  }
  stage_counts.by_double += i - singly;  // operator() counts its own
  for (; i < x.size(); ++i) signs[i] = on(Eigen::Vector3d(x[i], y[i], z[i]));
}

Eigen::Vector3d point_off_plane(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                const Eigen::Vector3d& c) {
  for (int i = 0; i < 3; ++i) {
    Eigen::Vector3d w = a;
    w[i] = a[i] != 0 ? -a[i] : 1.0;
    if (orient3d(a, b, c, w) != Sign::Zero) return w;
  }
  // Not reached: the three points differ from a along the three axes.
  return a;
}

PrecisionScope::PrecisionScope(Precision precision)
    : previous_(internal::thread_precision) {
  internal::thread_precision = precision;
}

PrecisionScope::~PrecisionScope() { internal::thread_precision = previous_; }

}  // namespace sightline
