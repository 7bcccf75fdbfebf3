// Every kind of node has its line: contacts in order that touch its generators.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "skeleton/build.h"
#include "skeleton/end_index.h"
#include "skeleton/skeleton_lines.h"
#include "tests/support/eee_scenes.h"
#include "tests/support/exact.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

Skeleton all_kinds(const Scene& scene, EventMode mode) {
  SkeletonRequest request;
  request.ff = mode == EventMode::Solid;
  request.events = mode;
  return build_skeleton(scene, request);
}

std::set<Point, bool (*)(const Point&, const Point&)> ends_of(const Scene& scene,
                                                              int edge) {
  const auto& p = scene.edges()[edge].points;
  return {{scene.point(p[0]), scene.point(p[1])}, [](const Point& a, const Point& b) {
            return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
          }};
}

/// The contact touches the corner, an edge in the same place, or the facet edge-on.
bool touches(const Scene& scene, const Contact& contact, const Generator& g) {
  return std::ranges::any_of(contact.touches, [&](const Touch& t) {
    const auto corners = scene.face_points(t.face);
    switch (g.kind) {
      case GeneratorKind::Vertex:
        // A stretch in a face begins at its corner.
        if (t.kind == TouchKind::EdgeOn) {
          return std::ranges::find(corners, g.id) != corners.end();
        }
        return t.kind == TouchKind::Corner && corners[t.index] == g.id;
      case GeneratorKind::Edge: {
        const auto& ends = scene.edges()[g.id].points;
        if (t.kind == TouchKind::Corner) {  // of a face on which the edge lies
          return collinear(scene.point(ends[0]), scene.point(ends[1]),
                           scene.point(corners[t.index]));
        }
        if (t.kind == TouchKind::Edge) {
          const int edge = scene.edge_of_side(t.face, t.index);
          return edge == g.id ||
                 (edge >= 0 && ends_of(scene, edge) == ends_of(scene, g.id));
        }
        // Through a face in whose plane the line lies.
        const auto& sides = scene.edges()[g.id].sides;
        return t.kind == TouchKind::EdgeOn &&
               std::ranges::any_of(sides, [&](const Edge::Side& s) {
                 return scene.faces()[s.face].facet == scene.faces()[t.face].facet;
               });
      }
      case GeneratorKind::Face:
        return scene.faces()[t.face].facet == g.id;
    }
    return false;
  });
}

struct Tally {
  std::map<NodeKind, int> with, without;
  int wrong = 0, end_contacts = 0;
};

void check_nodes(const Scene& scene, EventMode mode, Tally& tally) {
  const Skeleton skeleton = all_kinds(scene, mode);
  const SkeletonLines lines(scene);
  for (const SkeletonNode& node : skeleton.nodes) {
    const auto line = lines.line(skeleton, node);
    if (!line) {
      ++tally.without[node.kind];
      // Degenerate generators may leave a choice; a line along a face may end with it.
      EXPECT_TRUE(node.kind == NodeKind::Degenerate ||
                  (node.kind == NodeKind::FEE && node.end))
          << static_cast<int>(node.kind);
      continue;
    }
    ++tally.with[node.kind];
    EXPECT_LE(line->from, 0);
    EXPECT_GE(line->to, 1);
    double last = -1e300;
    for (const Contact& c : line->contacts) {
      EXPECT_LE(last, c.from);
      EXPECT_LE(c.from, c.to);
      last = c.from;
      EXPECT_TRUE(!c.blocked || c.from == line->from || c.to == line->to);
      tally.end_contacts += static_cast<int>(c.blocked);
    }
    for (const double position : {0.0, 1.0}) {
      EXPECT_TRUE(std::ranges::any_of(line->contacts, [&](const Contact& c) {
        return c.from <= position && c.to >= position;
      }));
    }
    // The generators in order, each at the contact of the one before or at a later one.
    std::size_t at = 0;
    bool all = true;
    for (const Generator& g : skeleton.generators(node)) {
      while (at < line->contacts.size() && !touches(scene, line->contacts[at], g)) ++at;
      all = all && at < line->contacts.size();
    }
    // FF tells its facets by their numbers, VEE begins with its vertex.
    if (!all) {
      at = 0;
      all = true;
      const auto generators = skeleton.generators(node);
      for (auto g = generators.rbegin(); g != generators.rend(); ++g) {
        while (at < line->contacts.size() && !touches(scene, line->contacts[at], *g))
          ++at;
        all = all && at < line->contacts.size();
      }
    }
    // In the plane of one face of a facet that is flat only by tolerance the line may
    // pass the others an ulp away.
    const bool flat = std::ranges::all_of(skeleton.generators(node), [&](const auto& g) {
      return g.kind != GeneratorKind::Face || scene.facets()[g.id].planar;
    });
    if (!all && flat && tally.wrong++ < 5) {
      ADD_FAILURE() << "kind " << static_cast<int>(node.kind) << " end " << node.end
                    << " generators " << node.generator_count << " contacts "
                    << line->contacts.size();
    }
  }
}

