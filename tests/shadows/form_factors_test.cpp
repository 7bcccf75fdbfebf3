// Form factors of scenes: rows, what leaves them, and people's cases.

#include "shadows/form_factors.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "linespace/face_visibility.h"
#include "shadows/backprojection.h"
#include "shadows/polygon_form_factor.h"

namespace sightline {
namespace {

/// Adds polygons to a soup, each in a group.
class SceneMaker {
 public:
  SceneMaker& polygon(const std::string& group, const std::vector<Point>& corners) {
    std::vector<int> face;
    for (const Point& p : corners) {
      face.push_back(static_cast<int>(soup_.vertices.size()));
      soup_.vertices.push_back(p);
    }
    auto at = std::ranges::find(soup_.groups, group, &PolygonSoup::Group::name);
    if (at == soup_.groups.end()) {
      soup_.groups.push_back({group, {}});
      at = soup_.groups.end() - 1;
    }
    at->faces.push_back(static_cast<int>(soup_.polygons.size()));
    soup_.polygons.push_back(face);
    return *this;
  }
  /// Across the axis, at this position, n x n squares; its front towards larger
  /// coordinates if `up`.
  SceneMaker& sheet(const std::string& group, int axis, double at, bool up,
                    const std::array<double, 2>& u, const std::array<double, 2>& v,
                    int n = 1) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const auto corner = [&](int a, int b) {
          Point p;
          p[axis] = at;
          p[(axis + 1) % 3] = u[0] + (u[1] - u[0]) * a / n;
          p[(axis + 2) % 3] = v[0] + (v[1] - v[0]) * b / n;
          return p;
        };
        std::vector<Point> c{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1),
                             corner(i, j + 1)};
        if (!up) std::ranges::reverse(c);
        polygon(group, c);
      }
    }
    return *this;
  }
  /// Fronts outwards, or inwards for a room.
  SceneMaker& box(const std::string& group, const Point& low, const Point& high,
                  bool room = false, int n = 1) {
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      sheet(group, axis, low[axis], room, {low[u], high[u]}, {low[v], high[v]}, n);
      sheet(group, axis, high[axis], !room, {low[u], high[u]}, {low[v], high[v]}, n);
    }
    return *this;
  }
  [[nodiscard]] Scene scene() const { return Scene(soup_); }

 private:
  PolygonSoup soup_;
};

FormFactors factors(const Scene& scene, const SurfaceWish& wish = {},
                    double accuracy = 1e-10) {
  FormFactorRequest request;
  request.accuracy = accuracy;
  request.threads = 1;
  return form_factors(scene, surfaces_of(scene, wish), request);
}

double total(const FormFactors& f, int row) {
  const FormFactorRow& r = f.rows[row];
  return f.row_sum(row) + r.others + r.outside + r.backs;
}

/// Rows add up to 1, A F is symmetric, nothing is negative.
void expect_consistent(const FormFactors& f, double within) {
  EXPECT_TRUE(f.complete);
  for (std::size_t i = 0; i < f.rows.size(); ++i) {
    const int row = static_cast<int>(i);
    EXPECT_NEAR(total(f, row), 1, within) << f.names[i];
    EXPECT_GE(f.rows[i].others, 0) << f.names[i];
    EXPECT_GE(f.rows[i].outside, 0) << f.names[i];
    EXPECT_GE(f.rows[i].backs, 0) << f.names[i];
    for (std::size_t k = 0; k < f.rows[i].to.size(); ++k) {
      const int j = f.rows[i].to[k];
      EXPECT_GT(f.rows[i].factor[k], 0);
      const double sent = f.rows[i].factor[k] * f.areas[i];
      EXPECT_NEAR(sent, f.at(j, row) * f.areas[j], 1e-15 * sent);
    }
  }
}

PointFactors from_point(const Scene& scene, const Point& at, const Eigen::Vector3d& n,
                        const SurfaceWish& wish = {},
                        const std::optional<Eigen::Vector3d>& up = std::nullopt) {
  const PointFactorIndex index(scene, surfaces_of(scene, wish));
  return index.at(eye_at(at), n, up);
}

