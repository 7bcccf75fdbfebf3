// The cases of docs/point_view.md, each under its name there: scenes of a few faces from
// tests/data/views, with numbers found by hand.
//
// The direction (1, -2, 2) has length 3, so that the faces of an axis-aligned box that
// look towards +x, -y and +z are seen with 1/3, 2/3 and 2/3 of their areas.  Of a square
// of half-side s an eye at distance s over its middle sees a sixth of the sphere, the
// share of a cube's side seen from its centre.

#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "linespace/mesh_io.h"
#include "linespace/point_view.h"
#include "tests/support/view_counts.h"

namespace sightline {
namespace {

using testing::corner_generator;
using testing::count;
using testing::counts;
using testing::edge_counts;
using testing::edge_generator;
using testing::EdgeCounts;
using testing::euler_excess;
using testing::face_generator;
using testing::facet_of;
using testing::MapCounts;
using testing::measure;
using testing::rectangle_angle;
using testing::seen;
using testing::sum_of_regions;
using testing::tells;

constexpr double kPi = std::numbers::pi;
constexpr double kSixth = 2 * kPi / 3;  // of the sphere
constexpr double kSmall = 0x1p-40;      // exact beside the coordinates here

// Polygons of a box in these files.
enum BoxFace : int { Bottom, Top, Front, Back, Left, Right };

const Point kOblique{1, -2, 2};

/// A scene of tests/data/views and what its views share.
struct Case {
  explicit Case(const std::string& name)
      : scene(read_mesh(std::string(SIGHTLINE_TEST_DATA) + "/views/" + name + ".obj")),
        index(scene) {}

  [[nodiscard]] PointView from(const Point& eye) const { return index.view(eye_at(eye)); }
  [[nodiscard]] PointView along(const Point& direction) const {
    return index.view(eye_far_along(direction));
  }
  [[nodiscard]] double seen_of(const PointView& view, int polygon) const {
    return measure(scene, view, polygon);
  }

