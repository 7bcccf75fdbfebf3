// Polygon mode: small scenes against the oracle, the catalogue of nodes, hand cases, and
// what lies beside random arcs.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "linespace/occlusion.h"
#include "linespace/scene.h"
#include "skeleton/build.h"
#include "skeleton/skeleton_index.h"
#include "skeleton/skeleton_lines.h"
#include "tests/support/eee_scenes.h"
#include "tests/support/ev_skeleton.h"
#include "tests/support/generators.h"
#include "tests/support/library_skeleton.h"
#include "tests/support/naive_eee.h"
#include "tests/support/naive_ev.h"

namespace sightline {
namespace {

using testing::CanonicalSkeleton;

Skeleton polygon_skeleton(const Scene& scene, bool ev = true, bool eee = true) {
  SkeletonRequest request;
  request.events = EventMode::Polygon;
  request.ev = ev;
  request.eee = eee;
  return build_skeleton(scene, request);
}

// Small scenes against the oracles; polygon_oracle_test has 44.
TEST(PolygonMode, SmallScenesEqualTheOracle) {
  for (const std::uint64_t seed : {12, 18, 24}) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const PolygonSoup soup = testing::eee_scene(seed);
    const Scene scene(soup);
    const CanonicalSkeleton naive = testing::naive_eee(soup, true);
    EXPECT_EQ(testing::difference(
                  testing::canonical(scene, polygon_skeleton(scene, false, true)),
                  "the skeleton", naive, "the oracle"),
              "");
    EXPECT_GT(naive.arcs.size(), 10u);
    EXPECT_EQ(testing::difference(
                  testing::canonical(scene, polygon_skeleton(scene, true, false)),
                  "the skeleton", testing::naive_ev(soup, true), "the oracle"),
              "");
  }
}

// Every node ends the arcs that docs/polygon_mode.md derives.
TEST(PolygonMode, EveryNodeEndsTheArcsOfTheCatalogue) {
  for (std::uint64_t seed = 1; seed <= 44; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const Scene scene(testing::eee_scene(seed));
    const Skeleton skeleton = polygon_skeleton(scene);
    EXPECT_GT(skeleton.nodes.size(), 50u);
    const auto wrong = SkeletonIndex(scene, skeleton).check_invariants();
    EXPECT_TRUE(wrong.empty()) << wrong.front();
  }
}

// VEE and EVE nodes are found twice, from EV and from EEE arcs: with the same contacts.
TEST(PolygonMode, BothPartsTellTheContactsOfTheirNodesAlike) {
  int ends = 0;
  for (std::uint64_t seed = 1; seed <= 44; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const Scene scene(testing::eee_scene(seed));
    CanonicalSkeleton parts[2] = {
        testing::canonical(scene, polygon_skeleton(scene, true, false)),
        testing::canonical(scene, polygon_skeleton(scene, false, true))};
    for (CanonicalSkeleton& part : parts) {
      part.arcs.clear();
      std::erase_if(part.nodes, [](const auto& node) {
        return !node.kind.starts_with("VEE") && !node.kind.starts_with("EVE");
      });
    }
    EXPECT_EQ(testing::difference(parts[0], "the EV part", parts[1], "the EEE part"), "");
    for (const auto& node : parts[0].nodes) ends += node.kind.ends_with("_end");
  }
  EXPECT_GT(ends, 1000);
}

// What grazes everywhere is the solid skeleton, arc by arc.
TEST(PolygonMode, ArcsAndNodesThatGrazeAreThoseOfSolidMode) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const Scene scene(testing::eee_scene(seed));
    CanonicalSkeleton polygon = testing::canonical(scene, polygon_skeleton(scene));
    const auto ends = [](const auto& x) {
      return std::ranges::any_of(
          x.generators, [](const auto& g) { return g.kind == 'v' || g.kind == 'e'; });
    };
    std::erase_if(polygon.nodes, ends);
    std::erase_if(polygon.arcs, ends);
    const CanonicalSkeleton solid = testing::canonical(scene, build_skeleton(scene));
    EXPECT_EQ(testing::difference(polygon, "polygon mode", solid, "solid mode"), "");
    EXPECT_GT(solid.arcs.size(), 100u);
  }
}

