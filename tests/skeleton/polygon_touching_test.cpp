// Polygon mode where faces of several objects meet: sheets that share an edge, boxes that
// touch along edges, at corners, or overlap.  Line by line against the naive grid; hand
// cases; the same whatever the axes and the order.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "linespace/scene.h"
#include "skeleton/build.h"
#include "tests/support/generators.h"
#include "tests/support/library_skeleton.h"
#include "tests/support/naive_grid.h"
#include "tests/support/random_geometry.h"

namespace sightline {
namespace {

using testing::AlignedBox;
using testing::GridScene;
using testing::Rational;
using testing::Vec3;
using Met = GridScene::Met;

Skeleton skeleton_of(const Scene& scene, EventMode events, bool ev = true,
                     bool eee = true) {
  SkeletonRequest request;
  request.events = events;
  request.ev = ev;
  request.eee = eee;
  return build_skeleton(scene, request);
}

/// Adds a group of axis-parallel rectangles, each flat in one coordinate, that share
/// equal corners.
void add_sheets(PolygonSoup& soup, const std::string& name,
                const std::vector<AlignedBox>& rectangles) {
  PolygonSoup::Group group{name, {}};
  const int first = static_cast<int>(soup.vertices.size());
  const auto vertex = [&](const Point& p) {
    for (int v = first; v < static_cast<int>(soup.vertices.size()); ++v) {
      if (soup.vertices[v] == p) return v;
    }
    soup.vertices.push_back(p);
    return static_cast<int>(soup.vertices.size()) - 1;
  };
  for (const auto& [low, high] : rectangles) {
    int k = 0;
    while (low[k] != high[k]) ++k;
    const int i = (k + 1) % 3;
    const int j = (k + 2) % 3;
    std::vector<int> corners;
    for (const auto& [x, y] : {std::pair(low[i], low[j]),
                               {high[i], low[j]},
                               {high[i], high[j]},
                               {low[i], high[j]}}) {
      Point p;
      p[k] = low[k];
      p[i] = x;
      p[j] = y;
      corners.push_back(vertex(p));
    }
    group.faces.push_back(static_cast<int>(soup.polygons.size()));
    soup.polygons.push_back(corners);
  }
  soup.groups.push_back(std::move(group));
}

struct Case {
  std::string name;
  PolygonSoup soup;
};

// A small box off the walls' planes, so that something looks at them.
const AlignedBox kAbove{{5, 9, 11}, {6, 11, 12}};
const AlignedBox kBelow{{-7, 3, -9}, {-5, 4, -8}};

std::vector<Case> cases() {
  std::vector<Case> all;
  const auto add = [&](const std::string& name, const std::vector<AlignedBox>& boxes,
                       const std::vector<std::vector<AlignedBox>>& sheets = {}) {
    PolygonSoup soup = testing::boxes_soup(boxes);
    int k = 0;
    for (const auto& sheet : sheets)
      add_sheets(soup, "sheet" + std::to_string(k++), sheet);
    all.push_back({name, std::move(soup)});
  };
  const AlignedBox left{{-4, 0, 0}, {0, 8, 0}}, right{{0, 0, 0}, {4, 8, 0}};
  const AlignedBox up{{0, 0, 0}, {0, 8, 7}}, down{{0, 0, -6}, {0, 8, 0}};
  add("T, one mesh", {kAbove, kBelow}, {{left, right, up}});
  add("X, one mesh", {kAbove, kBelow}, {{left, right, up, down}});
  add("fold", {kAbove, kBelow}, {{left, up}});
  add("T, two meshes", {kAbove, kBelow}, {{{{-4, 0, 0}, {4, 8, 0}}}, {up}});
  add("T, wall shorter", {kAbove, kBelow},
      {{{{-4, -1, 0}, {4, 10, 0}}}, {{{0, 1, 0}, {0, 8, 7}}}});
  add("X, two meshes", {kAbove, kBelow},
      {{{{-4, 0, 0}, {4, 8, 0}}}, {{{0, 1, -6}, {0, 7, 7}}}});
  add("wall on a slab", {kAbove, kBelow, {{-4, 0, -1}, {4, 10, 0}}}, {{up}});
  add("box under a sheet", {kAbove, kBelow, {{-2, 2, -3}, {2, 5, 0}}},
      {{{{-4, 0, 0}, {4, 10, 0}}}});
  add("common edge", {kAbove, kBelow, {{-4, 0, 0}, {0, 8, 3}}, {{0, 0, -3}, {4, 8, 0}}});
  add("part of an edge in common",
      {kAbove, kBelow, {{-4, 0, 0}, {0, 5, 3}}, {{0, 2, -3}, {4, 8, 0}}});
  add("common corner", {kAbove, kBelow, {{-4, 0, 0}, {0, 4, 3}}, {{0, 4, 3}, {4, 8, 6}}});
  add("corner on a face",
      {kAbove, kBelow, {{-4, 0, 0}, {0, 8, 3}}, {{0, 2, 1}, {4, 9, 6}}});
  add("flush, side by side",
      {kAbove, kBelow, {{-4, 0, 0}, {0, 8, 3}}, {{0, 0, 0}, {4, 8, 3}}});
  add("flush, one longer",
      {kAbove, kBelow, {{-4, 0, 0}, {0, 8, 3}}, {{0, 2, 0}, {4, 8, 3}}});
  add("stack", {kAbove, kBelow, {{-4, 0, 0}, {0, 8, 3}}, {{-3, 1, 3}, {-1, 5, 6}}});
  add("overlap", {kAbove, kBelow, {{-4, 0, 0}, {0, 8, 3}}, {{-2, 2, 1}, {3, 5, 6}}});
  add("cross", {kAbove, kBelow, {{-4, 2, 0}, {4, 5, 3}}, {{-2, 0, 1}, {1, 8, 2}}});
  for (int seed = 1; seed <= 24; ++seed) {
    testing::Random random(static_cast<std::uint64_t>(seed));
    const auto side = [&](int most) {
      const int low = random.integer(0, most - 1);
      return std::pair<double, double>(low, random.integer(low + 1, most));
    };
    const auto box = [&] {
      AlignedBox b;
      for (int k = 0; k < 3; ++k) std::tie(b.min[k], b.max[k]) = side(4);
      return b;
    };
    std::vector<AlignedBox> boxes{box(), box(), {{7, 6, 5}, {8, 8, 7}}};
    if (seed % 3 == 0) boxes.push_back(box());
    std::vector<std::vector<AlignedBox>> sheets;
    for (int k = seed % 4; k > 0; --k) {
      AlignedBox sheet = box();
      const int flat = random.integer(0, 2);
      sheet.max[flat] = sheet.min[flat];
      sheets.push_back({sheet});
    }
    add("random " + std::to_string(seed), boxes, sheets);
  }
  return all;
}

/// One non-manifold solid: two boxes of one mesh that share an edge.
PolygonSoup two_boxes_in_one() {
  PolygonSoup soup = testing::boxes_soup(
      {{{-4, 0, 0}, {0, 8, 3}}, {{0, 0, -3}, {4, 8, 0}}, kAbove, kBelow});
  soup.groups[0].faces.insert(soup.groups[0].faces.end(), soup.groups[1].faces.begin(),
                              soup.groups[1].faces.end());
  soup.groups.erase(soup.groups.begin() + 1);
  return soup;
}

Vec3 point_on(const Scene& scene, int edge, const Rational& s) {
  const auto& p = scene.edges()[edge].points;
  const Vec3 a = testing::exact(scene.point(p[0]));
  return a + s * (testing::exact(scene.point(p[1])) - a);
}

int axis_of(const Scene& scene, int edge) {
  const auto& p = scene.edges()[edge].points;
  int axis = 0;
  (scene.point(p[1]) - scene.point(p[0])).cwiseAbs().maxCoeff(&axis);
  return axis;
}

/// Points of its faces off an edge, those of all that coincide with it.
std::vector<Point> own_faces(const Scene& scene, int edge) {
  std::vector<Point> found;
  for (const Edge& e : scene.edges()) {
    if (e.points != scene.edges()[edge].points) continue;
    for (const Edge::Side& side : e.sides) {
      for (const int p : scene.face_points(side.face)) {
        const Point& x = scene.point(p);
        if (!collinear(scene.point(e.points[0]), scene.point(e.points[1]), x)) {
          found.push_back(x);
        }
      }
    }
  }
  return found;
}

/// Parameters strictly inside (0, 1), no multiples of a grid's parts.
const std::array<Rational, 6> kPlaces{Rational(3, 64),  Rational(13, 64),
                                      Rational(25, 64), Rational(35, 64),
                                      Rational(51, 64), Rational(61, 64)};

bool inside(const std::array<double, 2>& range, const Rational& s) {
  return Rational(range[0]) < s && s < Rational(range[1]);
}

std::string told(const std::array<bool, 2>& ends) {
  return std::string(ends[0] ? "end" : "graze") + (ends[1] ? " end" : " graze");
}

std::string told(Met first, Met last) {
  return told({first == Met::End, last == Met::End});
}

struct Compared {
  int ends = 0, grazes = 0, none = 0, wrong = 0;
};

// Every corner and edge, six lines each.
void compare_ev(const Scene& scene, const GridScene& grid, Compared& sum) {
  const int before = sum.wrong;
  const Skeleton skeleton = skeleton_of(scene, EventMode::Polygon, true, false);
  std::map<std::pair<int, int>, std::vector<const SkeletonArc*>> arcs;
  std::map<std::array<std::int32_t, 2>, int> first_edge;  // of coinciding ones
  const auto same = [&](int e) {
    return first_edge.try_emplace(scene.edges()[e].points, e).first->second;
  };
  for (int e = 0; e < static_cast<int>(scene.edges().size()); ++e) same(e);
  for (const SkeletonArc& arc : skeleton.ev()) {
    arcs[{arc.vertex(), same(arc.edge())}].push_back(&arc);
  }
  for (const int v : scene.corners()) {
    const Vec3 p = testing::exact(scene.point(v));
    for (int e = 0; e < static_cast<int>(scene.edges().size()); ++e) {
      if (same(e) != e) continue;
      const std::vector<Point> own = own_faces(scene, e);
      for (const Rational& s : kPlaces) {
        const Vec3 x = point_on(scene, e, s);
        const auto free = grid.is_free(p, x);
        if (!free) continue;
        const Met at_v = grid.at_corner(p, x - p);
        const Met at_e = grid.at_edge(x, axis_of(scene, e), p - x, own);
        std::string wanted = "none", found = "none";
        if (*free && at_v != Met::None && at_e != Met::None) wanted = told(at_v, at_e);
        for (const SkeletonArc* arc : arcs[{v, e}]) {
          if (!inside(arc->range, s)) continue;
          found = found == "none" ? told(arc->ends) : found + ", " + told(arc->ends);
        }
        (wanted == "none"          ? sum.none
         : wanted == "graze graze" ? sum.grazes
                                   : sum.ends) += 1;
        if (wanted == found) continue;
        if (++sum.wrong - before < 3) {
          ADD_FAILURE() << "from corner " << scene.point(v).transpose() << " to edge "
                        << scene.point(scene.edges()[e].points[0]).transpose() << " - "
                        << scene.point(scene.edges()[e].points[1]).transpose() << " at "
                        << s << ": wanted " << wanted << ", found " << found;
        }
      }
    }
  }
}

/// The point of edge `last` on a line through p and a point inside edge `between`.
std::optional<std::array<Vec3, 2>> line_through(const Scene& scene, const Vec3& p,
                                                int between, int last) {
  // Exact in doubles: p in 64ths, the corners small integers.
  const auto corner = [&](int e, int k) {
    return scene.point(scene.edges()[e].points[k]);
  };
  const Point at(p[0].convert_to<double>(), p[1].convert_to<double>(),
                 p[2].convert_to<double>());
  const Point across = (corner(between, 0) - at).cross(corner(between, 1) - at);
  if (across.dot(corner(last, 0) - at) * across.dot(corner(last, 1) - at) >= 0) {
    return std::nullopt;
  }
  const Vec3 m0 = point_on(scene, between, 0), m1 = point_on(scene, between, 1);
  const Vec3 q0 = point_on(scene, last, 0), q1 = point_on(scene, last, 1);
  const Vec3 n = cross(m0 - p, m1 - p);
  const Rational a = dot(n, q0 - p), b = dot(n, q1 - p);
  const Vec3 q = q0 + Rational(a / (a - b)) * (q1 - q0);
  const Vec3 d = q - p;
  for (int k = 0; k < 3; ++k) {
    if (d[k].sign() == 0) return std::nullopt;
  }
  // All corners have integer coordinates: where an edge is met at one, others may be.
  const auto on_grid = [](const Rational& x) { return denominator(x) == 1; };
  if (on_grid(q[axis_of(scene, last)])) return std::nullopt;
  // The edge between is along an axis; the others give the position.
  const int axis = axis_of(scene, between);
  const int k = (axis + 1) % 3;
  const Rational t = (m0[k] - p[k]) / d[k];
  if (t <= 0 || t >= 1) return std::nullopt;
  const Vec3 m = p + t * d;
  if ((m[axis] - m0[axis]) * (m[axis] - m1[axis]) >= 0) return std::nullopt;
  if (on_grid(m[axis])) return std::nullopt;
  return std::array<Vec3, 2>{m, q};
}

// Every three edges, a few lines each.
void compare_eee(const Scene& scene, const GridScene& grid, Compared& sum) {
  const int before = sum.wrong;
  const Skeleton skeleton = skeleton_of(scene, EventMode::Polygon, false, true);
  std::map<std::array<std::int32_t, 2>, int> first_edge;
  const int n = static_cast<int>(scene.edges().size());
  std::vector<int> same(n);
  std::vector<std::vector<Point>> own;
  for (int e = 0; e < n; ++e) own.push_back(own_faces(scene, e));
  for (int e = 0; e < n; ++e) {
    same[e] = first_edge.try_emplace(scene.edges()[e].points, e).first->second;
  }
  std::map<std::array<int, 3>, std::vector<const SkeletonArc*>> arcs;
  for (const SkeletonArc& arc : skeleton.eee()) {
    arcs[{same[arc.edges()[0]], same[arc.edges()[1]], same[arc.edges()[2]]}].push_back(
        &arc);
  }
  const auto parameter = [&](int e, const Vec3& x) -> Rational {
    const int k = axis_of(scene, e);
    const Vec3 a = point_on(scene, e, 0), b = point_on(scene, e, 1);
    return (x[k] - a[k]) / (b[k] - a[k]);
  };
  for (int i = 0; i < n; ++i) {
    if (same[i] != i) continue;
    for (const Rational& s : {kPlaces[0], kPlaces[2], kPlaces[4]}) {
      const Vec3 p = point_on(scene, i, s);
      for (int m = 0; m < n; ++m) {
        if (same[m] != m || m == i) continue;
        for (int j = 0; j < n; ++j) {
          if (same[j] != j || j == i || j == m) continue;
          const auto line = line_through(scene, p, m, j);
          if (!line) continue;
          const auto& [x, q] = *line;
          const auto free = grid.is_free(p, q, &x);
          if (!free) continue;
          const Met first = grid.at_edge(p, axis_of(scene, i), q - p, own[i]);
          const Met middle = grid.at_edge(x, axis_of(scene, m), q - p, own[m]);
          const Met last = grid.at_edge(q, axis_of(scene, j), p - q, own[j]);
          std::string wanted = "none", found = "none";
          if (*free && middle == Met::Graze && first != Met::None && last != Met::None) {
            wanted = told(first, last);
          }
          const auto look = [&](const SkeletonArc& arc, const Rational& at, bool turned) {
            if (!inside(arc.range, at)) return;
            const std::string one =
                turned ? told({arc.ends[1], arc.ends[0]}) : told(arc.ends);
            found = found == "none" ? one : found + ", " + one;
          };
          for (const SkeletonArc* arc : arcs[{i, m, j}]) {
            look(*arc, parameter(arc->edges()[0], p), false);
          }
          for (const SkeletonArc* arc : arcs[{j, m, i}]) {
            look(*arc, parameter(arc->edges()[0], q), true);
          }
          (wanted == "none"          ? sum.none
           : wanted == "graze graze" ? sum.grazes
                                     : sum.ends) += 1;
          if (wanted == found) continue;
          if (++sum.wrong - before < 3) {
            ADD_FAILURE() << "edges " << i << ", " << m << ", " << j << " from " << p[0]
                          << " " << p[1] << " " << p[2] << " over " << x[0] << " " << x[1]
                          << " " << x[2] << " to " << q[0] << " " << q[1] << " " << q[2]
                          << ": wanted " << wanted << ", found " << found;
          }
        }
      }
    }
  }
}

void print(const char* what, const Compared& sum) {
  std::printf("%s: ends %d, grazes %d, none %d, wrong %d\n", what, sum.ends, sum.grazes,
              sum.none, sum.wrong);
}

TEST(PolygonTouching, EveryLineOfACornerAndAnEdgeAsTheGridSays) {
  Compared sum;
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const Scene scene(c.soup);
    compare_ev(scene, GridScene(c.soup), sum);
  }
  print("corner and edge", sum);
  EXPECT_GT(sum.ends, 10000);
}

TEST(PolygonTouching, EveryLineOfThreeEdgesAsTheGridSays) {
  Compared sum;
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const Scene scene(c.soup);
    compare_eee(scene, GridScene(c.soup), sum);
  }
  print("three edges", sum);
  EXPECT_GT(sum.ends, 1000);
}

