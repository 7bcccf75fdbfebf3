// The exact view from a point, on small scenes told by hand.

#include "linespace/point_view.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include "linespace/mesh_io.h"
#include "linespace/view/line_view.h"
#include "linespace/view/possibly_seen.h"
#include "linespace/view/view_graph.h"
#include "tests/support/generators.h"
#include "tests/support/view_comparison.h"
#include "tests/support/view_scenes.h"

namespace sightline {
namespace {

int count(const PointView& view, MapVertexKind kind) {
  return static_cast<int>(std::ranges::count(view.vertices, kind, &MapVertex::kind));
}

int count(const PointView& view, MapEdgeKind kind) {
  return static_cast<int>(std::ranges::count(view.edges, kind, &MapEdge::kind));
}

// V - E + F = 1 + C.
void expect_euler(const PointView& view) {
  EXPECT_EQ(static_cast<int>(view.vertices.size()) - static_cast<int>(view.edges.size()) +
                static_cast<int>(view.regions.size()),
            1 + view.components);
}

// Seen from 2^-71 before a triangle of size 1 it fills half of all directions, and not
// the other half: det(r, u, v) is smaller than what long doubles of the three keep.
TEST(PointView, ATriangleVeryNearIsHalfOfAllDirections) {
  PolygonSoup soup;
  soup.vertices = {{1.107421875, 2.1962890625, 0.52490234375},
                   {1.740478515625, 1.48779296875, 0.742919921875},
                   {1.346923828125, 1.79248046875, 1.19921875},
                   {1.47216796875, 1.40771484375, 1.146728515625},
                   {1.951416015625, 1.501953125, 1.7060546875},
                   {2.04296875, 2.63671875, 1.231201171875}};
  soup.polygons = {{0, 1, 2}, {3, 4, 5}};
  soup.groups = {{"near", {0}}, {"other", {1}}};
  const Scene scene(soup);
  const PointView view = PointViewIndex(scene).view(viewpoint(
      Viewpoint::Kind::Eye, {"18545679150323626672079/14462247353788288466944",
                             "227608610517979123155287/115697978830306307735552",
                             "12067052927967563874297/16528282690043758247936"}));
  ASSERT_FALSE(view.facets.empty());
  EXPECT_NEAR(view.facets[0].measure, 2 * std::numbers::pi, 1e-12);
  double sum = 0;
  for (const MapRegion& region : view.regions) {
    EXPECT_GT(region.measure.value(), 0);
    sum += region.measure.value();
  }
  EXPECT_NEAR(sum, 4 * std::numbers::pi, 1e-12);
}

TEST(PointView, CubeFromACorner) {
  const Scene scene(testing::boxes_soup({{{0, 0, 0}, {1, 1, 1}}}));
  const PointViewIndex index(scene);
  for (const Viewpoint& eye : {eye_far_along({1, 2, 3}), eye_at({2, 3, 4})}) {
    const PointView view = index.view(eye);
    EXPECT_EQ(view.vertices.size(), 7U);
    EXPECT_EQ(view.edges.size(), 9U);
    EXPECT_EQ(view.regions.size(), 4U);
    EXPECT_EQ(view.components, 1);
    EXPECT_EQ(view.background_pieces, 1);
    EXPECT_EQ(count(view, MapVertexKind::Corner), 7);
    EXPECT_EQ(count(view, MapEdgeKind::Silhouette), 6);
    EXPECT_EQ(count(view, MapEdgeKind::Crease), 3);
    EXPECT_EQ(view.facets.size(), 3U);
    EXPECT_TRUE(view.general);
    expect_euler(view);
  }
}

TEST(PointView, AreasOfACube) {
  const Scene scene(testing::boxes_soup({{{0, 0, 0}, {1, 1, 1}}}));
  const PointView view = PointViewIndex(scene).view(eye_far_along({1, 2, 3}));
  double sum = 0;
  for (const SeenFacet& f : view.facets) sum += f.measure;
  EXPECT_NEAR(sum, 6 / std::sqrt(14.0), 1e-15);
}

TEST(PointView, BoxBeforeAnother) {
  const Scene scene(
      testing::boxes_soup({{{0, 0, 0}, {1, 1, 1}}, {{-0.5, -3, 0.25}, {0.5, -2, 0.75}}}));
  const PointView view = PointViewIndex(scene).view(eye_at({0.1, -10, 0.4}));
  EXPECT_EQ(count(view, MapVertexKind::T), 2);
  expect_euler(view);
  double sum = 0;
  for (const MapRegion& r : view.regions) sum += *r.measure;
  EXPECT_NEAR(sum, 4 * std::numbers::pi, 1e-12);
}

TEST(PointView, BoxInARoom) {
  PolygonSoup soup =
      testing::boxes_soup({{{0, 0, 0}, {8, 8, 4}}, {{3, 3, 1}, {4, 4, 2}}});
  for (int i = 0; i < 6; ++i) std::ranges::reverse(soup.polygons[i]);
  const Scene scene(soup);
  const PointView view = PointViewIndex(scene).view(eye_at({1, 1.5, 3.25}));
  EXPECT_EQ(view.background_pieces, 0);
  EXPECT_EQ(view.components, 1);
  expect_euler(view);
  double sum = 0;
  for (const SeenFacet& f : view.facets) sum += f.measure;
  EXPECT_NEAR(sum, 4 * std::numbers::pi, 1e-12);
}

TEST(FurtherLines, HiddenEdgesOfACubeAndASeam) {
  // The three edges at the far corner.
  const Scene cube(testing::boxes_soup({{{0, 0, 0}, {1, 1, 1}}}));
  const auto hidden =
      PointViewIndex(cube).further_lines(eye_far_along({1, 2, 3}), true, true);
  ASSERT_EQ(hidden.size(), 3U);
  for (const FurtherLine& line : hidden) {
    EXPECT_EQ(line.kind, FurtherLine::Kind::Hidden);
    EXPECT_NEAR((line.segment[0] - line.segment[1]).norm(), 1, 1e-15);
    EXPECT_EQ(std::min(line.segment[0].norm(), line.segment[1].norm()), 0);
  }
  // Two boxes side by side: their tops and their fronts each are one patch.
  const Scene two(testing::boxes_soup({{{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}}));
  const auto seams = PointViewIndex(two).further_lines(eye_at({0.3, -5, 4}), true, false);
  ASSERT_EQ(seams.size(), 2U);
  for (const FurtherLine& line : seams) {
    EXPECT_EQ(line.kind, FurtherLine::Kind::Seam);
    for (const Point& p : line.segment) EXPECT_EQ(p[0], 1);
  }
}

// ---- invariance
// --------------------------------------------------------------------------

// What of a view does not depend on numbers and on the side from which it is looked at.
struct Summary {
  std::vector<int> counts;
  std::vector<double> measures;  // ascending

  explicit Summary(const PointView& view, double scale = 1) {
    for (int k = 0; k < 4; ++k)
      counts.push_back(count(view, static_cast<MapVertexKind>(k)));
    for (int k = 0; k < 6; ++k)
      counts.push_back(count(view, static_cast<MapEdgeKind>(k)));
    for (const int n :
         {static_cast<int>(view.regions.size()), view.components, view.background_pieces,
          static_cast<int>(view.general), static_cast<int>(view.facets.size()),
          static_cast<int>(view.place)}) {
      counts.push_back(n);
    }
    for (const SeenFacet& f : view.facets) measures.push_back(f.measure * scale);
    std::ranges::sort(measures);
  }
};

void expect_same(const Summary& a, const Summary& b) {
  EXPECT_EQ(a.counts, b.counts);
  ASSERT_EQ(a.measures.size(), b.measures.size());
  for (std::size_t i = 0; i < a.measures.size(); ++i) {
    EXPECT_NEAR(a.measures[i], b.measures[i], 1e-12 * a.measures[i] + 2e-15);
  }
}

Viewpoint moved(const Viewpoint& eye, const Eigen::Matrix3d& m) {
  const Point p = m * eye.at.nearest;
  return eye.kind == Viewpoint::Kind::Eye ? eye_at(p) : eye_far_along(p);
}

PolygonSoup moved(PolygonSoup soup, const Eigen::Matrix3d& m) {
  for (Point& p : soup.vertices) p = (m * p).eval();
  return soup;
}

// Calls check(soup, view, eye) for eyes with double coordinates on all scenes.
template <class Check>
void for_views(int eyes, Check&& check) {
  for (const testing::ViewScene& s : testing::view_scenes()) {
    SCOPED_TRACE(s.name);
    const Scene scene(s.soup);
    const PointViewIndex index(scene);
    for (const testing::NaiveEye& naive : testing::view_eyes(scene, 77, eyes)) {
      const Viewpoint eye = testing::viewpoint_of(naive);
      if (!eye.at.is_double[0] || !eye.at.is_double[1] || !eye.at.is_double[2]) continue;
      SCOPED_TRACE(eye.at.nearest.transpose());
      check(s.soup, index.view(eye), eye);
    }
  }
}

TEST(PointViewInvariance, AxesAndMirrors) {
  Eigen::Matrix3d turn, mirror;
  turn << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  mirror << 0, -1, 0, -1, 0, 0, 0, 0, 1;
  for_views(3, [&](const PolygonSoup& soup, const PointView& view, const Viewpoint& eye) {
    const Scene turned(moved(soup, turn));
    const PointView other = PointViewIndex(turned).view(moved(eye, turn));
    expect_same(Summary(view), Summary(other));
    EXPECT_EQ(view.structure, other.structure);
    // A mirror turns polygons inside out: they are listed the other way round.
    PolygonSoup reversed = moved(soup, mirror);
    for (auto& polygon : reversed.polygons) std::ranges::reverse(polygon);
    const Scene mirrored(reversed);
    expect_same(Summary(view),
                Summary(PointViewIndex(mirrored).view(moved(eye, mirror))));
  });
}

TEST(PointViewInvariance, PowersOfTwo) {
  for_views(2, [&](const PolygonSoup& soup, const PointView& view, const Viewpoint& eye) {
    for (const double factor : {0x1p-100, 0x1p-20, 0x1p100}) {
      const Eigen::Matrix3d m = factor * Eigen::Matrix3d::Identity();
      const Scene scaled(moved(soup, m));
      const PointView other = PointViewIndex(scaled).view(moved(eye, m));
      const bool area = eye.kind == Viewpoint::Kind::Direction;
      expect_same(Summary(view), Summary(other, area ? 1 / (factor * factor) : 1));
      EXPECT_EQ(view.structure, other.structure);
    }
  });
}

TEST(PointViewInvariance, OrderOfPolygonsAndVertices) {
  testing::Random random(5);
  for_views(2, [&](const PolygonSoup& soup, const PointView& view, const Viewpoint& eye) {
    PolygonSoup other = soup;
    // Within groups, of which names and order stay.
    for (auto& group : other.groups) {
      std::vector<int> faces = group.faces;
      random.shuffle(faces);
      for (std::size_t i = 0; i < faces.size(); ++i)
        other.polygons[group.faces[i]] = soup.polygons[faces[i]];
    }
    for (auto& polygon : other.polygons)
      std::ranges::rotate(polygon, polygon.begin() + random.integer(0, 2));
    const Scene shuffled(other);
    expect_same(Summary(view), Summary(PointViewIndex(shuffled).view(eye)));
  });
}

TEST(PointViewInvariance, PolygonsCutIntoTriangles) {
  for_views(2, [&](const PolygonSoup& soup, const PointView& view, const Viewpoint& eye) {
    const bool convex = std::ranges::none_of(
        soup.polygons, [](const std::vector<int>& p) { return p.size() > 4; });
    // Copies of a polygon are one face; cut differently, they are several.
    std::set<std::vector<int>> all;
    for (std::vector<int> p : soup.polygons) {
      std::ranges::sort(p);
      if (!all.insert(p).second) return;
    }
    if (!convex) return;
    const Scene cut(testing::cut_into_triangles(soup));
    expect_same(Summary(view), Summary(PointViewIndex(cut).view(eye)));
  });
}

// ---- windows
// ------------------------------------------------------------------------------

// A triangle, and the three over its sides and a point within.
TEST(PointViewWindow, PartsAddUpToTheWhole) {
  testing::Random random(9);
  for_views(3, [&](const PolygonSoup& soup, const PointView& view, const Viewpoint& eye) {
    if (view.place != EyePlace::Free) return;
    const Scene scene(soup);
    const PointViewIndex index(scene);
    const Point middle = 0.5 * (scene.bounds()[0] + scene.bounds()[1]);
    const double size = (scene.bounds()[1] - scene.bounds()[0]).norm();
    std::vector<Point> corners;
    for (int i = 0; i < 3; ++i) corners.push_back(middle + size * random.direction());
    const Point within = 0.2 * corners[0] + 0.3 * corners[1] + 0.5 * corners[2];
    std::map<int, double> whole, parts;
    const auto add = [&](const std::vector<Point>& window, std::map<int, double>& sums) {
      for (const SeenFacet& f : index.view_through(eye, window).facets)
        sums[f.facet] += f.measure;
    };
    add(corners, whole);
    for (int i = 0; i < 3; ++i) add({corners[i], corners[(i + 1) % 3], within}, parts);
    // The point within is rounded: a strip of an ulp may be seen on one side alone.
    for (const auto& [facet, measure] : whole) {
      EXPECT_NEAR(measure, parts[facet], 1e-11 * measure + 1e-13);
      // Never more than without a window.
      const auto f = std::ranges::find(view.facets, facet, &SeenFacet::facet);
      ASSERT_NE(f, view.facets.end());
      EXPECT_LE(measure, f->measure * (1 + 1e-12));
    }
  });
}

TEST(PointViewWindow, RoundTheWholeSceneSeesAll) {
  for_views(2, [&](const PolygonSoup& soup, const PointView& view, const Viewpoint& eye) {
    if (eye.kind != Viewpoint::Kind::Direction) return;
    const Scene scene(soup);
    const double r =
        4 * (scene.bounds()[0].cwiseAbs() + scene.bounds()[1].cwiseAbs()).sum();
    const Eigen::Vector3d u = eye.at.nearest.unitOrthogonal();
    const Eigen::Vector3d v = eye.at.nearest.normalized().cross(u);
    const std::vector<Point> window{r * u, r * v, -r * u, -r * v};
    const PointView other = PointViewIndex(scene).view_through(eye, window);
    ASSERT_EQ(view.facets.size(), other.facets.size());
    for (std::size_t i = 0; i < view.facets.size(); ++i) {
      EXPECT_EQ(view.facets[i].facet, other.facets[i].facet);
      EXPECT_EQ(view.facets[i].pieces, other.facets[i].pieces);
      EXPECT_NEAR(view.facets[i].measure, other.facets[i].measure,
                  1e-12 * view.facets[i].measure);
    }
    EXPECT_EQ(view.edges.size() + 4, other.edges.size());
    EXPECT_EQ(view.general, other.general);
  });
}

TEST(PointViewWindow, RefusesWhatIsNoWindow) {
  const Scene scene(testing::boxes_soup({{{0, 0, 0}, {1, 1, 1}}}));
  const PointViewIndex index(scene);
  const Viewpoint eye = eye_at({0.5, -5, 0.5});
  const std::vector<Point> edge_on{{0, -4, 0.5}, {1, -4, 0.5}, {1, -3, 0.5}};
  const std::vector<Point> bent{{0, 0, 0}, {1, 0, 0}, {0.1, 0, 0.1}, {0, 0, 1}};
  const std::vector<Point> two{{0, 0, 0}, {1, 0, 0}};
  for (const auto& window : {edge_on, bent, two})
    EXPECT_THROW((void)index.view_through(eye, window), InvalidInput);
}

// ---- what is left out
// ---------------------------------------------------------------------

TEST(PossiblySeen, HidesNothingThatIsSeen) {
  testing::Random random(3);
  for (const bool square : {false, true}) {
    testing::StreetCityOptions options;
    options.square = square;
    const Scene scene(testing::street_city(square ? 2 : 1, 996, options));
    const internal::ViewScene shared(scene, {});
    std::size_t left_out = 0;
    for (int i = 0; i < 12; ++i) {
      Point p(random.uniform(-20, 150), random.uniform(-20, 150),
              random.uniform(0.5, 40));
      if (i % 3 == 0) p = p.array().round();
      const Viewpoint eye = i % 4 == 1 ? eye_far_along(p) : eye_at(p);
      const internal::EyeSpace space(shared, eye);
      const internal::EyeStar star(space);
      const auto seen = internal::possibly_seen(space);
      left_out += static_cast<std::size_t>(std::ranges::count(seen, 0));
      // All faces asked: none is seen that was left out.
      const std::vector<std::uint8_t> all(scene.faces().size(), 1);
      const internal::Window window(space);
      internal::LineViewer viewer(space, star, window, all);
      std::vector<internal::LinePiece> pieces;
      for (int line = 0; line < static_cast<int>(shared.lines().size()); ++line)
        viewer.view(line, pieces);
      const internal::ViewGraph graph = join_pieces(space, star, pieces, all);
      for (const internal::FacetSides& region : graph.regions) {
        for (const int side : region) {
          if (side < 0) continue;
          const bool kept = std::ranges::any_of(scene.facets()[side / 2].faces,
                                                [&](int f) { return seen[f] != 0; });
          EXPECT_TRUE(kept) << "facet " << side / 2 << " from " << p.transpose();
        }
      }
    }
    EXPECT_GT(left_out, 12U * 200);
  }
}

TEST(PointView, DoublePrecisionAnswers) {
  Request request;
  request.precision = Precision::Double;
  for (const testing::ViewScene& s : testing::view_scenes()) {
    const Scene scene(s.soup);
    const PointViewIndex index(scene);
    for (const testing::NaiveEye& eye : testing::view_eyes(scene, 5, 4)) {
      EXPECT_NO_THROW((void)index.view(testing::viewpoint_of(eye), request)) << s.name;
    }
  }
  // Once signs of doubles led round in a circle here.
  const Scene room(read_mesh(std::string(SIGHTLINE_EXAMPLES) + "/scenes/room.obj"));
  const PointViewIndex index(room);
  const Viewpoint eye = viewpoint(Viewpoint::Kind::Eye, {"8/3", "1", "7/2"});
  EXPECT_FALSE(index.view(eye, request).facets.empty());
}

}  // namespace
}  // namespace sightline