TEST(FormFactors, CubeOfSixWalls) {
  const Scene scene = SceneMaker().box("cube", {0, 0, 0}, {1, 1, 1}, true).scene();
  const FormFactors f = factors(scene, {.each_face = true});
  expect_consistent(f, 1e-9);
  EXPECT_NEAR(f.at(0, 1), 0.199824895698387, 1e-10);
  EXPECT_NEAR(f.at(0, 2), 0.200043776075403, 1e-10);
  EXPECT_EQ(f.at(0, 0), 0);
  const FormFactors whole = factors(scene);
  EXPECT_NEAR(whole.at(0, 0), 1, 1e-9) << "faces of one group see each other";
}

// REFERENCES: a unit box without a lid.
TEST(FormFactors, WhatLeavesABoxWithoutALid) {
  SceneMaker maker;
  maker.sheet("floor", 2, 0, true, {0, 1}, {0, 1});
  for (const int axis : {0, 1}) {
    maker.sheet("walls", axis, 0, true, {0, 1}, {0, 1});
    maker.sheet("walls", axis, 1, false, {0, 1}, {0, 1});
  }
  const FormFactors f = factors(maker.scene());
  expect_consistent(f, 1e-9);
  EXPECT_NEAR(f.row_sum(0), 0.800175104301613, 1e-10);
  EXPECT_NEAR(f.rows[0].outside, 0.199824895698387, 1e-10);
  const FormFactors floor = factors(maker.scene(), {.groups = {"floor"}});
  EXPECT_NEAR(floor.rows[0].others, 0.800175104301613, 1e-10);
}

TEST(FormFactors, EnclosureWithBoxes) {
  SceneMaker maker;
  maker.box("room", {0, 0, 0}, {1, 1, 1}, true, 3);
  maker.box("on floor", {0.25, 0.25, 0}, {0.5, 0.625, 0.5});
  maker.box("in corner", {0.75, 0, 0}, {1, 0.25, 0.75});
  maker.box("in air", {0.5, 0.6875, 0.5}, {0.6875, 0.9375, 0.8125});
  maker.box("through the wall", {-0.25, 0.75, 0.25}, {0.25, 0.875, 0.375});
  const FormFactors f = factors(maker.scene(), {.each_face = true}, 1e-8);
  expect_consistent(f, 1e-8);
  EXPECT_LE(f.error_bound, 1e-8);
  EXPECT_EQ(f.coincident_area, 0);
  double buried = 0;
  for (std::size_t i = 0; i < 54; ++i) buried += f.areas[i] * f.rows[i].backs;
  const double feet = 0.25 * 0.375 + 0.25 * 0.25 + 0.25 * 0.75 * 2 + 0.125 * 0.125;
  EXPECT_NEAR(buried, feet, 1e-9) << "under what stands on the walls";
}

// Hidden is 0 exactly, and visible through a slit is not: the same as what decides it.
TEST(FormFactors, ZeroIffHidden) {
  for (int seed = 0; seed < 6; ++seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> eighth(0, 6);
    SceneMaker maker;
    for (int b = 0; b < 6; ++b) {
      const Point low{eighth(random) / 8., eighth(random) / 8., eighth(random) / 8.};
      maker.box("box" + std::to_string(b), low, low + Point{0.25, 0.25, 0.25});
    }
    const Scene scene = maker.scene();
    const FormFactors f = factors(scene, {.each_face = true}, 1e-6);
    const FaceVisibility visibility(scene);
    for (int i = 0; i < static_cast<int>(f.rows.size()); ++i) {
      for (int j = i + 1; j < static_cast<int>(f.rows.size()); ++j) {
        if (f.at(i, j) > 0) {
          EXPECT_EQ(visibility.between(i, j).answer.verdict, Verdict::Visible);
        }
      }
    }
  }
  const double slit = std::ldexp(1, -40);
  SceneMaker maker;
  maker.sheet("floor", 2, 0, true, {0, 1}, {0, 1});
  maker.sheet("ceiling", 2, 1, false, {0, 1}, {0, 1});
  maker.sheet("left", 2, 0.5, true, {-4, 0.5}, {-4, 4});
  maker.sheet("right", 2, 0.5, true, {0.5 + slit, 4}, {-4, 4});
  EXPECT_GT(factors(maker.scene()).at(0, 1), 0);
  maker.sheet("cover", 2, 0.25, true, {-4, 4}, {-4, 4});
  EXPECT_EQ(factors(maker.scene()).at(0, 1), 0);
}