TEST(PolygonTouching, TwoBoxesOfOneMeshThatShareAnEdge) {
  const PolygonSoup soup = two_boxes_in_one();
  const Scene scene(soup);
  Compared sum;
  compare_ev(scene, GridScene(soup), sum);
  compare_eee(scene, GridScene(soup), sum);
  EXPECT_GT(sum.ends, 100);
}

// Walls that share the edge from (0, 0, 0) to (0, 8, 0), and a small level square beside
// them: from each of its four corners the edge is seen whole where it is a valley between
// two walls, and not at all where the two walls that are seen are one floor.
TEST(PolygonTouching, WallsThatShareAnEdge) {
  const AlignedBox left{{-4, 0, 0}, {0, 8, 0}}, right{{0, 0, 0}, {4, 8, 0}};
  const AlignedBox up{{0, 0, 0}, {0, 8, 7}}, down{{0, 0, -6}, {0, 8, 0}};
  struct Expected {
    std::vector<AlignedBox> walls;
    std::array<int, 4> seen;  // above left, above right, below left, below right
  };
  const Expected all[] = {
      {{left, right, up}, {4, 4, 0, 0}},        // T
      {{left, right, up, down}, {4, 4, 4, 4}},  // X
      {{left, up, down}, {4, 0, 4, 0}},         // T, lying
      {{left, up}, {4, 4, 4, 4}},               // a fold, a ridge from outside
  };
  const std::array<AlignedBox, 4> squares{{{{-2, 3, 3}, {-1, 4, 3}},
                                           {{1, 3, 3}, {2, 4, 3}},
                                           {{-2, 3, -3}, {-1, 4, -3}},
                                           {{1, 3, -3}, {2, 4, -3}}}};
  for (const auto& [walls, seen] : all) {
    for (std::size_t k = 0; k < squares.size(); ++k) {
      SCOPED_TRACE(::testing::Message() << walls.size() << " walls, square " << k);
      PolygonSoup soup;
      add_sheets(soup, "sheet walls", walls);
      add_sheets(soup, "sheet square", {squares[k]});
      const Scene scene(soup);
      int whole = 0, ends = 0;
      const Skeleton polygon = skeleton_of(scene, EventMode::Polygon);
      for (const SkeletonArc& arc : polygon.ev()) {
        const auto& p = scene.edges()[arc.edge()].points;
        const Point middle = 0.5 * (scene.point(p[0]) + scene.point(p[1]));
        // Not from the walls' own corners, along them.
        const bool from_square = std::abs(scene.point(arc.vertex())[2]) == 3;
        if (middle != Point(0, 4, 0) || !from_square) continue;
        EXPECT_FALSE(arc.ends[0]);
        ends += arc.ends[1];
        whole += arc.range == std::array<double, 2>{0, 1};
      }
      EXPECT_EQ(whole, seen[k]);
      // The ridge of the fold, which is silhouette from above right and below left.
      const bool silhouette = walls.size() == 2 && (k == 1 || k == 2);
      EXPECT_EQ(ends, silhouette ? 0 : seen[k]);
      if (walls.size() == 2) continue;
      const Skeleton solid = skeleton_of(scene, EventMode::Solid);
      for (const SkeletonArc& arc : solid.ev()) {
        const auto& p = scene.edges()[arc.edge()].points;
        EXPECT_NE(Point(0.5 * (scene.point(p[0]) + scene.point(p[1]))), Point(0, 4, 0));
      }
    }
  }
}

