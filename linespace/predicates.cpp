#include "linespace/predicates.h"

#include <CGAL/Exact_rational.h>

#include <array>
#include <cassert>

namespace sightline {
namespace {

using Rational = CGAL::Exact_rational;

template <class T>
using Vector = std::array<T, 3>;

template <class T>
Vector<T> difference(const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
  return {T(p[0]) - T(q[0]), T(p[1]) - T(q[1]), T(p[2]) - T(q[2])};
}

template <class T>
Vector<T> cross(const Vector<T>& u, const Vector<T>& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
          u[0] * v[1] - u[1] * v[0]};
}

template <class T>
T dot(const Vector<T>& u, const Vector<T>& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

template <class T>
Sign exact_sign(const T& x) {
  return x > 0 ? Sign::Positive : x < 0 ? Sign::Negative : Sign::Zero;
}

}  // namespace

namespace internal {

Sign decide_orient3d(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                     const Eigen::Vector3d& c, const Eigen::Vector3d& d, double value) {
  if (thread_precision == Precision::Double) {
    ++stage_counts.by_double;
    return sign_of(value);
  }
  ++stage_counts.by_exact;
  return exact_sign(dot(difference<Rational>(d, a),
                        cross(difference<Rational>(b, a), difference<Rational>(c, a))));
}

}  // namespace internal

Sign compare_crossings(const LineThrough& edge, const PlaneThrough& p,
                       const PlaneThrough& q) {
  using V = Vector<Rational>;
  const V n = cross(difference<Rational>(p.b, p.a), difference<Rational>(p.c, p.a));
  const V m = cross(difference<Rational>(q.b, q.a), difference<Rational>(q.c, q.a));
  const V along = difference<Rational>(edge.to, edge.from);
  const Rational f = dot(difference<Rational>(edge.from, p.a), n), df = dot(along, n);
  const Rational g = dot(difference<Rational>(edge.from, q.a), m), dg = dot(along, m);
  ++internal::stage_counts.by_exact;
  return exact_sign(Rational(g * df - f * dg)) * exact_sign(df) * exact_sign(dg);
}

bool collinear(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
               const Eigen::Vector3d& c) {
  const auto n = cross(difference<Rational>(b, a), difference<Rational>(c, a));
  ++internal::stage_counts.by_exact;
  return n[0] == 0 && n[1] == 0 && n[2] == 0;
}

void orient3d_batch(const PlaneThrough& plane, std::span<const double> x,
                    std::span<const double> y, std::span<const double> z,
                    std::span<Sign> signs) {
  assert(x.size() == y.size() && x.size() == z.size() && x.size() == signs.size());
  const PlaneSide on(plane);
  for (std::size_t i = 0; i < x.size(); ++i)
    signs[i] = on(Eigen::Vector3d(x[i], y[i], z[i]));
}

PrecisionScope::PrecisionScope(Precision precision)
    : previous_(internal::thread_precision) {
  internal::thread_precision = precision;
}

PrecisionScope::~PrecisionScope() { internal::thread_precision = previous_; }

}  // namespace sightline