TEST(FormFactors, CoincidentFrontsAreBothSeen) {
  SceneMaker maker;
  maker.sheet("floor", 2, 0, true, {0, 1}, {0, 1});
  maker.sheet("ceiling", 2, 1, false, {0, 1}, {0, 1});
  maker.sheet("picture", 2, 1, false, {0, 0.5}, {0, 0.5});
  const FormFactors f = factors(maker.scene());
  EXPECT_NEAR(f.coincident_area, 0.25, 1e-15);
  EXPECT_NEAR(f.at(0, 1), 0.199824895698387, 1e-10);
  EXPECT_NEAR(total(f, 0), 1 + f.at(0, 2), 1e-9);
}

TEST(FormFactors, AFrontCountsWhereABackLiesOnIt) {
  SceneMaker maker;
  maker.sheet("floor", 2, 0, true, {0, 1}, {0, 1});
  maker.sheet("ceiling", 2, 1, false, {0, 1}, {0, 1});
  maker.sheet("paper", 2, 1, true, {0, 0.5}, {0, 1});
  const FormFactors f = factors(maker.scene());
  EXPECT_EQ(f.rows[0].backs, 0);
  EXPECT_NEAR(total(f, 0), 1, 1e-9);
  const PointFactors p = from_point(maker.scene(), {0.25, 0.5, 0}, {0, 0, 1});
  EXPECT_NEAR(p.backs, 0, 1e-14);
  EXPECT_NEAR(p.factors[1] + p.outside, 1, 1e-12);
}

TEST(FormFactors, BothSidesAreSurfacesOfTheirOwn) {
  SceneMaker maker;
  maker.sheet("floor", 2, 0, true, {0, 1}, {0, 1});
  maker.sheet("shelf", 2, 0.5, true, {0, 1}, {0, 1});
  maker.sheet("ceiling", 2, 1, false, {0, 1}, {0, 1});
  const FormFactors one = factors(maker.scene());
  EXPECT_NEAR(one.rows[0].backs, 0.415253283577147, 1e-10);
  EXPECT_EQ(one.at(0, 1), 0);
  const FormFactors both = factors(maker.scene(), {.both_sides = {"shelf"}});
  ASSERT_EQ(both.names,
            (std::vector<std::string>{"floor", "shelf", "shelf/back", "ceiling"}));
  EXPECT_NEAR(both.at(0, 2), 0.415253283577147, 1e-10);
  EXPECT_NEAR(both.at(3, 1), 0.415253283577147, 1e-10);
  EXPECT_EQ(both.at(0, 1), 0);
  EXPECT_EQ(both.rows[0].backs, 0);
  expect_consistent(both, 1e-9);
}

TEST(FormFactors, EnforcedRowsAddUpAndStaySymmetric) {
  SceneMaker maker;
  maker.box("room", {0, 0, 0}, {1, 1, 1}, true, 2)
      .box("box", {0.25, 0.25, 0.25}, {0.5, 0.75, 0.5});
  const FormFactors f = factors(maker.scene(), {.each_face = true}, 1e-4);
  const EnforcedFactors e = enforced(f);
  EXPECT_LT(e.left_over, 1e-14);
  EXPECT_LE(e.moved, 1e-3);
  for (std::size_t i = 0; i < f.rows.size(); ++i) {
    for (const int j : e.factors.rows[i].to) {
      EXPECT_NEAR(e.factors.areas[i] * e.factors.at(static_cast<int>(i), j),
                  e.factors.areas[j] * e.factors.at(j, static_cast<int>(i)), 1e-16);
    }
  }
}

