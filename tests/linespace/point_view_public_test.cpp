// Scenes that other programs are publicly reported to draw or to count wrongly, each
// built anew after its report's description, with what is right found by hand.  The
// reports are issues of the named projects on GitHub.
//
// The directions (1, -2, 2) and (2, -6, 3) have the lengths 3 and 7: faces that look
// towards +x, -y, +z are seen with these shares of their areas.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "linespace/point_view.h"
#include "tests/support/add_box.h"
#include "tests/support/view_counts.h"

namespace sightline {
namespace {

using testing::add_box;
using testing::counts;
using testing::edge_counts;
using testing::edge_generator;
using testing::EdgeCounts;
using testing::MapCounts;
using testing::measure;
using testing::rectangle_angle;
using testing::seen;
using testing::sum_of_regions;

// Polygons of a box of add_box, from its first on.
enum BoxFace : int { Left, Right, Front, Back, Bottom, Top };

const Point kOblique{1, -2, 2};

/// Appends a polygon, counter-clockwise seen from its front, as a group of its own.
void add_sheet(PolygonSoup& soup, const std::string& name, std::vector<Point> corners) {
  std::vector<int> polygon;
  for (const Point& p : corners) {
    polygon.push_back(static_cast<int>(soup.vertices.size()));
    soup.vertices.push_back(p);
  }
  soup.groups.push_back({name, {static_cast<int>(soup.polygons.size())}});
  soup.polygons.push_back(std::move(polygon));
}

PointView view_along(const Scene& scene, const Point& direction) {
  return PointViewIndex(scene).view(eye_far_along(direction));
}
PointView view_from(const Scene& scene, const Point& eye) {
  return PointViewIndex(scene).view(eye_at(eye));
}

// matplotlib 3894: a green triangle above a red one is drawn below it when a blue one far
// from both is drawn together with the red one.  Seen along (7, -12, 8), from the height
// 70 the green one covers what lies at the height 50 and at (-17.5, 30) beside it: a part
// of the inside of the red one, as large as itself.
TEST(PointViewPublic, MatplotlibTrianglesOfTwoCollections) {
  const std::vector<Point> red{{-8, -56, 50}, {24, 52, 50}, {-56, 48, 50}};
  const std::vector<Point> blue{{60, -96, 50}, {88, -96, 50}, {82, -54, 50}};
  const std::vector<Point> green{{9.5, -30, 70}, {17.5, 0, 70}, {-2.5, 0, 70}};
  const double cosine = 8 / std::sqrt(257.);
  for (const std::array<int, 3>& order : {std::array{0, 1, 2}, {2, 1, 0}, {1, 2, 0}}) {
    PolygonSoup soup;
    std::array<int, 3> at{};
    for (int i = 0; i < 3; ++i) {
      at[order[i]] = i;
      add_sheet(soup, std::to_string(i), std::array{red, blue, green}[order[i]]);
    }
    const Scene scene(soup);
    const PointView view = view_along(scene, {7, -12, 8});
    EXPECT_NEAR(measure(scene, view, at[0]), (4256 - 300) * cosine, 1e-9);
    EXPECT_NEAR(measure(scene, view, at[1]), 588 * cosine, 1e-9);
    EXPECT_NEAR(measure(scene, view, at[2]), 300 * cosine, 1e-9);
    EXPECT_EQ(counts(view), (MapCounts{.corners = 9,
                                       .edges = 9,
                                       .regions = 4,
                                       .components = 3,
                                       .background_pieces = 1}));
    EXPECT_TRUE(view.general);
  }
}

// matplotlib 13728: 8 x 8 bars that touch, bar (i, j) with the height i + j, are drawn in
// the wrong order on one side of the diagonal.  Sight along (1, -2, 2) from a point at
// the distance s before the right side of its bar meets the next bar, higher by 1, if it
// gets there before it leaves that row of bars and below its top.  On a top, 1 deep, that
// is 2 s < 1 and 2 s < depth: a quarter of it.  The front of a bar stands out by 1 over
// the bar before it; there a quarter is hidden in the same way by the next bar of the row
// before.  The right sides are hidden, but for the last column, which is seen whole, and
// so is the first row's front.
TEST(PointViewPublic, MatplotlibFieldOfBars) {
  PolygonSoup soup;
  std::array<std::array<int, 8>, 8> first{};
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) {
      if (i + j == 0) continue;  // no height
      first[i][j] = static_cast<int>(soup.polygons.size());
      const std::string name = std::to_string(8 * i + j);
      add_box(soup, name.c_str(), Point(i, j, 0), Point(i + 1, j + 1, i + j));
    }
  }
  const Scene scene(soup);
  const PointView view = view_along(scene, kOblique);
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) {
      if (i + j == 0) continue;
      const auto area = [&](BoxFace side) {
        return measure(scene, view, first[i][j] + side);
      };
      EXPECT_NEAR(area(Top), (i < 7 ? 0.75 : 1) * 2 / 3, 1e-13) << i << ' ' << j;
      EXPECT_NEAR(area(Front),
                  (j == 0  ? i
                   : i < 7 ? 0.75
                           : 1) *
                      2. / 3,
                  1e-13)
          << i << ' ' << j;
      EXPECT_NEAR(area(Right), i < 7 ? 0 : (7 + j) / 3., 1e-13) << i << ' ' << j;
    }
  }
  // Seams are in the row of 7 fronts and in the column of 8 right sides.
  EXPECT_EQ(view.seams, 6 + 7);
  // 63 tops, 63 fronts, 8 right sides; nothing of any other side.
  EXPECT_EQ(view.facets.size(), 63U + 63 + 8);
  EXPECT_EQ(view.background_pieces, 1);
  EXPECT_EQ(testing::euler_excess(view), 0);
}

