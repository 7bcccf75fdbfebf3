// The cases of docs/shadows.md, each under its name there: scenes of a few faces from
// tests/data/shadows, with numbers found by hand.
//
// Unless a scene says otherwise the lamp is a square of half-side 1 at height 4 that
// shines down, and the ground a square of half-side 8 at height 0.  From a point (p, 0)
// of the ground a line over the height 2 at b meets the lamp's plane at 2 b - p, over the
// height 1 at 4 b - 3 p.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "linespace/mesh_io.h"
#include "shadows/backprojection.h"
#include "shadows/shadow_mesh.h"

namespace sightline {
namespace {

constexpr double kTiny = 1e-14;

// ---- form factors in closed form ------------------------------------------------------

// Of an element at the origin with the normal z to the rectangle [0, a] x [0, b] at
// height c; odd in a and in b.
double corner_factor(double a, double b, double c) {
  const double x = a / c, y = b / c;
  const double u = std::sqrt(1 + x * x), v = std::sqrt(1 + y * y);
  return (x / u * std::atan(y / u) + y / v * std::atan(x / v)) / (2 * std::numbers::pi);
}

// The same to [x0, x1] x [y0, y1].
double rectangle_factor(double x0, double x1, double y0, double y1, double c) {
  return corner_factor(x1, y1, c) - corner_factor(x0, y1, c) - corner_factor(x1, y0, c) +
         corner_factor(x0, y0, c);
}

// Of an element at the origin with the normal x to the rectangle [0, a] x [0, b] at
// height c.
double upright_factor(double a, double b, double c) {
  const double r = std::hypot(a, c);
  return (std::atan(b / c) - c / r * std::atan(b / r)) / (2 * std::numbers::pi);
}

// ---- a scene under its light ----------------------------------------------------------

struct Kinds {
  int ev = 0, ee = 0, eee = 0, face = 0, contact = 0, plane = 0, boundary = 0;
  bool operator==(const Kinds&) const = default;
  friend void PrintTo(const Kinds& k, std::ostream* out) {
    *out << "EV " << k.ev << ", EE " << k.ee << ", EEE " << k.eee << ", face " << k.face
         << ", contact " << k.contact << ", plane " << k.plane << ", boundary "
         << k.boundary;
  }
};

Kinds kinds(const ShadowMesh& mesh) {
  Kinds counts;
  for (const ShadowMesh::Edge& e : mesh.edges) {
    switch (e.kind) {
      case ShadowEdgeKind::Boundary:
        ++counts.boundary;
        break;
      case ShadowEdgeKind::Contact:
        ++counts.contact;
        break;
      case ShadowEdgeKind::Plane:
        ++counts.plane;
        break;
      case ShadowEdgeKind::Face:
        ++counts.face;
        break;
      case ShadowEdgeKind::EE:
        ++counts.ee;
        break;
      case ShadowEdgeKind::EV:
        ++counts.ev;
        break;
      case ShadowEdgeKind::EEE:
        ++counts.eee;
        break;
    }
  }
  return counts;
}

Point in_space(const ShadowMesh& mesh, const Eigen::Vector2d& p) {
  return mesh.frame.origin + p[0] * mesh.frame.x_axis + p[1] * mesh.frame.y_axis;
}

double length(const ShadowMesh::Edge& edge) {
  double sum = 0;
  for (std::size_t i = 1; i < edge.polyline.size(); ++i)
    sum += (edge.polyline[i] - edge.polyline[i - 1]).norm();
  return sum;
}

struct Case {
  explicit Case(const std::string& name, const std::vector<std::string>& light = {"lamp"},
                const std::vector<std::string>& both_sides = {})
      : scene(read_mesh(std::string(SIGHTLINE_TEST_DATA) + "/shadows/" + name + ".obj")),
        source(light_source(scene, light, both_sides)),
        index(scene, source) {}

  [[nodiscard]] Backprojection at(const Point& p) const {
    return index.from(shadow_point(p), {.boundaries = true});
  }
  [[nodiscard]] Backprojection at(const Point& p, const Eigen::Vector3d& normal) const {
    return index.from(shadow_point(p, normal), {.gradient = true, .boundaries = true});
  }
  [[nodiscard]] ReceiverShadows on(const std::string& name = "ground") const {
    return find_shadows(scene, source, {{name, scene.faces_named(name), true}})
        .receivers.at(0);
  }