TEST(FormFactors, ABudgetLeavesWholeRows) {
  const Scene scene = SceneMaker().box("room", {0, 0, 0}, {1, 1, 1}, true, 6).scene();
  FormFactorRequest request;
  request.threads = 1;
  // Set-up, which throws, takes a hundredth of the whole: some budget ends in between,
  // however fast the machine is.
  FormFactors f;
  for (request.budget_seconds = 0.01; f.names.empty(); request.budget_seconds *= 1.5) {
    try {
      f = form_factors(scene, surfaces_of(scene, {.each_face = true}), request);
    } catch (const Stopped&) {
      continue;
    }
  }
  EXPECT_LT(f.rows.size(), f.names.size());
  EXPECT_FALSE(f.complete);
}

// A second way to each row: the mean of what its points see, found by exact views.
TEST(FormFactors, RowsAreTheMeansOfPoints) {
  SceneMaker maker;
  maker.box("room", {0, 0, 0}, {1, 1, 1}, true)
      .box("box", {0.25, 0.25, 0}, {0.5, 0.75, 0.5});
  const Scene scene = maker.scene();
  const FormFactors f = factors(scene, {.each_face = true}, 1e-8);
  const PointFactorIndex index(scene, surfaces_of(scene, {.each_face = true}));
  const int ceiling = 5, n = 24;
  std::vector<double> mean(f.names.size(), 0);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const PointFactors p =
          index.at(eye_at({(i + 0.5) / n, (j + 0.5) / n, 1}), {0, 0, -1});
      double sum = p.others + p.outside + p.backs;
      for (std::size_t k = 0; k < mean.size(); ++k) {
        mean[k] += p.factors[k] / (n * n);
        sum += p.factors[k];
      }
      EXPECT_NEAR(sum, 1, 1e-12);
    }
  }
  for (std::size_t k = 0; k < mean.size(); ++k) {
    EXPECT_NEAR(mean[k], f.at(ceiling, static_cast<int>(k)), 2e-4) << f.names[k];
  }
}

// The sky of a tilted and of an upright surface without a horizon: (1 + cos) / 2; and
// beside a wall, what points see of it on the mean.
TEST(FormFactors, SkyOfTiltedSurfaces) {
  SceneMaker maker;
  maker.polygon("tilted", {{0, 0, 0}, {1, 0, 0}, {1, 0.8, 0.6}, {0, 0.8, 0.6}});
  maker.sheet("upright", 0, 4, false, {0, 1}, {0, 1});
  FormFactorRequest request;
  request.up = Eigen::Vector3d{0, 0, 2};
  request.threads = 1;
  request.accuracy = 1e-8;
  const Scene alone = SceneMaker(maker).scene();
  const FormFactors far = form_factors(alone, surfaces_of(alone, {}), request);
  EXPECT_NEAR(far.rows[0].sky, 0.5 * (1 + 0.8), 0.02);
  maker.sheet("wall", 1, -0.5, true, {0, 2}, {-1, 3});
  const Scene scene = maker.scene();
  const FormFactors f = form_factors(scene, surfaces_of(scene, {}), request);
  const PointFactorIndex index(scene, surfaces_of(scene, {}));
  const int n = 16;
  double mean = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double u = (i + 0.5) / n, v = (j + 0.5) / n;
      const Eigen::Vector3d normal{0, -0.6, 0.8};
      const Point at = Point{u, 0.8 * v, 0.6 * v} + 1e-12 * normal;
      mean += index.at(eye_at(at), normal, request.up).sky / (n * n);
    }
  }
  EXPECT_NEAR(f.rows[0].sky, mean, 1e-3);
  EXPECT_LT(f.rows[0].sky, f.rows[0].outside);
  EXPECT_GT(f.rows[0].sky, 0.1);
}

