#include "viewers/selection.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <set>
#include <tuple>

#include "viewers/answer.h"

namespace sightline::viewers {
namespace {

/// The points and edges of a group's faces.
class Members {
 public:
  Members(const Scene& scene, const std::string& group) {
    std::set<int> objects;
    std::vector<char> facets(scene.facets().size());
    points_.resize(scene.points().size());
    edges_.resize(scene.edges().size());
    for (const int f : scene.faces_named(group)) {
      facets[scene.faces()[f].facet] = 1;
      objects.insert(scene.faces()[f].object);
      for (const int p : scene.face_points(f)) points_[p] = 1;
    }
    objects_.assign(objects.begin(), objects.end());
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      // A merged edge names one face of each facet along it.
      edges_[e] =
          std::ranges::any_of(scene.edges()[e].sides, [&](const Edge::Side& side) {
            return facets[scene.faces()[side.face].facet] != 0;
          });
    }
  }

  [[nodiscard]] const std::vector<int>& objects() const { return objects_; }
  [[nodiscard]] bool vertex(int p) const { return points_[p] != 0; }
  [[nodiscard]] bool edge(int e) const { return e >= 0 && edges_[e] != 0; }

 private:
  std::vector<char> points_, edges_;
  std::vector<int> objects_;
};

/// What belongs to a part of the skeleton.
struct Part {
  std::function<bool(int vertex, int edge)> ev;
  std::function<bool(const EeeArc&)> eee;