void report(const char* name, const Tally& tally) {
  std::printf("%s:", name);
  for (const auto& [kind, n] : tally.with) {
    const auto none = tally.without.find(kind);
    std::printf(" %d: %d (%d without)", static_cast<int>(kind), n,
                none == tally.without.end() ? 0 : none->second);
  }
  std::printf("; %d end contacts\n", tally.end_contacts);
}

TEST(NodeLines, OfEveryKindInGeneralPosition) {
  Tally tally;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    check_nodes(Scene(testing::eee_scene(seed)), EventMode::Solid, tally);
  }
  report("solid", tally);
  EXPECT_TRUE(tally.without.empty());
  for (const NodeKind kind : {NodeKind::VV, NodeKind::VEE, NodeKind::EVE, NodeKind::FvE,
                              NodeKind::EEEE, NodeKind::FEE, NodeKind::FF}) {
    EXPECT_GT(tally.with[kind], 10) << static_cast<int>(kind);
  }
  EXPECT_EQ(tally.end_contacts, 0);
}

TEST(NodeLines, OfEveryKindInPolygonMode) {
  Tally tally;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    check_nodes(Scene(testing::eee_scene(seed)), EventMode::Polygon, tally);
  }
  report("polygon", tally);
  EXPECT_TRUE(tally.without.empty());
  EXPECT_GT(tally.with[NodeKind::EEEE], 10);
  EXPECT_GT(tally.end_contacts, 100);
}

/// Two sets of solids that overlap.
PolygonSoup overlapping(std::uint64_t seed) {
  PolygonSoup soup =
      testing::random_polytopes(seed, 3, {.max_vertices = 6, .density = 0.5});
  const PolygonSoup other =
      testing::random_polytopes(seed + 100, 3, {.max_vertices = 6, .density = 0.5});
  const auto shift = static_cast<int>(soup.vertices.size());
  soup.vertices.insert(soup.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (std::vector<int> polygon : other.polygons) {
    for (int& p : polygon) p += shift;
    soup.polygons.push_back(std::move(polygon));
  }
  soup.groups.clear();
  return soup;
}

// Overlapping solids have Pierce nodes, aligned ones degenerate nodes of all sorts.
TEST(NodeLines, OfPiercedAndDegenerateNodes) {
  Tally tally;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    check_nodes(Scene(testing::random_boxes(seed, 5, {.grid = 5})), EventMode::Solid,
                tally);
    check_nodes(Scene(testing::rotated_boxes(seed, 5)), EventMode::Solid, tally);
  }
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    check_nodes(Scene(overlapping(seed)), EventMode::Solid, tally);
  }
  check_nodes(Scene(testing::triangle_soup(3, 12)), EventMode::Solid, tally);
  check_nodes(Scene(testing::city(2, 40)), EventMode::Solid, tally);
  report("degenerate", tally);
  EXPECT_GT(tally.with[NodeKind::Degenerate], 100);
  EXPECT_GT(tally.with[NodeKind::Pierce], 10);
}