// ---- people's cases -------------------------------------------------------------------

// u-dales 359: an obstructed pair came out above 1.
TEST(FormFactorCases, ObstructedPairAboveOne) {
  SceneMaker maker;
  maker.sheet("wall", 0, 0, true, {0, 1}, {0, 8});
  maker.sheet("close", 0, 0.001, false, {0, 1}, {0, 8});
  maker.sheet("between", 0, 0.0005, true, {0.25, 0.75}, {1, 2});
  const FormFactors f = factors(maker.scene());
  expect_consistent(f, 1e-9);
  EXPECT_LT(f.at(0, 1), 1);
  EXPECT_GT(f.at(0, 1), 0.9);
  EXPECT_LT(
      f.at(0, 1),
      polygon_form_factor(
          std::vector<Point>{{0, 0, 0}, {0, 1, 0}, {0, 1, 8}, {0, 0, 8}},
          std::vector<Point>{{0.001, 0, 8}, {0.001, 1, 8}, {0.001, 1, 0}, {0.001, 0, 0}})
          .factor);
}

// EnergyPlus 463: a floor drawn upside down receives nothing; all of it is told as backs.
TEST(FormFactorCases, UpsideDownFloor) {
  SceneMaker maker;
  maker.sheet("floor", 2, 0, false, {0, 1}, {0, 1});
  maker.sheet("ceiling", 2, 1, false, {0, 1}, {0, 1});
  const FormFactors f = factors(maker.scene());
  EXPECT_EQ(f.at(1, 0), 0);
  EXPECT_NEAR(f.rows[1].backs, 0.199824895698387, 1e-10);
  EXPECT_EQ(f.rows[0].outside, 1);
}

// EnergyPlus 1445: a roof beside a taller wall sees part of it.
TEST(FormFactorCases, RoofBesideATallerWall) {
  SceneMaker maker;
  maker.box("low", {0, 0, 0}, {1, 1, 1}).box("tall", {1, 0, 0}, {2, 1, 2});
  const FormFactors f = factors(maker.scene(), {.each_face = true});
  expect_consistent(f, 1e-9);
  const int roof = 5, wall = 6;
  EXPECT_NEAR(f.at(roof, wall), 0.200043776075403, 1e-10);
  EXPECT_NEAR(f.rows[roof].outside, 1 - 0.200043776075403, 1e-10);
}

// View3D 4: from a point to surfaces.  REFERENCES: a 2 x 2 square over its centre.
TEST(FormFactorCases, PointToSurfaces) {
  SceneMaker maker;
  maker.sheet("near", 2, 1, false, {-1, 1}, {-1, 1});
  const PointFactors p = from_point(maker.scene(), {0, 0, 0}, {0, 0, 7});
  EXPECT_NEAR(p.factors[0], 0.554126423979572, 1e-12);
  EXPECT_NEAR(p.outside, 1 - 0.554126423979572, 1e-12);
  SceneMaker higher;
  higher.sheet("far", 2, 2, false, {-1, 1}, {-1, 1});
  EXPECT_NEAR(from_point(higher.scene(), {0, 0, 0}, {0, 0, 1}).factors[0], 0.239456470461,
              1e-12);
}

// pvlib 1665: one row of panels before another, both sides.  REFERENCES: tilt 30 degrees,
// pitch 2, slant 1, infinitely long: from the bottom edge to the row in front.
TEST(FormFactorCases, RowsOfPanels) {
  const double tilt = M_PI / 6, l = 1e5;
  SceneMaker maker;
  const double y = std::cos(tilt), z = std::sin(tilt);
  for (const double at : {0.0, -2.0}) {
    maker.polygon(at == 0 ? "row" : "front",
                  {{-l, at, 0}, {l, at, 0}, {l, at + y, z}, {-l, at + y, z}});
  }
  const SurfaceWish wish{.both_sides = {"row", "front"}};
  const PointFactors p = from_point(maker.scene(), {0, -1e-11 * z, 1e-11 * y}, {0, -z, y},
                                    wish, Eigen::Vector3d{0, 0, 1});
  EXPECT_NEAR(p.factors[3], 0.137667454607783, 1e-9);
  EXPECT_NEAR(p.sky, 0.795345247284436, 1e-9);
  const FormFactors f = factors(maker.scene(), wish, 1e-6);
  EXPECT_GT(f.at(0, 3), 0);
  EXPECT_EQ(f.at(0, 1), 0);
}