  /// Two EV arcs of the part line up through a corner there.
  [[nodiscard]] bool lines_up(std::span<const Generator> generators) const {
    for (std::size_t j = 1; j + 1 < generators.size(); ++j) {
      if (generators[j].kind != GeneratorKind::Vertex) continue;
      const auto arc_on = [&](const Generator& g) {
        return g.kind == GeneratorKind::Edge && ev(generators[j].id, g.id);
      };
      if (std::ranges::any_of(generators.first(j), arc_on) &&
          std::ranges::any_of(generators.subspan(j + 1), arc_on)) {
        return true;
      }
    }
    return false;
  }
};

void copy_node(const Skeleton& from, const SkeletonNode& node, Skeleton& to) {
  const std::span<const Generator> generators = from.generators(node);
  to.nodes.push_back(node);
  to.nodes.back().first_generator = static_cast<std::uint32_t>(to.generator_pool.size());
  to.generator_pool.insert(to.generator_pool.end(), generators.begin(), generators.end());
}

/// The part's arcs, the nodes at their ends and where its EV arcs line up; renumbered.
Skeleton filtered(const Skeleton& whole, const Part& part, bool with_ev) {
  Skeleton out;
  out.complete = whole.complete;
  out.vertices_done = whole.vertices_done;
  out.vertices_asked = whole.vertices_asked;
  out.edges_done = whole.edges_done;
  out.edges_asked = whole.edges_asked;
  out.predicates = whole.predicates;
  for (const SkeletonArc& arc : whole.arcs) {
    if (part.ev(arc.vertex, arc.edge)) out.arcs.push_back(arc);
  }
  for (const EeeArc& arc : whole.eee_arcs) {
    if (part.eee(arc)) out.eee_arcs.push_back(arc);
  }
  std::vector<char> kept(whole.nodes.size());
  for (const SkeletonArc& arc : out.arcs) kept[arc.nodes[0]] = kept[arc.nodes[1]] = 1;
  for (const EeeArc& arc : out.eee_arcs) kept[arc.nodes[0]] = kept[arc.nodes[1]] = 1;
  std::vector<std::uint32_t> renamed(whole.nodes.size());
  for (std::size_t n = 0; n < whole.nodes.size(); ++n) {
    const SkeletonNode& node = whole.nodes[n];
    if (!kept[n] && !(with_ev && part.lines_up(whole.generators(node)))) continue;
    renamed[n] = static_cast<std::uint32_t>(out.nodes.size());
    copy_node(whole, node, out);
  }
  for (SkeletonArc& arc : out.arcs) {
    for (std::uint32_t& n : arc.nodes) n = renamed[n];
  }
  for (EeeArc& arc : out.eee_arcs) {
    for (std::uint32_t& n : arc.nodes) n = renamed[n];
  }
  return out;
}

/// What tells a node from all others, whichever way along its line it was found.
auto key_of(const SkeletonNode& node, std::span<const Generator> generators) {
  std::vector<Generator> forward(generators.begin(), generators.end());
  std::vector<Generator> backward(generators.rbegin(), generators.rend());
  const bool any_end = node.kind != NodeKind::Degenerate && node.end;
  return std::tuple(node.kind, any_end, node.second, std::min(forward, backward));
}

/// The union of two skeletons of one scene.
Skeleton united(const Skeleton& a, const Skeleton& b) {
  Skeleton both;
  both.complete = a.complete && b.complete;
  both.vertices_done = a.vertices_done + b.vertices_done;
  both.vertices_asked = a.vertices_asked + b.vertices_asked;
  both.edges_done = a.edges_done + b.edges_done;
  both.edges_asked = a.edges_asked + b.edges_asked;
  both.predicates = a.predicates + b.predicates;
  std::map<decltype(key_of({}, {})), std::uint32_t> known;
  std::map<std::tuple<int, int, double>, SkeletonArc> arcs;
  std::set<std::tuple<std::array<std::int32_t, 3>, double>> eee_arcs;
  for (const Skeleton* one : {&a, &b}) {
    std::vector<std::uint32_t> renamed;
    for (const SkeletonNode& node : one->nodes) {
      const auto [entry, is_new] =
          known.try_emplace(key_of(node, one->generators(node)),
                            static_cast<std::uint32_t>(both.nodes.size()));
      renamed.push_back(entry->second);
      if (is_new) {
        copy_node(*one, node, both);
      } else {
        both.nodes[entry->second].end |= node.end;
      }
    }
    for (SkeletonArc arc : one->arcs) {
      arc.nodes = {renamed[arc.nodes[0]], renamed[arc.nodes[1]]};
      arcs.try_emplace({arc.vertex, arc.edge, arc.range[0]}, arc);
    }
    for (EeeArc arc : one->eee_arcs) {
      arc.nodes = {renamed[arc.nodes[0]], renamed[arc.nodes[1]]};
      if (eee_arcs.emplace(arc.edges, arc.range[0]).second) both.eee_arcs.push_back(arc);
    }
  }
  for (const auto& [key, arc] : arcs) both.arcs.push_back(arc);
  return both;
}

Skeleton build_between(const Scene& scene, SkeletonRequest request,
                       const std::array<std::string, 2>& groups) {
  const Members a(scene, groups[0]), b(scene, groups[1]);
  std::set<int> objects(a.objects().begin(), a.objects().end());
  objects.insert(b.objects().begin(), b.objects().end());
  request.vertex_objects.assign(objects.begin(), objects.end());
  request.edge_objects = request.vertex_objects;
  request.outer_objects = {a.objects(), b.objects()};
  const Part part{[&](int vertex, int edge) {
                    return (a.vertex(vertex) && b.edge(edge)) ||
                           (b.vertex(vertex) && a.edge(edge));
                  },
                  [&](const EeeArc& arc) {
                    return (a.edge(arc.edges[0]) && b.edge(arc.edges[2])) ||
                           (b.edge(arc.edges[0]) && a.edge(arc.edges[2]));
                  }};
  return filtered(build_skeleton(scene, request), part, request.ev);
}

Skeleton build_through(const Scene& scene, const SkeletonRequest& request,
                       const std::string& group) {
  const Members members(scene, group);
  const Part part{
      [&](int vertex, int edge) { return members.vertex(vertex) || members.edge(edge); },
      [&](const EeeArc& arc) {
        return std::ranges::any_of(arc.edges, [&](int e) { return members.edge(e); });
      }};
  SkeletonRequest second = request;
  second.edge_objects = members.objects();
  second.through_objects = members.objects();
  if (!request.ev) return filtered(build_skeleton(scene, second), part, false);
  // EV arcs by vertex, then by edge; the EEE arcs with the second.
  SkeletonRequest first = request;
  first.eee = false;
  first.vertex_objects = members.objects();
  const auto start = std::chrono::steady_clock::now();
  const Skeleton by_vertex = build_skeleton(scene, first);
  second.budget_seconds -=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return filtered(united(by_vertex, build_skeleton(scene, second)), part, true);
}

}  // namespace

Skeleton build_selected(const Scene& scene, const SkeletonRequest& request,
                        const Selection& selection) {
  if (selection.between) return build_between(scene, request, *selection.between);
  if (selection.through) return build_through(scene, request, *selection.through);
  return build_skeleton(scene, request);
}

}  // namespace sightline::viewers
