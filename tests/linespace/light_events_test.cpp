// Events of a source: their traces on receivers, against exact views from the receivers.

#include "linespace/light/light_events.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "linespace/mesh_io.h"
#include "tests/support/add_box.h"
#include "tests/support/generators.h"
#include "tests/support/light_crossings.h"

namespace sightline {
namespace {

using internal::light_events;
using internal::LightEventKind;
using internal::LightEvents;
using internal::LightEventsRequest;
using internal::LightSpace;
using internal::LightTrace;

void add_polygon(PolygonSoup& soup, const std::string& name, std::vector<Point> corners) {
  const int v = static_cast<int>(soup.vertices.size());
  std::vector<int> polygon;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    soup.vertices.push_back(corners[i]);
    polygon.push_back(v + static_cast<int>(i));
  }
  soup.polygons.push_back(polygon);
  soup.groups.push_back({name, {static_cast<int>(soup.polygons.size()) - 1}});
}

// A rectangle in the plane at height z, front up or down.
void add_rectangle(PolygonSoup& soup, const std::string& name, double x0, double y0,
                   double x1, double y1, double z, bool up) {
  std::vector<Point> c{{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
  if (!up) std::ranges::reverse(c);
  add_polygon(soup, name, c);
}

/// A scene with a source of one facet, or of one plane, and a receiver.  The window is
/// convex and holds the source; without one the source is convex itself.
struct Lit {
  explicit Lit(PolygonSoup soup, const std::string& light = "light",
               const std::string& floor = "floor", const std::vector<Point>& window = {})
      : scene(std::move(soup)), space(scene), index(scene) {
    request.source_faces = scene.faces_named(light);
    events = light_events(space, request);
    const int face = request.source_faces[0];
    if (window.empty()) {
      for (const int p : scene.face_points(face)) source.push_back(scene.point(p));
    } else {
      source = window;
    }
    for (const int f : request.source_faces) {
      source_facets.push_back(scene.faces()[f].facet);
    }
    floor_facet = scene.faces()[scene.faces_named(floor)[0]].facet;
    // Lines that are told run from the source to the receiver with nothing between.
    EXPECT_EQ(testing::wrong_pieces(space, events), 0)
        << scene.faces().size() << " faces";
  }
  [[nodiscard]] std::string structure(const Point& p) const {
    return testing::seen_structure(index, scene, source, source_facets, floor_facet, p);
  }
  [[nodiscard]] std::map<LightEventKind, int> pieces_on_floor() const {
    std::map<LightEventKind, int> out;
    for (const LightTrace& t : events.traces) {
      for (const auto& piece : t.pieces) {
        if (scene.faces()[piece.face].facet == floor_facet) ++out[t.kind];
      }
    }
    return out;
  }

  Scene scene;
  LightSpace space;
  PointViewIndex index;
  LightEventsRequest request;
  LightEvents events;
  std::vector<Point> source;
  std::vector<int> source_facets;
  int floor_facet;
};

/// Along the segment the structure changes only where some trace is crossed.  Adds to
/// `changes` how often it does.
void expect_complete(const Lit& lit, const Point& p, const Point& q, int& changes) {
  std::vector<double> at =
      testing::light_crossings(lit.space, lit.events, lit.floor_facet, p, q);
  const std::vector<double> feet =
      testing::foot_crossings(lit.scene, lit.floor_facet, p, q);
  at.insert(at.end(), feet.begin(), feet.end());
  at.push_back(0.0);
  at.push_back(1.0);
  std::ranges::sort(at);
  std::string before;
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    if (at[i + 1] - at[i] < 1e-6) continue;
    std::set<std::string> found;
    for (const double share : {0.001, 0.2, 0.4, 0.6, 0.8, 0.999}) {
      const double u = at[i] + share * (at[i + 1] - at[i]);
      found.insert(lit.structure(p + u * (q - p)));
    }
    EXPECT_EQ(found.size(), 1U) << "between " << at[i] << " and " << at[i + 1] << " of ("
                                << p.transpose() << ") to (" << q.transpose()
                                << "): " << *found.begin() << " and " << *found.rbegin();
    if (!before.empty() && before != *found.begin()) ++changes;
    before = *found.begin();
  }
}

int expect_complete_along(const Lit& lit, int count, unsigned seed, double x0, double y0,
                          double x1, double y1, double z = 0) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> x(x0, x1);
  std::uniform_real_distribution<double> y(y0, y1);
  int changes = 0;
  for (int i = 0; i < count; ++i) {
    const Point p{x(random), y(random), z};
    const Point q{x(random), y(random), z};
    expect_complete(lit, p, q, changes);
  }
  return changes;
}

PolygonSoup plate_scene() {
  PolygonSoup soup;
  add_rectangle(soup, "light", -1, -1, 1, 1, 4, false);
  add_rectangle(soup, "plate", -0.5, -0.5, 0.5, 0.5, 2, true);
  add_rectangle(soup, "floor", -8, -8, 8, 8, 0, true);
  return soup;
}

TEST(LightEvents, PlateUnderASquareLight) {
  const Lit lit(plate_scene());
  // Each corner of one over each side of the other; all in line with parallel sides.
  EXPECT_EQ(lit.events.traces.size(), 32U);
  EXPECT_EQ(lit.pieces_on_floor(), (std::map{std::pair(LightEventKind::EE, 32)}));
  EXPECT_GT(expect_complete_along(lit, 20, 1, -4, -4, 4, 4), 20);
}

TEST(LightEvents, TurnedPlate) {
  PolygonSoup soup;
  add_rectangle(soup, "light", -1, -1, 1, 1, 4, false);
  add_polygon(soup, "plate", {{-0.5, -0.25, 2}, {0.375, -0.5, 2.25}, {0.5, 0.5, 1.75}});
  add_rectangle(soup, "floor", -8, -8, 8, 8, 0, true);
  const Lit lit(soup);
  EXPECT_GT(expect_complete_along(lit, 20, 2, -4, -4, 4, 4), 20);
}

TEST(LightEvents, BoxesOnAFloor) {
  PolygonSoup soup;
  add_rectangle(soup, "light", -1, -1, 1, 1, 6, false);
  testing::add_box(soup, "a", {0.5, 0.25, 0}, {1.5, 1.75, 2});
  testing::add_box(soup, "b", {-2, -1.5, 0}, {-0.75, 0.5, 3});
  add_rectangle(soup, "floor", -8, -8, 8, 8, 0, true);
  const Lit lit(soup);
  EXPECT_GT(expect_complete_along(lit, 20, 3, -6, -6, 6, 6), 20);
}

void add_turned_box(PolygonSoup& soup, const char* name, const Point& centre,
                    const Point& size, double angle) {
  const std::size_t first = soup.vertices.size();
  testing::add_box(soup, name, -0.5 * size, 0.5 * size);
  for (std::size_t i = first; i < soup.vertices.size(); ++i) {
    Point& p = soup.vertices[i];
    p = Point(std::cos(angle) * p.x() - std::sin(angle) * p.y(),
              std::sin(angle) * p.x() + std::cos(angle) * p.y(), p.z()) +
        centre;
  }
}

TEST(LightEvents, TurnedBoxes) {
  int changes = 0;
  for (int scene = 0; scene < 6; ++scene) {
    std::mt19937 random(40 + scene);
    std::uniform_real_distribution<double> u(-1, 1);
    PolygonSoup soup;
    add_rectangle(soup, "light", -1, -1, 1, 1, 6, false);
    for (int i = 0; i < 3; ++i) {
      // Bottoms on the floor exactly: heights are powers of two.
      const double height = i == 0 ? 2 : i == 1 ? 1 : 4;
      add_turned_box(soup, ("b" + std::to_string(i)).c_str(),
                     {2.0 * i - 2 + 0.3 * u(random), 1.5 * u(random), height / 2},
                     {1 + 0.3 * u(random), 1 + 0.3 * u(random), height}, u(random));
    }
    add_rectangle(soup, "floor", -12, -12, 12, 12, 0, true);
    const Lit lit(soup);
    changes += expect_complete_along(lit, 8, 400 + scene, -8, -8, 8, 8);
  }
  EXPECT_GT(changes, 150);
}

// The same light, in the plane of its ceiling: as a hole's filling, as a part of the
// ceiling's own facet, laid on it, with the ceiling a box; recessed in a hole.
void add_ceiling_with_hole(PolygonSoup& soup, const std::string& name, double z) {
  add_rectangle(soup, name + "0", -8, -8, 8, -1, z, false);
  add_rectangle(soup, name + "1", -8, 1, 8, 8, z, false);
  add_rectangle(soup, name + "2", -8, -1, -1, 1, z, false);
  add_rectangle(soup, name + "3", 1, -1, 8, 1, z, false);
}

void add_blockers(PolygonSoup& soup) {
  add_polygon(soup, "plate", {{-0.5, -0.25, 2}, {0.375, -0.5, 2.25}, {0.5, 0.5, 1.75}});
  testing::add_box(soup, "a", {0.5, 0.25, 0}, {1.5, 1.75, 1});
  add_turned_box(soup, "b", {-1.5, 0.25, 1}, {1, 0.75, 2}, 0.3);
  add_rectangle(soup, "floor", -8, -8, 8, 8, 0, true);
}

TEST(LightEvents, WhereverTheLightLies) {
  std::vector<PolygonSoup> soups(6);
  add_rectangle(soups[0], "light", -1, -1, 1, 1, 4, false);
  add_rectangle(soups[1], "light", -1, -1, 1, 1, 4, false);
  add_rectangle(soups[1], "ceiling", -8, -8, 8, 8, 4, false);
  add_rectangle(soups[2], "light", -1, -1, 1, 1, 4, false);
  add_ceiling_with_hole(soups[2], "ceiling", 4);
  add_rectangle(soups[3], "light", -1, -1, 1, 1, 4, false);
  testing::add_box(soups[3], "ceiling", {-8, -8, 4}, {8, 8, 5});
  // One group, one facet.
  add_rectangle(soups[4], "light", -1, -1, 1, 1, 4, false);
  add_ceiling_with_hole(soups[4], "ceiling", 4);
  soups[4].groups = {{"room", {0, 1, 2, 3, 4}}};
  // On the bottom of a box, of one object with it.
  testing::add_box(soups[5], "light", {-1, -1, 4}, {1, 1, 5});
  std::map<LightEventKind, int> first;
  for (std::size_t i = 0; i < soups.size(); ++i) {
    add_blockers(soups[i]);
    const Lit lit(soups[i], i == 4 ? "#0-0" : i == 5 ? "#4-4" : "light");
    const auto pieces = lit.pieces_on_floor();
    if (i == 0) first = pieces;
    EXPECT_EQ(pieces, first) << i;
    EXPECT_GT(expect_complete_along(lit, 8, 70 + i, -4, -4, 4, 4), 20) << i;
  }
}

std::vector<Point> wide_window(double z) {
  return {{-3, 3, z}, {3, 3, z}, {3, -3, z}, {-3, -3, z}};
}

TEST(LightEvents, LShapedHoledAndJoinedLights) {
  std::vector<PolygonSoup> soups(4);
  add_polygon(soups[0], "light",
              {{-1, -1, 4}, {-1, 1, 4}, {0, 1, 4}, {0, 0, 4}, {1, 0, 4}, {1, -1, 4}});
  // The same as two polygons of two objects that touch, with a T-junction.
  add_rectangle(soups[1], "light", -1, -1, 1, 0, 4, false);
  add_rectangle(soups[1], "light2", -1, 0, 0, 1, 4, false);
  // Overlapping.
  add_rectangle(soups[2], "light", -1, -1, 1, 0, 4, false);
  add_rectangle(soups[2], "light2", -1, -0.5, 0, 1, 4, false);
  // With a hole: a frame of four.
  add_rectangle(soups[3], "light", -1, -1, 1, -0.5, 4, false);
  add_rectangle(soups[3], "light2", -1, 0.25, 1, 1, 4, false);
  add_rectangle(soups[3], "light3", -1, -0.5, -0.5, 0.25, 4, false);
  add_rectangle(soups[3], "light4", 0.5, -0.5, 1, 0.25, 4, false);
  std::map<LightEventKind, int> first;
  for (std::size_t i = 0; i < soups.size(); ++i) {
    const std::size_t lights = soups[i].polygons.size();
    add_blockers(soups[i]);
    const Lit lit(soups[i], "#0-" + std::to_string(lights - 1), "floor", wide_window(4));
    const auto pieces = lit.pieces_on_floor();
    if (i == 0) first = pieces;
    if (i < 3) {
      EXPECT_EQ(pieces, first) << i;
    }
    EXPECT_EQ(lit.events.patches[0].sides.size(), i < 3 ? 6U : 8U);
    EXPECT_GT(expect_complete_along(lit, 8, 170 + i, -4, -4, 4, 4), 20) << i;
  }
}

TEST(LightEvents, BlockersThatTouchAndCross) {
  for (int kind = 0; kind < 6; ++kind) {
    PolygonSoup soup;
    add_rectangle(soup, "light", -1, -1, 1, 1, 4, false);
    switch (kind) {
      case 0:  // stacked, turned
        testing::add_box(soup, "a", {-1, -1, 0}, {1, 1, 1});
        add_turned_box(soup, "b", {0, 0, 1.5}, {1.75, 1.5, 1}, 0.5);
        break;
      case 1:  // two sheets that cross
        add_polygon(
            soup, "a",
            {{-1, -0.5, 1.5}, {1, -0.25, 1.5}, {0.75, 0.5, 2.5}, {-1, 0.75, 2.5}});
        add_polygon(soup, "b", {{-1, -0.5, 2.5}, {1, 0.75, 1.25}, {-0.5, 1, 1.5}});
        break;
      case 2:  // a box that hangs from the light
        testing::add_box(soup, "a", {-0.5, -0.5, 3}, {0.25, 0.5, 4});
        add_polygon(soup, "t", {{-0.5, -0.25, 2}, {0.375, -0.5, 2.25}, {0.5, 0.5, 1.75}});
        break;
      case 3:  // a box through the light
        testing::add_box(soup, "a", {0.5, -0.5, 3}, {1.5, 0.25, 5});
        add_polygon(soup, "t", {{-0.5, -0.25, 2}, {0.375, -0.5, 2.25}, {0.5, 0.5, 1.75}});
        break;
      case 4:  // a sheet through the light, another across it
        add_polygon(soup, "a",
                    {{-0.75, -0.5, 3}, {1, 0.25, 3}, {1, 0.25, 5}, {-0.75, -0.5, 5}});
        add_polygon(soup, "b", {{-0.75, 0.75, 2.5}, {1, -0.5, 3}, {1, 0.25, 2}});
        break;
      default:  // a box sunk in the floor, and one in the other
        testing::add_box(soup, "a", {-1, -1, -1}, {0.5, 0.5, 1});
        add_turned_box(soup, "b", {0.5, 0.5, 1}, {1.25, 1, 1.5}, 0.4);
    }
    add_rectangle(soup, "floor", -8, -8, 8, 8, 0, true);
    const Lit lit(soup);
    EXPECT_GT(expect_complete_along(lit, 12, 270 + kind, -4, -4, 4, 4), 20) << kind;
  }
}

// Points u, v of the rectangle from `corner` along two sides.
int expect_complete_on(const Lit& lit, int count, unsigned seed, const Point& corner,
                       const Point& side, const Point& other) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0.0625, 0.9375);
  int changes = 0;
  for (int i = 0; i < count; ++i) {
    const Point p = corner + u(random) * side + u(random) * other;
    const Point q = corner + u(random) * side + u(random) * other;
    expect_complete(lit, p, q, changes);
  }
  return changes;
}

