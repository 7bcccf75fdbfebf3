#include "shadows/planar/arcs/plane_support.h"

#include "linespace/scene.h"

namespace sightline::internal {
namespace {

using IntegerMatrix = std::array<std::array<Integer, 3>, 3>;

template <std::size_t N>
void make_primitive(std::array<Integer, N>& values) {
  Integer divisor = 0;
  for (const Integer& x : values) divisor = gcd(divisor, x);
  for (const Integer& x : values) {
    if (x == 0) continue;
    if (x < 0) divisor = -divisor;
    break;
  }
  for (Integer& x : values) x /= divisor;
}

// Rings and balls of a matrix, the balls with a common scale.
void set_forms(const IntegerMatrix& m, std::array<std::array<Ring, 3>, 3>& rings,
               std::array<std::array<BallNumber, 3>, 3>& rounded) {
  std::array<Integer, 9> all;
  for (int i = 0; i < 9; ++i) all[i] = m[i / 3][i % 3];
  const std::vector<BallNumber> b = balls(all);
  for (int i = 0; i < 9; ++i) {
    rings[i / 3][i % 3] = ring(all[i]);
    rounded[i / 3][i % 3] = b[i];
  }
}

// cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]).
IntegerMatrix row_products(const IntegerMatrix& m) {
  return {cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])};
}

IntegerMatrix transposed(const IntegerMatrix& m) {
  IntegerMatrix t;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) t[i][j] = m[j][i];
  }
  return t;
}

// z0 z2 - z1^2.
ImplicitForm implicit_form(const IntegerMatrix& z) {
  const auto product = [&](int i, int j) {
    const auto& [p, q] = std::array{z[i], z[j]};
    return ImplicitForm{p[0] * q[0],
                        p[0] * q[1] + p[1] * q[0],
                        p[1] * q[1],
                        p[0] * q[2] + p[2] * q[0],
                        p[1] * q[2] + p[2] * q[1],
                        p[2] * q[2]};
  };
  ImplicitForm f = product(0, 2);
  const ImplicitForm square = product(1, 1);
  for (int i = 0; i < 6; ++i) f[i] -= square[i];
  make_primitive(f);
  return f;
}

bool is_null(const std::array<Integer, 3>& v) {
  return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

}  // namespace

// x = s where |b| is the larger of the two coefficients, (b s : -(a s + c) : b) with
// b > 0.  Left of it F = a x + b y + c w is positive.  With y = s the curve is
// (-(b s + c) : a s : a) with a > 0, and the positive side of F lies to the right.
PlaneSupport line_support(const std::array<Integer, 3>& line) {
  std::array<Integer, 3> f = line;
  make_primitive(f);
  PlaneSupport support;
  support.implicit = {0, 0, 0, f[0], f[1], f[2]};
  support.by_x = abs(f[1]) >= abs(f[0]);
  if (f[support.by_x ? 1 : 0] < 0) {
    for (Integer& x : f) x = -x;
  }
  const auto& [a, b, c] = f;
  const IntegerMatrix curve = support.by_x
                                  ? IntegerMatrix{{{0, b, 0}, {-c, -a, 0}, {b, 0, 0}}}
                                  : IntegerMatrix{{{-c, -b, 0}, {0, a, 0}, {a, 0, 0}}};
  set_forms(curve, support.exact.curve, support.balls.curve);
  IntegerMatrix inverse{};
  inverse[0][2] = 1;
  inverse[1][support.by_x ? 0 : 1] = 1;
  set_forms(inverse, support.exact.inverse, support.balls.inverse);
  if (!support.by_x) {
    for (Integer& x : f) x = -x;
  }
  const std::vector<BallNumber> rounded = balls(f);
  for (int i = 0; i < 3; ++i) {
    support.exact.line[i] = ring(f[i]);
    support.balls.line[i] = rounded[i];
  }
  return support;
}

