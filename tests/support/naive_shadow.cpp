#include "tests/support/naive_shadow.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/naive_shadow_rays.h"

namespace sightline::testing {
namespace {

/// The first 64 bits of x.
struct Rounded {
  long double mantissa;
  long exponent;
};
Rounded rounded(const Integer& x) {
  const mpz_srcptr z = x.backend().data();
  const auto bits = static_cast<long>(mpz_sizeinbase(z, 2));
  const long drop = std::max(bits - 64, 0L);
  Integer head;
  mpz_tdiv_q_2exp(head.backend().data(), z, static_cast<mp_bitcnt_t>(drop));
  long double mantissa = 0;
  for (int half = 0; half < 2; ++half) {
    // A limb has 64 bits; in two steps, lest one be rounded to a double.
    const mp_limb_t limb = mpz_getlimbn(head.backend().data(), 0);
    const auto part = static_cast<std::uint32_t>(half == 0 ? limb >> 32 : limb);
    mantissa = mantissa * 0x1p32L + static_cast<long double>(part);
  }
  return {z->_mp_size < 0 ? -mantissa : mantissa, drop};
}

long double quotient(const Integer& a, const Integer& b) {
  const Rounded x = rounded(a), y = rounded(b);
  return std::ldexp(x.mantissa / y.mantissa, static_cast<int>(x.exponent - y.exponent));
}

using Long3 = std::array<long double, 3>;

long double dot_of(const Long3& a, const Long3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Long3 unit(const Integers& v) {
  std::array<Rounded, 3> parts;
  long most = 0;
  for (int i = 0; i < 3; ++i) {
    parts[i] = rounded(v[i]);
    most = std::max(most, parts[i].exponent);
  }
  Long3 result;
  long double squares = 0;
  for (int i = 0; i < 3; ++i) {
    result[i] = std::ldexp(parts[i].mantissa,
                           static_cast<int>(std::max(parts[i].exponent - most, -16000L)));
    squares += result[i] * result[i];
  }
  for (long double& x : result) x /= std::sqrt(squares);
  return result;
}
Long3 unit(const Ray& ray) { return unit(ray.exact()); }

/// The axis along which the face's normal is longest.
int steepest(const Ray& normal) {
  const auto& n = normal.near();
  int result = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(n[i]) > std::abs(n[result])) result = i;
  }
  return result;
}

/// Corners of a part on the face's plane as they are dropped onto a coordinate plane,
/// from a corner of the face, in the units of `rays`: numerators over denominators.
struct Fractions {
  Integer x, y, below;
};
std::vector<Fractions> dropped(const NaiveRays& rays, const SourcePart& part, int axis) {
  const Ray& normal = rays.setup().normals[part.face];
  const Integer& height = rays.height(part.face);
  const Integers origin = rays.to_corner(part.face, 0);
  std::vector<Fractions> result;
  for (const Ray& corner : part.cone.corners) {
    const Integers& v = corner.exact();
    const auto& n = normal.exact();
    Fractions f;
    f.below = n[0] * v[0] + n[1] * v[1] + n[2] * v[2];
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    f.x = v[i] * height - f.below * origin[i];
    f.y = v[j] * height - f.below * origin[j];
    result.push_back(std::move(f));
  }
  return result;
}

/// Twice the area of the dropped part; T is the number to compute with.
template <class T, class Divide>
T dropped_area(const NaiveRays& rays, const SourcePart& part, Divide&& divide) {
  std::vector<std::array<T, 2>> at;
  for (const Fractions& f :
       dropped(rays, part, steepest(rays.setup().normals[part.face]))) {
    at.push_back({divide(f.x, f.below), divide(f.y, f.below)});
  }
  T sum = 0;
  for (std::size_t i = 1; i + 1 < at.size(); ++i) {
    sum += (at[i][0] - at[0][0]) * (at[i + 1][1] - at[0][1]) -
           (at[i][1] - at[0][1]) * (at[i + 1][0] - at[0][0]);
  }
  return sum < 0 ? T(-sum) : sum;
}

long double area(const NaiveRays& rays, const SourcePart& part) {
  const Ray& normal = rays.setup().normals[part.face];
  return dropped_area<long double>(rays, part, quotient) /
         std::abs(unit(normal)[steepest(normal)]);
}

/// Lambert: each side of the cone by its angle, times the cosine of its inward normal.
long double form_factor(const SourcePart& part, const Long3& normal) {
  const Cone& cone = part.cone;
  long double sum = 0;
  for (std::size_t i = 0; i < cone.corners.size(); ++i) {
    const Long3 a = unit(cone.corners[i]);
    const Long3 b = unit(cone.corners[(i + 1) % cone.corners.size()]);
    const Long3 across{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                       a[0] * b[1] - a[1] * b[0]};
    const long double angle = std::atan2(std::sqrt(dot_of(across, across)), dot_of(a, b));
    sum += angle * dot_of(unit(cone.sides[i]), normal);
  }
  return sum / (2 * std::numbers::pi_v<long double>);
}

NaiveLight light_of(const SourceParts& parts) {
  if (parts.seen.empty()) return NaiveLight::Umbra;
  return parts.hides ? NaiveLight::Penumbra : NaiveLight::Lit;
}

}  // namespace