TEST(LightEvents, OnWallsAndRoofs) {
  PolygonSoup soup;
  add_rectangle(soup, "light", -1, -1, 1, 1, 4, false);
  testing::add_box(soup, "wall", {2, -3, 0}, {2.5, 3, 3});
  testing::add_box(soup, "low", {-2, -2, 0}, {0.5, 2, 0.5});
  add_turned_box(soup, "b", {1.25, 0.25, 1}, {0.5, 0.75, 2}, 0.3);
  add_polygon(soup, "t", {{-0.5, -0.25, 2}, {0.375, -0.5, 2.25}, {0.5, 0.5, 1.75}});
  add_rectangle(soup, "floor", -8, -8, 8, 8, 0, true);
  const Lit wall(soup, "light", "#1-1");
  EXPECT_GT(expect_complete_on(wall, 12, 1, {2, -3, 0}, {0, 6, 0}, {0, 0, 3}), 20);
  const Lit roof(soup, "light", "#12-12");
  EXPECT_GT(expect_complete_on(roof, 12, 2, {-2, -2, 0.5}, {2.5, 0, 0}, {0, 4, 0}), 20);
}

TEST(LightEvents, HorizonThroughTheLight) {
  PolygonSoup soup;
  add_rectangle(soup, "light", -1, -1, 1, 1, 4, false);
  testing::add_box(soup, "wall", {0.25, -3, 0}, {0.75, 3, 3});
  // It stands against the wall.
  testing::add_box(soup, "a", {-0.25, -0.5, 0.5}, {0.25, 0.5, 2});
  add_polygon(soup, "t", {{-1, 0.75, 2}, {0.125, 0.5, 2.25}, {-0.25, 1.5, 1.75}});
  // Through the wall's plane over its top.
  add_polygon(soup, "s", {{-0.5, -1.5, 3.25}, {1, -0.5, 3.125}, {0.75, -1.75, 3.5}});
  const Lit lit(soup, "light", "#1-1");
  EXPECT_GT(expect_complete_on(lit, 24, 3, {0.25, -3, 0}, {0, 6, 0}, {0, 0, 3}), 20);
}