// mitsuba3 1505: both sides of a light.
TEST(FormFactorCases, BothSidesOfALight) {
  SceneMaker maker;
  maker.sheet("floor", 2, 0, true, {0, 1}, {0, 1});
  maker.sheet("light", 2, 0.5, false, {0.25, 0.75}, {0.25, 0.75});
  maker.sheet("ceiling", 2, 1, false, {0, 1}, {0, 1});
  const FormFactors f = factors(maker.scene(), {.both_sides = {"light"}});
  EXPECT_NEAR(f.at(1, 0), f.at(2, 3), 1e-12);
  EXPECT_EQ(f.at(1, 3), 0);
  EXPECT_NEAR(f.at(0, 3), 0.099506294598985, 1e-10) << "REFERENCES: past the light";
  expect_consistent(f, 1e-9);
}

// EnergyPlus 1868: a plenum 1/100 as high as wide.
TEST(FormFactorCases, FlatPlenum) {
  const FormFactors f = factors(
      SceneMaker().box("p", {0, 0, 0}, {100, 100, 1}, true).scene(), {.each_face = true});
  expect_consistent(f, 1e-8);
  EXPECT_NEAR(f.at(4, 5), 0.980416602925973, 1e-10);
  EXPECT_NEAR(f.at(4, 0), 0.00489584926850667, 1e-10);
}

// hive 602: a sensor inside a building sees nothing of the sky.
TEST(FormFactorCases, SensorInsideABuilding) {
  const Scene scene = SceneMaker().box("building", {0, 0, 0}, {10, 10, 10}).scene();
  const PointFactors p =
      from_point(scene, {5, 5, 5}, {0, 0, 1}, {}, Eigen::Vector3d{0, 0, 1});
  EXPECT_EQ(p.backs, 1);
  EXPECT_EQ(p.outside, 0);
  EXPECT_EQ(p.sky, 0);
}

// honeybee-radiance 726: millimetres for metres change nothing.
TEST(FormFactorCases, MillimetresForMetres) {
  const auto scene = [](double unit) {
    return SceneMaker()
        .box("room", {0, 0, 0}, Point{4, 3, 2.5} * unit, true)
        .box("table", Point{1, 1, 0} * unit, Point{2, 2, 0.75} * unit)
        .scene();
  };
  const FormFactors metres = factors(scene(1), {.each_face = true});
  const FormFactors millimetres = factors(scene(1000), {.each_face = true});
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 12; ++j) {
      EXPECT_NEAR(metres.at(i, j), millimetres.at(i, j), 2e-10);
    }
  }
}

// frads 58: the sky beside surfaces, from points on a tilted roof written in doubles.
TEST(FormFactorCases, SkyBesideSurfaces) {
  SceneMaker maker;
  maker.polygon("roof", {{0, 0, 1}, {1, 0, 1}, {1, 0.7, 1.3}, {0, 0.7, 1.3}});
  maker.sheet("chimney", 0, 0.5, false, {0.2, 0.4}, {1.3, 2});
  const Eigen::Vector3d normal{0, -0.3, 0.7};
  const Scene scene = maker.scene();
  for (const double s : {0.1, 0.3, 0.6, 0.9}) {
    const Point on{0.25, 0.7 * s, 1 + 0.3 * s};
    const PointFactors p =
        from_point(scene, on + 1e-9 * normal, normal, {}, Eigen::Vector3d{0, 0, 1});
    EXPECT_NEAR(p.factors[0] + p.factors[1] + p.others + p.outside + p.backs, 1, 1e-12);
    EXPECT_LE(p.sky, p.outside + 1e-12);
    EXPECT_NEAR(p.sky + p.factors[1], 0.5 * (1 + normal.normalized().z()), 0.05);
  }
}