using testing::CanonicalSkeleton;

bool is_end(const testing::NodeKey& node) { return node.kind.ends_with("_end"); }

// What is not counted under `end` is solid mode's, node by node, and its end nodes are
// among polygon mode's.
TEST(PolygonTouching, NodesThatGrazeAreThoseOfSolidMode) {
  int nodes = 0, ends = 0, without = 0;
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const Scene scene(c.soup);
    const Skeleton polygon = skeleton_of(scene, EventMode::Polygon);
    CanonicalSkeleton all = testing::canonical(scene, polygon);
    CanonicalSkeleton solid =
        testing::canonical(scene, skeleton_of(scene, EventMode::Solid));
    all.arcs.clear();
    solid.arcs.clear();
    const auto upper = [](testing::NodeKey node) {
      for (auto& g : node.generators) {
        g.kind = static_cast<char>(std::toupper(g.kind));
      }
      return testing::node_key(node.kind, node.generators);
    };
    std::set<testing::NodeKey> end_nodes;
    for (const auto& node : all.nodes) {
      if (is_end(node)) end_nodes.insert(upper(node));
    }
    for (const auto& node : solid.nodes) {
      if (!is_end(node)) continue;
      ++ends;
      EXPECT_TRUE(end_nodes.contains(node)) << node.kind;
    }
    std::erase_if(all.nodes, is_end);
    std::erase_if(solid.nodes, is_end);
    EXPECT_EQ(testing::difference(all, "polygon mode", solid, "solid mode"), "");
    nodes += static_cast<int>(solid.nodes.size());
    // A contact of each end node says so, but for degenerate lines that graze everywhere
    // and end only arcs with an end contact.
    std::vector<int> grazing(polygon.nodes.size());
    for (const SkeletonArc& arc : polygon.ev()) {
      for (const auto n : arc.nodes) grazing[n] += !arc.ends[0] && !arc.ends[1];
    }
    for (const SkeletonArc& arc : polygon.eee()) {
      for (const auto n : arc.nodes) grazing[n] += !arc.ends[0] && !arc.ends[1];
    }
    for (std::size_t n = 0; n < polygon.nodes.size(); ++n) {
      const SkeletonNode& node = polygon.nodes[n];
      EXPECT_TRUE(node.end || !(node.ends[0] || node.ends[1]));
      if (!node.end || node.ends[0] || node.ends[1]) continue;
      EXPECT_EQ(node.kind, NodeKind::Degenerate);
      EXPECT_EQ(grazing[n], 0);
      ++without;
    }
  }
  std::printf("%d nodes of solid mode, %d that end; %d end without an end contact\n",
              nodes, ends, without);
  EXPECT_GT(nodes, 1000);
  EXPECT_GT(ends, 100);
}