// Boxes of one axis that touch in all ways, over a floor, under a light with sides in
// their walls' planes.
TEST(LightEvents, TouchingBoxesInLineWithTheLight) {
  int changes = 0;
  for (const testing::Touching kind : testing::all_touching()) {
    PolygonSoup soup = testing::touching_boxes(kind);
    Point low = soup.vertices[0];
    Point high = low;
    for (const Point& p : soup.vertices) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const double z = high.z() + 2;
    add_rectangle(soup, "light", low.x(), low.y(), high.x(), high.y(), z, false);
    add_rectangle(soup, "floor", low.x() - 4, low.y() - 4, high.x() + 4, high.y() + 4,
                  low.z() - 1, true);
    const Lit lit(soup);
    changes +=
        expect_complete_along(lit, 4, 900 + static_cast<int>(kind), low.x() - 3,
                              low.y() - 3, high.x() + 3, high.y() + 3, low.z() - 1);
    if (HasFailure()) {
      ADD_FAILURE() << name(kind);
      return;
    }
  }
  EXPECT_GT(changes, 100);
}

// Everything on a grid of small integers: lines through many corners, planes through many
// edges.
TEST(LightEvents, TrianglesOnAGrid) {
  int changes = 0;
  for (int scene = 0; scene < 12; ++scene) {
    std::mt19937 random(500 + scene);
    std::uniform_int_distribution<int> xy(-2, 2);
    std::uniform_int_distribution<int> z(1, 3);
    PolygonSoup soup;
    add_rectangle(soup, "light", -1, -1, 1, 1, 4, false);
    for (int i = 0; i < 4;) {
      const Point a(xy(random), xy(random), z(random));
      const Point b(xy(random), xy(random), z(random));
      const Point c(xy(random), xy(random), z(random));
      if ((b - a).cross(c - a).norm() == 0) continue;
      add_polygon(soup, "t" + std::to_string(i++), {a, b, c});
    }
    add_rectangle(soup, "floor", -12, -12, 12, 12, 0, true);
    const Lit lit(soup);
    changes += expect_complete_along(lit, 5, 600 + scene, -6, -6, 6, 6);
  }
  EXPECT_GT(changes, 200);
}

