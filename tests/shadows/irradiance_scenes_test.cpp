// Irradiance meshes of many lit scenes against points asked exactly.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "shadows/irradiance.h"
#include "tests/support/generators.h"
#include "tests/support/shadow_scenes.h"

namespace sightline::testing {
namespace {

// Of meshes asked at random points of their receivers.
struct Found {
  double closed_form = 0;  // the largest error of the closed form
  int points = 0, beyond_bound = 0, polynomials = 0;
  double least_ratio = 1e300;  // bound over error, where the error is no rounding
};

class Comparison {
 public:
  Comparison(const Scene& scene, const LightSource& source)
      : scene_(&scene), source_(&source), light_(scene, source) {}

  void receiver(const Receiver& receiver, int points, Found& found) {
    const Shadows shadows = find_shadows(*scene_, *source_, {receiver});
    for (const ShadowMesh& mesh : shadows.receivers.at(0).meshes) {
      // Doubles cannot be told to lie on this or that triangle of a bent facet.
      if (scene_->facets()[mesh.facet].planar)
        compare(receiver, shadows, mesh, points, found);
    }
  }

 private:
  void compare(const Receiver& receiver, const Shadows& shadows, const ShadowMesh& mesh,
               int points, Found& found) {
    const auto made = [&](int order, double accuracy) {
      return IrradianceMesh(*scene_, light_, receiver, shadows, mesh,
                            {.order = order, .accuracy = accuracy, .smallest = 1e-3});
    };
    const IrradianceMesh closed = made(0, 1e-6), linear = made(1, 1e-2),
                         quadratic = made(2, 1e-3);
    int face = -1;
    for (const int f : receiver.faces) {
      if (scene_->faces()[f].facet == mesh.facet) face = f;
    }
    std::uniform_real_distribution<double> share(0, 1);
    for (int i = 0; i < points; ++i) {
      const Point p = point_of(mesh, share);
      const auto here = closed.at(p);
      if (!here) continue;
      const double exact =
          *light_.from(shadow_point_on_face(*scene_, face, p, receiver.front))
               .form_factor;
      ++found.points;
      // Where there is no closed form the bound is 1.
      if (here->bound < 0.5) {
        found.closed_form =
            std::max(found.closed_form, std::abs(here->value - exact) - here->bound);
      }
      for (const IrradianceMesh* other : {&linear, &quadratic}) {
        const auto value = other->at(p);
        ASSERT_TRUE(value);
        const double error = std::abs(value->value - exact);
        constexpr double kRounding = 1e-12;
        if (error > value->bound + kRounding) ++found.beyond_bound;
        if (error < kRounding) continue;
        ++found.polynomials;
        found.least_ratio = std::min(found.least_ratio, value->bound / error);
      }
    }
  }

  Point point_of(const ShadowMesh& mesh, std::uniform_real_distribution<double>& share) {
    Eigen::Vector2d low = mesh.vertices.at(0), high = low;
    for (const Eigen::Vector2d& v : mesh.vertices) {
      low = low.cwiseMin(v);
      high = high.cwiseMax(v);
    }
    return mesh.frame.origin +
           (low.x() + share(random_) * (high.x() - low.x())) * mesh.frame.x_axis +
           (low.y() + share(random_) * (high.y() - low.y())) * mesh.frame.y_axis;
  }

  const Scene* scene_;
  const LightSource* source_;
  BackprojectionIndex light_;
  std::mt19937_64 random_{11};
};

TEST(IrradianceScenes, ClosedFormsAreExactAndBoundsHold) {
  const bool every = std::getenv("SIGHTLINE_SCENE") != nullptr;
  Found all;
  int number = 0;
  for (const ShadowScene& lit : shadow_scenes()) {
    if (number++ % 4 != 2 && !every) continue;
    SCOPED_TRACE(lit.name);
    const Scene scene(lit.soup);
    const LightSource source = light_source(scene, lit.lights, lit.two_sided);
    Comparison comparison(scene, source);
    Found found;
    for (const Object& object : scene.objects())
      comparison.receiver({object.name, object.faces, true}, 8, found);
    EXPECT_LE(found.closed_form, 1e-12);
    EXPECT_EQ(found.beyond_bound, 0);
    all.points += found.points;
    all.polynomials += found.polynomials;
    all.least_ratio = std::min(all.least_ratio, found.least_ratio);
  }
  EXPECT_GT(all.points, 1000);
  EXPECT_GT(all.polynomials, 300);
  RecordProperty("points", all.points);
  RecordProperty("least_ratio", std::to_string(all.least_ratio));
}

TEST(IrradianceScenes, CityWithCurvedEdges) {
  const Scene scene(lit_city(96, false));
  const LightSource source = light_source(scene, std::vector<std::string>{"light"});
  Comparison comparison(scene, source);
  Found found;
  comparison.receiver({"ground", scene.faces_named("ground"), true}, 3000, found);
  EXPECT_LE(found.closed_form, 1e-12);
  EXPECT_EQ(found.beyond_bound, 0);
  EXPECT_GT(found.polynomials, 500);
}

}  // namespace
}  // namespace sightline::testing
