// Shapes of views: equal up to names, not up to mirrors.

#include "aspect/shape/map_shape.h"

#include <gtest/gtest.h>

#include <random>

#include "linespace/point_view.h"
#include "tests/support/add_box.h"
#include "tests/support/add_polygons.h"

namespace sightline {
namespace {

using internal::shape_map;
using internal::shape_of;
using internal::ShapeMap;
using testing::add_box;
using testing::add_polygons;

std::string shape_from(const PolygonSoup& soup, const Point& direction) {
  const Scene scene(soup);
  return shape_of(shape_map(PointViewIndex(scene).view(eye_far_along(direction))));
}

// The same map with vertices, edges, regions and directions of edges shuffled.
ShapeMap shuffled(const ShapeMap& map, std::mt19937& random) {
  const auto order = [&](std::size_t n) {
    std::vector<int> out(n);
    for (std::size_t i = 0; i < n; ++i) out[i] = static_cast<int>(i);
    std::ranges::shuffle(out, random);
    return out;
  };
  const auto v = order(map.vertex_kinds.size()), e = order(map.edges.size()),
             r = order(map.regions.size());
  ShapeMap out;
  out.vertex_kinds.resize(v.size());
  out.edges.resize(e.size());
  out.regions.resize(r.size());
  std::vector<int> turned(e.size());
  for (std::size_t i = 0; i < v.size(); ++i) out.vertex_kinds[v[i]] = map.vertex_kinds[i];
  for (std::size_t i = 0; i < e.size(); ++i) {
    ShapeMap::Edge edge = map.edges[i];
    for (int& end : edge.ends) end = v[end];
    turned[i] = static_cast<int>(random() % 2);
    if (turned[i] == 1) std::swap(edge.ends[0], edge.ends[1]);
    out.edges[e[i]] = edge;
  }
  for (std::size_t i = 0; i < r.size(); ++i) {
    ShapeMap::Region region = map.regions[i];
    for (auto& walk : region.boundary) {
      for (int& d : walk) d = 2 * e[d / 2] + ((d % 2) ^ turned[d / 2]);
      std::ranges::rotate(walk, walk.begin() + static_cast<long>(random() % walk.size()));
    }
    std::ranges::shuffle(region.boundary, random);
    out.regions[r[i]] = region;
  }
  return out;
}

// A box with three posts before it, two of them apart: islands and T-vertices.
PolygonSoup posts(double mirror) {
  PolygonSoup soup;
  add_box(soup, "wall", {-5, 4, 0}, {5, 5, 5});
  const double x = mirror;
  const auto post = [&](const char* name, double at, double high) {
    add_box(soup, name, {std::min(x * at, x * (at + 0.5)), 0, 1},
            {std::max(x * at, x * (at + 0.5)), 1, high});
  };
  post("a", -3, 2);
  post("b", 0, 3);
  post("c", 2, 8);
  return soup;
}

TEST(MapShape, NamesDoNotMatter) {
  std::mt19937 random(7);
  for (const Point& d :
       {Point(0.1, -1, 0.2), Point(0.7, -1, 0.9), Point(-0.3, -1, -0.8)}) {
    const Scene scene(posts(1));
    const ShapeMap map = shape_map(PointViewIndex(scene).view(eye_far_along(d)));
    EXPECT_GT(map.regions.size(), 6u);
    for (int i = 0; i < 20; ++i)
      EXPECT_EQ(shape_of(shuffled(map, random)), shape_of(map));
  }
}

TEST(MapShape, AMirrorImageIsAnotherShape) {
  const std::string shape = shape_from(posts(1), {0.1, -1, 0.2});
  EXPECT_NE(shape, shape_from(posts(-1), {-0.1, -1, 0.2}));
  // A cube from its corners: its own mirror image.
  PolygonSoup cube;
  add_box(cube, "cube", {0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(shape_from(cube, {1, 2, 3}), shape_from(cube, {-1, 2, 3}));
}

TEST(MapShape, KindsAndPlacesMatter) {
  // A square before a square, and beside it.
  const auto squares = [](double shift, double depth) {
    PolygonSoup soup;
    const Point s(shift, 0, depth);
    add_polygons(soup, "large", {{{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}}});
    add_polygons(soup, "small",
                 {{Point(1, 1, 1) + s, Point(2, 1, 1) + s, Point(2, 2, 1) + s,
                   Point(1, 2, 1) + s}});
    return soup;
  };
  const Point above(0.01, 0.02, 1);
  const std::string before = shape_from(squares(0, 0), above);
  EXPECT_EQ(shape_from(squares(3, 2), above), before);
  EXPECT_NE(shape_from(squares(20, 0), above), before);
  EXPECT_NE(shape_from(squares(8.5, 0), above), before);
  EXPECT_NE(shape_from(squares(0, 0), -above), before);
}

}  // namespace
}  // namespace sightline