// A narrow gutter of two sheets, with a valley between their fronts: from below the fold
// is an outline.
// Lines through a corner and an edge reach the floor through a slit only, however narrow.
TEST(LightEvents, NarrowSlits) {
  for (const double width : {1.0, 0x1p-30, 0x1p-50, 0x1p-70, 0x1p-130}) {
    PolygonSoup soup;
    add_rectangle(soup, "light", -1, -1, 1, 1, 10, false);
    add_rectangle(soup, "floor", -9, -9, 9, 9, 0, true);
    add_rectangle(soup, "roof", -4, 0, 4, 4, 8, true);
    add_polygon(soup, "corner", {{0, 0, 2}, {-1, -2, 2}, {1, -2, 2}});
    add_rectangle(soup, "left", -3, -3, 0, 3, 1, true);
    add_rectangle(soup, "right", width, -3, 4, 3, 1, true);
    const Lit lit(std::move(soup));
    int found = 0;
    for (const LightTrace& t : lit.events.traces) {
      if (t.kind != LightEventKind::EV) continue;
      for (const auto& piece : t.pieces) {
        if (lit.scene.faces()[piece.face].facet != lit.floor_facet) continue;
        // X(0) is the corner, Y(0) a corner of the roof.
        const auto& x = t.first[0];
        const auto& y = t.last[0];
        if (!is_zero(x[0]) || !is_zero(x[1]) || CGAL::to_double(x[2]) != 2) continue;
        if (CGAL::to_double(y[2]) != 8) continue;
        ++found;
        const auto& [from, to] = piece.range;
        EXPECT_EQ(internal::compare(from, to), Sign::Negative);
      }
    }
    EXPECT_EQ(found, 1) << width;
  }
}

