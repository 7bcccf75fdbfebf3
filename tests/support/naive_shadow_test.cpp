// The naive shadows against closed forms, samples, quadrature, and themselves written
// down otherwise.

#include "tests/support/naive_shadow.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "linespace/scene/solid_index.h"
#include "tests/support/add_box.h"
#include "tests/support/add_polygons.h"
#include "tests/support/generators.h"
#include "tests/support/naive_shadow_rays.h"
#include "tests/support/shadow_scenes.h"

namespace sightline::testing {
namespace {

std::string text_of(const Vec3& v) {
  return v[0].str() + " " + v[1].str() + " " + v[2].str();
}

Vec3 vec(double x, double y, double z) { return exact(Point(x, y, z)); }

/// Level, front below.
std::vector<Point> level(double x0, double y0, double x1, double y1, double z) {
  return {{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}};
}

NaiveShadow lit_by_first(const PolygonSoup& soup) {
  const Scene scene(soup);
  return NaiveShadow(naive_shadow_faces(scene, scene.faces_named(soup.groups[0].name)));
}

TEST(NaiveShadow, SquareOverItsCentre) {
  PolygonSoup soup;
  add_polygons(soup, "light", {level(-1, -1, 1, 1, 1)});
  const NaiveShadow shadow = lit_by_first(soup);
  const NaiveLightAt at = shadow.at(vec(0, 0, 0), vec(0, 0, 3));
  EXPECT_EQ(at.light, NaiveLight::Lit);
  EXPECT_NEAR(static_cast<double>(*at.form_factor), 0.554126423979572, 1e-15);
  EXPECT_NEAR(static_cast<double>(*shadow.at(vec(0, 0, -1), vec(0, 0, 1)).form_factor),
              0.239456470461, 1e-12);
  // Behind it, in its plane; turned away; half below the horizon.
  EXPECT_EQ(shadow.at(vec(0, 0, 2)).light, NaiveLight::Umbra);
  EXPECT_EQ(shadow.at(vec(5, 0, 1)).light, NaiveLight::Umbra);
  EXPECT_EQ(shadow.at(vec(0, 0, 0), vec(0, 0, -1)).light, NaiveLight::Umbra);
  EXPECT_EQ(shadow.exact_fraction(vec(0, 0, 0), vec(2, 0, 0)), Rational(1, 2));
}

TEST(NaiveShadow, PlatesBetween) {
  PolygonSoup soup;
  add_polygons(soup, "light", {level(-1, -1, 1, 1, 2)});
  add_polygons(soup, "plate", {level(-0.5, -0.5, 0, 0.25, 1)});
  const NaiveShadow shadow = lit_by_first(soup);
  EXPECT_EQ(shadow.exact_fraction(vec(0, 0, 0)), Rational(4 - 1 * 1.5) / 4);
  // On the plate: it hides nothing.  Just below: everything.
  EXPECT_EQ(shadow.at(vec(-0.25, 0, 1)).light, NaiveLight::Lit);
  EXPECT_EQ(shadow.at(vec(-0.25, 0, std::nextafter(1.0, 0.0))).light, NaiveLight::Umbra);
  EXPECT_EQ(shadow.at(vec(0.5, 0, 1)).light, NaiveLight::Lit);
}

TEST(NaiveShadow, TinyOpenings) {
  for (const double slit : {0x1p-36, 0.0}) {
    PolygonSoup soup;
    add_polygons(soup, "light", {level(-1, -1, 1, 1, 2)});
    add_polygons(soup, "plate", {level(-2, -2, 0.5 - slit, 2, 1)});
    add_polygons(soup, "other", {level(-2, -2, 2, 0.5 - slit, 1)});
    const NaiveLightAt at = lit_by_first(soup).at(vec(0, 0, 0));
    EXPECT_EQ(at.light, slit > 0 ? NaiveLight::Penumbra : NaiveLight::Umbra);
    EXPECT_EQ(static_cast<double>(at.visible_fraction), slit * slit);
  }
}

TEST(NaiveShadow, InAndOnSolids) {
  PolygonSoup soup;
  add_polygons(soup, "light", {level(-1, -1, 1, 1, 4)});
  add_box(soup, "box", {0, -2, 0}, {2, 2, 2});
  const NaiveShadow shadow = lit_by_first(soup);
  EXPECT_EQ(shadow.at(vec(1, 0, 1)).light, NaiveLight::Umbra);
  EXPECT_EQ(shadow.at(vec(1, 0, 2)).light, NaiveLight::Lit);
  EXPECT_EQ(shadow.at(vec(1, 0, 0)).light, NaiveLight::Umbra);
  // On the wall, at its foot, and on its ridge.
  EXPECT_EQ(shadow.exact_fraction(vec(0, 0, 1)), Rational(1, 2));
  EXPECT_EQ(shadow.exact_fraction(vec(0, 0, 0)), Rational(1, 2));
  EXPECT_EQ(shadow.exact_fraction(vec(0, 0, 2)), Rational(1));
}

TEST(NaiveShadow, CoincidentLightsCountOnce) {
  PolygonSoup soup;
  add_polygons(soup, "light",
               {level(0, 0, 2, 2, 1), level(1, 0, 3, 2, 1), level(1, 0, 3, 2, 1)});
  add_polygons(soup, "plate", {level(0, 0, 1, 1, 0.5)});
  const NaiveShadow shadow = lit_by_first(soup);
  // Seen from (0, 0, 0) the plate hides 2 x 2 of 3 x 2.
  EXPECT_EQ(shadow.exact_fraction(vec(0, 0, 0)), Rational(1, 3));
}

/// Whether the face meets the open segment from p to s elsewhere than in its own plane;
/// nullopt where it does so on one of its sides.
std::optional<bool> meets(const NaiveShadowFace& face, const Vec3& p, const Vec3& s) {
  const Vec3 n =
      cross(face.corners[1] - face.corners[0], face.corners[2] - face.corners[0]);
  const Rational at_p = dot(n, p - face.corners[0]), at_s = dot(n, s - face.corners[0]);
  if (at_p.sign() * at_s.sign() >= 0) return false;
  const Vec3 x = p + Rational(at_p / (at_p - at_s)) * (s - p);
  int least = 1;
  for (std::size_t i = 0; i < face.corners.size(); ++i) {
    const Vec3& a = face.corners[i];
    const Vec3& b = face.corners[(i + 1) % face.corners.size()];
    least = std::min(least, dot(n, cross(b - a, x - a)).sign());
  }
  if (least == 0) return std::nullopt;
  return least > 0;
}

/// By the definition; nullopt for a segment that touches a side.
std::optional<bool> sees(const std::vector<NaiveShadowFace>& faces,
                         const internal::SolidIndex& solids, const AskedPoint& p,
                         const Vec3& s) {
  if (p.normal && dot(*p.normal, s - p.at).sign() <= 0) return false;
  bool hidden = false;
  for (const NaiveShadowFace& face : faces) {
    const std::optional<bool> hit = meets(face, p.at, s);
    if (!hit) return std::nullopt;
    hidden = hidden || *hit;
  }
  if (hidden) return false;
  internal::ExactPoint middle;
  for (int i = 0; i < 3; ++i) middle[i] = (p.at[i] + s[i]) / 2;
  return solids.solids_around(middle).empty();
}

bool holds(const Cone& cone, const Vec3& ray) {
  return std::ranges::all_of(cone.sides,
                             [&](const Ray& s) { return side(s, Ray(ray)) > 0; });
}

TEST(NaiveShadow, SegmentsToSamplesOfTheLightsSaySo) {
  std::array<int, 2> counts{};  // hidden, seen
  for (const ShadowScene& lit : shadow_scenes()) {
    const Scene scene(lit.soup);
    const internal::SolidIndex solids(scene);
    const auto faces = naive_shadow_faces(scene, faces_of_groups(scene, lit.lights),
                                          faces_of_groups(scene, lit.two_sided));
    const NaiveShadow::Setup setup(faces);
    auto points = random_asked_points(scene, 5, 4);
    const auto more = event_asked_points(scene, 6, 8);
    points.insert(points.end(), more.begin(), more.end());
    Random random(7);
    for (const AskedPoint& p : points) {
      const NaiveRays rays(setup, p.at);
      const SourceParts parts = parts_seen(rays, p.normal);
      for (const int f : parts.shown) {
        const auto& c = faces[f].corners;
        const int k = random.integer(1, static_cast<int>(c.size()) - 2);
        const Rational u = Rational(random.uniform(0, 1)), v(random.uniform(0, 1));
        const Vec3 s =
            c[0] + u * (Rational(1 - v) * (c[k] - c[0]) + v * (c[k + 1] - c[0]));
        const std::optional<bool> expected = sees(faces, solids, p, s);
        if (!expected) continue;
        ++counts[*expected ? 1 : 0];
        // Of coplanar lights on one another one has it.
        const bool found = std::ranges::any_of(parts.seen, [&](const SourcePart& part) {
          return (part.face == f || !rays.before(part.face, f)) &&
                 holds(part.cone, s - p.at);
        });
        EXPECT_EQ(found, *expected)
            << lit.name << ", from " << text_of(p.at) << " to " << text_of(s);
      }
    }
  }
  EXPECT_GT(counts[0], 500);
  EXPECT_GT(counts[1], 500);
}

/// The integrand over a triangle by Gauss's rule with 24 x 24 points.
long double quadrature(const Point& p, const Point& n, const std::array<Point, 3>& t) {
  constexpr int kCount = 24;
  static const auto rule = [] {
    std::array<std::array<long double, 2>, kCount> result;
    for (int i = 0; i < kCount; ++i) {
      long double x = std::cos(std::numbers::pi_v<long double> * (i + 0.75L) /
                               (kCount + 0.5L)),
                  slope = 1;
      for (int step = 0; step < 8; ++step) {
        long double a = 1, b = x;
        for (int k = 2; k <= kCount; ++k) {
          const long double c = ((2 * k - 1) * x * b - (k - 1) * a) / k;
          a = b;
          b = c;
        }
        slope = kCount * (x * b - a) / (x * x - 1);
        x -= b / slope;
      }
      result[i] = {(1 + x) / 2, 1 / ((1 - x * x) * slope * slope)};
    }
    return result;
  }();
  using LongVector = Eigen::Matrix<long double, 3, 1>;
  const LongVector a = t[0].cast<long double>(), u = (t[1] - t[0]).cast<long double>(),
                   v = (t[2] - t[1]).cast<long double>();
  const LongVector across = u.cross(v), up = n.cast<long double>().normalized();
  long double sum = 0;
  for (const auto& [x, weight_x] : rule) {
    for (const auto& [y, weight_y] : rule) {
      const LongVector r = a + x * (u + y * v) - p.cast<long double>();
      const long double square = r.squaredNorm();
      sum += weight_x * weight_y * x * up.dot(r) * across.dot(r) / (square * square);
    }
  }
  return std::abs(sum) / std::numbers::pi_v<long double>;
}

TEST(NaiveShadow, FormFactorsAreThoseOfQuadrature) {
  Random random(3);
  int count = 0;
  while (count < 200) {
    std::array<Point, 3> t;
    for (Point& c : t) {
      c = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(2, 3)};
    }
    const Point n = random.direction(), p(0, 0, 0);
    if (std::ranges::any_of(t, [&](const Point& c) { return n.dot(c) < 0.1; })) continue;
    if (Point((t[1] - t[0]).cross(t[2] - t[0])).dot(t[0]) > 0) std::swap(t[1], t[2]);
    PolygonSoup soup;
    add_polygons(soup, "light", {{t[0], t[1], t[2]}});
    const NaiveLightAt at = lit_by_first(soup).at(exact(p), exact(n));
    EXPECT_NEAR(static_cast<double>(*at.form_factor - quadrature(p, n, t)), 0, 1e-17);
    ++count;
  }
}

/// The faces in another order, and each cut into a fan of triangles around a corner.
std::vector<NaiveShadowFace> cut_and_shuffled(const std::vector<NaiveShadowFace>& faces) {
  Random random(11);
  std::vector<NaiveShadowFace> result;
  for (const NaiveShadowFace& f : faces) {
    const std::size_t n = f.corners.size();
    const std::size_t first = random.integer(0, static_cast<int>(n) - 1);
    for (std::size_t i = 1; i + 1 < n; ++i) {
      NaiveShadowFace part = f;
      part.corners = {f.corners[first], f.corners[(first + i) % n],
                      f.corners[(first + i + 1) % n]};
      const Vec3 u = part.corners[1] - part.corners[0];
      if (!is_zero(cross(u, part.corners[2] - part.corners[0]))) result.push_back(part);
    }
  }
  random.shuffle(result);
  return result;
}

Vec3 on_other_axes(const Vec3& v) { return {v[1], v[2], v[0]}; }

TEST(NaiveShadow, IsTheSameCutIntoTrianglesAndOnOtherAxes) {
  int structures = 0;
  for (const ShadowScene& lit : shadow_scenes()) {
    const Scene scene(lit.soup);
    const auto faces = naive_shadow_faces(scene, faces_of_groups(scene, lit.lights),
                                          faces_of_groups(scene, lit.two_sided));
    auto turned_faces = faces;
    for (NaiveShadowFace& f : turned_faces) {
      for (Vec3& c : f.corners) c = on_other_axes(c);
    }
    const NaiveShadow shadow(faces), cut(cut_and_shuffled(faces)), turned(turned_faces);
    for (const bool event : {false, true}) {
      const auto points =
          event ? event_asked_points(scene, 2, 6) : random_asked_points(scene, 1, 6);
      for (const AskedPoint& p : points) {
        const NaiveLightAt a = shadow.at(p.at, p.normal), b = cut.at(p.at, p.normal);
        std::optional<Vec3> normal;
        if (p.normal) normal = on_other_axes(*p.normal);
        const NaiveLightAt c = turned.at(on_other_axes(p.at), normal);
        for (const NaiveLightAt& other : {b, c}) {
          EXPECT_EQ(a.light, other.light) << lit.name;
          EXPECT_NEAR(a.visible_fraction, other.visible_fraction, 1e-16) << lit.name;
          if (!p.normal) continue;
          EXPECT_NEAR(*a.form_factor, *other.form_factor, 1e-16) << lit.name;
        }
        SCOPED_TRACE(lit.name + ", " + text_of(p.at));
        const std::string text = text_of(shadow.structure(p.at, p.normal));
        EXPECT_EQ(text, text_of(cut.structure(p.at, p.normal))) << lit.name;
        structures += text.empty() ? 0 : 1;
      }
    }
  }
  EXPECT_GT(structures, 200);
}

}  // namespace
}  // namespace sightline::testing