TEST(PolygonMode, EvArcsThatGrazeAreThoseOfSolidModeWhereSolidsTouch) {
  std::size_t arcs = 0;
  for (const testing::Touching kind : testing::all_touching()) {
    SCOPED_TRACE(testing::name(kind));
    const Scene scene(testing::touching_boxes(kind));
    std::set<std::tuple<int, int, double, double>> solid, polygon;
    for (const SkeletonArc& arc : testing::build_ev_skeleton(scene).arcs) {
      solid.emplace(arc.vertex(), arc.edge(), arc.range[0], arc.range[1]);
    }
    for (const SkeletonArc& arc : polygon_skeleton(scene, true, false).arcs) {
      if (arc.ends[0] || arc.ends[1]) continue;
      polygon.emplace(arc.vertex(), arc.edge(), arc.range[0], arc.range[1]);
    }
    EXPECT_EQ(polygon, solid);
    arcs += solid.size();
  }
  EXPECT_GT(arcs, 500u);
}

/// Arcs by what their two outer contacts are: "graze graze", "graze end", ...
std::string contacts(const std::array<bool, 2>& ends) {
  return std::string(ends[0] ? "end" : "graze") + (ends[1] ? " end" : " graze");
}

TEST(PolygonMode, ACubeAloneHasNoEvents) {
  // Two contacts on one convex solid are the lines along its own faces: no events.
  const Scene scene(testing::boxes_soup({{{0, 0, 0}, {1, 1, 1}}}));
  const Skeleton skeleton = polygon_skeleton(scene);
  EXPECT_TRUE(skeleton.ev().empty());
  EXPECT_TRUE(skeleton.eee().empty());
  EXPECT_TRUE(skeleton.nodes.empty());
}

// Slab [-2, 2]^2 x [-1, 0], cube [-0.25, 0.75] x [-0.5, 0.5] x [0, 1] on it.  From an
// upper corner of the slab: two feet of the cube (the line runs along the slab's top and
// ends at the wall), one vertical edge between two fronts, all whole.  From a lower
// corner of the cube, along the slab's top: the two parts of the slab's sides for which
// the line would go on under the cube.  Upper corners of the cube see only silhouettes of
// the slab.
TEST(PolygonMode, ACubeOnASlab) {
  const Scene scene(testing::boxes_soup(
      {{{-2, -2, -1}, {2, 2, 0}}, {{-0.25, -0.5, 0}, {0.75, 0.5, 1}}}));
  const Skeleton skeleton = polygon_skeleton(scene);
  int feet = 0, walls = 0, from_below = 0;
  std::map<std::string, int> kinds;
  for (const SkeletonArc& arc : skeleton.ev()) {
    ++kinds[contacts(arc.ends)];
    const Point& v = scene.point(arc.vertex());
    const auto& ends = scene.edges()[arc.edge()].points;
    const Point &e0 = scene.point(ends[0]), &e1 = scene.point(ends[1]);
    const bool corner = std::abs(v[0]) == 2 && v[2] == 0;
    const bool on_cube = std::abs(e0[0]) < 1 && std::abs(e1[0]) < 1;
    if (arc.ends[1]) {
      EXPECT_TRUE(corner && on_cube);
      EXPECT_EQ(arc.range, (std::array<double, 2>{0, 1}));
      (e0[2] == 0 && e1[2] == 0 ? feet : walls) += 1;
    }
    if (arc.ends[0]) {
      EXPECT_TRUE(std::abs(v[0]) < 1 && v[2] == 0);
      EXPECT_EQ(std::max(e0[2], e1[2]), 0);
      ++from_below;
    }
  }
  EXPECT_EQ(feet, 8);
  EXPECT_EQ(walls, 4);
  EXPECT_EQ(from_below, 8);
  EXPECT_EQ(kinds["end end"], 0);
  EXPECT_EQ(kinds["graze graze"], static_cast<int>(build_skeleton(scene).ev_count()));
  EXPECT_TRUE(skeleton.eee().empty());
}