TEST(LightEvents, FoldOfASheet) {
  PolygonSoup soup;
  add_rectangle(soup, "light", -1, -1, 1, 1, 4, false);
  soup.vertices.insert(soup.vertices.end(), {{-1, 0.25, 1.5},
                                             {1, -0.125, 1.75},
                                             {1, 0.25, 2.75},
                                             {-1, 0.5, 2.5},
                                             {1, -0.375, 2.75},
                                             {-1, 0.125, 2.5}});
  const int v = 4;
  soup.polygons.push_back({v, v + 1, v + 2});
  soup.polygons.push_back({v, v + 2, v + 3});
  soup.polygons.push_back({v + 1, v, v + 5});
  soup.polygons.push_back({v + 1, v + 5, v + 4});
  soup.groups.push_back({"gutter", {1, 2, 3, 4}});
  add_rectangle(soup, "floor", -12, -12, 12, 12, 0, true);
  const Lit lit(soup);
  EXPECT_GT(expect_complete_along(lit, 20, 5, -8, -8, 8, 8), 20);
}

Point scaled_and_turned(const Point& p, int exponent) {
  return Point(std::ldexp(p.y(), exponent), std::ldexp(p.z(), exponent),
               std::ldexp(p.x(), exponent));
}

// Another size and other axes: the same traces and pieces.
TEST(LightEvents, PowersOfTwoAndAxes) {
  PolygonSoup soup;
  add_rectangle(soup, "light", -1, -1, 1, 1, 4, false);
  add_ceiling_with_hole(soup, "ceiling", 4);
  add_blockers(soup);
  testing::add_box(soup, "hanging", {-0.75, -0.75, 3.5}, {-0.25, 0.25, 4.5});
  const Lit lit(soup);
  for (const int exponent : {0, 3, -40, 60}) {
    PolygonSoup other = soup;
    for (Point& p : other.vertices) p = scaled_and_turned(p, exponent);
    const Lit again(other);
    ASSERT_EQ(again.events.traces.size(), lit.events.traces.size()) << exponent;
    EXPECT_EQ(again.pieces_on_floor(), lit.pieces_on_floor()) << exponent;
    for (std::size_t i = 0; i < lit.events.traces.size(); ++i) {
      EXPECT_EQ(again.events.traces[i].generators, lit.events.traces[i].generators);
    }
  }
}