// Sensors on a tilted roof, their coordinates computed in doubles: those that rounding
// has put behind the roof see its back, and nothing of the sky.  Put exactly on it, as
// "on" does, all see the same.
TEST(FormFactorCases, SensorsOnATiltedRoof) {
  SceneMaker maker;
  const double length = 7.3, depth = 4.1, rise = 2.7;
  maker.polygon("roof", {{0, 0, 3.1},
                         {length, 0, 3.1},
                         {length, depth, 3.1 + rise},
                         {0, depth, 3.1 + rise}});
  maker.sheet("ground", 2, 0, true, {-20, 20}, {-20, 20});
  const Scene scene = maker.scene();
  const PointFactorIndex index(scene, surfaces_of(scene, {}));
  const Eigen::Vector3d normal{0, -rise, depth}, up{0, 0, 1};
  const double open = 0.5 * (1 + normal.normalized().z());
  int behind = 0;
  for (int i = 1; i < 20; ++i) {
    const double t = i / 20.;
    const Point written(length * t, depth * t, 3.1 + rise * t);
    const PointFactors rounded = index.at(eye_at(written), normal, up);
    if (rounded.sky < 0.5 * open) ++behind;
    const ShadowPoint on = shadow_point_on(scene, 0, shadow_point(written).at);
    const PointFactors p = index.at({Viewpoint::Kind::Eye, on.at}, normal, up);
    EXPECT_NEAR(p.sky, open, 1e-12) << i;
    EXPECT_EQ(p.factors[0], 0) << i;
    EXPECT_NEAR(p.factors[1] + p.outside, 1, 1e-12) << i;
  }
  EXPECT_GT(behind, 2);
}

// Daylight through a window with its pane: the pane is a face like all others, and takes
// all that would leave.  Without it what leaves the room is the factor to the opening.
TEST(FormFactorCases, DaylightThroughAWindowWithItsPane) {
  SceneMaker maker;
  maker.sheet("floor", 2, 0, true, {0, 4}, {0, 3});
  maker.sheet("room", 2, 2.5, false, {0, 4}, {0, 3});
  for (const int axis : {0, 1}) {
    const double far = axis == 0 ? 4 : 3;
    const std::array<double, 2> y{0, 3}, x{0, 4}, z{0, 2.5};
    if (axis == 0) maker.sheet("room", 0, far, false, y, z);
    if (axis == 1) maker.sheet("room", 1, 0, true, z, x);
    if (axis == 1) maker.sheet("room", 1, far, false, z, x);
  }
  // The wall x = 0 around the opening from y 1 to 2, z 1 to 2.
  maker.sheet("room", 0, 0, true, {0, 3}, {0, 1})
      .sheet("room", 0, 0, true, {0, 3}, {2, 2.5});
  maker.sheet("room", 0, 0, true, {0, 1}, {1, 2})
      .sheet("room", 0, 0, true, {2, 3}, {1, 2});
  const std::vector<Point> floor{{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}};
  const std::vector<Point> opening{{0, 1, 1}, {0, 2, 1}, {0, 2, 2}, {0, 1, 2}};
  const double daylight = polygon_form_factor(floor, opening).factor;
  const FormFactors open = factors(SceneMaker(maker).scene());
  EXPECT_NEAR(open.rows[0].outside, daylight, 1e-10);
  maker.sheet("pane", 0, 0, true, {1, 2}, {1, 2});
  const FormFactors closed = factors(maker.scene());
  EXPECT_EQ(closed.names[2], "pane");
  EXPECT_NEAR(closed.at(0, 2), daylight, 1e-10);
  EXPECT_EQ(closed.rows[0].outside, 0);
  expect_consistent(closed, 1e-9);
}

}  // namespace
}  // namespace sightline
