#include "tests/support/naive_cones.h"

#include <algorithm>
#include <cmath>

namespace sightline::testing {
namespace {

std::array<Integer, 3> cross_of(const std::array<Integer, 3>& a,
                                const std::array<Integer, 3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
          a[0] * b[1] - a[1] * b[0]};
}

Integer dot_of(const std::array<Integer, 3>& a, const std::array<Integer, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

std::array<Integer, 3> cleared(const Vec3& v) {
  Integer common = 1;
  for (const Rational& x : v) common = lcm(common, Integer(denominator(x)));
  std::array<Integer, 3> result;
  for (int i = 0; i < 3; ++i) {
    result[i] = Integer(numerator(v[i])) * (common / Integer(denominator(v[i])));
  }
  return result;
}

/// mantissa 2^exponent, the mantissa below 1; 0 for 0.
std::pair<double, long> mantissa(const Integer& x) {
  long exponent = 0;
  const double m = mpz_get_d_2exp(&exponent, x.backend().data());
  return {m, exponent};
}

}  // namespace

Ray::Ray(const std::array<Integer, 3>& v) {
  Data data;
  const Integer divisor = gcd(gcd(v[0], v[1]), v[2]);
  long longest = 0;
  for (int i = 0; i < 3; ++i) {
    data.exact[i] = v[i] / divisor;
    longest = std::max(longest, mantissa(data.exact[i]).second);
  }
  for (int i = 0; i < 3; ++i) {
    const auto [m, exponent] = mantissa(data.exact[i]);
    data.near[i] = std::ldexp(m, static_cast<int>(std::max(exponent - longest, -2000L)));
  }
  data_ = std::make_shared<const Data>(std::move(data));
}

Ray::Ray(const Vec3& v) : Ray(cleared(v)) {}

Vec3 Ray::rational() const {
  return {Rational(exact()[0]), Rational(exact()[1]), Rational(exact()[2])};
}

Ray Ray::operator-() const {
  return Ray(std::array<Integer, 3>{-exact()[0], -exact()[1], -exact()[2]});
}

int side(const Ray& half_space, const Ray& ray) {
  const auto& a = half_space.near();
  const auto& b = ray.near();
  double sum = 0, size = 0;
  for (int i = 0; i < 3; ++i) {
    sum += a[i] * b[i];
    size += std::abs(a[i] * b[i]);
  }
  // Each product is within 2.1 * 2^-52 of itself, the two sums add 2 * 2^-53 of size
  // each; coordinates that underflow change less than 1e-300.
  if (std::abs(sum) > 0x1p-48 * size + 1e-300) return sum > 0 ? 1 : -1;
  return dot_of(half_space.exact(), ray.exact()).sign();
}

int orientation(const Ray& a, const Ray& b, const Ray& c) {
  return dot_of(a.exact(), cross_of(b.exact(), c.exact())).sign();
}

bool reversed(const Ray& r) {
  const auto& x = r.exact();
  const Integer& first = x[0] != 0 ? x[0] : x[1] != 0 ? x[1] : x[2];
  return first.sign() < 0;
}
Ray canonical(const Ray& r) { return reversed(r) ? -r : r; }

std::optional<Ray> normal(const Ray& a, const Ray& b) {
  const std::array<Integer, 3> n = cross_of(a.exact(), b.exact());
  if (n[0] == 0 && n[1] == 0 && n[2] == 0) return std::nullopt;
  return Ray(n);
}

Ray between(const std::vector<Ray>& rays) {
  // Scaled to lengths within a factor of 4, so that the sum is well inside: any positive
  // factors would be right.
  const auto bits = [](const Ray& r) {
    long most = 0;
    for (const Integer& x : r.exact()) most = std::max(most, mantissa(x).second);
    return most;
  };
  long most = 0;
  for (const Ray& r : rays) most = std::max(most, bits(r));
  std::array<Integer, 3> sum{0, 0, 0};
  for (const Ray& r : rays) {
    for (int i = 0; i < 3; ++i) sum[i] += r.exact()[i] << (most - bits(r));
  }
  return Ray(sum);
}

std::optional<Cone> cone_of(std::vector<Ray> rays) {
  bool changed = true;
  while (changed && rays.size() >= 3) {
    changed = false;
    for (std::size_t i = 0; i < rays.size() && !changed; ++i) {
      const std::size_t n = rays.size();
      if (orientation(rays[(i + n - 1) % n], rays[i], rays[(i + 1) % n]) == 0) {
        rays.erase(rays.begin() + static_cast<std::ptrdiff_t>(i));
        changed = true;
      }
    }
  }
  if (rays.size() < 3) return std::nullopt;
  if (orientation(rays[0], rays[1], rays[2]) < 0) std::reverse(rays.begin(), rays.end());
  Cone cone;
  cone.corners = std::move(rays);
  for (std::size_t i = 0; i < cone.corners.size(); ++i) {
    cone.sides.push_back(
        normal(cone.corners[i], cone.corners[(i + 1) % cone.corners.size()]).value());
  }
  return cone;
}

std::optional<Cone> clip(const Cone& cone, const Ray& half_space) {
  const std::size_t n = cone.corners.size();
  std::vector<int> signs(n);
  for (std::size_t i = 0; i < n; ++i) signs[i] = side(half_space, cone.corners[i]);
  if (std::ranges::none_of(signs, [](int s) { return s > 0; })) return std::nullopt;
  if (std::ranges::none_of(signs, [](int s) { return s < 0; })) return cone;
  Cone result;
  for (std::size_t i = 0; i < n; ++i) {
    const int here = signs[i], next = signs[(i + 1) % n];
    if (here >= 0) {
      result.corners.push_back(cone.corners[i]);
      result.sides.push_back(here == 0 && next < 0 ? half_space : cone.sides[i]);
    }
    if (here * next >= 0) continue;
    // Where the side leaves or enters: a crossing of two planes, of which the ray on the
    // side is taken, that is the one ahead of corner i.
    const Ray line = normal(cone.sides[i], half_space).value();
    const bool ahead = side(cone.sides[i], *normal(cone.corners[i], line)) > 0;
    result.corners.push_back(ahead ? line : -line);
    result.sides.push_back(here > 0 ? half_space : cone.sides[i]);
  }
  return result;
}

Cut cut(const Cone& cone, const std::vector<Ray>& half_spaces) {
  for (const Ray& h : half_spaces) {
    if (std::ranges::none_of(cone.corners,
                             [&](const Ray& corner) { return side(h, corner) > 0; })) {
      return {std::nullopt, {cone}};
    }
  }
  Cut result{cone, {}};
  for (const Ray& h : half_spaces) {
    if (const std::optional<Cone> outside = clip(*result.inside, -h)) {
      result.outside.push_back(*outside);
    }
    result.inside = clip(*result.inside, h);
    if (!result.inside) return {std::nullopt, {cone}};
  }
  return result;
}

namespace {

long double angle_in_octant(const Cone& cone) {
  // Van Oosterom and Strackee, 1983, on a fan of triangles; the determinant is exact, so
  // that slivers are as good as other triangles.
  const auto rounded_dot = [](const Ray& a, const Ray& b) {
    const Integer exact = dot_of(a.exact(), b.exact());
    const auto [m, e] = mantissa(exact);
    return std::pair<long double, long>(m, e);
  };
  const auto length = [&](const Ray& a) {
    const auto [m, e] = rounded_dot(a, a);
    const long half = e / 2;
    return std::pair<long double, long>(
        std::sqrt(std::ldexp(m, static_cast<int>(e - 2 * half))), half);
  };
  const auto cosine = [&](const Ray& a, const Ray& b) {
    const auto [m, e] = rounded_dot(a, b);
    const auto [la, ea] = length(a);
    const auto [lb, eb] = length(b);
    return std::ldexp(m / (la * lb), static_cast<int>(std::max(e - ea - eb, -16000L)));
  };
  long double sum = 0;
  const std::vector<Ray>& c = cone.corners;
  for (std::size_t i = 1; i + 1 < c.size(); ++i) {
    const Integer det = dot_of(c[0].exact(), cross_of(c[i].exact(), c[i + 1].exact()));
    auto [m, e] = mantissa(det);
    long double top = m;
    for (const Ray& r : {c[0], c[i], c[i + 1]}) {
      const auto [l, k] = length(r);
      top /= l;
      e -= k;
    }
    top = std::ldexp(top, static_cast<int>(std::max(e, -16000L)));
    const long double bottom =
        1 + cosine(c[0], c[i]) + cosine(c[i], c[i + 1]) + cosine(c[i + 1], c[0]);
    sum += 2 * std::atan2(top, bottom);
  }
  return sum;
}

}  // namespace

double solid_angle(const Cone& cone) {
  // In one octant no angle is above a quarter turn, so that nothing cancels.
  long double sum = 0;
  for (int octant = 0; octant < 8; ++octant) {
    std::optional<Cone> part = cone;
    for (int i = 0; i < 3 && part; ++i) {
      std::array<Integer, 3> axis{0, 0, 0};
      axis[i] = (octant >> i & 1) != 0 ? 1 : -1;
      part = clip(*part, Ray(axis));
    }
    if (part) sum += angle_in_octant(*part);
  }
  return static_cast<double>(sum);
}

}  // namespace sightline::testing
