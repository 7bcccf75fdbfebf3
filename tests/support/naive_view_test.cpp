// The naive view on cases by hand, and its laws on the seeded scenes.

#include "tests/support/naive_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <numeric>

#include "tests/support/add_box.h"
#include "tests/support/generators.h"
#include "tests/support/naive_picture.h"
#include "tests/support/view_scenes.h"

namespace sightline::testing {
namespace {

NaiveEye from(Rational x, Rational y, Rational z) {
  return {Viewpoint::Kind::Eye, {x, y, z}};
}
NaiveEye along(Rational x, Rational y, Rational z) {
  return {Viewpoint::Kind::Direction, {x, y, z}};
}

void add_rectangle(PolygonSoup& soup, double x0, double y0, double x1, double y1,
                   double z) {
  const int v = static_cast<int>(soup.vertices.size());
  soup.vertices.insert(soup.vertices.end(),
                       {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}});
  soup.groups.push_back({"sheet" + std::to_string(soup.polygons.size()),
                         {static_cast<int>(soup.polygons.size())}});
  soup.polygons.push_back({v, v + 1, v + 2, v + 3});
}

NaiveView view_of(PolygonSoup soup, const NaiveEye& eye) {
  const Scene scene(std::move(soup));
  return NaiveViewer(scene).view(eye);
}

int count(const NaiveView& view, MapVertexKind kind) {
  return static_cast<int>(std::ranges::count(view.vertices, kind, &NaiveVertex::kind));
}
int count(const NaiveView& view, MapEdgeKind kind) {
  return static_cast<int>(std::ranges::count_if(
      view.edges, [&](const NaiveEdge& e) { return e.kinds == std::vector{kind}; }));
}
void expect_euler(const NaiveView& view) {
  EXPECT_EQ(static_cast<int>(view.vertices.size() + view.regions.size()) -
                static_cast<int>(view.edges.size()),
            1 + view.components);
}

TEST(NaiveView, SquareFromADirection) {
  PolygonSoup soup;
  add_rectangle(soup, 0, 0, 3, 2, 5);
  const NaiveView view = view_of(soup, along(0, 3, 4));
  ASSERT_EQ(view.facets.size(), 1U);
  EXPECT_EQ(view.facets[0].scaled_area, "24");  // 6 times cosine 4/5 times length 5
  EXPECT_DOUBLE_EQ(view.facets[0].measure, 4.8);
  EXPECT_TRUE(view.facets[0].front);
  EXPECT_EQ(count(view, MapVertexKind::Corner), 4);
  EXPECT_EQ(count(view, MapEdgeKind::Boundary), 4);
  EXPECT_EQ(view.regions.size(), 2U);
  EXPECT_EQ(view.background_pieces, 1);
  expect_euler(view);
  EXPECT_FALSE(view_of(soup, along(0, 3, -4)).facets[0].front);
  EXPECT_TRUE(view_of(soup, along(0, 3, 0)).facets.empty());
}

TEST(NaiveView, SquareHalfHidden) {
  PolygonSoup soup;
  add_rectangle(soup, 0, 0, 4, 4, 0);
  add_rectangle(soup, -1, 1, 2, 3, 1);
  const NaiveView view = view_of(soup, along(0, 0, 1));
  ASSERT_EQ(view.facets.size(), 2U);
  EXPECT_EQ(view.facets[0].scaled_area, "12");
  EXPECT_EQ(view.facets[1].scaled_area, "6");
  EXPECT_EQ(count(view, MapVertexKind::Corner), 8);
  EXPECT_EQ(count(view, MapVertexKind::T), 2);
  EXPECT_EQ(view.vertices.size(), 10U);
  // The left side of the far one is cut in two, two sides of the near one are cut.
  EXPECT_EQ(count(view, MapEdgeKind::Boundary), 11);
  EXPECT_EQ(view.regions.size(), 3U);
  EXPECT_EQ(view.components, 1);
  expect_euler(view);
}

TEST(NaiveView, SquareInFrontOfASquareMakesTwoComponents) {
  PolygonSoup soup;
  add_rectangle(soup, 0, 0, 4, 4, 0);
  add_rectangle(soup, 1, 1, 3, 3, 1);
  const NaiveView view = view_of(soup, from(2, 2, 20));
  EXPECT_EQ(view.components, 2);
  EXPECT_EQ(view.facets[0].pieces, 1);
  EXPECT_EQ(view.regions.size(), 3U);
  expect_euler(view);
  add_rectangle(soup, -1, 1.5, 5, 2.5, 2);
  const NaiveView barred = view_of(soup, from(2, 2, 20));
  EXPECT_EQ(barred.facets[0].pieces, 2);
  EXPECT_EQ(barred.facets[1].pieces, 2);
  expect_euler(barred);
}

TEST(NaiveView, CubeFromACorner) {
  PolygonSoup soup;
  add_box(soup, "cube", {0, 0, 0}, {2, 2, 2});
  for (const NaiveEye& eye : {along(1, 1, 1), along(3, 2, 5), from(7, 6, 9)}) {
    const NaiveView view = view_of(soup, eye);
    EXPECT_EQ(view.vertices.size(), 7U);
    EXPECT_EQ(count(view, MapVertexKind::Corner), 7);
    EXPECT_EQ(view.edges.size(), 9U);
    EXPECT_EQ(count(view, MapEdgeKind::Silhouette), 6);
    EXPECT_EQ(count(view, MapEdgeKind::Crease), 3);
    EXPECT_EQ(view.regions.size(), 4U);
    expect_euler(view);
  }
  EXPECT_DOUBLE_EQ(view_of(soup, along(1, 1, 1)).facets[0].measure, 4 / std::sqrt(3.0));
}

TEST(NaiveView, CubeFromItsMiddle) {
  PolygonSoup soup;
  add_box(soup, "cube", {0, 0, 0}, {2, 2, 2});
  const NaiveView view = view_of(soup, from(1, 1, 1));
  EXPECT_EQ(view.place, EyePlace::Inside);
  EXPECT_EQ(view.place_ids, std::vector{0});
  EXPECT_EQ(view.facets.size(), 6U);
  for (const NaiveFacet& f : view.facets) {
    EXPECT_FALSE(f.front);
    EXPECT_NEAR(f.measure, 4 * std::numbers::pi / 6, 1e-15);
  }
  EXPECT_EQ(count(view, MapEdgeKind::Valley), 12);
  EXPECT_EQ(view.background_pieces, 0);
  expect_euler(view);
}

TEST(NaiveView, CrossingSquares) {
  PolygonSoup soup;
  add_rectangle(soup, -2, -2, 2, 2, 0);
  const int v = static_cast<int>(soup.vertices.size());
  soup.vertices.insert(soup.vertices.end(),
                       {{0, -1, -3}, {0, 1, -3}, {0, 1, 3}, {0, -1, 3}});
  soup.polygons.push_back({v, v + 1, v + 2, v + 3});
  soup.groups.push_back({"upright", {1}});
  const NaiveView view = view_of(soup, from(1, Rational(1, 8), 10));
  EXPECT_EQ(count(view, MapEdgeKind::Crossing), 1);
  // The crossing ends on two upright sides.
  EXPECT_EQ(count(view, MapVertexKind::Touch), 2);
  EXPECT_EQ(view.regions.size(), 3U);
  EXPECT_EQ(view.facets[0].pieces, 1);
  expect_euler(view);
}

TEST(NaiveView, OctantHasHalfPi) {
  PolygonSoup soup;
  soup.vertices = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  soup.polygons = {{0, 1, 2}};
  EXPECT_NEAR(view_of(soup, from(0, 0, 0)).facets[0].measure, std::numbers::pi / 2,
              1e-15);
}

TEST(NaiveView, FacetsThatCoincideAreBothSeen) {
  PolygonSoup soup;
  add_rectangle(soup, 0, 0, 4, 4, 0);
  add_rectangle(soup, 2, 1, 6, 3, 0);
  const NaiveView view = view_of(soup, along(0, 0, -1));
  EXPECT_EQ(view.facets[0].scaled_area, "16");
  EXPECT_EQ(view.facets[1].scaled_area, "8");
  EXPECT_EQ(view.regions.size(), 2U);
  EXPECT_EQ(view.edges.size(), 8U);
  // The near parts of the outlines that lie on the other sheet: the right side of one,
  // and three sides of the other.
  EXPECT_EQ(view.seams, 4);
  expect_euler(view);
}

TEST(NaiveView, StackedBoxesHaveOneFrontAndASeam) {
  PolygonSoup soup;
  add_box(soup, "lower", {0, 0, 0}, {2, 2, 1});
  add_box(soup, "upper", {0, 0, 1}, {2, 2, 3});
  const NaiveView view = view_of(soup, from(7, 6, 9));
  EXPECT_EQ(view.vertices.size(), 7U);
  EXPECT_EQ(view.edges.size(), 9U);
  EXPECT_EQ(view.regions.size(), 4U);
  EXPECT_EQ(view.seams, 2);
  expect_euler(view);
}

TEST(NaiveView, BoxOnABoxHasContacts) {
  PolygonSoup soup;
  add_box(soup, "slab", {-2, -2, -1}, {2, 2, 0});
  add_box(soup, "box", {-1, -1, 0}, {1, 1, 1});
  const NaiveView view = view_of(soup, from(7, 6, 9));
  EXPECT_EQ(count(view, MapEdgeKind::Contact), 2);
  expect_euler(view);
}

TEST(NaiveView, EyeOnABoxSeesTheHalfSpaceInFront) {
  PolygonSoup soup;
  add_box(soup, "slab", {-2, -2, -1}, {2, 2, 0});
  add_box(soup, "box", {1, -1, 0}, {2, 1, 1});
  const NaiveView view = view_of(soup, from(0, 0, 0));
  EXPECT_EQ(view.place, EyePlace::Facet);
  ASSERT_EQ(view.facets.size(), 1U);
  const NaiveView corner = view_of(soup, from(2, 2, 0));
  EXPECT_EQ(corner.place, EyePlace::Corner);
  EXPECT_EQ(corner.facets.size(), 1U);
  const NaiveView edge = view_of(soup, from(-2, 0, 0));
  EXPECT_EQ(edge.place, EyePlace::Edge);
}

TEST(NaiveView, AirOfARoomIsOutsideAndItsWallsAreMaterial) {
  PolygonSoup soup;
  add_box(soup, "house", {-1, -1, -1}, {5, 5, 5});
  add_box(soup, "room", {0, 0, 0}, {4, 4, 4});
  for (int f = 6; f < 12; ++f) std::swap(soup.polygons[f][1], soup.polygons[f][3]);
  const NaiveView air = view_of(soup, from(1, 2, 3));
  EXPECT_EQ(air.place, EyePlace::Free);
  EXPECT_EQ(air.facets.size(), 6U);
  const NaiveView wall = view_of(soup, from(1, 2, Rational(-1, 2)));
  EXPECT_EQ(wall.place, EyePlace::Inside);
  EXPECT_EQ(wall.place_ids, std::vector{0});
  // On the floor: the other five walls of the room, whose other side is the house.
  const NaiveView floor = view_of(soup, from(1, 2, 0));
  EXPECT_EQ(floor.place, EyePlace::Facet);
  EXPECT_EQ(floor.facets.size(), 5U);
  // A room alone: its walls have no thickness, and outside is no material either.
  soup.polygons.erase(soup.polygons.begin(), soup.polygons.begin() + 6);
  soup.groups = {{"room", {0, 1, 2, 3, 4, 5}}};
  EXPECT_EQ(view_of(soup, from(1, 2, 3)).place, EyePlace::Free);
  EXPECT_EQ(view_of(soup, from(1, 2, 9)).place, EyePlace::Free);
  EXPECT_EQ(view_of(soup, from(1, 2, 0)).facets.size(), 5U);
}

TEST(NaiveView, GeneralWhereNothingLinesUp) {
  PolygonSoup soup;
  add_rectangle(soup, 0, 0, 4, 4, 0);
  add_rectangle(soup, 1, 1, 5, 3, 1);
  const Scene scene(soup);
  const NaiveViewer viewer(scene);
  EXPECT_TRUE(viewer.general(along(1, 2, 9)));
  EXPECT_FALSE(viewer.general(along(1, 0, 1)));  // an edge over a corner's edge
  EXPECT_FALSE(viewer.general(along(1, 2, 0)));  // edge-on
}

TEST(NaiveView, AccidentsAreNotGeneralAndDoublesAre) {
  std::uint64_t seed = 0;
  int general = 0, not_general = 0;
  for (const ViewScene& each : view_scenes()) {
    const Scene scene(each.soup);
    const NaiveViewer viewer(scene);
    Random random(++seed);
    if (seed % 8 != 0) continue;
    const NaiveEye any{
        Viewpoint::Kind::Eye,
        exact(Point(random.uniform(), random.uniform(), 9 + random.uniform()))};
    EXPECT_TRUE(viewer.general(any)) << each.name;
    for (const NaiveEye& eye : view_eyes(scene, seed, 2)) {
      const bool answer = viewer.general(eye);
      ++(answer ? general : not_general);
      const NaiveView view = viewer.view(eye);
      if (count(view, MapVertexKind::Accident) > 0) {
        EXPECT_FALSE(answer) << each.name;
      }
    }
  }
  EXPECT_GT(general, 5);
  EXPECT_GT(not_general, 5);
}

/// Faces that a ray meets first in their inside; edge-on ones count as air.
std::vector<int> first_hit(const Scene& scene, const Vec3& eye, const Vec3& along) {
  std::vector<int> result;
  std::optional<Rational> nearest;
  for (int f = 0; f < static_cast<int>(scene.faces().size()); ++f) {
    const auto p = scene.face_points(f);
    const Vec3 a = exact(scene.point(p[0]));
    const Vec3 n = cross(exact(scene.point(p[1])) - a, exact(scene.point(p[2])) - a);
    const Rational ahead = dot(n, a - eye), slope = dot(n, along);
    if (ahead.sign() * slope.sign() <= 0) continue;
    const Rational t = ahead / slope;
    if (!face_holds(scene, f, eye + t * along)) continue;
    if (nearest && *nearest < t) continue;
    if (!nearest || t < *nearest) result.clear();
    nearest = t;
    result.push_back(f);
  }
  return result;
}

TEST(NaivePicture, CellsHoldWhatTheirRaysMeetFirst) {
  Random random(7);
  int rays = 0;
  for (const ViewScene& each : view_scenes()) {
    const Scene scene(each.soup);
    for (const NaiveEye& eye : view_eyes(scene, 11, 4)) {
      if (eye.kind == Viewpoint::Kind::Direction) continue;
      for (const PictureCell& cell : picture(scene, Lens(eye)).cells) {
        if (cell.blocked || !random.one_in(20)) continue;
        // Somewhere inside, so that no other cell's border is likely to be met.
        Vec3 along{};
        for (const Ray& corner : cell.cone.corners) {
          const Rational share(random.integer(1, 100));
          const auto& v = corner.near();
          along = along + share * exact(Point(v[0], v[1], v[2]));
        }
        const Ray ray(along);
        if (std::ranges::any_of(cell.cone.sides,
                                [&](const Ray& s) { return side(s, ray) <= 0; })) {
          continue;
        }
        std::vector<int> faces = cell.faces;
        std::ranges::sort(faces);
        EXPECT_EQ(faces, first_hit(scene, eye.at, along)) << each.name;
        ++rays;
      }
    }
  }
  EXPECT_GT(rays, 300);
}

/// A number of the environment, for longer runs.
int setting(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atoi(text);
}

TEST(NaiveView, LawsOnAllScenes) {
  const int eyes = setting("SIGHTLINE_VIEW_EYES", 4);
  std::map<MapVertexKind, int> vertices;
  std::map<MapEdgeKind, int> edge_kinds;
  std::map<EyePlace, int> places;
  int fit = 0;
  std::uint64_t scenes = 0;
  for (const ViewScene& each : view_scenes()) {
    const Scene scene(each.soup);
    fit += scene.faces().size() >= 10 && scene.faces().size() <= 100 ? 1 : 0;
    const NaiveViewer viewer(scene);
    int number = 0;
    for (const NaiveEye& eye : view_eyes(scene, scenes++, eyes)) {
      SCOPED_TRACE(each.name + " eye " + std::to_string(number++));
      const NaiveView view = viewer.view(eye);
      ++places[view.place];
      for (const NaiveVertex& v : view.vertices) ++vertices[v.kind];
      for (const NaiveEdge& e : view.edges) {
        for (const MapEdgeKind kind : e.kinds) ++edge_kinds[kind];
      }
      if (view.place != EyePlace::Free && view.place != EyePlace::Inside) continue;
      expect_euler(view);
      if (eye.kind == Viewpoint::Kind::Direction) continue;
      double sum = 0;
      for (const NaiveRegion& r : view.regions) sum += r.measure.value();
      EXPECT_NEAR(sum, 4 * std::numbers::pi, 1e-12);
    }
  }
  // All kinds occur.
  EXPECT_GE(fit, 60);
  EXPECT_EQ(vertices.size(), 4U);
  EXPECT_EQ(edge_kinds.size(), 6U);
  EXPECT_EQ(places.size(), 5U);
}

}  // namespace
}  // namespace sightline::testing