/// An L-shaped solid, y from 0 to 1: floor to z = 1 for x to 2, tower to z = 2 for x
/// to 1.
PolygonSoup ell() {
  PolygonSoup soup;
  const double outline[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (const double y : {0.0, 1.0}) {
    for (const auto& [x, z] : outline) soup.vertices.emplace_back(x, y, z);
  }
  soup.polygons = {{0, 1, 2, 3, 4, 5}, {11, 10, 9, 8, 7, 6}};
  for (int i = 0; i < 6; ++i) {
    const int j = (i + 1) % 6;
    soup.polygons.push_back({j, i, i + 6, j + 6});
  }
  soup.groups = {{"ell", {0, 1, 2, 3, 4, 5, 6, 7}}};
  return soup;
}

bool is_reflex(const Scene& scene, int edge) {
  return scene.edges()[edge].kind == EdgeKind::Reflex;
}

// Alone: each of the four corners above the notch sees the upper edge of the other side,
// a silhouette; the valley only in the plane of a face that they share with it.
TEST(PolygonMode, AnEllAlone) {
  const Scene scene(ell());
  ASSERT_EQ(scene.edges().size(), 18u);
  const Skeleton skeleton = polygon_skeleton(scene);
  for (const SkeletonArc& arc : skeleton.ev()) {
    EXPECT_TRUE(arc.self);
    EXPECT_FALSE(is_reflex(scene, arc.edge()));
    EXPECT_FALSE(arc.ends[0] || arc.ends[1]);
  }
  EXPECT_EQ(skeleton.ev().size(), build_skeleton(scene).ev_count());
}

// A triangle above the notch, within its two walls' fronts: each of its corners sees the
// whole valley, three end arcs; no line grazes the valley.  Of the other edges of the
// ell, those between two faces that show their fronts are ends: the two upper edges of
// the notch are silhouettes only where the triangle is behind a side.
TEST(PolygonMode, ATriangleAboveAnEll) {
  PolygonSoup soup = ell();
  soup.groups.push_back({"triangle", {8}});
  soup.polygons.push_back({12, 13, 14});
  soup.vertices.emplace_back(1.5, 0.41, 1.63);
  soup.vertices.emplace_back(1.57, 0.52, 1.71);
  soup.vertices.emplace_back(1.61, 0.43, 1.57);
  const Scene scene(soup);
  int valley = 0;
  const Skeleton polygon = polygon_skeleton(scene);
  for (const SkeletonArc& arc : polygon.ev()) {
    if (!is_reflex(scene, arc.edge())) continue;
    ++valley;
    EXPECT_EQ(contacts(arc.ends), "graze end");
    EXPECT_EQ(arc.range, (std::array<double, 2>{0, 1}));
    EXPECT_FALSE(arc.self);
  }
  EXPECT_EQ(valley, 3);
  const Skeleton solid = build_skeleton(scene);
  for (const SkeletonArc& arc : solid.ev()) {
    EXPECT_FALSE(is_reflex(scene, arc.edge()));
  }
}

// A small open sheet that sees the top and one side of a box: the edge between them is a
// crease, seen whole from each of the sheet's three corners.  The sheet itself is grazed
// everywhere, and so are the corners of the box.
TEST(PolygonMode, ASheetAndABox) {
  PolygonSoup soup = testing::boxes_soup({{{0, 0, 0}, {1, 1, 1}}});
  const int first = static_cast<int>(soup.vertices.size());
  const int face = static_cast<int>(soup.polygons.size());
  soup.vertices.emplace_back(2, 0.4, 2.1);
  soup.vertices.emplace_back(2.1, 0.6, 2);
  soup.vertices.emplace_back(1.9, 0.5, 2.3);
  soup.polygons.push_back({first, first + 1, first + 2});
  soup.groups.push_back({"sheet", {face}});
  const Scene scene(soup);
  const Skeleton skeleton = polygon_skeleton(scene);
  int creases = 0;
  for (const SkeletonArc& arc : skeleton.ev()) {
    EXPECT_FALSE(arc.ends[0]);
    if (!arc.ends[1]) continue;
    ++creases;
    for (const int p : scene.edges()[arc.edge()].points) {
      EXPECT_EQ(scene.point(p)[0], 1);
      EXPECT_EQ(scene.point(p)[2], 1);
    }
    EXPECT_EQ(arc.range, (std::array<double, 2>{0, 1}));
  }
  EXPECT_EQ(creases, 3);
  EXPECT_EQ(skeleton.ev().size(), build_skeleton(scene).ev_count() + 3);
  for (const SkeletonNode& node : skeleton.nodes) EXPECT_FALSE(node.end);
}

/// Faces that a ray meets first, starting inside a free segment.
std::vector<int> faces_ahead(const OcclusionIndex& index, const Point& from,
                             const Point& toward) {
  // `toward` itself may be beyond the face.
  const auto free = index.maximal_free_segment(from, from + 0.5 * (toward - from));
  return free ? free->to_faces : std::vector<int>{};
}

/// From a point shortly before a contact at x, rays a little beside it: of those eight,
/// how many meet one of these facets first, how many different ones they meet.
struct Beside {
  int met = 0;
  std::set<int> facets;
};
Beside look_beside(const Scene& scene, const OcclusionIndex& index, const Point& x,
                   const Point& other, std::span<const int> own) {
  const Point eye = x + 1e-4 * (other - x);  // beyond the middle contact
  const Point along = (x - other).normalized();
  const Point across = along.unitOrthogonal(), up = along.cross(across);
  Beside result;
  for (int k = 0; k < 8; ++k) {
    const double angle = 0.3 + k * std::numbers::pi / 4;
    const Point to =
        x + 1e-6 * (x - eye).norm() * (std::cos(angle) * across + std::sin(angle) * up);
    bool met = false;
    for (const int f : faces_ahead(index, eye, to)) {
      const int facet = scene.faces()[f].facet;
      if (std::ranges::count(own, facet) == 0) continue;
      met = true;
      result.facets.insert(facet);
    }
    result.met += met;
  }
  return result;
}

// Beside an end contact every ray meets a face of its edge or corner, on the two sides of
// an edge different ones; beside a graze some pass.
TEST(PolygonMode, FacesBesideRandomArcsDifferAsTheArcSays) {
  int ends = 0, grazes = 0, skipped = 0;
  testing::Random random(11);
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const Scene scene(testing::eee_scene(seed));
    const OcclusionIndex index(scene);
    const SkeletonLines lines(scene);
    const Skeleton skeleton = polygon_skeleton(scene);
    const auto check = [&](const Point& x, const Point& other, std::span<const int> own,
                           bool end, bool edge) {
      const Beside beside = look_beside(scene, index, x, other, own);
      if (end) {
        ++ends;
        EXPECT_EQ(beside.met, 8) << (edge ? "edge at " : "vertex at ") << x.transpose()
                                 << " seen from " << other.transpose();
        EXPECT_GE(beside.facets.size(), 2u);
      } else {
        ++grazes;
        EXPECT_LT(beside.met, 8);
        EXPECT_TRUE(beside.met > 0 || !edge);
      }
    };
    const auto at_edge = [&](int e) {
      std::vector<int> own;
      for (const Edge::Side& side : scene.edges()[e].sides)
        own.push_back(scene.faces()[side.face].facet);
      return own;
    };
    const auto point_on = [&](int e, double s) {
      const auto& p = scene.edges()[e].points;
      return Point(scene.point(p[0]) + s * (scene.point(p[1]) - scene.point(p[0])));
    };
    const auto parameter = [&](const std::array<double, 2>& range) {
      return range[0] + random.uniform(0.2, 0.8) * (range[1] - range[0]);
    };
    for (int k = 0; k < 60; ++k) {
      const auto i = random.integer(0, static_cast<int>(skeleton.ev().size()) - 1);
      const SkeletonArc& arc = skeleton.ev()[i];
      if (!(arc.ends[0] || arc.ends[1]) || arc.range[1] - arc.range[0] < 1e-2) {
        ++skipped;
        continue;
      }
      const double s = parameter(arc.range);
      const Point& v = scene.point(arc.vertex());
      const Point x = point_on(arc.edge(), s);
      std::vector<int> at_v;
      for (const int f : scene.faces_at(arc.vertex())) {
        at_v.push_back(scene.faces()[f].facet);
      }
      check(v, x, at_v, arc.ends[0], false);
      check(x, v, at_edge(arc.edge()), arc.ends[1], true);
      const FreeSegment free = lines.line(arc, s).value();
      EXPECT_EQ(free.from == 0, arc.ends[0]);
      EXPECT_EQ(free.to == 1, arc.ends[1]);
    }
    for (int k = 0; k < 150 && !skeleton.eee().empty(); ++k) {
      const auto i = random.integer(0, static_cast<int>(skeleton.eee().size()) - 1);
      const SkeletonArc& arc = skeleton.eee()[i];
      if (!(arc.ends[0] || arc.ends[1]) || arc.range[1] - arc.range[0] < 1e-2) {
        ++skipped;
        continue;
      }
      const double s = parameter(arc.range);
      const auto free = lines.line(arc, s);
      ASSERT_TRUE(free);
      EXPECT_EQ(free->from == 0, arc.ends[0]);
      EXPECT_EQ(free->to == 1, arc.ends[1]);
      // The last point, where the plane of the first and the middle edge crosses.
      const Point p = point_on(arc.edges()[0], s);
      const auto& m = scene.edges()[arc.edges()[1]].points;
      const Point n = (scene.point(m[0]) - p).cross(scene.point(m[1]) - p);
      const auto& l = scene.edges()[arc.edges()[2]].points;
      const double y0 = n.dot(scene.point(l[0]) - p), y1 = n.dot(scene.point(l[1]) - p);
      const Point q = point_on(arc.edges()[2], y0 / (y0 - y1));
      check(p, q, at_edge(arc.edges()[0]), arc.ends[0], true);
      check(q, p, at_edge(arc.edges()[2]), arc.ends[1], true);
    }
    if (HasFailure()) break;
  }
  std::printf("end contacts %d, grazes %d, arcs skipped %d\n", ends, grazes, skipped);
  EXPECT_GT(ends, 2000);
  EXPECT_GT(grazes, 500);
}

}  // namespace
}  // namespace sightline