// With N = adj(M) and e = (1, s, s^2), the gradient of z0 z2 - z1^2 at X = M e is
// det(M) (X x X'), and X x X' points to the left: so the form has the sign of det(M)
// there.
PlaneSupport support_of(const IntegerMatrix& curve) {
  const IntegerMatrix inverse = transposed(row_products(curve));
  const Integer determinant = dot(curve[0], row_products(curve)[0]);
  if (determinant == 0) {
    for (const std::array<Integer, 3>& line : row_products(transposed(curve))) {
      if (!is_null(line)) return line_support(line);
    }
    throw InvalidInput("a curve of a planar map is a single point");
  }
  PlaneSupport support;
  support.straight = false;
  support.reversed = determinant < 0;
  set_forms(curve, support.exact.curve, support.balls.curve);
  set_forms(inverse, support.exact.inverse, support.balls.inverse);
  support.implicit = implicit_form(inverse);
  return support;
}

SurdPoint point_at(const PlaneSupport& support, const QuadraticRoot& s) {
  std::array<Surd, 3> x;
  for (int i = 0; i < 3; ++i) {
    const auto& c = support.exact.curve[i];
    x[i] = value_at(std::span(c).first(support.degree() + 1), s);
  }
  return {x[0], x[1], x[2], s.d};
}

namespace {
Surd at_point(const std::array<Ring, 3>& form, const SurdPoint& p) {
  return form[0] * p.x + form[1] * p.y + form[2] * p.w;
}
}  // namespace

Sign side_of(const PlaneSupport& support, const SurdPoint& p) {
  const SupportForms<Ring>& f = support.exact;
  if (support.straight) return sign_of(at_point(f.line, p), p.d);
  const Surd z0 = at_point(f.inverse[0], p), z1 = at_point(f.inverse[1], p),
             z2 = at_point(f.inverse[2], p);
  const Sign sign = sign_of(product(z0, z2, p.d) - product(z1, z1, p.d), p.d);
  return support.reversed ? -sign : sign;
}

std::optional<QuadraticRoot> parameter_of(const PlaneSupport& support,
                                          const SurdPoint& p) {
  const Surd z0 = at_point(support.exact.inverse[0], p);
  if (is_zero(z0, p.d)) return std::nullopt;
  return exact_ratio(at_point(support.exact.inverse[1], p), z0, p.d);
}

namespace {

template <class T>
std::array<T, 3> composed(const std::array<T, 3>& form,
                          const std::array<std::array<T, 3>, 3>& curve, int degree) {
  std::array<T, 3> out{};
  for (int k = 0; k <= degree; ++k) {
    out[k] = form[0] * curve[0][k] + form[1] * curve[1][k] + form[2] * curve[2][k];
  }
  return out;
}

}  // namespace

template <class T>
Substitution<T> substitute(const PlaneSupport& own, const PlaneSupport& other) {
  const SupportForms<T>& g = other.forms<T>();
  const auto& curve = own.forms<T>().curve;
  const int degree = own.degree();
  Substitution<T> out{};
  for (int i = 0; i < 2; ++i) out.z[i] = composed(g.inverse[i], curve, degree);
  if (other.straight) {
    const std::array<T, 3> f = composed(g.line, curve, degree);
    for (int k = 0; k <= degree; ++k) out.f[k] = f[k];
    out.degree = degree;
    return out;
  }
  const std::array<T, 3> z2 = composed(g.inverse[2], curve, degree);
  for (int i = 0; i <= degree; ++i) {
    for (int j = 0; j <= degree; ++j) {
      const T term = out.z[0][i] * z2[j] - out.z[1][i] * out.z[1][j];
      out.f[i + j] = other.reversed ? out.f[i + j] - term : out.f[i + j] + term;
    }
  }
  out.degree = 2 * degree;
  return out;
}
template Substitution<Ring> substitute(const PlaneSupport&, const PlaneSupport&);
template Substitution<BallNumber> substitute(const PlaneSupport&, const PlaneSupport&);

}  // namespace sightline::internal