std::vector<NaiveShadowFace> naive_shadow_faces(const Scene& scene,
                                                std::span<const int> sources,
                                                std::span<const int> two_sided) {
  std::vector<NaiveShadowFace> result;
  for (int f = 0; f < static_cast<int>(scene.faces().size()); ++f) {
    NaiveShadowFace face;
    for (const int p : scene.face_points(f))
      face.corners.push_back(exact(scene.point(p)));
    if (scene.turned(f)) {
      // The first three corners, which are not collinear, stay the first three.
      std::reverse(face.corners.begin(), face.corners.begin() + 3);
      std::reverse(face.corners.begin() + 3, face.corners.end());
    }
    face.polygon = scene.faces()[f].source;
    face.object = scene.faces()[f].object;
    face.source = std::ranges::find(sources, f) != sources.end();
    face.two_sided = std::ranges::find(two_sided, f) != two_sided.end();
    result.push_back(std::move(face));
  }
  return result;
}

NaiveShadow::NaiveShadow(std::vector<NaiveShadowFace> faces)
    : setup_(std::make_unique<const Setup>(std::move(faces))) {}
NaiveShadow::~NaiveShadow() = default;

NaiveLightAt NaiveShadow::at(const Vec3& p, const std::optional<Vec3>& normal) const {
  const NaiveRays rays(*setup_, p);
  const SourceParts parts = parts_seen(rays, normal);
  NaiveLightAt result{light_of(parts), 0, {}};
  long double whole = 0, seen = 0;
  for (const SourcePart& part : parts.whole) whole += area(rays, part);
  for (const SourcePart& part : parts.seen) seen += area(rays, part);
  if (result.light != NaiveLight::Umbra) {
    result.visible_fraction = result.light == NaiveLight::Lit ? 1 : seen / whole;
  }
  if (normal) {
    const Long3 up = unit(Ray(*normal));
    result.form_factor = 0;
    for (const SourcePart& part : parts.seen)
      *result.form_factor += form_factor(part, up);
  }
  return result;
}

std::optional<Rational> NaiveShadow::exact_fraction(
    const Vec3& p, const std::optional<Vec3>& normal) const {
  const NaiveRays rays(*setup_, p);
  const SourceParts parts = parts_seen(rays, normal);
  for (const SourcePart& part : parts.whole) {
    if (canonical(setup_->normals[part.face]) !=
        canonical(setup_->normals[parts.whole[0].face])) {
      return std::nullopt;
    }
  }
  const auto sum = [&](const std::vector<SourcePart>& list) {
    Rational result = 0;
    for (const SourcePart& part : list) {
      result += dropped_area<Rational>(
          rays, part, [](const Integer& a, const Integer& b) { return Rational(a, b); });
    }
    return result;
  };
  return parts.whole.empty() ? Rational(0) : Rational(sum(parts.seen) / sum(parts.whole));
}

}  // namespace sightline::testing