// three.js 6887: of a box behind a long one a triangle is drawn over the long one.  Along
// (2, -6, 3) sight from y goes up by (y - 1) / 2 to the long box's rear upper edge, of
// height 1.  It hides the front of the other box, at y = 2, below 1/2, and its right side
// below (3 - y) / 2, an area of 3/16.
TEST(PointViewPublic, ThreeJsLongBoxBeforeAnother) {
  PolygonSoup soup;
  add_box(soup, "long", {0, 0, 0}, {20, 1, 1});
  add_box(soup, "behind", {17, 2, 0}, {18, 2.5, 2});
  const Scene scene(soup);
  const PointView view = view_along(scene, {2, -6, 3});
  EXPECT_NEAR(measure(scene, view, Front), 20 * 6. / 7, 1e-12);
  EXPECT_NEAR(measure(scene, view, Top), 20 * 3. / 7, 1e-12);
  EXPECT_NEAR(measure(scene, view, Right), 2. / 7, 1e-13);
  EXPECT_NEAR(measure(scene, view, 6 + Front), 1.5 * 6 / 7, 1e-13);
  EXPECT_NEAR(measure(scene, view, 6 + Right), (1 - 3. / 16) * 2 / 7, 1e-13);
  EXPECT_NEAR(measure(scene, view, 6 + Top), 0.5 * 3 / 7, 1e-13);
  // Three upright edges of the box behind pass behind the rear edge, which they cut.
  EXPECT_EQ(counts(view), (MapCounts{.corners = 7 + 4,
                                     .t_vertices = 3,
                                     .edges = 9 + 3 + 7,
                                     .regions = 7,
                                     .components = 1,
                                     .background_pieces = 1}));
  EXPECT_EQ(edge_counts(view), (EdgeCounts{.silhouette = 9 + 4, .crease = 3 + 3}));
  const int rear = edge_generator(scene, {0, 1, 1}, {20, 1, 1}).id;
  std::set<int> upright, right;
  for (const MapVertex& v : view.vertices) {
    if (v.kind != MapVertexKind::T) continue;
    EXPECT_EQ(v.near.edge, rear);
    upright.insert(v.far.edge);
  }
  for (const Point& foot : {Point(17, 2, 0), Point(18, 2, 0), Point(18, 2.5, 0)})
    right.insert(edge_generator(scene, foot, foot + Point(0, 0, 2)).id);
  EXPECT_EQ(upright, right);
  EXPECT_TRUE(view.general);
}

// three.js 6011: voxels on a plate and on each other; triangles of the plate are drawn
// over them.  Voxel b stands beside a, and c on b.  Of a's top c hides a quarter, as the
// bars above do; b's top and a's right side are covered.  The voxels take 23/6 of the
// picture, all of it before the plate's top.
TEST(PointViewPublic, ThreeJsTouchingVoxels) {
  PolygonSoup soup;
  add_box(soup, "plate", {-1, 0, 0}, {3, 5, 1});
  add_box(soup, "a", {0, 1, 1}, {1, 2, 2});
  add_box(soup, "b", {1, 1, 1}, {2, 2, 2});
  add_box(soup, "c", {1, 1, 2}, {2, 2, 3});
  const Scene scene(soup);
  const PointView view = view_along(scene, kOblique);
  constexpr int kA = 6, kB = 12, kC = 18;
  for (const int voxel : {kA, kB, kC})
    EXPECT_NEAR(measure(scene, view, voxel + Front), 2. / 3, 1e-13);
  for (const int voxel : {kB, kC})
    EXPECT_NEAR(measure(scene, view, voxel + Right), 1. / 3, 1e-13);
  EXPECT_NEAR(measure(scene, view, kA + Top), 0.75 * 2 / 3, 1e-13);
  EXPECT_NEAR(measure(scene, view, kC + Top), 2. / 3, 1e-13);
  EXPECT_EQ(seen(scene, view, kB + Top), nullptr);
  EXPECT_EQ(seen(scene, view, kA + Right), nullptr);
  EXPECT_NEAR(measure(scene, view, Top), 20 * 2. / 3 - 23. / 6, 1e-12);
  EXPECT_NEAR(measure(scene, view, Front), 4 * 2. / 3, 1e-13);
  EXPECT_NEAR(measure(scene, view, Right), 5. / 3, 1e-13);
  EXPECT_EQ(view.facets.size(), 7U + 3);
  // Fronts of a and b, of b and c; right sides of b and c.
  EXPECT_EQ(view.seams, 3);
}

