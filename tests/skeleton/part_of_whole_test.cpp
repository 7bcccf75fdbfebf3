// What is asked for is that part of the whole: every arc with its generators and its
// range, and the kind and the generators of the nodes at its ends, whatever else was
// asked for, in general position and on scenes where everything lines up.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "linespace/mesh_io.h"
#include "linespace/scene.h"
#include "skeleton/build.h"
#include "tests/support/generators.h"
#include "tests/support/library_skeleton.h"

namespace sightline {
namespace {

using EndNode = std::tuple<NodeKind, bool, std::vector<Generator>>;
/// Edges (and before them the vertex of an EV arc), range, end nodes.
using ArcKey = std::tuple<std::vector<int>, std::array<double, 2>, EndNode, EndNode>;

/// The arcs that `ev` and `eee` let through, in their order.
std::vector<ArcKey> arcs_of(const Skeleton& skeleton,
                            const std::function<bool(const SkeletonArc&)>& ev,
                            const std::function<bool(const SkeletonArc&)>& eee) {
  const auto node = [&](std::uint32_t id) {
    const SkeletonNode& n = skeleton.nodes[id];
    const auto g = skeleton.generators(n);
    return EndNode(n.kind, n.second, {g.begin(), g.end()});
  };
  std::vector<ArcKey> arcs;
  for (const SkeletonArc& a : skeleton.ev()) {
    if (!ev(a)) continue;
    arcs.emplace_back(std::vector<int>{a.vertex(), a.edge()}, a.range, node(a.nodes[0]),
                      node(a.nodes[1]));
  }
  for (const SkeletonArc& a : skeleton.eee()) {
    if (!eee(a)) continue;
    arcs.emplace_back(std::vector<int>(a.edges().begin(), a.edges().end()), a.range,
                      node(a.nodes[0]), node(a.nodes[1]));
  }
  return arcs;
}

std::string told(const ArcKey& arc) {
  std::ostringstream out;
  out.precision(17);
  const auto& [edges, range, from, to] = arc;
  for (const int e : edges) out << e << ' ';
  out << "from " << range[0] << " to " << range[1] << '\n';
  for (const EndNode* node : {&from, &to}) {
    out << "  " << testing::node_name(std::get<0>(*node)) << std::get<1>(*node);
    for (const Generator& g : std::get<2>(*node)) {
      out << ' ' << "VEF"[static_cast<int>(g.kind)] << g.id;
    }
    out << '\n';
  }
  return out.str();
}

bool has(const std::vector<int>& set, int x) {
  return set.empty() || std::find(set.begin(), set.end(), x) != set.end();
}

/// The request's own words, applied to the whole.
struct Rule {
  const Scene& scene;
  const SkeletonRequest& request;