TEST(LightEvents, CornellBox) {
  const Lit lit(read_mesh(std::string(SIGHTLINE_EXAMPLES) + "/scenes/cornell.obj"));
  int changes = 0;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(1, 54);
  for (int i = 0; i < 12; ++i) {
    expect_complete(lit, {u(random), 0, u(random)}, {u(random), 0, u(random)}, changes);
  }
  EXPECT_GT(changes, 20);
}

// Sheets through each other: edges that pass through faces end what is seen of them.
TEST(LightEvents, CrossingTriangles) {
  int changes = 0;
  for (int scene = 0; scene < 8; ++scene) {
    std::mt19937 random(300 + scene);
    std::uniform_real_distribution<double> u(-1.25, 1.25);
    PolygonSoup soup;
    add_rectangle(soup, "light", -1, -1, 1, 1, 4, false);
    for (int i = 0; i < 4; ++i) {
      std::vector<Point> c;
      for (int k = 0; k < 3; ++k)
        c.emplace_back(u(random), u(random), 2 + 0.6 * u(random));
      add_polygon(soup, "t" + std::to_string(i), c);
    }
    add_rectangle(soup, "floor", -12, -12, 12, 12, 0, true);
    const Lit lit(soup);
    changes += expect_complete_along(lit, 6, 350 + scene, -4, -4, 4, 4);
  }
  EXPECT_GT(changes, 200);
}

