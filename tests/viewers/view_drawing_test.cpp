// Drawings of views that are written down by hand: the picture's plane and its window,
// regions with holes, and the same as SVG, pixels, VTK files, JSON and a table.

#include "viewers/pictures/view_drawing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <tuple>

#include "linespace/mesh_io.h"
#include "linespace/point_view.h"
#include "tests/support/add_box.h"
#include "tests/viewers/convex_view.h"
#include "viewers/files/view_svg.h"
#include "viewers/files/view_vtk.h"
#include "viewers/palette.h"
#include "viewers/pictures/trapezoids.h"
#include "viewers/pictures/view_image.h"
#include "viewers/queries/view_answer.h"
#include "viewers/vtk_export.h"

namespace sightline::viewers {
namespace {

namespace fs = std::filesystem;
using testing::convex_view;
using testing::plain_viewpoint;
using Kind = Viewpoint::Kind;

Scene box(const Point& low, const Point& high, const char* name = "box") {
  PolygonSoup soup;
  testing::add_box(soup, name, low, high);
  return Scene(std::move(soup));
}

Scene cube() { return box({0, 0, 0}, {1, 1, 1}); }

double area(const std::vector<PlanePoint>& ring) {
  double twice = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const PlanePoint &a = ring[i], &b = ring[(i + 1) % ring.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

double area(const std::vector<std::vector<PlanePoint>>& rings) {
  double sum = 0;
  for (const auto& ring : rings) sum += area(ring);
  return sum;
}

std::size_t occurrences(const std::string& text, const std::string& word) {
  std::size_t n = 0;
  for (std::size_t at = text.find(word); at != std::string::npos;
       at = text.find(word, at + 1)) {
    ++n;
  }
  return n;
}

/// A plan: a slab whose top has a hole where a smaller box stands on it.
PointView plan_with_hole() {
  static const Scene slab = box({0, 0, 0}, {4, 4, 1});
  PointView view = convex_view(slab, plain_viewpoint(Kind::Direction, {0, 0, 1}));
  EXPECT_EQ(view.regions.size(), 2U);
  static const Scene small = box({1, 1, 1}, {3, 2, 2});
  PointView inner = convex_view(small, view.eye);
  const int vertices = static_cast<int>(view.vertices.size());
  const int edges = static_cast<int>(view.edges.size());
  for (MapVertex v : inner.vertices) view.vertices.push_back(v);
  for (MapEdge e : inner.edges) {
    for (int& end : e.ends) end += vertices;
    e.left = 2;
    e.right = 1;
    view.edges.push_back(e);
  }
  const auto moved = [&](std::vector<int> walk) {
    for (int& half : walk) half += 2 * edges;
    return walk;
  };
  view.regions[1].boundary.push_back(moved(inner.regions[0].boundary[0]));
  view.regions.push_back({{5}, {5}, 2.0, {moved(inner.regions[1].boundary[0])}});
  return view;
}

TEST(PicturePlane, ADirectionShowsAllWithZUp) {
  const Scene scene = cube();
  const PointView view = convex_view(scene, plain_viewpoint(Kind::Direction, {1, 0, 0}));
  const PicturePlane plane(view, scene.bounds());
  EXPECT_EQ(plane.axes()[0], Point(0, 1, 0));  // seen from +x, y runs to the right
  EXPECT_EQ(plane.axes()[1], Point(0, 0, 1));
  EXPECT_EQ(plane.axes()[2], Point(-1, 0, 0));
  EXPECT_LT(plane.window().low.x(), 0);
  EXPECT_GT(plane.window().high.x(), 1);
  EXPECT_LT(plane.window().high.x(), 1.1);
}

TEST(PicturePlane, APlanHasYUp) {
  const Scene scene = cube();
  const PointView view = convex_view(scene, plain_viewpoint(Kind::Direction, {0, 0, 5}));
  const PicturePlane plane(view, scene.bounds());
  EXPECT_EQ(plane.axes()[0], Point(1, 0, 0));
  EXPECT_EQ(plane.axes()[1], Point(0, 1, 0));
}

TEST(PicturePlane, AnEyeLooksAtTheMiddleOfWhatItSees) {
  const Scene scene = cube();
  const PointView view = convex_view(scene, plain_viewpoint(Kind::Eye, {6, 5, 4}));
  const PicturePlane plane(view, scene.bounds());
  const Point to_middle = (Point(0.5, 0.5, 0.5) - Point(6, 5, 4)).normalized();
  EXPECT_GT(plane.axes()[2].dot(to_middle), 0.99);
  const PlanePoint middle = plane.window().low + plane.window().high;
  EXPECT_LT(middle.norm(), 1e-3 * (plane.window().high - plane.window().low).norm());
  for (const MapVertex& v : view.vertices) {
    const Point h = plane.homogeneous(v.at);
    EXPECT_GT(h.z(), 0);
    EXPECT_GT(h.x() / h.z(), plane.window().low.x());
    EXPECT_LT(h.y() / h.z(), plane.window().high.y());
  }
}

TEST(PicturePlane, AnEyeAmidWhatItSeesLooksAlongTheHorizontal) {
  PointView view{};
  view.eye = plain_viewpoint(Kind::Eye, {1, 1, 1});
  for (const Point& at : {Point(1, 0, 0), Point(-1, 0, 0), Point(0, 1, 0),
                          Point(0, -1, 0), Point(0, 0, 1), Point(0, 0, -1)}) {
    view.vertices.push_back({MapVertexKind::Corner, 0, {}, {}, at});
  }
  const PicturePlane plane(view, {Point(0, 0, 0), Point(2, 6, 9)});
  EXPECT_EQ(plane.axes()[2], Point(0, 1, 0));
  EXPECT_NEAR(plane.window().high.x(), 1, 1e-15);  // 90 degrees
}

TEST(PicturePlane, WishesHold) {
  const Scene scene = cube();
  const PointView view = convex_view(scene, plain_viewpoint(Kind::Eye, {6, 5, 4}));
  PictureWish wish;
  wish.towards = Point(6, 9, 4);
  wish.field_of_view = M_PI / 3;
  wish.up = Point(1, 0, 0);
  const PicturePlane plane(view, scene.bounds(), wish);
  EXPECT_EQ(plane.axes()[2], Point(0, 1, 0));
  EXPECT_EQ(plane.axes()[1], Point(1, 0, 0));
  EXPECT_NEAR(plane.window().high.y(), std::tan(M_PI / 6), 1e-15);
  wish.up = Point(0, -2, 0);
  EXPECT_THROW(PicturePlane(view, scene.bounds(), wish), InvalidInput);
  wish.up.reset();
  wish.towards = Point(6, 5, 4);
  EXPECT_THROW(PicturePlane(view, scene.bounds(), wish), InvalidInput);
}

/// An eye in the origin that looks along x through the window [-1, 1]^2.
PicturePlane ahead() {
  PointView view{};
  view.eye = plain_viewpoint(Kind::Eye, {0, 0, 0});
  PictureWish wish;
  wish.towards = Point(1, 0, 0);
  return PicturePlane(view, {Point(0, 0, 0), Point(1, 1, 1)}, wish);
}

TEST(PicturePlane, PiecesAreCutAtTheWindowAlsoFromBehindTheEye) {
  const PicturePlane plane = ahead();
  // y runs to the left.
  const auto inside = plane.clipped_piece(Point(1, 0.5, 0), Point(2, -1, 1));
  ASSERT_TRUE(inside);
  EXPECT_TRUE((*inside)[0].isApprox(PlanePoint(-0.5, 0)));
  EXPECT_TRUE((*inside)[1].isApprox(PlanePoint(0.5, 0.5)));
  const auto from_behind = plane.clipped_piece(Point(-1, 0.5, 0.5), Point(1, 0.5, 0.5));
  ASSERT_TRUE(from_behind);
  EXPECT_TRUE((*from_behind)[0].isApprox(PlanePoint(-1, 1)));
  EXPECT_TRUE((*from_behind)[1].isApprox(PlanePoint(-0.5, 0.5)));
  EXPECT_FALSE(plane.clipped_piece(Point(-1, 0.5, 0), Point(-1, -0.5, 0)));
  EXPECT_FALSE(plane.clipped_piece(Point(1, 2, 0), Point(1, 3, 0)));
}

TEST(PicturePlane, PolygonsAreCutAtTheWindow) {
  const PicturePlane plane = ahead();
  const std::vector<Point> ground{Point(9, 9, -1), Point(-9, 9, -1), Point(-9, -9, -1),
                                  Point(9, -9, -1)};
  // Below the horizon, from 1/9 on where the ground ends: 2 by 8/9.
  EXPECT_NEAR(std::abs(area(plane.clipped_polygon(ground))), 2 * 8.0 / 9, 1e-12);
  const std::vector<Point> behind{Point(-1, 1, 0), Point(-1, -1, 0), Point(-1, 0, 1)};
  EXPECT_TRUE(plane.clipped_polygon(behind).empty());
}

TEST(Trapezoids, HoldTheInsideOfRings) {
  const std::vector<std::vector<PlanePoint>> rings{{{0, 0}, {5, 1}, {4, 5}, {1, 4}},
                                                   {{1, 1}, {2, 3}, {3, 2}},
                                                   {{3, 3}, {3, 4}, {4, 3}}};
  double expected = 0;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    expected += (i == 0 ? 1 : -1) * std::abs(area(rings[i]));
  }
  const auto pieces = trapezoids(rings);
  for (const auto& piece : pieces) {
    EXPECT_GT(area(piece), 0);
    EXPECT_LE(piece.size(), 4U);
  }
  EXPECT_NEAR(area(pieces), expected, 1e-12);
  EXPECT_LE(pieces.size(), 20U);
}

TEST(Trapezoids, CoincidentSidesCancel) {
  const std::vector<PlanePoint> square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const std::vector<PlanePoint> beside{{1, 0}, {2, 0}, {2, 1}, {1, 1}};
  EXPECT_NEAR(area(trapezoids({square, beside})), 2, 1e-15);
  EXPECT_TRUE(trapezoids({square, square}).empty());
}

/// An edge seen from its lesser to its greater corner, with the facets to its left and
/// right, -1 for background.
using SeenEdge = std::tuple<int, int, MapEdgeKind, int, int>;

std::set<SeenEdge> seen_edges(const PointView& view) {
  std::set<SeenEdge> edges;
  for (const MapEdge& e : view.edges) {
    int a = view.vertices[e.ends[0]].corner, b = view.vertices[e.ends[1]].corner;
    const auto facet = [&](int region) {
      const std::vector<int>& facets = view.regions[region].facets;
      return facets.empty() ? -1 : facets[0];
    };
    int left = facet(e.left), right = facet(e.right);
    if (a > b) {
      std::swap(a, b);
      std::swap(left, right);
    }
    edges.insert({a, b, e.kind, left, right});
  }
  return edges;
}

// What the other tests write down by hand is what the library finds.
TEST(ViewDrawing, HandMadeViewsAreThoseOfTheIndex) {
  const Scene scene = box({-1, 0, 2}, {1, 3, 3});
  const PointViewIndex index(scene);
  for (const Viewpoint& eye : {eye_at({6, 5, 4}), eye_far_along({6, 5, 4}),
                               eye_at({-3, 1, 0}), eye_far_along({-1, -2, 3})}) {
    const PointView found = index.view(eye);
    const PointView made = convex_view(scene, eye);
    EXPECT_EQ(seen_edges(found), seen_edges(made));
    for (const MapVertex& v : found.vertices) {
      const auto same = std::ranges::find(made.vertices, v.corner, &MapVertex::corner);
      ASSERT_NE(same, made.vertices.end());
      EXPECT_LT((v.at - same->at).norm(), 1e-14);
    }
    // Walks have the region on the left: all that is drawn is counter-clockwise.
    double sum = 0;
    for (const DrawnRegion& region : view_drawing(scene, found).regions) {
      EXPECT_GT(area(region.rings), 0);
      sum += area(region.rings);
    }
    EXPECT_GT(sum, 0);
  }
}

TEST(ViewDrawing, ACubeFromACorner) {
  const Scene scene = cube();
  const PointView view = convex_view(scene, plain_viewpoint(Kind::Direction, {1, 1, 1}));
  ASSERT_EQ(view.vertices.size(), 7U);
  ASSERT_EQ(view.edges.size(), 9U);
  ASSERT_EQ(view.regions.size(), 4U);
  const ViewDrawing drawing = view_drawing(scene, view);
  EXPECT_EQ(drawing.edges.size(), 9U);
  EXPECT_EQ(drawing.vertices.size(), 7U);
  ASSERT_EQ(drawing.regions.size(), 3U);
  std::set<std::array<float, 3>> colours;
  for (const DrawnRegion& region : drawing.regions) {
    EXPECT_NEAR(area(region.rings), 1 / std::sqrt(3), 1e-12);  // counter-clockwise
    colours.insert({region.colour.red, region.colour.green, region.colour.blue});
  }
  EXPECT_EQ(colours.size(), 3U);
}

TEST(ViewDrawing, WhatIsOutsideOfTheWindowIsLeftOut) {
  const PointView view = plan_with_hole();
  const Scene scene = box({0, 0, 0}, {4, 4, 1});
  PictureWish wish;
  wish.window = PlaneWindow{{0.5, -1}, {2, 1.5}};
  const ViewDrawing drawing = view_drawing(scene, view, wish);
  EXPECT_EQ(drawing.edges.size(), 3U);  // one of the slab, two of the box
  EXPECT_EQ(drawing.vertices.size(), 1U);
  ASSERT_EQ(drawing.regions.size(), 2U);
  // 1.5 by 1.5 without 1 by 0.5; and that.
  EXPECT_NEAR(area(drawing.regions[0].rings), 1.75, 1e-12);
  EXPECT_NEAR(area(drawing.regions[1].rings), 0.5, 1e-12);
}

bool holds(const DrawnRegion& region, const PlanePoint& p) {
  bool inside = false;
  for (const std::vector<PlanePoint>& ring : region.rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const PlanePoint &a = ring[i], &b = ring[(i + 1) % ring.size()];
      if ((a.y() > p.y()) == (b.y() > p.y())) continue;
      const double x = a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      if (x > p.x()) inside = !inside;
    }
  }
  return inside;
}

// The same room by a z-buffer, which knows nothing of maps and windows: but for pixels on
// edges, the same facets in the same places.
TEST(ViewDrawing, APictureFromWithinAgreesWithAZBuffer) {
  constexpr int kPixels = 120;
  const Scene scene(read_mesh(std::string(SIGHTLINE_EXAMPLES) + "/scenes/room.obj"));
  Drawing faces;
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    const auto corners = scene.face_points(static_cast<int>(f));
    for (std::size_t i = 2; i < corners.size(); ++i) {
      faces.triangles.push_back({{scene.point(corners[0]), scene.point(corners[i - 1]),
                                  scene.point(corners[i])},
                                 {1, 1, 1},
                                 false,
                                 scene.faces()[f].facet});
    }
  }
  const PointViewIndex index(scene);
  PictureWish wish;
  wish.up = Point(0, 1, 0);
  wish.field_of_view = 1.9;
  for (const auto& [eye, at] : {std::pair(Point(5, 1.6, 4), Point(1, 1, 1)),
                                {Point(0.7, 2.1, 0.9), Point(4, 0.2, 3.1)}}) {
    wish.towards = at;
    const PointView view = index.view(eye_at(eye));
    const ViewDrawing drawing = view_drawing(scene, view, wish);
    const std::vector<int> ids =
        visible_ids(faces, {eye, at, *wish.up, *wish.field_of_view}, kPixels, kPixels);
    const double reach = std::tan(*wish.field_of_view / 2);
    int different = 0;
    for (int i = 0; i < kPixels * kPixels; ++i) {
      const PlanePoint p(reach * ((i % kPixels + 0.5) * 2 / kPixels - 1),
                         reach * (1 - (i / kPixels + 0.5) * 2 / kPixels));
      int found = 0, right = 0;
      for (const DrawnRegion& region : drawing.regions) {
        if (!holds(region, p)) continue;
        ++found;
        right += static_cast<int>(
            std::ranges::count(view.regions[region.region].facets, ids[i]));
      }
      EXPECT_LE(found, 1);
      if (ids[i] < 0 ? found != 0 : right != 1) ++different;
    }
    EXPECT_LE(different, 5) << "of " << kPixels * kPixels;
  }
}

TEST(ViewSvg, IsWellFormedAndHoldsEachLineOnce) {
  const Scene scene = box({0, 0, 0}, {1, 1, 1}, "a<b>&\"c\xFC");
  const PointView view = convex_view(scene, plain_viewpoint(Kind::Eye, {6, 5, 4}));
  const std::string svg = view_svg(scene, view, view_drawing(scene, view));
  EXPECT_EQ(occurrences(svg, "<path class=\"patch\""), 3U);
  EXPECT_EQ(occurrences(svg, "<line class=\"silhouette\""), 6U);
  EXPECT_EQ(occurrences(svg, "<line class=\"crease\""), 3U);
  EXPECT_EQ(occurrences(svg, "<circle class=\"corner\""), 7U);
  EXPECT_EQ(occurrences(svg, "<title>"), 3U + 9U + 7U);
  for (int e = 0; e < 9; ++e) {
    EXPECT_EQ(occurrences(svg, "data-edge=\"" + std::to_string(e) + "\""), 1U);
  }
  EXPECT_EQ(occurrences(svg, "data-object=\"a&lt;b&gt;&amp;&quot;c\\xFC\""), 3U);
  // Elements that are opened are closed, and no bare & is left.
  for (const std::string element : {"path", "line", "circle", "g", "svg", "title"}) {
    EXPECT_EQ(
        occurrences(svg, "<" + element + " ") + occurrences(svg, "<" + element + ">"),
        occurrences(svg, "</" + element + ">"))
        << element;
  }
  EXPECT_EQ(occurrences(svg, "&"), 4U * 2 * 3);
}

TEST(ViewImage, HolesShowWhatIsInThemAndTheWindowIsFilled) {
  const PointView view = plan_with_hole();
  const Scene scene = box({0, 0, 0}, {4, 4, 1});
  PictureWish wish;
  wish.window = PlaneWindow{{-1, -1}, {5, 3}};
  const ViewDrawing drawing = view_drawing(scene, view, wish);
  const Image image = view_image(drawing, view, 300);
  EXPECT_EQ(image.width, 300);
  EXPECT_EQ(image.height, 200);
  const auto colour_at = [&](double x, double y) {
    const int column = static_cast<int>((x + 1) * 50),
              row = static_cast<int>((3 - y) * 50);
    const std::uint8_t* c = image.rgb.data() + 3 * (row * 300 + column);
    return hex({c[0] / 255.0F, c[1] / 255.0F, c[2] / 255.0F});
  };
  const std::string slab = hex(drawing.regions[0].colour);
  EXPECT_EQ(colour_at(0.5, 0.5), slab);
  EXPECT_EQ(colour_at(3.5, 2.5), slab);
  EXPECT_EQ(colour_at(2, 1.5), hex(drawing.regions[1].colour));
  EXPECT_EQ(colour_at(-0.5, 0.5), hex(kPaper));
  EXPECT_EQ(colour_at(4.5, 2.9), hex(kPaper));
  // The line along x = 0 is dark.
  EXPECT_LT(image.rgb[3 * (100 * 300 + 50)], 160);
}

TEST(ViewAnswer, HasTheKeysOfTheContract) {
  const Scene scene = cube();
  const PointView view = convex_view(scene, plain_viewpoint(Kind::Direction, {1, 1, 1}));
  const ViewQuestion question{view.eye, {"1", "1", "2/2"}, ""};
  const Json j = view_json(scene, question, view, true);
  EXPECT_EQ(j["direction"].dump(), R"([1.0,1.0,"2/2"])");
  EXPECT_EQ(j["eye"], "free");
  EXPECT_EQ(j["ids"], Json::array());
  EXPECT_EQ(j["corners"], 7);
  EXPECT_EQ(j["t_vertices"], 0);
  EXPECT_EQ(j["touches"], 0);
  EXPECT_EQ(j["accident_vertices"], 0);
  EXPECT_EQ(j["edges"], 9);
  EXPECT_EQ(j["regions"], 4);
  EXPECT_EQ(j["components"], 1);
  EXPECT_EQ(j["background_pieces"], 1);
  EXPECT_EQ(j["seams"], 0);
  EXPECT_EQ(j["general"], true);
  EXPECT_EQ(j["accidents"], Json::array());
  EXPECT_EQ(j["structure"], "one convex solid");
  ASSERT_EQ(j["facets"].size(), 3U);
  EXPECT_EQ(j["facets"][0]["object"], "box");
  EXPECT_EQ(j["facets"][0]["faces"].size(), 1U);
  EXPECT_EQ(j["facets"][0]["area"], 1.0);
  EXPECT_FALSE(j["facets"][0].contains("solid_angle"));
  EXPECT_TRUE(j["facets"][0]["gradient"].is_null());
  const Json& map = j["map"];
  EXPECT_EQ(map["vertices"].size(), 7U);
  EXPECT_EQ(map["edges"].size(), 9U);
  EXPECT_EQ(map["vertices"][0]["kind"], "corner");
  EXPECT_TRUE(map["vertices"][0]["corner"].is_number());
  const Json& background = map["regions"][0];
  EXPECT_TRUE(background["patch"].is_null());
  EXPECT_TRUE(background["area"].is_null());
  EXPECT_EQ(background["boundary"][0].size(), 6U);
  for (const Json& e : background["boundary"][0]) {
    EXPECT_EQ(map["edges"][e.get<int>()]["kind"], "silhouette");
    EXPECT_EQ(map["edges"][e.get<int>()]["right"], 0);
  }
  EXPECT_FALSE(view_json(scene, question, view, false).contains("map"));
}

TEST(ViewAnswer, TellsTheOtherKinds) {
  const Scene scene = cube();
  PointView view = convex_view(scene, plain_viewpoint(Kind::Eye, {6, 5, 4}));
  view.place = EyePlace::Edge;
  view.place_ids = {3, 4};
  view.general = false;
  view.structure.clear();
  view.accidents.push_back({AccidentKind::CornerOnEdge,
                            {{GeneratorKind::Vertex, 2}, {GeneratorKind::Edge, 5}}});
  view.facets[1].gradient = Point(1, -2, 0.5);
  view.facets[2].front = false;
  view.regions[1].patches = {7, 9};
  view.vertices.push_back(
      {MapVertexKind::T, -1, {4, {-1, -1}}, {-1, {0, 2}}, Point(1, 0, 0)});
  view.vertices.push_back({MapVertexKind::Accident, -1, {}, {}, Point(0, 1, 0)});
  const Json j = view_json(scene, {view.eye, {"6", "5", "4"}, ""}, view, true);
  EXPECT_EQ(j["from"].dump(), "[6.0,5.0,4.0]");
  EXPECT_EQ(j["eye"], "edge");
  EXPECT_EQ(j["ids"].dump(), "[3,4]");
  EXPECT_TRUE(j["structure"].is_null());
  EXPECT_EQ(j["accidents"][0]["kind"], "corner_on_edge");
  EXPECT_EQ(j["accidents"][0]["generators"][1]["type"], "edge");
  EXPECT_EQ(j["facets"][1]["gradient"].dump(), "[1.0,-2.0,0.5]");
  EXPECT_EQ(j["facets"][2]["front"], false);
  EXPECT_EQ(j["facets"][0]["solid_angle"], 1.0);
  EXPECT_EQ(j["t_vertices"], 1);
  EXPECT_EQ(j["accident_vertices"], 1);
  EXPECT_EQ(j["map"]["regions"][1]["patch"].dump(), "[7,9]");
  EXPECT_EQ(j["map"]["regions"][2]["patch"], view.regions[2].patches[0]);
  EXPECT_EQ(j["map"]["vertices"][7]["near"], 4);
  EXPECT_EQ(j["map"]["vertices"][7]["far"].dump(), R"({"facets":[0,2]})");
}

TEST(ViewCsv, ARowForEachFacet) {
  const Scene scene = box({0, 0, 0}, {1, 1, 1}, "a \"b\", c");
  PointView view = convex_view(scene, plain_viewpoint(Kind::Eye, {6, 5, 4}));
  view.facets[0].gradient = Point(1, -2, 0.5);
  const std::string csv = view_csv(scene, 7, view);
  EXPECT_EQ(occurrences(csv, "\n"), 3U);
  const std::string first = csv.substr(0, csv.find('\n'));
  EXPECT_EQ(first, "7," + std::to_string(view.facets[0].facet) + ",\"a \"\"b\"\", c\"," +
                       std::to_string(polygons_of(scene, view.facets[0].facet)[0]) +
                       ",true,1,1,,1,-2,0.5");
  const std::string head(kViewCsvHead);
  EXPECT_EQ(occurrences(head, ","), occurrences(first, ",") - 1);  // one in the name
}

class ViewVtk : public ::testing::Test {
 protected:
  ViewVtk() {
    std::string pattern = (fs::temp_directory_path() / "sightline-vtk-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~ViewVtk() override { fs::remove_all(folder_); }

  std::vector<std::string> write(const Scene& scene, const PointView& view,
                                 const ViewDrawing& drawing) const {
    VtkViews files(folder_, scene);
    files.add(view, drawing);
    return files.finish();
  }

  fs::path folder_;
};

TEST_F(ViewVtk, RegionsLieOnTheirFacets) {
  const Scene scene = cube();
  for (const Kind kind : {Kind::Eye, Kind::Direction}) {
    const PointView view = convex_view(scene, plain_viewpoint(kind, {6, 5, 4}));
    const ViewDrawing drawing = view_drawing(scene, view);
    const std::vector<std::string> files = write(scene, view, drawing);
    for (const std::string& file : files) {
      EXPECT_TRUE(fs::exists(folder_ / file)) << file;
    }
    const VtkPicture regions = read_vtk(folder_ / "view0_regions.vtp");
    ASSERT_EQ(regions.veils.size(), 6U);  // two triangles a face
    for (const VeilTriangle& veil : regions.veils) {
      bool on_a_face = false;
      for (int axis = 0; axis < 3; ++axis) {
        on_a_face |= std::ranges::all_of(
            veil.points, [&](const Point& p) { return std::abs(p[axis] - 1) < 1e-12; });
      }
      EXPECT_TRUE(on_a_face);
    }
    EXPECT_EQ(read_vtk(folder_ / "view0_edges.vtp").strokes.size(), 9U);
    const VtkPicture picture = read_vtk(folder_ / "view0_picture_edges.vtp");
    EXPECT_EQ(picture.strokes.size(), 9U);
    for (const Stroke& s : picture.strokes) EXPECT_EQ(s.points[0].z(), 0);
    // The index holds what lies in space: the six triangles and the nine lines.
    const VtkPicture all = read_vtk(folder_ / "sightline.vtm");
    EXPECT_EQ(all.veils.size(), 6U);
    EXPECT_EQ(all.strokes.size(), 9U);
  }
}

/// Of the triangle, as the eye in the origin sees it (van Oosterom and Strackee 1983).
double solid_angle(const Point& a, const Point& b, const Point& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return std::abs(2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc +
                                                        b.dot(c) * la + c.dot(a) * lb));
}

// The polygons of a room cover what the measures say, holes and all.
TEST_F(ViewVtk, RegionsCoverWhatIsSeen) {
  const Scene scene(read_mesh(std::string(SIGHTLINE_EXAMPLES) + "/scenes/room.obj"));
  const PointViewIndex index(scene);
  const Point eye(5, 1.6, 4);
  const PointView from = index.view(eye_at(eye)),
                  far = index.view(eye_far_along({1, 2, 3}));
  const ViewDrawing near_drawing = view_drawing(scene, from);
  const ViewDrawing far_drawing = view_drawing(scene, far);
  VtkViews files(folder_, scene);
  files.add(from, near_drawing);
  files.add(far, far_drawing);
  files.finish();
  double expected = 0, sum = 0;
  for (const MapRegion& r : from.regions) expected += r.patches.empty() ? 0 : *r.measure;
  for (const VeilTriangle& veil : read_vtk(folder_ / "view0_regions.vtp").veils) {
    const auto& [a, b, c] = veil.points;
    sum += solid_angle(a - eye, b - eye, c - eye);
    EXPECT_GE((b - a).cross(c - a).dot(eye - a), -1e-15);  // counter-clockwise
  }
  EXPECT_NEAR(sum, expected, 1e-9);
  expected = sum = 0;
  for (const MapRegion& r : far.regions) expected += r.patches.empty() ? 0 : *r.measure;
  for (const VeilTriangle& veil : read_vtk(folder_ / "view1_picture_regions.vtp").veils) {
    const auto& [a, b, c] = veil.points;
    sum += (b - a).cross(c - a).norm() / 2;
  }
  EXPECT_NEAR(sum, expected, 1e-9);
}

// An eye inside a cube sees the backs of its faces: each is one polygon, turned to it.
TEST_F(ViewVtk, BacksAreTurnedToTheEye) {
  const Scene scene = cube();
  const Point eye(0.3, 0.4, 0.55);
  const PointView view = PointViewIndex(scene).view(eye_at(eye));
  const ViewDrawing drawing = view_drawing(scene, view);
  write(scene, view, drawing);
  const VtkPicture regions = read_vtk(folder_ / "view0_regions.vtp");
  EXPECT_EQ(regions.veils.size(), 12U);
  double sum = 0;
  for (const VeilTriangle& veil : regions.veils) {
    const auto& [a, b, c] = veil.points;
    EXPECT_GT((b - a).cross(c - a).dot(eye - a), 0);
    sum += solid_angle(a - eye, b - eye, c - eye);
  }
  EXPECT_NEAR(sum, 4 * M_PI, 1e-12);
}

// What of a run is never finished takes no name, and waits for it in the folder.
TEST_F(ViewVtk, FilesGetTheirNamesAtTheEnd) {
  const Scene scene = cube();
  const PointView view = convex_view(scene, plain_viewpoint(Kind::Eye, {6, 5, 4}));
  const ViewDrawing drawing = view_drawing(scene, view);
  {
    VtkViews files(folder_, scene);
    files.add(view, drawing);
    EXPECT_FALSE(fs::exists(folder_ / "view0_regions.vtp"));
    EXPECT_FALSE(fs::is_empty(folder_));
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(ViewVtk, ARegionWithAHoleIsCut) {
  const PointView view = plan_with_hole();
  const Scene scene = box({0, 0, 0}, {4, 4, 1});
  const ViewDrawing drawing = view_drawing(scene, view);
  write(scene, view, drawing);
  for (const char* name : {"view0_regions.vtp", "view0_picture_regions.vtp"}) {
    double sum = 0;
    for (const VeilTriangle& veil : read_vtk(folder_ / name).veils) {
      const auto& [a, b, c] = veil.points;
      sum += (b - a).cross(c - a).norm() / 2;
    }
    EXPECT_NEAR(sum, 16, 1e-9) << name;
  }
}

}  // namespace
}  // namespace sightline::viewers
