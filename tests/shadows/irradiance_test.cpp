#include "shadows/irradiance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/add_box.h"
#include "tests/support/add_polygons.h"

namespace sightline {
namespace {

using testing::add_box;
using testing::add_polygons;
using testing::lamp_and_ground;

// The ground of a scene, its mesh and its exact values.
struct Lit {
  explicit Lit(const PolygonSoup& soup)
      : scene(soup),
        source(light_source(scene, std::vector<std::string>{"lamp"})),
        ground{"ground", scene.faces_named("ground"), true},
        light(scene, source),
        shadows(find_shadows(scene, source, {ground})) {}

  [[nodiscard]] IrradianceMesh interpolated(const IrradianceOptions& options) const {
    return {scene, light, ground, shadows, shadows.receivers.at(0).meshes.at(0), options};
  }
  [[nodiscard]] double exact(const Point& p) const {
    return *light.from(shadow_point(p, {0, 0, 1})).form_factor;
  }
  // The largest error at random points.
  [[nodiscard]] double error(const IrradianceMesh& mesh, int points) const {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> place(-8, 8);
    double most = 0;
    for (int i = 0; i < points; ++i) {
      const Point p(place(random), place(random), 0);
      const auto found = mesh.at(p);
      EXPECT_TRUE(found) << p.transpose();
      if (found) most = std::max(most, std::abs(found->value - exact(p)));
    }
    return most;
  }

  Scene scene;
  LightSource source;
  Receiver ground;
  BackprojectionIndex light;
  Shadows shadows;
};

PolygonSoup with_plate() {
  PolygonSoup soup = lamp_and_ground();
  add_polygons(soup, "plate",
               {{{-1.5, -1.5, 2}, {1.5, -1.5, 2}, {1.5, 1.5, 2}, {-1.5, 1.5, 2}}});
  return soup;
}

TEST(IrradianceMesh, TrianglesGrowWithTheAccuracy) {
  // Triangles half as large: errors fall to 2^-(order + 1), there are four times as many.
  const Lit lit(lamp_and_ground());
  for (const int order : {1, 2}) {
    double last = 0;
    for (const double accuracy : {1e-3, 1e-4}) {
      const auto count = static_cast<double>(
          lit.interpolated({.order = order, .accuracy = accuracy, .smallest = 0})
              .statistics()
              .triangles);
      if (last > 0) {
        EXPECT_NEAR(std::log2(count / last), std::log2(1e2) / (order + 1), 0.8) << order;
      }
      last = count;
    }
  }
}

TEST(IrradianceMesh, IsAsExactAsAsked) {
  const Lit lit(with_plate());
  for (const int order : {1, 2}) {
    for (const double accuracy : {1e-3, 1e-5}) {
      const IrradianceMesh mesh =
          lit.interpolated({.order = order, .accuracy = accuracy});
      EXPECT_LE(mesh.statistics().largest_bound, accuracy);
      EXPECT_LE(lit.error(mesh, 1000), accuracy);
      // And no more exact than that: polynomials answer, not the closed form alone.
      EXPECT_GT(lit.error(mesh, 1000), 1e-3 * accuracy);
      EXPECT_LT(mesh.statistics().closed_form_share, order == 1 ? 0.6 : 0.4);
    }
  }
}

TEST(IrradianceMesh, OrderZeroIsTheClosedForm) {
  const Lit lit(with_plate());
  const IrradianceMesh mesh = lit.interpolated({.order = 0});
  EXPECT_LE(lit.error(mesh, 1000), 1e-14);
  EXPECT_LE(mesh.statistics().largest_bound, 0);
}

TEST(IrradianceMesh, ThreadsChangeNothing) {
  const Lit lit(with_plate());
  Request one, two;
  one.threads = 1;
  two.threads = 2;
  const IrradianceOptions options{.accuracy = 1e-6};
  const ShadowMesh& ground = lit.shadows.receivers.at(0).meshes.at(0);
  const IrradianceMesh x(lit.scene, lit.light, lit.ground, lit.shadows, ground, options,
                         one);
  const IrradianceMesh y(lit.scene, lit.light, lit.ground, lit.shadows, ground, options,
                         two);
  for (double u = -7.9; u < 8; u += 0.37) {
    const Point p(u, 0.7 * u + 0.3, 0);
    EXPECT_EQ(x.at(p)->value, y.at(p)->value);
  }
}

TEST(IrradianceMesh, UmbraIsZero) {
  const Lit lit(with_plate());
  const IrradianceMesh mesh = lit.interpolated({.accuracy = 1});
  EXPECT_EQ(mesh.at({1.9, 1.9, 0})->value, 0);
  EXPECT_EQ(mesh.at({-1.9, 0.3, 0})->bound, 0);
  EXPECT_GT(mesh.at({2.5, 0, 0})->value, 0);
}

TEST(IrradianceMesh, NothingBesideTheReceiver) {
  const Lit lit(lamp_and_ground());
  const IrradianceMesh mesh = lit.interpolated({.accuracy = 1});
  EXPECT_FALSE(mesh.at({9, 0, 0}));
  EXPECT_TRUE(mesh.at({7.9, -7.9, 0}));
}

TEST(IrradianceMesh, KeepsTheJumpAtAFoot) {
  // A box that stands on the ground: under it is darkness, at its side is not.
  PolygonSoup soup = lamp_and_ground();
  add_box(soup, "box", {3, -1, 0}, {4, 1, 2});
  const Lit lit(soup);
  const IrradianceMesh mesh = lit.interpolated({.accuracy = 1e-4});
  const Point beside(3 - 1e-7, 0.1, 0), under(3 + 1e-7, 0.1, 0);
  EXPECT_NEAR(mesh.at(beside)->value, lit.exact(beside), 1e-4);
  EXPECT_GT(mesh.at(beside)->value, 0.01);
  EXPECT_EQ(mesh.at(under)->value, 0);
  EXPECT_LE(lit.error(mesh, 1000), 1e-4);
}

TEST(IrradianceMesh, KeepsBothSidesOfAnUprightSheet) {
  // On its foot all of the lamp is seen, beside it only what is on the same side.
  PolygonSoup soup = lamp_and_ground();
  add_polygons(soup, "sheet", {{{0.5, -1, 0}, {0.5, 1, 0}, {0.5, 1, 2}, {0.5, -1, 2}}});
  const Lit lit(soup);
  const IrradianceMesh mesh = lit.interpolated({.accuracy = 1e-3});
  for (const double x : {0.5 - 1e-7, 0.5 + 1e-7}) {
    const Point beside(x, 0.1, 0);
    EXPECT_NEAR(mesh.at(beside)->value, lit.exact(beside), 1e-3) << x;
  }
}

TEST(IrradianceMesh, RefusesOtherOrders) {
  const Lit lit(lamp_and_ground());
  EXPECT_THROW(lit.interpolated({.order = 3}), InvalidInput);
}

}  // namespace
}  // namespace sightline