  [[nodiscard]] bool inside(int point) const {
    if (!request.part.region) return true;
    const Point& p = scene.point(point);
    return (p.array() >= (*request.part.region)[0].array()).all() &&
           (p.array() <= (*request.part.region)[1].array()).all();
  }
  [[nodiscard]] bool edge_inside(int edge) const {
    const auto& p = scene.edges()[edge].points;
    return inside(p[0]) && inside(p[1]);
  }
  [[nodiscard]] bool on(const std::vector<int>& objects, int edge) const {
    if (objects.empty()) return true;
    // An edge stands for all that coincide with it.
    const auto ends = [&](const Edge& e) {
      std::array<std::array<double, 3>, 2> k;
      for (int i = 0; i < 2; ++i) {
        const Point& p = scene.point(e.points[i]);
        k[i] = {p[0], p[1], p[2]};
      }
      std::sort(k.begin(), k.end());
      return k;
    };
    const auto wanted = ends(scene.edges()[edge]);
    return std::any_of(scene.edges().begin(), scene.edges().end(), [&](const Edge& e) {
      return has(objects, e.object) && ends(e) == wanted;
    });
  }
  bool operator()(const SkeletonArc& a) const { return a.is_ev() ? ev(a) : eee(a); }
  [[nodiscard]] bool ev(const SkeletonArc& a) const {
    const auto faces = scene.faces_at(a.vertex());
    return request.ev && inside(a.vertex()) && edge_inside(a.edge()) &&
           std::any_of(faces.begin(), faces.end(),
                       [&](int f) {
                         return has(request.part.vertex_objects, scene.faces()[f].object);
                       }) &&
           on(request.part.edge_objects, a.edge()) && through(a) && between(a);
  }
  [[nodiscard]] bool at_vertex(const std::vector<int>& objects, int vertex) const {
    const auto faces = scene.faces_at(vertex);
    return objects.empty() || std::any_of(faces.begin(), faces.end(), [&](int f) {
             return has(objects, scene.faces()[f].object);
           });
  }
  [[nodiscard]] bool through(const SkeletonArc& a) const {
    return at_vertex(request.part.through_objects, a.vertex()) ||
           on(request.part.through_objects, a.edge());
  }
  [[nodiscard]] bool between(const SkeletonArc& a) const {
    const auto& o = request.part.outer_objects;
    return (at_vertex(o[0], a.vertex()) && on(o[1], a.edge())) ||
           (at_vertex(o[1], a.vertex()) && on(o[0], a.edge()));
  }
  [[nodiscard]] bool eee(const SkeletonArc& a) const {
    const auto& o = request.part.outer_objects;
    return request.eee &&
           std::all_of(a.edges().begin(), a.edges().end(),
                       [&](int e) { return edge_inside(e); }) &&
           ((on(o[0], a.edges()[0]) && on(o[1], a.edges()[2])) ||
            (on(o[0], a.edges()[2]) && on(o[1], a.edges()[0]))) &&
           std::any_of(a.edges().begin(), a.edges().end(),
                       [&](int e) { return on(request.part.through_objects, e); });
  }
};

std::vector<PolygonSoup> scenes() {
  PolygonSoup room = read_mesh(std::string(SIGHTLINE_EXAMPLES) + "/scenes/room.obj");
  room.source = "room";
  PolygonSoup sheets = read_mesh(std::string(SIGHTLINE_EXAMPLES) + "/scenes/cornell.obj");
  sheets.source = "sheets";
  return {room,
          sheets,
          testing::city(3, 90),
          testing::grid_city(1, 90),
          testing::grid_city(2, 72, {.may_touch = true}),
          testing::touching_boxes(testing::Touching::Pyramid),
          testing::random_polytopes(3, 12, {.max_vertices = 8, .density = 0.25})};
}

std::vector<std::pair<std::string, SkeletonRequest>> parts(const Scene& scene) {
  std::vector<std::pair<std::string, SkeletonRequest>> result;
  const int n = static_cast<int>(scene.objects().size());
  const auto add = [&](const std::string& name) -> SkeletonRequest& {
    result.emplace_back(name, SkeletonRequest{});
    return result.back().second;
  };
  add("EV alone").eee = false;
  add("EEE alone").ev = false;
  for (const int a : {0, n / 2, n - 1}) {
    add("through " + std::to_string(a)).part.through_objects = {a};
    add("vertices of " + std::to_string(a)).part.vertex_objects = {a};
    add("edges of " + std::to_string(a)).part.edge_objects = {a};
    SkeletonRequest& between = add("between " + std::to_string(a) + " and others");
    between.part.vertex_objects = {a};
    between.part.edge_objects = {(a + 1) % n, (a + 2) % n};
    between.part.outer_objects = {between.part.vertex_objects, between.part.edge_objects};
  }
  const auto& b = scene.bounds();
  add("region").part.region = {b[0] + 0.15 * (b[1] - b[0]), b[1]};
  return result;
}

TEST(PartOfWhole, EveryArcWithItsRangeAndEndNodes) {
  std::size_t compared = 0;
  std::set<NodeKind> kinds;
  for (const PolygonSoup& soup : scenes()) {
    SCOPED_TRACE(soup.source);
    const Scene scene(soup);
    const Skeleton whole = build_skeleton(scene);
    for (const SkeletonNode& node : whole.nodes) kinds.insert(node.kind);
    for (const auto& [name, request] : parts(scene)) {
      SCOPED_TRACE(name);
      const Rule rule{scene, request};
      const std::vector<ArcKey> expected = arcs_of(whole, rule, rule);
      const auto all = [](const auto&) { return true; };
      const std::vector<ArcKey> found = arcs_of(build_skeleton(scene, request), all, all);
      compared += expected.size();
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        ASSERT_TRUE(found[i] == expected[i]) << told(found[i]) << "in the whole\n"
                                             << told(expected[i]);
      }
    }
  }
  std::printf("%zu arcs compared\n", compared);
  EXPECT_GT(compared, 50000u);
  EXPECT_TRUE(kinds.contains(NodeKind::Degenerate));
}

}  // namespace
}  // namespace sightline