/// The soup on other axes, in another order; `back` undoes the motion.
struct Moved {
  PolygonSoup soup;
  testing::PointMap back;
};
Moved moved(const PolygonSoup& soup, const std::array<int, 3>& axis, int signs) {
  const std::array<double, 3> sign{signs & 1 ? -1.0 : 1.0, signs & 2 ? -1.0 : 1.0,
                                   signs & 4 ? -1.0 : 1.0};
  Moved m;
  m.soup = soup;
  for (Point& p : m.soup.vertices) {
    const Point q = p;
    for (int k = 0; k < 3; ++k) p[k] = sign[k] * q[axis[k]];
  }
  const bool even = (axis[1] - axis[0] + 3) % 3 == 1;
  const bool mirrored = even == (sign[0] * sign[1] * sign[2] < 0);
  if (mirrored) {
    for (auto& polygon : m.soup.polygons) std::ranges::reverse(polygon);
  }
  // The last group first, and its polygons begin elsewhere.
  std::ranges::reverse(m.soup.groups);
  const int last = static_cast<int>(m.soup.polygons.size()) - 1;
  std::ranges::reverse(m.soup.polygons);
  for (auto& group : m.soup.groups) {
    for (int& f : group.faces) f = last - f;
  }
  for (auto& polygon : m.soup.polygons) std::ranges::rotate(polygon, polygon.begin() + 1);
  m.back = [axis, sign](const Point& p) {
    Point q;
    for (int k = 0; k < 3; ++k) q[axis[k]] = sign[k] * p[k];
    return q;
  };
  return m;
}

TEST(PolygonTouching, TheSameOnAllAxesAndInAnyOrder) {
  const std::vector<Case> all = cases();
  std::vector<Case> some{{"two boxes in one", two_boxes_in_one()}};
  for (const std::size_t k : {0, 1, 3, 4, 8, 10, 11, 15, 16, 19, 24})
    some.push_back(all[k]);
  for (const Case& c : some) {
    SCOPED_TRACE(c.name);
    const Scene scene(c.soup);
    const CanonicalSkeleton here =
        testing::canonical(scene, skeleton_of(scene, EventMode::Polygon));
    std::array<int, 3> axis{0, 1, 2};
    do {
      for (int signs = 0; signs < 8; ++signs) {
        const Moved m = moved(c.soup, axis, signs);
        const Scene there(m.soup);
        const CanonicalSkeleton same =
            testing::canonical(there, skeleton_of(there, EventMode::Polygon), m.back);
        ASSERT_EQ(testing::difference(same, "moved", here, "here"), "")
            << "axes " << axis[0] << axis[1] << axis[2] << " signs " << signs;
      }
    } while (std::ranges::next_permutation(axis).found);
  }
}

}  // namespace
}  // namespace sightline