// manim 357: two squares turned by 45 degrees about the axis that they share; one is
// drawn over the other on both sides.  Each is in front on one side of the axis.
TEST(PointViewPublic, ManimCrossedSquares) {
  PolygonSoup soup;
  add_sheet(soup, "blue", {{-1, -1, -1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, -1}});
  add_sheet(soup, "green", {{-1, -1, 1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, 1}});
  const Scene scene(soup);
  const MapCounts right{.corners = 4,
                        .touches = 2,
                        .edges = 7,
                        .regions = 3,
                        .components = 1,
                        .background_pieces = 1};
  const PointView view = view_from(scene, {0, 0, 5});
  EXPECT_EQ(counts(view), right);
  EXPECT_EQ(edge_counts(view), (EdgeCounts{.boundary = 6, .crossing = 1}));
  EXPECT_NEAR(measure(scene, view, 0), measure(scene, view, 1), 1e-14);
  EXPECT_TRUE(view.general);
  for (const MapEdge& e : view.edges) {
    if (e.kind != MapEdgeKind::Crossing) continue;
    EXPECT_EQ(e.segment[0].x(), 0);
    EXPECT_EQ(std::abs(e.segment[0].y() - e.segment[1].y()), 2);
  }
  // Along the axis between them both show a rectangle of 1 x 2.
  const PointView flat = view_along(scene, {0, 0, 1});
  EXPECT_EQ(edge_counts(flat).crossing, 1);
  EXPECT_NEAR(measure(scene, flat, 0), 2, 1e-14);
  EXPECT_NEAR(measure(scene, flat, 1), 2, 1e-14);
}

// CloudCompare 2070: points on the back of a plate 1 mm thick are kept as visible.  Over
// the plate's middle its top is all that is seen, however thin the plate.
TEST(PointViewPublic, CloudCompareBackOfAThinPlate) {
  for (const double thickness : {1., 0x1p-10, 0x1p-40}) {
    PolygonSoup soup;
    add_box(soup, "plate", {0, 0, -thickness}, {100, 100, 0});
    const Scene scene(soup);
    const PointView view = view_from(scene, {50, 50, 200});
    ASSERT_EQ(view.facets.size(), 1U);
    EXPECT_NEAR(measure(scene, view, Top), 4 * rectangle_angle(50, 50, 200), 1e-14);
    EXPECT_EQ(counts(view), (MapCounts{.corners = 4,
                                       .edges = 4,
                                       .regions = 2,
                                       .components = 1,
                                       .background_pieces = 1}));
  }
}