// All in line, boxes that touch too, a light in whose planes walls lie: on walls, roofs
// and the ground alike.
TEST(LightEvents, EveryFacetOfAlignedCities) {
  int changes = 0;
  for (int seed = 1; seed <= 4; ++seed) {
    PolygonSoup soup = testing::grid_city(seed, 42, {.may_touch = seed % 2 == 0});
    Point low = soup.vertices[0];
    Point high = low;
    for (const Point& p : soup.vertices) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const Point middle = 0.5 * (low + high);
    const double x = std::floor(middle.x());
    const double y = std::floor(middle.y());
    add_rectangle(soup, "light", x - 3, y - 2, x + 3, y + 3, high.z() + 1, false);
    Lit lit(soup, "light", "ground");
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(0.03, 0.97);
    for (std::size_t f = 0; f < lit.scene.faces().size(); f += 2) {
      const auto ids = lit.scene.face_points(static_cast<int>(f));
      const Point a = lit.scene.point(ids[0]);
      const Point b = lit.scene.point(ids[1]) - a;
      const Point c = lit.scene.point(ids[3]) - a;
      lit.floor_facet = lit.scene.faces()[f].facet;
      if (lit.floor_facet == lit.source_facets[0]) continue;
      // Small integers and axes: the points stay in the plane.
      for (int i = 0; i < 3; ++i) {
        const Point p = a + u(random) * b + u(random) * c;
        const Point q = a + u(random) * b + u(random) * c;
        expect_complete(lit, p, q, changes);
      }
    }
  }
  EXPECT_GT(changes, 20);
}

TEST(LightEvents, ScatteredTriangles) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> near(-0.75, 0.75);
  std::uniform_real_distribution<double> place(-1.5, 1.5);
  std::uniform_real_distribution<double> height(1.0, 3.0);
  int changes = 0;
  for (int scene = 0; scene < 8; ++scene) {
    PolygonSoup soup;
    add_polygon(soup, "light",
                {{-1, -1, 4}, {-0.75, 1.25, 4}, {1, 1, 4}, {1.25, -0.5, 4}});
    for (int i = 0; i < 3 + scene / 2; ++i) {
      const Point at{place(random), place(random), height(random)};
      std::vector<Point> c;
      for (int k = 0; k < 3; ++k) {
        c.push_back(at + Point(near(random), near(random), near(random)));
      }
      add_polygon(soup, "t" + std::to_string(i), c);
    }
    add_rectangle(soup, "floor", -8, -8, 8, 8, 0, true);
    const Lit lit(soup);
    changes += expect_complete_along(lit, 10, 100 + scene, -5, -5, 5, 5);
  }
  EXPECT_GT(changes, 500);
}

}  // namespace
}  // namespace sightline