  Scene scene;
  PointViewIndex index;
};

// ---- edge-on, end-on, in line ---------------------------------------------------------

// The eye lies in the plane of the top, beside the box, and sees front and right.
TEST(PointViewCases, FacetEdgeOn) {
  const Case box("box");
  const PointView view = box.from({5, -2, 2});
  EXPECT_EQ(counts(view), (MapCounts{.corners = 6,
                                     .edges = 7,
                                     .regions = 3,
                                     .components = 1,
                                     .background_pieces = 1}));
  EXPECT_EQ(edge_counts(view), (EdgeCounts{.silhouette = 6, .crease = 1}));
  EXPECT_EQ(view.facets.size(), 2U);
  // The front is 2 away, and goes from 3 to 5 beside the eye and 2 down.
  EXPECT_NEAR(box.seen_of(view, Front),
              rectangle_angle(5, 2, 2) - rectangle_angle(3, 2, 2), 1e-14);
  EXPECT_NEAR(box.seen_of(view, Right),
              rectangle_angle(4, 2, 3) - rectangle_angle(2, 2, 3), 1e-14);
  EXPECT_FALSE(view.general);
  EXPECT_TRUE(view.structure.empty());
  EXPECT_FALSE(view.facets[0].gradient.has_value());
  EXPECT_TRUE(
      tells(view, {AccidentKind::EdgeOn, {face_generator(facet_of(box.scene, Top))}}));
  EXPECT_EQ(count(view, AccidentKind::EdgeOn), 1);

  // A little above the top is seen; a little below nothing is an accident any more.
  const PointView above = box.from({5, -2, 2 + kSmall});
  EXPECT_EQ(counts(above).corners, 7);
  EXPECT_EQ(counts(above).edges, 9);
  EXPECT_TRUE(above.general);
  const PointView below = box.from({5, -2, 2 - kSmall});
  EXPECT_EQ(counts(below), counts(view));
  EXPECT_TRUE(below.general);
}

// A sheet edge-on before the front of a box: the front stays one region.
TEST(PointViewCases, SheetEdgeOn) {
  const Case scene("sheet_before_box");
  const int sheet = facet_of(scene.scene, 6);
  const PointView view = scene.from({1, -6, 1});
  EXPECT_EQ(counts(view), (MapCounts{.corners = 4,
                                     .edges = 4,
                                     .regions = 2,
                                     .components = 1,
                                     .background_pieces = 1}));
  EXPECT_EQ(view.facets.size(), 1U);
  EXPECT_NEAR(scene.seen_of(view, Front), 4 * rectangle_angle(1, 1, 6), 1e-15);
  EXPECT_TRUE(tells(view, {AccidentKind::EdgeOn, {face_generator(sheet)}}));
  EXPECT_FALSE(view.general);

  // A little to the right it has a side, all of it before the front.
  const PointView right = scene.from({1 + kSmall, -6, 1});
  EXPECT_EQ(counts(right), (MapCounts{.corners = 8,
                                      .edges = 8,
                                      .regions = 3,
                                      .components = 2,
                                      .background_pieces = 1}));
  EXPECT_TRUE(right.general);
}

// The eye lies on the line of the edge between top and right side.
TEST(PointViewCases, EdgeEndOn) {
  const Case box("box");
  const PointView view = box.from({2, -3, 2});
  EXPECT_EQ(counts(view), (MapCounts{.corners = 4,
                                     .edges = 4,
                                     .regions = 2,
                                     .components = 1,
                                     .background_pieces = 1}));
  EXPECT_EQ(view.facets.size(), 1U);
  EXPECT_NEAR(box.seen_of(view, Front), rectangle_angle(2, 2, 3), 1e-15);
  EXPECT_FALSE(view.general);
  EXPECT_TRUE(
      tells(view, {AccidentKind::EdgeOn, {face_generator(facet_of(box.scene, Top))}}));
  EXPECT_TRUE(
      tells(view, {AccidentKind::EdgeOn, {face_generator(facet_of(box.scene, Right))}}));
  EXPECT_TRUE(tells(
      view, {AccidentKind::EndOn, {edge_generator(box.scene, {2, 0, 2}, {2, 2, 2})}}));
  EXPECT_EQ(count(view, AccidentKind::EdgeOn), 2);
  EXPECT_EQ(count(view, AccidentKind::EndOn), 1);

  // Along y a square is all there is; four facets and four edges stand behind its sides.
  const PointView elevation = box.along({0, -1, 0});
  EXPECT_EQ(counts(elevation), counts(view));
  EXPECT_NEAR(box.seen_of(elevation, Front), 4, 1e-14);
  EXPECT_EQ(count(elevation, AccidentKind::EdgeOn), 4);
  EXPECT_EQ(count(elevation, AccidentKind::EndOn), 4);
}

// Two boxes in a row: their edges continue each other in space, which is no accident.
TEST(PointViewCases, EdgesInLine) {
  const Case row("row_of_boxes");
  const PointView view = row.along(kOblique);
  EXPECT_EQ(counts(view), (MapCounts{.corners = 14,
                                     .edges = 18,
                                     .regions = 7,
                                     .components = 2,
                                     .background_pieces = 1}));
  EXPECT_EQ(edge_counts(view), (EdgeCounts{.silhouette = 12, .crease = 6}));
  EXPECT_TRUE(view.general);
  for (const int first : {0, 6}) {
    EXPECT_NEAR(row.seen_of(view, first + Right), 1. / 3, 1e-14);
    EXPECT_NEAR(row.seen_of(view, first + Front), 2. / 3, 1e-14);
    EXPECT_NEAR(row.seen_of(view, first + Top), 2. / 3, 1e-14);
  }
}

// The sides of two sheets at different depths are seen in one: what lies behind shows
// through a crack of no width, and is not seen.
TEST(PointViewCases, CrackOfNoWidth) {
  const Case crack("crack");
  const PointView view = crack.along({0, -1, 0});
  // Two corners of the left sheet are seen on the side of the right one.
  EXPECT_EQ(counts(view), (MapCounts{.corners = 6,
                                     .accident_vertices = 2,
                                     .edges = 9,
                                     .regions = 3,
                                     .components = 1,
                                     .background_pieces = 1}));
  EXPECT_EQ(edge_counts(view), (EdgeCounts{.boundary = 9}));
  EXPECT_EQ(view.facets.size(), 2U);
  EXPECT_NEAR(crack.seen_of(view, 0), 12, 1e-14);
  EXPECT_NEAR(crack.seen_of(view, 1), 4, 1e-14);
  // Where the sides overlap, the edge is the near one's.
  const int near = edge_generator(crack.scene, {0, 0, 0}, {0, 0, 2}).id;
  EXPECT_EQ(
      std::ranges::count(view.edges, near, [](const MapEdge& e) { return e.line.edge; }),
      1);
  EXPECT_FALSE(view.general);
  EXPECT_TRUE(tells(view, {AccidentKind::AlongEdge,
                           {edge_generator(crack.scene, {0, 0, 0}, {0, 0, 2}),
                            edge_generator(crack.scene, {0, 1, -1}, {0, 1, 3})}}));

  // Seen a little from the right the crack opens: the sheet behind, 1 high, shows as
  // wide as the eye's line of sight shifts between the two sheets, but for the part
  // that the right sheet hides.
  const PointView open = crack.along({kSmall, -1, 0});
  EXPECT_TRUE(open.general);
  EXPECT_NE(seen(crack.scene, open, 2), nullptr);
  // From the left one sheet overlaps the other.
  const PointView shut = crack.along({-kSmall, -1, 0});
  EXPECT_TRUE(shut.general);
  EXPECT_EQ(seen(crack.scene, shut, 2), nullptr);
}

// ---- objects that touch ---------------------------------------------------------------

// Neither box hides any of the other: sight from one leaves towards +x and -y, and the
// other lies towards -x or +y.  Each has 7 corners and 9 edges, 3 of them creases; the
// common edge, a silhouette of each, is one, a contact.
TEST(PointViewCases, BoxesSharingAnEdge) {
  const Case boxes("boxes_sharing_an_edge");
  const PointView view = boxes.along(kOblique);
  EXPECT_EQ(counts(view), (MapCounts{.corners = 12,
                                     .edges = 17,
                                     .regions = 7,
                                     .components = 1,
                                     .background_pieces = 1}));
  EXPECT_EQ(edge_counts(view), (EdgeCounts{.silhouette = 10, .crease = 6, .contact = 1}));
  EXPECT_TRUE(view.general);
}

TEST(PointViewCases, BoxesSharingACorner) {
  const Case boxes("boxes_sharing_a_corner");
  const PointView view = boxes.along(kOblique);
  EXPECT_EQ(counts(view), (MapCounts{.corners = 13,
                                     .edges = 18,
                                     .regions = 7,
                                     .components = 1,
                                     .background_pieces = 1}));
  EXPECT_EQ(edge_counts(view), (EdgeCounts{.silhouette = 12, .crease = 6}));
  EXPECT_TRUE(view.general);
}

// The small box hides part of the large one's top, and stands out nowhere: its farthest
// corner (1, 2, 2) covers (0.5, 3, 1).  Two edges of its bottom are contacts.
TEST(PointViewCases, StackedBoxes) {
  const Case boxes("stacked_boxes");
  const PointView view = boxes.along(kOblique);
  EXPECT_EQ(counts(view), (MapCounts{.corners = 14,
                                     .edges = 18,
                                     .regions = 7,
                                     .components = 2,
                                     .background_pieces = 1}));
  EXPECT_EQ(edge_counts(view), (EdgeCounts{.silhouette = 10, .crease = 6, .contact = 2}));
  // 16 * 2/3 without the 1/3 + 2/3 + 2/3 that the small box takes.
  EXPECT_NEAR(boxes.seen_of(view, Top), 9, 1e-13);
  EXPECT_NEAR(boxes.seen_of(view, Front), 8. / 3, 1e-14);
  EXPECT_NEAR(boxes.seen_of(view, Right), 4. / 3, 1e-14);
  EXPECT_NEAR(boxes.seen_of(view, 6 + Top), 2. / 3, 1e-14);
  EXPECT_TRUE(view.general);
}

// The same picture where the small box reaches into the large one: two sides cut through
// its top, and three upright edges pierce it.
TEST(PointViewCases, SunkBox) {
  const Case boxes("sunk_box");
  const PointView view = boxes.along(kOblique);
  EXPECT_EQ(counts(view), (MapCounts{.corners = 11,
                                     .touches = 3,
                                     .edges = 18,
                                     .regions = 7,
                                     .components = 2,
                                     .background_pieces = 1}));
  EXPECT_EQ(edge_counts(view),
            (EdgeCounts{.silhouette = 10, .crease = 6, .crossing = 2}));
  EXPECT_NEAR(boxes.seen_of(view, Top), 9, 1e-13);
  EXPECT_TRUE(view.general);
}

// A box turned by 45 degrees stands on its edge: where that edge is seen, its lower front
// meets the ground.  In the direction (2, -6, 3), of length 7, fronts with the normals
// (0, -1, -1) and (0, -1, 1) and the end, of area 2, take 3/7, 9/7 and 4/7 of the
// picture, all before the ground of 7 x 11.
TEST(PointViewCases, BoxOnItsEdge) {
  const Case boxes("box_on_its_edge");
  const PointView view = boxes.along({2, -6, 3});
  EXPECT_EQ(counts(view), (MapCounts{.corners = 14,
                                     .edges = 18,
                                     .regions = 7,
                                     .components = 2,
                                     .background_pieces = 1}));
  EXPECT_EQ(edge_counts(view), (EdgeCounts{.silhouette = 11, .crease = 6, .contact = 1}));
  EXPECT_NEAR(boxes.seen_of(view, Top), 33 - 16. / 7, 1e-12);
  EXPECT_TRUE(view.general);
}

// Two boxes with flush tops and fronts show the map of one, with two seams.
TEST(PointViewCases, FlushBoxes) {
  const Case boxes("flush_boxes");
  const PointView view = boxes.along(kOblique);
  EXPECT_EQ(counts(view), (MapCounts{.corners = 7,
                                     .edges = 9,
                                     .regions = 4,
                                     .components = 1,
                                     .background_pieces = 1,
                                     .seams = 2}));
  EXPECT_EQ(edge_counts(view), (EdgeCounts{.silhouette = 6, .crease = 3}));
  EXPECT_EQ(view.facets.size(), 5U);
  EXPECT_NEAR(boxes.seen_of(view, Top), 2. / 3, 1e-14);
  EXPECT_NEAR(boxes.seen_of(view, 6 + Top), 4. / 3, 1e-14);
  EXPECT_EQ(seen(boxes.scene, view, Right), nullptr);
  EXPECT_EQ(boxes.index.patch_of(facet_of(boxes.scene, Top), true),
            boxes.index.patch_of(facet_of(boxes.scene, 6 + Top), true));
  EXPECT_TRUE(view.general);
}

// ---- facets that coincide -------------------------------------------------------------

// Two sheets overlap: both are seen whole, the overlap counts for each.
TEST(PointViewCases, CoincidingFacets) {
  const Case sheets("coinciding_sheets");
  const PointView view = sheets.along({0, 0, 1});
  EXPECT_EQ(counts(view), (MapCounts{.corners = 4,
                                     .edges = 4,
                                     .regions = 2,
                                     .components = 1,
                                     .background_pieces = 1,
                                     .seams = 2}));
  EXPECT_NEAR(sheets.seen_of(view, 0), 2, 1e-14);
  EXPECT_NEAR(sheets.seen_of(view, 1), 2, 1e-14);
  for (const MapRegion& region : view.regions) {
    if (region.patches.empty()) continue;
    EXPECT_EQ(region.patches.size(), 1U);
    EXPECT_EQ(region.facets.size(), 2U);
    EXPECT_NEAR(region.measure.value(), 3, 1e-14);
  }
  for (const SeenFacet& facet : view.facets) EXPECT_EQ(facet.pieces, 1);
  EXPECT_TRUE(view.general);
}

// Two boxes in one place show the map of one, with two facets in each region.
TEST(PointViewCases, TwoEqualBoxes) {
  const Case boxes("two_equal_boxes");
  const PointView view = boxes.along(kOblique);
  EXPECT_EQ(counts(view), (MapCounts{.corners = 7,
                                     .edges = 9,
                                     .regions = 4,
                                     .components = 1,
                                     .background_pieces = 1}));
  EXPECT_EQ(edge_counts(view), (EdgeCounts{.silhouette = 6, .crease = 3}));
  EXPECT_EQ(view.facets.size(), 6U);
  for (const int side : {int{Front}, 6 + Front})
    EXPECT_NEAR(boxes.seen_of(view, side), 8. / 3, 1e-14);
  EXPECT_TRUE(view.general);
}

// A sheet on the top of a box is of the top's patch; its four sides are seams.
TEST(PointViewCases, SheetOnABox) {
  const Case scene("sheet_on_box");
  const PointView view = scene.along(kOblique);
  EXPECT_EQ(counts(view), (MapCounts{.corners = 7,
                                     .edges = 9,
                                     .regions = 4,
                                     .components = 1,
                                     .background_pieces = 1,
                                     .seams = 4}));
  EXPECT_NEAR(scene.seen_of(view, Top), 32. / 3, 1e-13);
  EXPECT_NEAR(scene.seen_of(view, 6), 2. / 3, 1e-14);
  EXPECT_TRUE(view.general);
}

// From inside a box the wall at which another one touches shows two patches: the back of
// one facet and the front of the other.
TEST(PointViewCases, CoincidingPatches) {
  const Case boxes("touching_boxes");
  const PointView view = boxes.from({1, 1, 1});
  EXPECT_EQ(counts(view),
            (MapCounts{.corners = 8, .edges = 12, .regions = 6, .components = 1}));
  EXPECT_EQ(view.facets.size(), 7U);
  EXPECT_FALSE(seen(boxes.scene, view, Right)->front);
  EXPECT_TRUE(seen(boxes.scene, view, 6 + Left)->front);
  for (const int polygon : {int{Right}, 6 + Left})
    EXPECT_NEAR(boxes.seen_of(view, polygon), kSixth, 1e-14);
  int twofold = 0;
  for (const MapRegion& region : view.regions) twofold += region.patches.size() == 2;
  EXPECT_EQ(twofold, 1);
  EXPECT_NEAR(sum_of_regions(view), 4 * kPi, 1e-13);
  EXPECT_TRUE(view.general);
}

// ---- meshes ---------------------------------------------------------------------------

// Where a corner of two quads lies on the side of a third there is a seam, no vertex.
TEST(PointViewCases, TeeJunctionInAPlane) {
  const Case square("tee_flat");
  const PointView view = square.along(kOblique);
  EXPECT_EQ(counts(view), (MapCounts{.corners = 4,
                                     .edges = 4,
                                     .regions = 2,
                                     .components = 1,
                                     .background_pieces = 1,
                                     .seams = 1}));
  EXPECT_NEAR(square.seen_of(view, 0) + square.seen_of(view, 1), 8. / 3, 1e-14);
  EXPECT_TRUE(view.general);
}

// The same on a fold: one crease from end to end, though the mesh has boundaries there.
TEST(PointViewCases, TeeJunctionOnAFold) {
  const Case fold("tee_folded");
  const PointView view = fold.along(kOblique);
  EXPECT_EQ(counts(view), (MapCounts{.corners = 6,
                                     .edges = 7,
                                     .regions = 3,
                                     .components = 1,
                                     .background_pieces = 1}));
  EXPECT_EQ(edge_counts(view), (EdgeCounts{.crease = 1, .boundary = 6}));
  EXPECT_NEAR(fold.seen_of(view, 0), 4. / 3, 1e-14);
  // 2 sqrt(2), at the cosine 1 / sqrt(2).
  EXPECT_NEAR(fold.seen_of(view, 1), 2, 1e-14);
  EXPECT_TRUE(view.general);
}

// Of a box whose sides are six objects each is a sheet: its creases are contacts, its
// silhouettes are boundaries.
TEST(PointViewCases, BoxOfSheets) {
  const Case box("box_of_sheets");
  const PointView view = box.along(kOblique);
  EXPECT_EQ(counts(view), (MapCounts{.corners = 7,
                                     .edges = 9,
                                     .regions = 4,
                                     .components = 1,
                                     .background_pieces = 1}));
  EXPECT_EQ(edge_counts(view), (EdgeCounts{.boundary = 6, .contact = 3}));
  EXPECT_TRUE(view.general);
  // Within it, the eye is in no material.
  const PointView within = box.from({1, 1, 1});
  EXPECT_EQ(within.place, EyePlace::Free);
  EXPECT_EQ(edge_counts(within), (EdgeCounts{.contact = 12}));
}

// Of each sheet the half before the other is seen whole.  Of the right half of a (x = 0)
// sheet b hides what has z < 1 - y; a triangle of area 1/2 is left.  Of the left half of
// b sheet a hides z < 1 + 2 x for x > -1/2: 3/4, so that 5/4 is left.
TEST(PointViewCases, CrossingFacets) {
  const Case sheets("crossing_sheets");
  const PointView view = sheets.along(kOblique);
  // The ends of the common line touch both upper, both lower sides.  The lower side of b
  // passes behind a, the right side of a behind b; the lower right corner of a is hidden.
  EXPECT_EQ(counts(view), (MapCounts{.corners = 7,
                                     .t_vertices = 2,
                                     .touches = 2,
                                     .edges = 14,
                                     .regions = 5,
                                     .components = 1,
                                     .background_pieces = 1}));
  EXPECT_EQ(edge_counts(view), (EdgeCounts{.boundary = 13, .crossing = 1}));
  EXPECT_NEAR(sheets.seen_of(view, 0), (2 + 1. / 2) / 3, 1e-14);
  EXPECT_NEAR(sheets.seen_of(view, 1), (2 + 5. / 4) * 2 / 3, 1e-14);
  EXPECT_EQ(seen(sheets.scene, view, 0)->pieces, 2);
  EXPECT_EQ(seen(sheets.scene, view, 1)->pieces, 2);
  EXPECT_TRUE(view.general);
}

// Pages y = 0, x = y and x = 0 share the z-axis, with all of them on one side of it: a
// silhouette.  At the distance s along x from the axis page y = 0 hides the second one
// below z = 2 - s, up to s = 4/3, which leaves 4 - 16/9 of 4.  The second hides the third
// below z = 2 - 2 y / 3, which leaves a third of it.
TEST(PointViewCases, BookOfThreePages) {
  const Case book("book");
  const PointView view = book.along(kOblique);
  // The lower side of the second page comes out behind the first, the far side of the
  // third behind the second; its lower corner is hidden.
  EXPECT_EQ(counts(view), (MapCounts{.corners = 7,
                                     .t_vertices = 2,
                                     .edges = 11,
                                     .regions = 4,
                                     .components = 1,
                                     .background_pieces = 1}));
  EXPECT_EQ(edge_counts(view), (EdgeCounts{.silhouette = 1, .boundary = 10}));
  EXPECT_NEAR(book.seen_of(view, 0), 8. / 3, 1e-14);
  EXPECT_NEAR(book.seen_of(view, 1), 4 - 16. / 9, 1e-14);
  EXPECT_NEAR(book.seen_of(view, 2), 4. / 9, 1e-14);
  EXPECT_TRUE(view.general);
}

// The two sides of a sheet are two patches, with one map.
TEST(PointViewCases, SheetFromBothSides) {
  const Case sheet("sheet");
  const PointView above = sheet.along({1, -2, 2}), below = sheet.along({1, -2, -2});
  for (const PointView* view : {&above, &below}) {
    EXPECT_EQ(counts(*view), (MapCounts{.corners = 4,
                                        .edges = 4,
                                        .regions = 2,
                                        .components = 1,
                                        .background_pieces = 1}));
    EXPECT_EQ(edge_counts(*view), (EdgeCounts{.boundary = 4}));
    EXPECT_NEAR(sheet.seen_of(*view, 0), 4, 1e-14);
    EXPECT_TRUE(view->general);
  }
  EXPECT_TRUE(above.facets[0].front);
  EXPECT_FALSE(below.facets[0].front);
  EXPECT_NE(sheet.index.patch_of(0, true), sheet.index.patch_of(0, false));
  EXPECT_NE(above.structure, below.structure);
}

// Four quads are one facet with a hole; of the sheet below, the hole shows its middle.
TEST(PointViewCases, FrameWithAHole) {
  const Case frame("frame");
  const PointView view = frame.from({1.5, 1.5, 1});
  EXPECT_EQ(counts(view), (MapCounts{.corners = 8,
                                     .edges = 8,
                                     .regions = 3,
                                     .components = 2,
                                     .background_pieces = 1}));
  EXPECT_EQ(edge_counts(view), (EdgeCounts{.boundary = 8}));
  for (const MapRegion& region : view.regions) {
    // The frame has an outer and an inner boundary.
    const bool is_frame = region.facets == std::vector{facet_of(frame.scene, 0)};
    EXPECT_EQ(region.boundary.size(), is_frame ? 2U : 1U);
    for (const std::vector<int>& walk : region.boundary) EXPECT_EQ(walk.size(), 4U);
  }
  const double hole = 4 * rectangle_angle(0.5, 0.5, 1);
  EXPECT_NEAR(frame.seen_of(view, 0), 4 * rectangle_angle(1.5, 1.5, 1) - hole, 1e-14);
  EXPECT_NEAR(frame.seen_of(view, 4), hole, 1e-14);
  EXPECT_NEAR(sum_of_regions(view), 4 * kPi, 1e-13);
  EXPECT_TRUE(view.general);
}

// ---- eyes in and on the scene ---------------------------------------------------------

// Inside a room nothing is background.  Its shell is turned, so that its walls show their
// backs.
TEST(PointViewCases, EyeInARoom) {
  const Case room("room");
  const PointView view = room.from({1, 1, 1});
  EXPECT_EQ(view.place, EyePlace::Free);
  EXPECT_EQ(counts(view),
            (MapCounts{.corners = 8, .edges = 12, .regions = 6, .components = 1}));
  EXPECT_EQ(edge_counts(view), (EdgeCounts{.valley = 12}));
  ASSERT_EQ(view.facets.size(), 6U);
  for (const SeenFacet& facet : view.facets) {
    EXPECT_FALSE(facet.front);
    EXPECT_NEAR(facet.measure, kSixth, 1e-14);
  }
  EXPECT_TRUE(view.general);
}

TEST(PointViewCases, EyeInASolid) {
  const Case box("box");
  const PointView view = box.from({1, 1, 1});
  EXPECT_EQ(view.place, EyePlace::Inside);
  EXPECT_EQ(view.place_ids, std::vector{0});
  EXPECT_EQ(counts(view),
            (MapCounts{.corners = 8, .edges = 12, .regions = 6, .components = 1}));
  EXPECT_EQ(edge_counts(view), (EdgeCounts{.valley = 12}));
  ASSERT_EQ(view.facets.size(), 6U);
  for (const SeenFacet& facet : view.facets) {
    EXPECT_FALSE(facet.front);
    EXPECT_NEAR(facet.measure, kSixth, 1e-14);
  }
  EXPECT_TRUE(view.general);
}

// On the top of a box half of all directions leave freely; a sheet takes a sixth.
TEST(PointViewCases, EyeOnAFacet) {
  const Case scene("box_below_sheet");
  const PointView view = scene.from({1, 1, 0});
  EXPECT_EQ(view.place, EyePlace::Facet);
  EXPECT_EQ(view.place_ids, std::vector{facet_of(scene.scene, Top)});
  EXPECT_EQ(view.facets.size(), 1U);
  EXPECT_NEAR(scene.seen_of(view, 6), kSixth, 1e-14);
  EXPECT_EQ(view.background_pieces, 1);
  EXPECT_NEAR(sum_of_regions(view), 2 * kPi, 1e-13);
  EXPECT_FALSE(view.general);
  EXPECT_TRUE(
      tells(view, {AccidentKind::OnScene, {face_generator(facet_of(scene.scene, Top))}}));
}

// On a sheet all directions leave freely but those in it.
TEST(PointViewCases, EyeOnASheet) {
  const Case sheet("sheet");
  const PointView view = sheet.from({1, 1, 0});
  EXPECT_EQ(view.place, EyePlace::Facet);
  EXPECT_TRUE(view.facets.empty());
  EXPECT_NEAR(sum_of_regions(view), 4 * kPi, 1e-13);
  EXPECT_FALSE(view.general);
}

// On an edge of a box a quarter of all directions runs into it.
TEST(PointViewCases, EyeOnAnEdge) {
  const Case scene("box_below_sheets");
  const PointView view = scene.from({1, 0, 0});
  const Generator edge = edge_generator(scene.scene, {0, 0, 0}, {2, 0, 0});
  EXPECT_EQ(view.place, EyePlace::Edge);
  EXPECT_EQ(view.place_ids, std::vector{edge.id});
  EXPECT_EQ(view.facets.size(), 1U);
  EXPECT_NEAR(scene.seen_of(view, 6), kSixth, 1e-14);
  EXPECT_NEAR(sum_of_regions(view), 3 * kPi, 1e-13);
  EXPECT_FALSE(view.general);
  EXPECT_TRUE(tells(view, {AccidentKind::OnScene, {edge}}));
}

// On a corner an eighth does.
TEST(PointViewCases, EyeOnACorner) {
  const Case scene("box_corner_below_sheet");
  const PointView view = scene.from({0, 0, 0});
  const Generator corner = corner_generator(scene.scene, {0, 0, 0});
  EXPECT_EQ(view.place, EyePlace::Corner);
  EXPECT_EQ(view.place_ids, std::vector{corner.id});
  EXPECT_EQ(view.facets.size(), 1U);
  EXPECT_NEAR(scene.seen_of(view, 6), kSixth, 1e-14);
  EXPECT_NEAR(sum_of_regions(view), 3.5 * kPi, 1e-13);
  EXPECT_FALSE(view.general);
  EXPECT_TRUE(tells(view, {AccidentKind::OnScene, {corner}}));
}

// Between two boxes that touch all directions run into one of them.
TEST(PointViewCases, EyeBetweenBoxes) {
  const Case boxes("touching_boxes");
  const PointView view = boxes.from({2, 1, 1});
  EXPECT_EQ(view.place, EyePlace::Facet);
  std::vector<int> both{facet_of(boxes.scene, Right), facet_of(boxes.scene, 6 + Left)};
  std::ranges::sort(both);
  EXPECT_EQ(view.place_ids, both);
  EXPECT_TRUE(view.facets.empty());
  EXPECT_TRUE(view.regions.empty());
  EXPECT_FALSE(view.general);

  // On the edges of both, in their flush fronts, half of all leave freely.
  const PointView front = boxes.from({2, 0, 1});
  EXPECT_EQ(front.place, EyePlace::Edge);
  EXPECT_EQ(front.place_ids.size(), 2U);
  EXPECT_NEAR(sum_of_regions(front), 2 * kPi, 1e-13);
}

// Where a small box stands on a large one, a quarter of all directions leaves freely.
TEST(PointViewCases, EyeAtAFoot) {
  const Case boxes("stacked_boxes");
  const PointView view = boxes.from({1.5, 1, 1});
  EXPECT_EQ(view.place, EyePlace::Edge);
  EXPECT_EQ(view.place_ids,
            std::vector{edge_generator(boxes.scene, {1, 1, 1}, {2, 1, 1}).id});
  EXPECT_TRUE(view.facets.empty());
  EXPECT_NEAR(sum_of_regions(view), kPi, 1e-13);
}

// On a wall of a room both sides are air: the other walls fill one half, of which the one
// opposite is 2 away, and background the other.
TEST(PointViewCases, EyeOnARoomsWall) {
  const Case room("room");
  const PointView view = room.from({0, 1, 1});
  EXPECT_EQ(view.place, EyePlace::Facet);
  EXPECT_EQ(view.facets.size(), 5U);
  EXPECT_EQ(seen(room.scene, view, Left), nullptr);
  EXPECT_NEAR(room.seen_of(view, Right), 4 * rectangle_angle(1, 1, 2), 1e-14);
  EXPECT_EQ(view.background_pieces, 1);
  for (const MapRegion& region : view.regions) {
    if (!region.patches.empty()) continue;
    EXPECT_NEAR(region.measure.value(), 2 * kPi, 1e-13);
  }
  EXPECT_NEAR(sum_of_regions(view), 4 * kPi, 1e-13);
  EXPECT_FALSE(view.general);
}

// Within a box in the material of another it is the inner one that is seen.
TEST(PointViewCases, EyeInTwoSolids) {
  const Case boxes("nested_boxes");
  const PointView view = boxes.from({0, 0, 0});
  EXPECT_EQ(view.place, EyePlace::Inside);
  EXPECT_EQ(view.place_ids, (std::vector{0, 1}));
  EXPECT_EQ(view.facets.size(), 6U);
  for (int side = 0; side < 6; ++side)
    EXPECT_NEAR(boxes.seen_of(view, 6 + side), kSixth, 1e-14);
}

// At the height h over the middle of a square of side 2, close to it, the square's solid
// angle is 2 pi - 4 sqrt(2) h.  Below, inside the box, the sheet is not seen.
TEST(PointViewCases, EyeNearAFace) {
  const Case scene("box_below_sheet");
  const PointView above = scene.from({1, 1, 0x1p-60});
  EXPECT_EQ(above.place, EyePlace::Free);
  EXPECT_EQ(counts(above), (MapCounts{.corners = 8,
                                      .edges = 8,
                                      .regions = 3,
                                      .components = 2,
                                      .background_pieces = 1}));
  EXPECT_NEAR(scene.seen_of(above, Top), 2 * kPi, 1e-14);
  EXPECT_NEAR(scene.seen_of(above, 6), kSixth, 1e-14);
  EXPECT_TRUE(above.general);
  const SeenFacet* top = seen(scene.scene, above, Top);
  ASSERT_TRUE(top->gradient.has_value());
  EXPECT_NEAR(top->gradient->x(), 0, 1e-12);
  EXPECT_NEAR(top->gradient->y(), 0, 1e-12);
  EXPECT_NEAR(top->gradient->z(), -4 * std::numbers::sqrt2, 1e-12);
  // Of 4 atan(1 / (h sqrt(2 + h^2))) at h = 1, towards the sheet.
  EXPECT_NEAR(seen(scene.scene, above, 6)->gradient->z(), 4 / std::sqrt(3.), 1e-12);

  const PointView below = scene.from({1, 1, -0x1p-60});
  EXPECT_EQ(below.place, EyePlace::Inside);
  EXPECT_EQ(below.facets.size(), 6U);
  EXPECT_NEAR(scene.seen_of(below, Top), 2 * kPi, 1e-14);
  EXPECT_NEAR(sum_of_regions(below), 4 * kPi, 1e-13);
}

// ---- accidents ------------------------------------------------------------------------

// The lowest corner of a triangle stands on the upper side of a nearer sheet.
TEST(PointViewCases, AccidentCornerOnEdge) {
  const Case scene("corner_on_edge");
  const PointView view = scene.from({0, -2, 1});
  EXPECT_EQ(counts(view), (MapCounts{.corners = 6,
                                     .accident_vertices = 1,
                                     .edges = 8,
                                     .regions = 3,
                                     .components = 1,
                                     .background_pieces = 1}));
  ASSERT_EQ(view.accidents.size(), 1U);
  EXPECT_TRUE(tells(view, {AccidentKind::CornerOnEdge,
                           {corner_generator(scene.scene, {0, 2, -1}),
                            edge_generator(scene.scene, {-2, 0, 0}, {2, 0, 0})}}));
  EXPECT_FALSE(view.general);

  // From a little higher the triangle stands free; from a little lower its corner is
  // hidden, and its two lower sides end in T-vertices.
  const PointView above = scene.from({0, -2, 1 + kSmall});
  EXPECT_EQ(counts(above).components, 1 + 1);
  EXPECT_TRUE(above.general);
  const PointView below = scene.from({0, -2, 1 - kSmall});
  EXPECT_EQ(counts(below).t_vertices, 2);
  EXPECT_TRUE(below.general);
}

// A corner on the same side, of which one side comes out above the sheet and the other is
// hidden, is an accident vertex and no T; there is one of these farther to the right.
TEST(PointViewCases, AccidentCornerHalfHidden) {
  const Case scene("corner_half_hidden");
  const PointView view = scene.from({0, -2, 1});
  EXPECT_EQ(counts(view), (MapCounts{.corners = 5,
                                     .t_vertices = 1,
                                     .accident_vertices = 1,
                                     .edges = 8,
                                     .regions = 3,
                                     .components = 1,
                                     .background_pieces = 1}));
  ASSERT_EQ(view.accidents.size(), 1U);
  EXPECT_TRUE(tells(view, {AccidentKind::CornerOnEdge,
                           {corner_generator(scene.scene, {0, 2, -1}),
                            edge_generator(scene.scene, {-2, 0, 0}, {2, 0, 0})}}));
}

TEST(PointViewCases, AccidentCornerOnCorner) {
  const Case scene("corner_on_corner");
  const PointView view = scene.from({1, -2, 1});
  EXPECT_EQ(counts(view), (MapCounts{.corners = 4,
                                     .accident_vertices = 1,
                                     .edges = 6,
                                     .regions = 3,
                                     .components = 1,
                                     .background_pieces = 1}));
  ASSERT_EQ(view.accidents.size(), 1U);
  EXPECT_TRUE(tells(view, {AccidentKind::CornerOnCorner,
                           {corner_generator(scene.scene, {0, 0, 0}),
                            corner_generator(scene.scene, {-1, 2, -1})}}));
}

// Sides of three sheets, one behind the other, pass through one point of the picture.
TEST(PointViewCases, AccidentThreeEdges) {
  const Case scene("three_edges");
  const PointView view = scene.along({0, -1, 0});
  EXPECT_EQ(counts(view), (MapCounts{.corners = 8,
                                     .t_vertices = 2,
                                     .accident_vertices = 1,
                                     .edges = 13,
                                     .regions = 4,
                                     .components = 1,
                                     .background_pieces = 1}));
  EXPECT_NEAR(scene.seen_of(view, 0), 8, 1e-14);
  // Of the second what is right of x = 0, of the third also what is above z = 0.
  EXPECT_NEAR(scene.seen_of(view, 1), 3, 1e-14);
  EXPECT_NEAR(scene.seen_of(view, 2), 15. / 16, 1e-14);
  ASSERT_EQ(view.accidents.size(), 1U);
  EXPECT_TRUE(
      tells(view, {AccidentKind::ThreeEdges,
                   {edge_generator(scene.scene, {0, 0, -2}, {0, 0, 2}),
                    edge_generator(scene.scene, {-1, 1, 0}, {3, 1, 0}),
                    edge_generator(scene.scene, {-1.5, 2, -1.5}, {1.5, 2, 1.5})}}));
}

// The eye lies in the plane of the upper sides of two sheets.  That of the far one is
// seen where the near one ends, and ends in its corner.
TEST(PointViewCases, AccidentAlongEdge) {
  const Case scene("two_sheets");
  const PointView view = scene.from({0, -1, 0});
  EXPECT_EQ(counts(view), (MapCounts{.corners = 5,
                                     .t_vertices = 1,
                                     .accident_vertices = 1,
                                     .edges = 8,
                                     .regions = 3,
                                     .components = 1,
                                     .background_pieces = 1}));
  EXPECT_FALSE(view.general);
  EXPECT_TRUE(tells(view, {AccidentKind::AlongEdge,
                           {edge_generator(scene.scene, {-1, 0, 1}, {1, 0, 1}),
                            edge_generator(scene.scene, {1, 1, 2}, {4, 1, 2})}}));
  // Either side ends on the other.
  EXPECT_EQ(count(view, AccidentKind::AlongEdge), 1);
  EXPECT_EQ(count(view, AccidentKind::CornerOnEdge), 2);
  EXPECT_EQ(view.accidents.size(), 3U);
}

// A corner seen on a seam is none: a little to the left or to the right the structure is
// the same.
TEST(PointViewCases, CornerOnASeam) {
  const Case scene("before_a_seam");
  const PointView view = scene.from({0.5, -6, 0.75});
  EXPECT_EQ(counts(view), (MapCounts{.corners = 4 + 3,
                                     .t_vertices = 2,
                                     .edges = 5 + 5,
                                     .regions = 3,
                                     .components = 1,
                                     .background_pieces = 1,
                                     .seams = 1}));
  EXPECT_TRUE(view.accidents.empty());
  EXPECT_TRUE(view.general);
  for (const double x : {0.5 - kSmall, 0.5 + kSmall}) {
    const PointView beside = scene.from({x, -6, 0.75});
    EXPECT_TRUE(beside.general);
    EXPECT_EQ(beside.structure, view.structure);
  }
}

// Nor is an edge that is seen to pass the joint of two edges that only go straight on
// there, whatever objects they are of: the left side of the sheet passes the joint of two
// boxes' upper edges, or of a box's and of two sheets'.
TEST(PointViewCases, EdgePassingAJoint) {
  struct Passing {
    const char* scene;
    double z;
    int t_vertices;  // on the sheet's sides: two edges behind each, or three from above
  };
  for (const auto& [name, z, t_vertices] :
       {Passing{"before_a_joint", 0.75, 4}, {"before_a_joint_of_objects", 1.5, 6}}) {
    const Case scene(name);
    const PointView view = scene.from({0.5, -6, z});
    for (const double x : {0.5 - kSmall, 0.5, 0.5 + kSmall}) {
      const PointView beside = scene.from({x, -6, z});
      EXPECT_EQ(counts(beside).t_vertices, t_vertices) << name << x;
      EXPECT_EQ(counts(beside).accident_vertices, 0) << name << x;
      EXPECT_TRUE(beside.accidents.empty()) << name << x;
      EXPECT_TRUE(beside.general) << name << x;
      EXPECT_EQ(beside.structure, view.structure) << name << x;
    }
  }
}

// What no eye near by sees makes no accident.
TEST(PointViewCases, HiddenAccident) {
  const Case scene("hidden_three_edges");
  const PointView view = scene.along({0, -1, 0});
  EXPECT_EQ(counts(view), (MapCounts{.corners = 4,
                                     .edges = 4,
                                     .regions = 2,
                                     .components = 1,
                                     .background_pieces = 1}));
  EXPECT_TRUE(view.accidents.empty());
  EXPECT_TRUE(view.general);
}

// Every view of these scenes from eyes off the scene keeps V - E + F = 1 + C.
TEST(PointViewCases, EulerHoldsInAllOfThem) {
  for (const char* name : {"box",
                           "sheet_before_box",
                           "two_sheets",
                           "row_of_boxes",
                           "crack",
                           "boxes_sharing_an_edge",
                           "boxes_sharing_a_corner",
                           "stacked_boxes",
                           "flush_boxes",
                           "sheet_on_box",
                           "coinciding_sheets",
                           "tee_flat",
                           "tee_folded",
                           "crossing_sheets",
                           "sheet",
                           "frame",
                           "room",
                           "touching_boxes",
                           "box_below_sheet",
                           "box_below_sheets",
                           "box_corner_below_sheet",
                           "corner_on_edge",
                           "corner_on_corner",
                           "three_edges",
                           "hidden_three_edges"}) {
    const Case scene(name);
    for (const Point& d : {Point(1, -2, 2), Point(0, -1, 0), Point(0, 0, 1),
                           Point(1, 1, 0), Point(-1, 1, 1)}) {
      EXPECT_EQ(euler_excess(scene.along(d)), 0) << name << ": " << d.transpose();
      const PointView view = scene.from(7 * d);
      EXPECT_EQ(euler_excess(view), 0) << name << ": " << (7 * d).transpose();
      EXPECT_NEAR(sum_of_regions(view), 4 * kPi, 1e-12) << name;
    }
  }
}

}  // namespace
}  // namespace sightline
