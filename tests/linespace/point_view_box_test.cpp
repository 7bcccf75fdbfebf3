// Views of a scene that a box cuts: the cases of docs/point_view.md, In a box, and views
// of the scene cut beforehand as an oracle.

#include <gtest/gtest.h>

#include <bit>
#include <iostream>
#include <numbers>

#include "linespace/mesh_io.h"
#include "linespace/view_path.h"
#include "tests/support/box_comparison.h"
#include "tests/support/generators.h"
#include "tests/support/invariant_scenes.h"
#include "tests/support/setting.h"
#include "tests/support/view_comparison.h"
#include "tests/support/view_counts.h"
#include "tests/support/view_scenes.h"

namespace sightline::testing {
namespace {

// Polygons of a box in tests/data/views.
enum BoxFace : int { Bottom, Top, Front, Back, Left, Right };
// Sides of the box that cuts.
enum BoxSide : int { X0, Y0, Z0, X1, Y1, Z1 };

const Point kOblique{1, -2, 2};

struct Case {
  Case(const std::string& name, const Point& low, const Point& high)
      : scene(read_mesh(std::string(SIGHTLINE_TEST_DATA) + "/views/" + name + ".obj")),
        index(scene, view_box(low, high)) {}
  Scene scene;
  PointViewIndex index;
};

int edges(const PointView& view, MapEdgeKind kind) {
  return static_cast<int>(std::ranges::count(view.edges, kind, &MapEdge::kind));
}

// ---- cases ----------------------------------------------------------------------------

// A box 2 high cut at height 1 and seen from above: bottom and four walls show their
// backs, the walls edge-on; seen obliquely, front and right show fronts, the others
// backs.
TEST(PointViewBox, SectionOfABox) {
  const Case box("box", {-1, -1, -1}, {3, 3, 1});
  const PointView plan = box.index.view(eye_far_along({0, 0, 1}));
  ASSERT_EQ(plan.facets.size(), 1U);
  EXPECT_EQ(plan.facets[0].facet, facet_of(box.scene, Bottom));
  EXPECT_FALSE(plan.facets[0].front);
  EXPECT_DOUBLE_EQ(plan.facets[0].measure, 4);
  // Each wall is edge-on, and ends in the cut.
  EXPECT_EQ(count(plan, AccidentKind::EdgeOn), 4);

  const PointView view = box.index.view(eye_far_along(kOblique));
  EXPECT_EQ(view.facets.size(), 5U);
  EXPECT_TRUE(seen(box.scene, view, Front)->front);
  EXPECT_TRUE(seen(box.scene, view, Right)->front);
  EXPECT_FALSE(seen(box.scene, view, Back)->front);
  EXPECT_FALSE(seen(box.scene, view, Left)->front);
  EXPECT_FALSE(seen(box.scene, view, Bottom)->front);
  EXPECT_EQ(seen(box.scene, view, Top), nullptr);
  EXPECT_NEAR(measure(box.scene, view, Front), 2 * 2. / 3, 1e-14);
  // Where the floor's far sides pass behind them, the near cuts have a T-vertex each.
  EXPECT_EQ(edges(view, MapEdgeKind::Cut), 6);
  EXPECT_EQ(counts(view), (MapCounts{.corners = 4,
                                     .t_vertices = 2,
                                     .touches = 4,
                                     .edges = 14,
                                     .regions = 6,
                                     .components = 1,
                                     .background_pieces = 1}));
  for (const MapEdge& e : view.edges) {
    if (e.kind != MapEdgeKind::Cut) continue;
    EXPECT_EQ(e.line.edge, -1);
    EXPECT_EQ(e.line.box_side, Z1);
    EXPECT_GE(e.line.facets[0], 0);
    EXPECT_EQ(e.segment[0].z(), 1);
    EXPECT_EQ(e.segment[1].z(), 1);
  }
  EXPECT_EQ(euler_excess(view), 0);
  EXPECT_TRUE(view.general);
}

// A facet in a side of the box counts: the top alone is left, as a sheet with four
// boundaries, which are edges of the scene.
TEST(PointViewBox, FacetInASideOfTheBox) {
  const Case box("box", {-1, -1, 2}, {3, 3, 5});
  const PointView view = box.index.view(eye_far_along(kOblique));
  ASSERT_EQ(view.facets.size(), 1U);
  EXPECT_NEAR(measure(box.scene, view, Top), 4 * 2. / 3, 1e-14);
  EXPECT_EQ(edge_counts(view), (EdgeCounts{.boundary = 4}));
  EXPECT_EQ(counts(view).corners, 4);
  const PointView below = box.index.view(eye_far_along({1, -2, -2}));
  ASSERT_EQ(below.facets.size(), 1U);
  EXPECT_FALSE(below.facets[0].front);
}

// Two faces of one facet meet in a side of the box: the facet ends there, in a cut.
TEST(PointViewBox, FacesMeetInASideOfTheBox) {
  PolygonSoup soup;
  soup.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {0, 1, 0}};
  soup.polygons = {{0, 1, 4, 5}, {1, 2, 3, 4}};
  soup.groups = {{"sheet", {0, 1}}};
  const Scene scene(soup);
  ASSERT_EQ(scene.facets().size(), 1U);
  const PointView view = PointViewIndex(scene, view_box({-1, -1, -1}, {1, 3, 1}))
                             .view(eye_far_along({0, 0, 1}));
  ASSERT_EQ(view.facets.size(), 1U);
  EXPECT_DOUBLE_EQ(view.facets[0].measure, 1);
  EXPECT_EQ(edge_counts(view), (EdgeCounts{.boundary = 3}));
  EXPECT_EQ(edges(view, MapEdgeKind::Cut), 1);
}

// What only touches the box has no area in it.
TEST(PointViewBox, TouchingTheBoxIsNotInIt) {
  const Case box("box", {2, 2, -1}, {3, 3, 5});
  const PointView view = box.index.view(eye_far_along(kOblique));
  EXPECT_TRUE(view.facets.empty());
  EXPECT_TRUE(view.edges.empty());
  EXPECT_EQ(view.background_pieces, 1);
}

// What is cut off does not hide: the front of the large box is seen past the small one
// that stands on it.
TEST(PointViewBox, WhatIsCutOffDoesNotHide) {
  const Case boxes("stacked_boxes", {-1, -1, -1}, {9, 9, 1});
  const PointView view = boxes.index.view(eye_far_along({0, 0, 1}));
  double area = 0;
  for (const SeenFacet& f : view.facets) area += f.measure;
  // The small box's lower side lies in the box's side, on the large one's top.
  EXPECT_NEAR(area - measure(boxes.scene, view, 6 + Bottom),
              measure(boxes.scene, view, Top), 1e-14);
}

// Two sheets that cut through each other end at the box: their crossing does, too.
TEST(PointViewBox, CrossingFacetsAreCut) {
  const Case sheets("crossing_sheets", {-9, -9, -9}, {9, 9, 9});
  const PointView whole = sheets.index.view(eye_far_along(kOblique));
  ASSERT_EQ(edges(whole, MapEdgeKind::Crossing), 1);
  const MapEdge& crossing =
      *std::ranges::find(whole.edges, MapEdgeKind::Crossing, &MapEdge::kind);
  // A side of the box through its middle, across it.
  int axis = 0;
  const Point way = crossing.segment[1] - crossing.segment[0];
  way.cwiseAbs().maxCoeff(&axis);
  Point high(9, 9, 9);
  high[axis] = 0.5 * (crossing.segment[0] + crossing.segment[1])[axis];
  const PointView cut = PointViewIndex(sheets.scene, view_box({-9, -9, -9}, high))
                            .view(eye_far_along(kOblique));
  for (const MapEdge& e : cut.edges) {
    EXPECT_LE(e.segment[0][axis], high[axis]);
    EXPECT_LE(e.segment[1][axis], high[axis]);
  }
  EXPECT_EQ(edges(cut, MapEdgeKind::Crossing), 1);
  EXPECT_GE(edges(cut, MapEdgeKind::Cut), 1);
  EXPECT_EQ(euler_excess(cut), 0);
}

// An eye within a solid that is cut open is in no material, and sees the backs of what is
// left; through the cut it sees out.
TEST(PointViewBox, EyeInASolidCutOpen) {
  const Case box("box", {-1, -1, -1}, {3, 3, 1});
  const PointView view = box.index.view(eye_at({1, 1, 0.5}));
  EXPECT_EQ(view.place, EyePlace::Free);
  EXPECT_EQ(view.facets.size(), 5U);
  EXPECT_EQ(edges(view, MapEdgeKind::Cut), 4);
  EXPECT_EQ(view.background_pieces, 1);
  // In the cut's plane it sees all of the lower half but for what lies above.
  const PointView at = box.index.view(eye_at({1, 1, 1}));
  double sum = 0;
  for (const SeenFacet& f : at.facets) sum += f.measure;
  EXPECT_NEAR(sum, 2 * std::numbers::pi, 1e-13);
}

// An eye on the part of a facet that is cut off is in the open.
TEST(PointViewBox, EyeWhereAFacetIsCutOff) {
  const Case box("box", {-1, -1, -1}, {3, 3, 1});
  EXPECT_EQ(box.index.view(eye_at({1, 0, 1.5})).place, EyePlace::Free);
  const PointView on = box.index.view(eye_at({1, 0, 0.5}));
  EXPECT_EQ(on.place, EyePlace::Facet);
  EXPECT_EQ(on.place_ids, std::vector{facet_of(box.scene, Front)});
  // On the line of the cut it is on the facet.
  EXPECT_EQ(box.index.view(eye_at({1, 0, 1})).place, EyePlace::Facet);
}

TEST(PointViewBox, WithAllOfTheSceneNothingChanges) {
  for (const ViewScene& named : view_scenes()) {
    if (named.name.ends_with(" 2") || named.name.ends_with("row")) {
      const Scene scene(named.soup);
      const PointViewIndex whole(scene);
      const PointViewIndex in_box(scene, view_box(scene.bounds()[0] - Point(1, 1, 1),
                                                  scene.bounds()[1] + Point(1, 1, 1)));
      for (const NaiveEye& eye : view_eyes(scene, 7, 4)) {
        const PointView a = whole.view(viewpoint_of(eye));
        const PointView b = in_box.view(viewpoint_of(eye));
        EXPECT_EQ(a.structure, b.structure) << named.name;
        EXPECT_EQ(counts(a), counts(b)) << named.name;
        EXPECT_EQ(a.accidents, b.accidents) << named.name;
      }
    }
  }
}

// Bounds that no double has: a scene three times as large, cut at whole numbers.
TEST(PointViewBox, BoundsInThirdsAreExact) {
  PolygonSoup soup = crowded_scene(Crowd::Overlapping, 3);
  const Scene small(soup);
  for (Point& p : soup.vertices) p *= 3;
  const Scene large(soup);
  int cut = 0;
  for (int i = -2; i <= 4; ++i) {
    const std::string low = std::to_string(i), high = std::to_string(i + 5);
    const PointViewIndex in_thirds(small, view_box(std::array<std::string, 6>{
                                              low + "/3", low + "/3", low + "/3",
                                              high + "/3", high + "/3", high + "/3"}));
    const PointViewIndex whole(large,
                               view_box(Point::Constant(i), Point::Constant(i + 5)));
    const PointView a =
        in_thirds.view(viewpoint(Viewpoint::Kind::Eye, {"7/3", "-5", "4"}));
    const PointView b = whole.view(eye_at({7, -15, 12}));
    EXPECT_EQ(counts(a), counts(b)) << i;
    EXPECT_EQ(a.structure, b.structure) << i;
    ASSERT_EQ(a.facets.size(), b.facets.size()) << i;
    for (std::size_t f = 0; f < a.facets.size(); ++f)
      EXPECT_NEAR(a.facets[f].measure, b.facets[f].measure, 1e-15);
    cut += edges(a, MapEdgeKind::Cut);
  }
  EXPECT_GT(cut, 10);
}

TEST(PointViewBox, RefusesWhatIsNoBox) {
  const Scene scene(crowded_scene(Crowd::Touching, 1));
  EXPECT_THROW(PointViewIndex(scene, view_box({0, 0, 0}, {1, 0, 1})), InvalidInput);
  EXPECT_THROW(PointViewIndex(scene, view_box({0, 0, 2}, {1, 1, 1})), InvalidInput);
  EXPECT_THROW((void)view_box({"0", "0", "0", "1", "1/0", "1"}), InvalidInput);
  EXPECT_THROW((void)view_box({"0", "0", "1e300", "1", "1", "2e300"}), InvalidInput);
  const PointViewIndex index(scene, view_box({0, 0, 0}, {1, 1, 1}));
  const std::vector path{eye_at({-5, -9, 1}), eye_at({5, -9, 1})};
  EXPECT_THROW((void)view_path(index, path), InvalidInput);
}

// ---- the oracle -----------------------------------------------------------------------

// Octahedra on a grid: their slopes are 1, so that boxes on the grid cut them in doubles.
PolygonSoup octahedra(std::uint64_t seed) {
  Random random(seed);
  PolygonSoup soup;
  for (int i = 0; i < 3 + static_cast<int>(seed % 4); ++i) {
    const double r = random.integer(1, 3);
    const Point c(random.integer(0, 5), random.integer(0, 5), random.integer(0, 5));
    PolygonSoup::Group group{.name = "o" + std::to_string(i), .faces = {}};
    for (int octant = 0; octant < 8; ++octant) {
      std::array<int, 3> corners{};
      for (int axis = 0; axis < 3; ++axis) {
        corners[axis] = static_cast<int>(soup.vertices.size());
        Point p = c;
        p[axis] += (octant >> axis & 1) != 0 ? -r : r;
        soup.vertices.push_back(p);
      }
      if (std::popcount(static_cast<unsigned>(octant)) % 2 == 1)
        std::swap(corners[0], corners[1]);
      group.faces.push_back(static_cast<int>(soup.polygons.size()));
      soup.polygons.push_back({corners.begin(), corners.end()});
    }
    soup.groups.push_back(std::move(group));
  }
  return soup;
}

// Mostly half-integers about the scene, some of them coordinates of its points.
std::array<Vec3, 2> some_box(Random& random, const Scene& scene) {
  std::array<Vec3, 2> box;
  const auto& points = scene.points();
  for (int axis = 0; axis < 3; ++axis) {
    const double low = scene.bounds()[0][axis], high = scene.bounds()[1][axis];
    std::array<double, 2> x{};
    do {
      for (double& bound : x) {
        bound = random.one_in(3)
                    ? points[random.integer(0, static_cast<int>(points.size()) - 1)][axis]
                    : std::round(2 * random.uniform(low - 1, high + 1)) / 2;
      }
    } while (x[0] == x[1]);
    box[0][axis] = std::min(x[0], x[1]);
    box[1][axis] = std::max(x[0], x[1]);
  }
  return box;
}

// On sides, edges and corners of the box, and anywhere.
NaiveEye eye_by(Random& random, const std::array<Vec3, 2>& box) {
  Vec3 at;
  for (int axis = 0; axis < 3; ++axis) {
    at[axis] = random.one_in(2) ? box[random.integer(0, 1)][axis]
                                : box[0][axis] + Rational(random.integer(-6, 18), 12) *
                                                     (box[1][axis] - box[0][axis]);
  }
  return {Viewpoint::Kind::Eye, at};
}

// SIGHTLINE_VIEW_EYES: eyes a box; SIGHTLINE_VIEW_EVERY: of how many scenes one;
// SIGHTLINE_VIEW_SEED: other boxes and eyes.
TEST(PointViewBox, ViewsAreThoseOfTheSceneCutBeforehand) {
  std::vector<ViewScene> scenes = view_scenes();
  for (std::uint64_t seed = 1; seed <= 12; ++seed)
    scenes.push_back({"octahedra " + std::to_string(seed), octahedra(seed)});
  for (ViewScene& large : large_view_scenes()) scenes.push_back(std::move(large));
  const int every = setting("SIGHTLINE_VIEW_EVERY", 3);
  const int eyes = setting("SIGHTLINE_VIEW_EYES", 3);
  const auto seed = static_cast<std::uint64_t>(setting("SIGHTLINE_VIEW_SEED", 0));
  int boxes = 0, cuts = 0, views = 0, wrong = 0;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    if (i % static_cast<std::size_t>(every) != seed % static_cast<std::size_t>(every))
      continue;
    const Scene scene(scenes[i].soup);
    Random random(1000 * seed + i);
    for (int k = 0; k < 4; ++k) {
      const std::array<Vec3, 2> box = some_box(random, scene);
      const BoxComparison comparison(scene, box);
      if (!comparison.usable()) continue;
      ++boxes;
      cuts += comparison.cuts_a_face() ? 1 : 0;
      std::vector<NaiveEye> from =
          view_eyes(comparison.cut_scene(), random.integer(0, 1 << 20), eyes);
      for (int e = 0; e < eyes; ++e) from.push_back(eye_by(random, box));
      for (const NaiveEye& eye : from) {
        ++views;
        const std::vector<std::string> found = comparison.differences(eye);
        if (found.empty() || ++wrong > 10) continue;
        std::string box_text;
        for (const Vec3& corner : box) {
          for (const Rational& x : corner) box_text += x.str() + ",";
        }
        ADD_FAILURE() << scenes[i].name << " box " << box_text << '\n'
                      << report(scenes[i].soup, eye, found);
      }
    }
  }
  std::cout << boxes << " boxes, of which " << cuts << " cut a face; " << views
            << " views, " << wrong << " wrong\n";
  EXPECT_GT(cuts, boxes / 2);
}

}  // namespace
}  // namespace sightline::testing