  Scene scene;
  LightSource source;
  BackprojectionIndex index;
};

const Eigen::Vector3d kUp{0, 0, 1}, kDown{0, 0, -1};

void expect_umbra(const Backprojection& seen) {
  EXPECT_EQ(seen.shadow, ShadowClass::Umbra);
  EXPECT_EQ(seen.visible_fraction, 0);
  if (seen.form_factor) {
    EXPECT_EQ(*seen.form_factor, 0);
  }
  EXPECT_TRUE(seen.boundaries.empty());
}

void expect_lit(const Backprojection& seen) {
  EXPECT_EQ(seen.shadow, ShadowClass::Lit);
  EXPECT_EQ(seen.visible_fraction, 1);
}
void expect_lit(const Backprojection& seen, double factor) {
  expect_lit(seen);
  ASSERT_TRUE(seen.form_factor);
  EXPECT_NEAR(*seen.form_factor, factor, kTiny);
}

void expect_penumbra(const Backprojection& seen, double fraction) {
  EXPECT_EQ(seen.shadow, ShadowClass::Penumbra);
  EXPECT_NEAR(seen.visible_fraction, fraction, kTiny);
}
void expect_penumbra(const Backprojection& seen, double fraction, double factor) {
  expect_penumbra(seen, fraction);
  ASSERT_TRUE(seen.form_factor);
  EXPECT_NEAR(*seen.form_factor, factor, kTiny);
}

void expect_areas(const ReceiverShadows& r, double lit, double penumbra, double umbra,
                  double away = 0) {
  EXPECT_NEAR(r.lit_area, lit, 1e-10);
  EXPECT_NEAR(r.penumbra_area, penumbra, 1e-10);
  EXPECT_NEAR(r.umbra_area, umbra, 1e-10);
  EXPECT_NEAR(r.away_area, away, 1e-10);
}

std::vector<std::size_t> side_counts(const Backprojection& seen) {
  std::vector<std::size_t> counts;
  for (const SeenBoundary& b : seen.boundaries) counts.push_back(b.sides.size());
  return counts;
}

int sides_of(const Backprojection& seen, SeenSide::Kind kind) {
  int n = 0;
  for (const SeenBoundary& b : seen.boundaries) {
    for (const auto& names : b.sides) {
      n += std::ranges::any_of(names, [&](const SeenSide& s) { return s.kind == kind; })
               ? 1
               : 0;
    }
  }
  return n;
}

using Counts = std::vector<std::size_t>;

// ---- points of blockers ---------------------------------------------------------------

// The sheet lies in a plane through the foot that also holds the middle of the lamp:
// edge-on, it hides nothing from its foot.  From e beside it, it hides what lies 3 e
// beyond.
TEST(ShadowCases, FootOfASheet) {
  const Case foot("foot");
  expect_lit(foot.at({0, 0, 0}, kUp), rectangle_factor(-1, 1, -1, 1, 4));
  const double e = 0x1p-4;
  expect_penumbra(foot.at({-e, 0, 0}, kUp), (1 + 3 * e) / 2,
                  rectangle_factor(-1 + e, 4 * e, -1, 1, 4));
  expect_penumbra(foot.at({e, 0, 0}, kUp), (1 + 3 * e) / 2,
                  rectangle_factor(-4 * e, 1 - e, -1, 1, 4));
}

// From the foot of a box half of the directions run into it; from the foot of its corner
// those towards the lamp pass it by.
TEST(ShadowCases, FootOfABox) {
  const Case foot("foot");
  expect_penumbra(foot.at({0, 4, 0}, kUp), 0.5, rectangle_factor(0, 1, -5, -3, 4));
  expect_lit(foot.at({0, 3, 0}, kUp), rectangle_factor(-1, 1, -4, -2, 4));
  expect_umbra(foot.at({-1, 4, 0}, kUp));  // below the box
}

// A sheet that leans to the right: its foot sees what points on its left see, and all is
// umbra at once on its right.
TEST(ShadowCases, FootOfALeaningSheet) {
  const Case leaning("leaning");
  expect_lit(leaning.at({-0x1p-40, 0, 0}, kUp));
  expect_lit(leaning.at({0, 0, 0}, kUp), rectangle_factor(-1, 1, -1, 1, 4));
  expect_umbra(leaning.at({0x1p-40, 0, 0}, kUp));
}

TEST(ShadowCases, OnASheet) {
  const Case leaning("leaning");
  expect_lit(leaning.at({1, 0, 1}));
  expect_lit(leaning.at({1, 0, 1}, {-1, 0, 1}));
  expect_umbra(leaning.at({1, 0, 1}, {1, 0, -1}));
  expect_lit(leaning.at({2, 0, 2}, kUp), rectangle_factor(-3, -1, -1, 1, 2));  // its rim
}

// Three quarters of the directions towards the lamp leave the lower corner freely.
TEST(ShadowCases, CornerOfABlocker) {
  const Case corner("corner");
  expect_penumbra(corner.at({0, 0, 1}, kUp), 0.75, 3 * corner_factor(1, 1, 3));
  EXPECT_EQ(side_counts(corner.at({0, 0, 1}, kUp)), Counts{6});
  expect_lit(corner.at({0, 0, 2}, kUp), 4 * corner_factor(1, 1, 2));
}

TEST(ShadowCases, EdgeOfABlocker) {
  const Case corner("corner");
  expect_penumbra(corner.at({0, -0.5, 1}, kUp), 0.5,
                  rectangle_factor(0, 1, -0.5, 1.5, 3));
  expect_lit(corner.at({0, -1, 2}, kUp), rectangle_factor(-1, 1, 0, 2, 2));
  // The upright edge hides the quarter behind it.
  expect_penumbra(corner.at({0, 0, 1.5}, kUp), 0.75, 3 * corner_factor(1, 1, 2.5));
}

TEST(ShadowCases, OnASolid) {
  const Case corner("corner");
  expect_lit(corner.at({-1, -1, 2}, kUp), rectangle_factor(0, 2, 0, 2, 2));
  // The side: what lies behind its plane is below the horizon, or else within the box.
  expect_penumbra(corner.at({0, -1, 1.5}, {1, 0, 0}), 0.5, upright_factor(1, 2, 2.5));
  expect_penumbra(corner.at({0, -1, 1.5}), 0.5);
  // The underside, whatever normal is given.
  expect_umbra(corner.at({-1, -1, 1}, kDown));
  expect_umbra(corner.at({-1, -1, 1}, kUp));
}

TEST(ShadowCases, InASolid) {
  const Case corner("corner");
  expect_umbra(corner.at({-1, -1, 1.5}, kUp));
  expect_umbra(corner.at({-0x1p-40, -0x1p-40, 2 - 0x1p-40}, kUp));
}

// ---- sheets laid on others ------------------------------------------------------------

TEST(ShadowCases, SheetOnTheGround) {
  const Case laid("sheet_on_the_ground");
  expect_lit(laid.at({0, 0, 0}, kUp), 4 * corner_factor(1, 1, 4));
  for (const auto& [name, area] : {std::pair{"ground", 256.}, {"sheet", 4.}}) {
    const ReceiverShadows r = laid.on(name);
    expect_areas(r, area, 0, 0);
    EXPECT_EQ(kinds(r.meshes.at(0)), (Kinds{.boundary = 4})) << name;
    EXPECT_EQ(r.meshes.at(0).faces.size(), 1U);
  }
}

TEST(ShadowCases, SheetOnTheSource) {
  const Case laid("lies_on_the_source");
  const Backprojection seen = laid.at({0, 0, 0}, kUp);
  expect_lit(seen, 4 * corner_factor(1, 1, 4));
  EXPECT_EQ(side_counts(seen), Counts{4});
  EXPECT_EQ(sides_of(seen, SeenSide::Kind::Edge), 0);
  const ReceiverShadows r = laid.on();
  expect_areas(r, 256, 0, 0);
  EXPECT_EQ(kinds(r.meshes.at(0)), (Kinds{.boundary = 4}));
}

// ---- the source's plane, the horizon --------------------------------------------------

TEST(ShadowCases, InTheSourcesPlane) {
  const Case lamp("lamp");
  expect_umbra(lamp.at({3, 0, 4}, {-1, 0, 0}));
  expect_umbra(lamp.at({0, 0, 4}, kDown));  // on the lamp
  expect_umbra(lamp.at({1, 0, 4}, kUp));    // on its side
  // 2^-40 below, before its middle, half a space is filled with light.
  const Backprojection near = lamp.at({0, 0, 4 - 0x1p-40}, kUp);
  expect_lit(near, 1);
}

TEST(ShadowCases, BehindTheSource) {
  const Case lamp("lamp");
  expect_umbra(lamp.at({0, 0, 5}, kDown));
  expect_umbra(lamp.at({0, 0, 4 + 0x1p-40}));
}

// What the horizon cuts off counts as not seen.
TEST(ShadowCases, HorizonThroughTheSource) {
  const Case lamp("lamp");
  const Backprojection half = lamp.at({0, 0, 0}, {3, 0, 0});
  expect_penumbra(half, 0.5, 2 * upright_factor(1, 1, 4));
  EXPECT_EQ(side_counts(half), Counts{4});
  EXPECT_EQ(sides_of(half, SeenSide::Kind::Horizon), 1);
  // 8 x > z.
  expect_penumbra(lamp.at({0, 0, 0}, {8, 0, -1}), 0.25);
  // Along a side of the lamp it cuts nothing off, or all.
  expect_lit(lamp.at({-1, 0, 0}, {1, 0, 0}), 2 * upright_factor(2, 1, 4));
  expect_umbra(lamp.at({1, 0, 0}, {1, 0, 0}));
}

// ---- polygons bent by rounding --------------------------------------------------------

// The lamp's last corner is 2^-40 too high: it counts as two triangles.  The ground's
// third corner is too high, too: a mesh for each of its triangles, and (0, 0, 0) is
// behind it.
TEST(ShadowCases, BentByRounding) {
  const Case bent("bent");
  const Backprojection seen = bent.at({0, 0, 1}, kUp);
  expect_lit(seen);
  EXPECT_NEAR(*seen.form_factor, 4 * corner_factor(1, 1, 3), 1e-12);
  expect_umbra(bent.at({0, 0, 5}, kDown));
  expect_umbra(bent.at({0, 0, 0}, kUp));
  expect_lit(
      bent.index.from(shadow_point_on(bent.scene, 1, shadow_point({4, -4, 0}).at)));
  const ReceiverShadows r = bent.on();
  EXPECT_EQ(r.meshes.size(), 2U);
  EXPECT_NEAR(r.area, 256, 1e-9);
  EXPECT_NEAR(r.lit_area, 256, 1e-9);
  EXPECT_EQ(r.umbra_area, 0);
  EXPECT_EQ(r.penumbra_area, 0);
}

// ---- sources --------------------------------------------------------------------------

// Sides parallel: umbra |p| < 2, outline of the penumbra |p| < 4.  Each side of the lamp
// and each of the plate make one line; the lines at 2 and 4, 8 in all, cut the penumbra
// into four strips and four corners, all of different structures.
void expect_nine_cells(const Case& scene) {
  const ReceiverShadows r = scene.on();
  expect_areas(r, 192, 48, 16);
  EXPECT_EQ(r.umbra_components, 1);
  ASSERT_EQ(r.meshes.size(), 1U);
  EXPECT_EQ(kinds(r.meshes[0]), (Kinds{.ee = 24, .boundary = 4}));
  EXPECT_EQ(r.meshes[0].vertices.size(), 20U);
  EXPECT_EQ(r.meshes[0].faces.size(), 10U);
  expect_penumbra(scene.at({3, 0, 0}, kUp), 0.5, rectangle_factor(-3, -2, -1, 1, 4));
  // On the borders.
  expect_umbra(scene.at({2, 0, 0}, kUp));
  expect_lit(scene.at({4, 0, 0}, kUp), rectangle_factor(-5, -3, -1, 1, 4));
}
TEST(ShadowCases, SourceInMidAir) { expect_nine_cells(Case("mid_air")); }
TEST(ShadowCases, SourceFlushWithTheCeiling) {
  expect_nine_cells(Case("flush_with_the_ceiling"));
}
TEST(ShadowCases, SourceLetIntoTheCeiling) {
  expect_nine_cells(Case("let_into_the_ceiling"));
}

// A lamp at 5 over a hole of its size at 4: a line over the hole at b meets the lamp at
// (5 b - p) / 4.  Lit |p| < 1, umbra |p| > 9: a ring.
TEST(ShadowCases, SourceAboveAHole) {
  const ReceiverShadows r = Case("recessed").on();
  expect_areas(r, 4, 320, 76);
  EXPECT_EQ(r.umbra_components, 1);
  EXPECT_EQ(kinds(r.meshes.at(0)), (Kinds{.ee = 24, .boundary = 4}));
  EXPECT_EQ(r.meshes[0].faces.size(), 10U);
}

// The lamp's side divides the wall: contact where it touches, its plane beside.
TEST(ShadowCases, SourceTouchingAWall) {
  const Case wall("touching_a_wall");
  expect_lit(wall.at({1, 0, 0}, kUp), 2 * corner_factor(2, 1, 4));
  expect_lit(wall.at({1, 0, 2}, {-1, 0, 0}), 2 * upright_factor(2, 1, 2));
  expect_umbra(wall.at({1, 0, 4}, {-1, 0, 0}));
  expect_umbra(wall.at({1, 0, 5}, {-1, 0, 0}));
  const ReceiverShadows r = wall.on("wall");
  expect_areas(r, 64, 0, 32, 32);
  EXPECT_EQ(r.umbra_components, 1);
  EXPECT_EQ(kinds(r.meshes.at(0)), (Kinds{.contact = 1, .plane = 2, .boundary = 6}));
  EXPECT_EQ(r.meshes[0].faces.size(), 2U);
  for (const ShadowMesh::Edge& e : r.meshes[0].edges) {
    if (e.kind == ShadowEdgeKind::Contact) {
      EXPECT_NEAR(length(e), 2, kTiny);
      EXPECT_EQ(e.order, 0);
    } else if (e.kind == ShadowEdgeKind::Plane) {
      EXPECT_EQ(e.order, 1);
    } else {
      EXPECT_EQ(e.order, std::nullopt);
    }
  }
  // Its foot is the ground's outline.
  const ReceiverShadows ground = wall.on();
  expect_areas(ground, 144, 0, 0);
  EXPECT_EQ(kinds(ground.meshes.at(0)), (Kinds{.boundary = 4}));
}

// A window named by its polygon: the rest of the wall is no source, though it lies in the
// same plane.
TEST(ShadowCases, SourcePartOfAWall) {
  const Case wall("part_of_a_wall", {"#1-1"});
  const Backprojection seen = wall.at({3, 0, 0}, kUp);
  expect_lit(seen, 2 * upright_factor(4, 1, 3));
  EXPECT_EQ(side_counts(seen), Counts{4});
  expect_umbra(wall.at({0, 0, 0}, kUp));
  expect_umbra(wall.at({-3, 0, 0}, kUp));
  const ReceiverShadows r = wall.on();
  expect_areas(r, 128, 0, 128, 128);
  EXPECT_EQ(kinds(r.meshes.at(0)), (Kinds{.contact = 1, .plane = 2, .boundary = 6}));
}

TEST(ShadowCases, SourceLShaped) {
  const Case scene("l_shaped");
  const Backprojection lit = scene.at({6, 0, 0}, kUp);
  expect_lit(lit, rectangle_factor(-7, -5, -1, 1, 4) - rectangle_factor(-6, -5, 0, 1, 4));
  EXPECT_EQ(side_counts(lit), Counts{6});
  // The box hides all over x < 0: of three squares one is left.  Its two edges at x = 0
  // are seen in line with each other, and with a side of the lamp.
  const Backprojection third = scene.at({0, 0, 0}, kUp);
  expect_penumbra(third, 1. / 3, corner_factor(1, 1, 4));
  EXPECT_EQ(side_counts(third), Counts{4});
  EXPECT_EQ(sides_of(third, SeenSide::Kind::Edge), 1);
  EXPECT_EQ(third.gradient, std::nullopt);
}

TEST(ShadowCases, SourceHoled) {
  const Case scene("holed");
  const Backprojection seen = scene.at({0, 0, 0}, kUp);
  expect_lit(seen, 4 * (corner_factor(2, 2, 4) - corner_factor(1, 1, 4)));
  EXPECT_EQ(side_counts(seen), (Counts{4, 4}));
  EXPECT_EQ(seen.boundaries.at(0).source_face, seen.boundaries.at(1).source_face);
  expect_areas(scene.on(), 256, 0, 0);
}

// The fraction is over the area of those source faces that show their fronts.
TEST(ShadowCases, SeveralSources) {
  const Case scene("several_at_once", {"high", "low"});
  const Backprojection both = scene.at({0, 0, 0}, kUp);
  expect_lit(both, rectangle_factor(-3, -1, -1, 1, 4) + rectangle_factor(1, 3, -1, 1, 2));
  EXPECT_EQ(side_counts(both), (Counts{4, 4}));
  EXPECT_NE(both.boundaries.at(0).source_face, both.boundaries.at(1).source_face);
  // Above the low one.
  expect_lit(scene.at({0, 0, 3}, kUp), rectangle_factor(-3, -1, -1, 1, 1));
  // The low one hides what lies left of -2 of the high one.
  expect_penumbra(
      scene.at({8, 0, 0}, kUp), 0.75,
      rectangle_factor(-10, -9, -1, 1, 4) + rectangle_factor(-7, -5, -1, 1, 2));
}

TEST(ShadowCases, SourcesOnOneAnother) {
  // Alike: the overlap counts once, and the joint is no side.
  const Case alike("on_one_another", {"a", "b"});
  const Backprojection seen = alike.at({0, 0, 0}, kUp);
  expect_lit(seen, rectangle_factor(-1, 2, -1, 1, 4));
  EXPECT_EQ(side_counts(seen), Counts{4});
  // Back to back: each side shows its own.
  const Case opposed("on_one_another", {"a", "c"});
  expect_lit(opposed.at({0, 0, 0}, kUp), 4 * corner_factor(1, 1, 4));
  expect_lit(opposed.at({0, 0, 8}, kDown), 4 * corner_factor(1, 1, 4));
  expect_umbra(opposed.at({3, 0, 4}));
}

// A lamp that shines all round, its bottom at height 3.  It hides nothing of itself but
// what turns away; where a side comes in view all is lit before and after.
TEST(ShadowCases, SourceClosed) {
  const Case scene("closed_lamp");
  expect_lit(scene.at({0, 0, 0}, kUp), 4 * corner_factor(1, 1, 3));
  const Backprojection beside = scene.at({4, 0, 0}, kUp);
  expect_lit(beside, rectangle_factor(-5, -3, -1, 1, 3) +
                         2 * (upright_factor(4, 1, 3) - upright_factor(3, 1, 3)));
  EXPECT_EQ(side_counts(beside), (Counts{4, 4}));
  expect_umbra(scene.at({0, 0, 3.5}));  // in it
  const ReceiverShadows r = scene.on();
  expect_areas(r, 256, 0, 0);
  EXPECT_EQ(kinds(r.meshes.at(0)), (Kinds{.plane = 12, .boundary = 12}));
  EXPECT_EQ(r.meshes[0].faces.size(), 9U);
}

TEST(ShadowCases, SourceTwoSided) {
  const Case one("two_sided"), two("two_sided", {"lamp"}, {"lamp"});
  for (const Case* scene : {&one, &two}) {
    expect_lit(scene->at({0, 0, 0}, kUp), 4 * corner_factor(1, 1, 4));
    expect_umbra(scene->at({3, 0, 4}));
    expect_areas(scene->on(), 256, 0, 0);
  }
  expect_umbra(one.at({0, 0, 8}, kDown));
  expect_lit(two.at({0, 0, 8}, kDown), 4 * corner_factor(1, 1, 4));
  expect_areas(one.on("ceiling"), 0, 0, 256, 256);
  expect_areas(two.on("ceiling"), 256, 0, 0);
}

// ---- blockers at the source -----------------------------------------------------------

// Below the middle the box, 1 below the lamp, hides a square of half-side 2/3.  From
// (8, 0, 0) it hides, beyond where its side cuts the lamp, a part that is 1 wide there
// and 1.2 at the lamp's far side.
TEST(ShadowCases, BlockerCutsTheSource) {
  const Case scene("cuts_the_source");
  const Backprojection below = scene.at({0, 0, 0}, kUp);
  expect_penumbra(below, 5. / 9,
                  4 * (corner_factor(1, 1, 4) - corner_factor(2. / 3, 2. / 3, 4)));
  EXPECT_EQ(side_counts(below), (Counts{4, 4}));
  EXPECT_EQ(sides_of(below, SeenSide::Kind::Cut), 0);
  const Backprojection beside = scene.at({8, 0, 0}, kUp);
  expect_penumbra(beside, 1 - 1.65 / 4);
  EXPECT_EQ(side_counts(beside), Counts{8});
  EXPECT_EQ(sides_of(beside, SeenSide::Kind::Cut), 1);
  EXPECT_EQ(sides_of(beside, SeenSide::Kind::Edge), 2);
  // A part of the lamp is within the box, whoever looks.
  expect_areas(scene.on(), 0, 256, 0);
}

// The same box ends in the lamp's plane: the same is hidden, but by an edge.
TEST(ShadowCases, BlockerTouchesTheSource) {
  const Case scene("touches_the_source");
  expect_penumbra(scene.at({0, 0, 0}, kUp), 5. / 9);
  const Backprojection beside = scene.at({8, 0, 0}, kUp);
  expect_penumbra(beside, 1 - 1.65 / 4);
  EXPECT_EQ(side_counts(beside), Counts{8});
  EXPECT_EQ(sides_of(beside, SeenSide::Kind::Cut), 0);
  EXPECT_EQ(sides_of(beside, SeenSide::Kind::Edge), 3);
  expect_areas(scene.on(), 0, 256, 0);
}

// ---- edges by kind --------------------------------------------------------------------

TEST(ShadowCases, EdgesBoundary) {
  const ReceiverShadows r = Case("lamp").on();
  ASSERT_EQ(kinds(r.meshes.at(0)), (Kinds{.boundary = 4}));
  for (const ShadowMesh::Edge& e : r.meshes[0].edges) {
    EXPECT_EQ(e.order, std::nullopt);
    EXPECT_NEAR(length(e), 16, kTiny);
    EXPECT_EQ(std::min(e.left, e.right), -1);
  }
}

// Feet: four sides of a box, 2 long, and one of a sheet.  Behind the box, y > 5, is umbra
// as below it.
TEST(ShadowCases, EdgesContact) {
  const ReceiverShadows r = Case("foot").on();
  const ShadowMesh& mesh = r.meshes.at(0);
  double changing = 0, others = 0;
  for (const ShadowMesh::Edge& e : mesh.edges) {
    if (e.kind != ShadowEdgeKind::Contact) continue;
    const bool changes = mesh.faces[e.left].structure != mesh.faces[e.right].structure;
    EXPECT_EQ(e.order, changes ? std::optional(0) : std::nullopt);
    (changes ? changing : others) += length(e);
  }
  EXPECT_NEAR(changing + others, 10, 1e-12);
  EXPECT_GE(others, 2);
  EXPECT_GE(changing, 6);
}

TEST(ShadowCases, EdgesPlane) {
  const ReceiverShadows r = Case("closed_lamp").on();
  int planes = 0;
  for (const ShadowMesh::Edge& e : r.meshes.at(0).edges) {
    if (e.kind != ShadowEdgeKind::Plane) continue;
    ++planes;
    EXPECT_EQ(e.order, 1);
    EXPECT_EQ(e.generators.size(), 1U);
  }
  EXPECT_EQ(planes, 12);
}

// The box's side in x = 0, from height 1 to 2 and as wide as the lamp, is seen edge-on by
// points of x = 0: by its upper edge from up to 3 aside.
TEST(ShadowCases, EdgesFace) {
  const ReceiverShadows r = Case("edge_face").on();
  const ShadowMesh& mesh = r.meshes.at(0);
  double sum = 0;
  for (const ShadowMesh::Edge& e : mesh.edges) {
    const bool here = std::ranges::all_of(e.polyline, [&](const auto& p) {
      return std::abs(in_space(mesh, p)[0]) < kTiny;
    });
    if (!here) continue;
    EXPECT_EQ(e.kind, ShadowEdgeKind::Face);
    EXPECT_EQ(e.order, 1);
    sum += length(e);
  }
  EXPECT_NEAR(sum, 6, 1e-12);
}

TEST(ShadowCases, EdgesEE) {
  const ReceiverShadows r = Case("mid_air").on();
  for (const ShadowMesh::Edge& e : r.meshes.at(0).edges) {
    if (e.kind == ShadowEdgeKind::Boundary) continue;
    EXPECT_EQ(e.kind, ShadowEdgeKind::EE);
    EXPECT_EQ(e.order, 1);
    // One of them is the plate's.
    EXPECT_EQ(std::ranges::count_if(e.generators,
                                    [](const auto& g) { return g.starts_with("edge "); }),
              1);
  }
}

// A plate turned by 45 degrees, its corners 1.5 from its middle.  Umbra: |x| + |y| < 1.
// Not lit: |x| + |y| < 3, widened by the lamp, of area 18 + 4 + 24.
TEST(ShadowCases, EdgesEV) {
  const ReceiverShadows r = Case("edge_ev").on();
  expect_areas(r, 210, 44, 2);
  EXPECT_EQ(r.umbra_components, 1);
  const Kinds k = kinds(r.meshes.at(0));
  EXPECT_EQ(k, (Kinds{.ev = k.ev, .boundary = 4}));
  EXPECT_GT(k.ev, 12);
  for (const ShadowMesh::Edge& e : r.meshes[0].edges) {
    if (e.kind != ShadowEdgeKind::EV) continue;
    EXPECT_EQ(e.order, 2);
    EXPECT_GE(e.generators.size(), 2U);
    EXPECT_LE(e.generators.size(),
              3U);  // two corners of the lamp lie along a plate's edge
    EXPECT_EQ(e.polyline.size(), 2U);
  }
}

// The roof's rim is (0, v, 2), the post's edge (1/2, 1/4, z), the lamp's side (s, 1, 4).
// Lines that meet all three arrive at (x, y, 0) with (x + 1/2) y = (1 - x) / 2, from the
// post's foot to x = 1, where the lamp ends.
TEST(ShadowCases, EdgesEEE) {
  const ReceiverShadows r = Case("edge_eee").on();
  const ShadowMesh& mesh = r.meshes.at(0);
  double along = 0;
  for (const ShadowMesh::Edge& e : mesh.edges) {
    if (e.kind != ShadowEdgeKind::EEE) continue;
    const bool here = std::ranges::all_of(e.polyline, [&](const auto& q) {
      const Point p = in_space(mesh, q);
      return p[0] > 0 && std::abs((p[0] + 0.5) * p[1] - (1 - p[0]) / 2) < 1e-12;
    });
    if (!here) continue;
    EXPECT_EQ(e.order, 2);
    EXPECT_EQ(e.generators.size(), 3U);
    along += std::abs(in_space(mesh, e.polyline.front())[0] -
                      in_space(mesh, e.polyline.back())[0]);
  }
  EXPECT_NEAR(along, 0.5, 1e-12);
}

// ---- shapes of the umbra --------------------------------------------------------------

// The upper plate alone has the umbra x in [-5, -1], |y| < 7; the lower one x in
// [-1/3, 5/3], |y| < 5.  Between them, |y| < 5, one hides the left and the other the
// right of the lamp.
TEST(ShadowCases, FusedUmbrae) {
  const Case scene("fused_umbrae");
  const ReceiverShadows r = scene.on();
  EXPECT_NEAR(r.umbra_area, 56 + 20 + 20. / 3, 1e-10);
  EXPECT_EQ(r.umbra_components, 1);
  expect_umbra(scene.at({-2. / 3, 0, 0}));
}

// Below the hole, 1/2 wide, light comes through for |p| < 3/2.
TEST(ShadowCases, UmbraWithAHole) {
  const Case scene("umbra_with_a_hole");
  const ReceiverShadows r = scene.on();
  expect_areas(r, 60, 105, 91);
  EXPECT_EQ(r.umbra_components, 1);
  expect_penumbra(scene.at({0, 0, 0}, kUp), 0.25, 4 * corner_factor(0.5, 0.5, 4));
}

// Demouth et al. 2009: a segment of light and two triangles may cast an umbra of four
// pieces.  The lamp is 2^-10 wide.  The scene was found by a search that knows only the
// intervals of the segment that each triangle hides; at 4,000^2 points of the ground it
// counts four pieces of 46.62, 2.40, 0.58 and 0.45, the last two hidden by both together.
TEST(ShadowCases, FourPieces) {
  const ReceiverShadows r = Case("four_pieces").on();
  EXPECT_EQ(r.umbra_components, 4);
  EXPECT_NEAR(r.umbra_area, 50.05, 0.1);
  EXPECT_GT(kinds(r.meshes.at(0)).eee, 0);
}

}  // namespace
}  // namespace sightline