// Open3D 3794: points of a part seen from the top are hidden as if in perspective.  From
// straight above, a tray 3 deep shows its whole floor and none of its walls; from an eye
// at the height 6 it shows both.
TEST(PointViewPublic, Open3DOrthographicView) {
  PolygonSoup soup;
  add_sheet(soup, "floor", {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  const std::array<Point, 4> around{Point(0, 0, 0), {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  for (int i = 0; i < 4; ++i) {
    const Point &a = around[i], &b = around[(i + 1) % 4], up{0, 0, 3};
    add_sheet(soup, "wall" + std::to_string(i), {a, b, b + up, a + up});
  }
  const Scene scene(soup);
  const PointView flat = view_along(scene, {0, 0, 1});
  ASSERT_EQ(flat.facets.size(), 1U);
  EXPECT_NEAR(measure(scene, flat, 0), 4, 1e-14);

  const PointView view = view_from(scene, {1, 1, 6});
  const double floor = 4 * rectangle_angle(1, 1, 6), rim = 4 * rectangle_angle(1, 1, 3);
  EXPECT_NEAR(measure(scene, view, 0), floor, 1e-14);
  for (int wall = 1; wall <= 4; ++wall)
    EXPECT_NEAR(measure(scene, view, wall), (rim - floor) / 4, 1e-14);
  EXPECT_EQ(counts(view), (MapCounts{.corners = 8,
                                     .edges = 12,
                                     .regions = 6,
                                     .components = 1,
                                     .background_pieces = 1}));
}

// IfcOpenShell 4595: shelves under shelves are missing in a plan.  Of boards that come
// forward by 1/8 each, the lower ones farther, a strip of each is seen; a board exactly
// below another is not.  The elevation has all fronts.
TEST(PointViewPublic, IfcOpenShellShelvesUnderShelves) {
  PolygonSoup soup;
  for (int k = 0; k < 4; ++k) {  // from the top down
    const std::string name = "board" + std::to_string(k);
    add_box(soup, name.c_str(), Point(0, -0.125 * k, 3 - k), Point(2, 1, 3.125 - k));
  }
  add_box(soup, "same_as_the_lowest", Point(0, -0.375, -1), Point(2, 1, -0.875));
  const Scene scene(soup);
  const PointView plan = view_along(scene, {0, 0, 1});
  EXPECT_EQ(plan.facets.size(), 4U);
  EXPECT_NEAR(measure(scene, plan, Top), 2, 1e-14);
  for (int k = 1; k < 4; ++k)
    EXPECT_NEAR(measure(scene, plan, 6 * k + Top), 2 * 0.125, 1e-14);
  EXPECT_EQ(seen(scene, plan, 24 + Top), nullptr);
  // A front edge for each board, the rear edge, and two sides of four pieces each.
  EXPECT_EQ(plan.edges.size(), 4U + 1 + 2 * 4);

  const PointView elevation = view_along(scene, {0, -1, 0});
  EXPECT_EQ(elevation.facets.size(), 5U);
  for (int k = 0; k < 5; ++k)
    EXPECT_NEAR(measure(scene, elevation, 6 * k + Front), 2 * 0.125, 1e-14);
}

// IfcOpenShell 3880: a perspective view prints no lines.  An eye that sees three sides of
// a box sees nine of its twelve edges, whole.
TEST(PointViewPublic, IfcOpenShellPerspectiveLines) {
  PolygonSoup soup;
  add_box(soup, "box", {0, 0, 0}, {2, 2, 2});
  const Scene scene(soup);
  const PointView view = view_from(scene, {5, -4, 3});
  std::set<std::array<std::array<double, 3>, 2>> lines;
  for (const MapEdge& e : view.edges) {
    std::array<std::array<double, 3>, 2> ends;
    for (int i = 0; i < 2; ++i)
      ends[i] = {e.segment[i].x(), e.segment[i].y(), e.segment[i].z()};
    if (ends[1] < ends[0]) std::swap(ends[0], ends[1]);
    lines.insert(ends);
  }
  // All but those at the corner (0, 2, 0), which is hidden.
  const std::set<std::array<std::array<double, 3>, 2>> right{
      {{{0, 0, 0}, {2, 0, 0}}}, {{{0, 0, 0}, {0, 0, 2}}}, {{{2, 0, 0}, {2, 2, 0}}},
      {{{2, 0, 0}, {2, 0, 2}}}, {{{2, 2, 0}, {2, 2, 2}}}, {{{0, 0, 2}, {2, 0, 2}}},
      {{{0, 0, 2}, {0, 2, 2}}}, {{{2, 0, 2}, {2, 2, 2}}}, {{{0, 2, 2}, {2, 2, 2}}}};
  EXPECT_EQ(lines, right);
  EXPECT_EQ(view.edges.size(), 9U);
}

// trimesh 555: which triangles does a camera see, without a ray for each pixel?  The
// triangles here have legs of a sixteenth of a pixel of 1/256, and lie where four pixels
// meet, so that no ray through the middle of a pixel finds one.  All are seen.  At a
// point at the distance r a piece of the plane z = 1 of area a has the solid angle
// a / r^3.
TEST(PointViewPublic, TrimeshTrianglesSmallerThanAPixel) {
  PolygonSoup soup;
  constexpr double kPixel = 1. / 256, kLeg = kPixel / 16;
  std::vector<Point> corners;
  for (int i = -90; i <= 90; i += 20) {
    for (int j = -120; j <= 120; j += 20) {
      corners.emplace_back(i * kPixel, j * kPixel, 1);
      const Point& p = corners.back();
      add_sheet(soup, std::to_string(corners.size()),
                {p, p + Point(kLeg, 0, 0), p + Point(0, kLeg, 0)});
    }
  }
  const Scene scene(soup);
  const PointView view = view_from(scene, {0, 0, 0});
  EXPECT_EQ(view.facets.size(), corners.size());
  EXPECT_EQ(view.components, static_cast<int>(corners.size()));
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double right = kLeg * kLeg / 2 / std::pow(corners[i].norm(), 3);
    EXPECT_NEAR(measure(scene, view, static_cast<int>(i)), right, 1e-3 * right);
  }
  EXPECT_NEAR(sum_of_regions(view), 4 * std::numbers::pi, 1e-12);
}

}  // namespace
}  // namespace sightline