// The far ends of an EEEE line are those of the arcs that end there with the same outer
// edges: found by the arcs' own cuts.
TEST(NodeLines, EndWhereTheArcsBesideThemDo) {
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Scene scene(testing::random_polytopes(seed, 8, {.density = 0.35}));
    const Skeleton skeleton = build_skeleton(scene);
    const SkeletonLines lines(scene);
    const EndIndex ends(scene, skeleton);
    const auto facet_of = [&](const std::vector<int>& faces) {
      return faces.empty() ? kOutside : scene.faces()[faces.front()].facet;
    };
    for (auto i = static_cast<std::uint32_t>(skeleton.ev_count());
         i < skeleton.arcs.size(); ++i) {
      const SkeletonArc& arc = skeleton.arcs[i];
      const auto pieces = ends.pieces(i);
      for (const int k : {0, 1}) {
        const SkeletonNode& node = skeleton.nodes[arc.nodes[k]];
        if (node.kind != NodeKind::EEEE) continue;
        const auto generators = skeleton.generators(node);
        const bool same = generators.front().id == arc.edges()[0] &&
                          generators.back().id == arc.edges()[2];
        const bool turned = generators.front().id == arc.edges()[2] &&
                            generators.back().id == arc.edges()[0];
        if (!same && !turned) continue;
        const auto line = lines.line(skeleton, node);
        ASSERT_TRUE(line.has_value());
        std::array<std::int32_t, 2> facets{facet_of(line->from_faces),
                                           facet_of(line->to_faces)};
        if (turned) std::swap(facets[0], facets[1]);
        EXPECT_EQ(facets, (k == 0 ? pieces.front() : pieces.back()).facets)
            << seed << " arc " << i;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 100);
  std::printf("%d EEEE lines compared\n", compared);
}

using testing::Rational;
using testing::Vec3;

std::array<Vec3, 2> parsed(const std::array<ExactPosition, 2>& points) {
  std::array<Vec3, 2> out;
  for (int k = 0; k < 2; ++k) {
    for (int i = 0; i < 3; ++i) {
      out[k][i] = Rational(points[k].exact[i]);
      EXPECT_EQ(points[k].is_double[i], Rational(points[k].nearest[i]) == out[k][i]);
    }
  }
  return out;
}

// What --list tells of arcs and nodes holds exactly: the line's points are on the outer
// generators of an arc, and the line meets all others; a node's line meets its own.
TEST(NodeLines, ExactPointsAreOnLinesThatMeetTheirGenerators) {
  int arcs = 0, nodes = 0, irrational = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Scene scene(testing::eee_scene(seed));
    const SkeletonLines lines(scene);
    const Skeleton skeleton = all_kinds(scene, EventMode::Solid);
    const auto point = [&](int id) { return testing::exact(scene.point(id)); };
    const auto on = [&](const Vec3& p, const Vec3& a, const Vec3& b) {
      return testing::is_zero(testing::cross(b - a, p - a));
    };
    const auto on_edge = [&](const Vec3& p, int edge) {
      const auto& e = scene.edges()[edge].points;
      return on(p, point(e[0]), point(e[1]));
    };
    const auto meets_edge = [&](const std::array<Vec3, 2>& line, int edge) {
      const auto& e = scene.edges()[edge].points;
      const Vec3 n = testing::cross(line[1] - line[0], point(e[0]) - line[0]);
      return testing::dot(n, point(e[1]) - line[0]) == 0;
    };
    for (const SkeletonArc& arc : skeleton.ev()) {
      const auto at = parsed(*lines.points(arc, 0.5 * (arc.range[0] + arc.range[1])));
      EXPECT_EQ(at[0], point(arc.vertex()));
      EXPECT_TRUE(on_edge(at[1], arc.edge()));
      ++arcs;
    }
    for (const SkeletonArc& arc : skeleton.eee()) {
      const auto found = lines.points(arc, 0.5 * (arc.range[0] + arc.range[1]));
      ASSERT_TRUE(found);
      const auto at = parsed(*found);
      EXPECT_TRUE(on_edge(at[0], arc.edges()[0]) && on_edge(at[1], arc.edges()[2]));
      EXPECT_TRUE(meets_edge(at, arc.edges()[1]));
      ++arcs;
    }
    for (const SkeletonNode& node : skeleton.nodes) {
      const auto found = lines.points(skeleton, node);
      irrational += node.kind == NodeKind::EEEE && !found;
      if (!found) continue;
      const auto at = parsed(*found);
      ++nodes;
      for (const Generator& g : skeleton.generators(node)) {
        EXPECT_TRUE(g.kind != GeneratorKind::Vertex || on(point(g.id), at[0], at[1]));
        EXPECT_TRUE(g.kind != GeneratorKind::Edge || meets_edge(at, g.id));
      }
    }
  }
  std::printf("%d arcs, %d nodes, %d irrational\n", arcs, nodes, irrational);
  EXPECT_GT(arcs, 3000);
  EXPECT_GT(nodes, 3000);
  EXPECT_GT(irrational, 30);
}

}  // namespace
}  // namespace sightline
