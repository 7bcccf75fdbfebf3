// What proves the bound of interpolated irradiance: majorants, bounds of derivatives, the
// constants of interpolation.

#include "shadows/irradiance/element_tree.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "shadows/backprojection.h"
#include "tests/support/generators.h"

namespace sightline::internal {
namespace {

TEST(Majorant, QuotientOfALinearFunctionIsItsSeries) {
  // 1 / (2 - x / 2) on |x| <= 1: nowhere larger than at x = 1, with D^j / j! = 1/2^j
  // over (3/2)^(j + 1).
  const Majorant quotient = reciprocal({{2.5, 0.5}}, 1.5);
  for (int j = 0; j < Majorant::kTerms; ++j)
    EXPECT_NEAR(quotient.a[j], std::pow(0.5, j) / std::pow(1.5, j + 1), 1e-15) << j;
}

TEST(Majorant, ProductIsLeibnizRule) {
  // e^x e^x = e^2x: the terms of e^2 times 2^j / j!.
  const double e = std::numbers::e;
  const Majorant exponential{{e, e, e / 2, e / 6}};
  const Majorant square = exponential * exponential;
  for (int j = 0; j < Majorant::kTerms; ++j)
    EXPECT_NEAR(square.a[j], e * e * std::pow(2, j) / std::tgamma(j + 1), 1e-12) << j;
}

TEST(ElementTree, QuadraticConstant) {
  // The largest sum of |l_i| |x - x_i|^3 in a triangle on the unit circle; between the
  // points asked it grows by less than 1e-4.
  const auto corner = [](int i) -> Eigen::Vector2d {
    const double angle = 2 * std::numbers::pi * i / 3;
    return {std::cos(angle), std::sin(angle)};
  };
  constexpr int kSteps = 300;
  double most = 0;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j) {
      const Eigen::Vector3d b(i / double{kSteps}, j / double{kSteps},
                              (kSteps - i - j) / double{kSteps});
      const Eigen::Vector2d x = b[0] * corner(0) + b[1] * corner(1) + b[2] * corner(2);
      double sum = 0;
      for (int k = 0; k < 3; ++k) {
        const int n = (k + 1) % 3;
        sum += std::abs(b[k] * (2 * b[k] - 1)) * std::pow((x - corner(k)).norm(), 3);
        sum += 4 * b[k] * b[n] * std::pow((x - 0.5 * (corner(k) + corner(n))).norm(), 3);
      }
      most = std::max(most, sum);
    }
  }
  EXPECT_LT(most + 1e-4, kQuadraticError);
  EXPECT_GT(most, 0.99 * kQuadraticError);
}

TEST(ElementTree, PlacesFollowThePieces) {
  ElementTree tree;
  tree.pieces = {{PieceKind::Halved, 1, 1},
                 {PieceKind::ClosedForm},
                 {PieceKind::Halved, 0, 3},
                 {PieceKind::ClosedForm},
                 {PieceKind::ClosedForm}};
  // Nearer to corner 1 than to corner 2: the middle of 12 takes the place of corner 2.
  Barycentric place{0.2, 0.5, 0.3};
  EXPECT_EQ(&tree.find(place), &tree.pieces[1]);
  EXPECT_NEAR(place[0], 0.2, 1e-15);
  EXPECT_NEAR(place[1], 0.2, 1e-15);
  EXPECT_NEAR(place[2], 0.6, 1e-15);
  // Nearer to corner 2; and then, of side 01, nearer to what is corner 1 now, the middle.
  place = {0.1, 0.2, 0.7};
  EXPECT_EQ(&tree.find(place), &tree.pieces[4]);
  EXPECT_NEAR(place[0], 0.2, 1e-15);
  EXPECT_NEAR(place[1], 0.3, 1e-15);
  EXPECT_NEAR(place[2], 0.5, 1e-15);
}

// Second and third differences along random ways in random ellipses of a city's ground
// are nowhere above the bound of the derivatives.
TEST(SeenFormula, BoundsItsDerivatives) {
  const Scene scene(testing::lit_city(96, false));
  const LightSource source = light_source(scene, std::vector<std::string>{"light"});
  const BackprojectionIndex light(scene, source);
  const auto ground = scene.faces_named("ground");
  const Shadows shadows = find_shadows(scene, source, {{"ground", ground, true}});
  const Eigen::Vector3d up(0, 0, 1);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  int known = 0;
  std::array<double, 4> nearest{};
  for (const ShadowMesh& mesh : shadows.receivers[0].meshes) {
    const Point some = mesh.frame.origin;
    if (std::abs(mesh.frame.x_axis.cross(mesh.frame.y_axis).normalized().z()) < 0.5 ||
        std::abs(some.z()) > 1e-12) {
      continue;
    }
    FormulaMaker maker(light.source_scene(), ground.front());
    for (const ShadowMesh::Face& face : mesh.faces) {
      const auto formula = maker.formula(shadows.structures[face.structure]);
      ASSERT_TRUE(formula);
      Eigen::Matrix<double, 3, 2> axes;
      axes << unit(random), unit(random), unit(random), unit(random), 0, 0;
      const Majorant bound = formula->bound(face.inside, axes, up);
      if (!(bound.a[3] < 1e3) || formula->loops.empty()) continue;
      ++known;
      for (int i = 0; i < 20; ++i) {
        const double angle = std::numbers::pi * unit(random), step = 0.03;
        const Eigen::Vector2d way(std::cos(angle), std::sin(angle));
        const Eigen::Vector2d at =
            0.9 * std::sqrt(std::abs(unit(random))) *
            Eigen::Vector2d(std::cos(3 * angle), std::sin(angle)).normalized();
        const auto value = [&](int k) {
          return formula->value(face.inside + axes * (at + k * step * way), up);
        };
        const double first = (value(1) - value(-1)) / (2 * step);
        const double second = (value(1) - 2 * value(0) + value(-1)) / (step * step) / 2;
        const double third =
            (value(2) - 3 * value(1) + 3 * value(0) - value(-1)) / std::pow(step, 3) / 6;
        const std::array<double, 4> found{value(0), first, second, third};
        for (int j = 0; j < 4; ++j) {
          EXPECT_LE(std::abs(found[j]), bound.a[j] * (1 + 1e-9) + 1e-9) << j;
          nearest[j] = std::max(nearest[j], std::abs(found[j]) / bound.a[j]);
        }
      }
    }
  }
  EXPECT_GT(known, 50);
  // They are bounds of that, not of anything.
  for (int j = 0; j < 4; ++j) EXPECT_GT(nearest[j], 0.01) << j;
}

}  // namespace
}  // namespace sightline::internal
