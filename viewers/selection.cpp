#include "viewers/selection.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "viewers/answer.h"

namespace sightline::viewers {
namespace {

/// The points, edges and facets of a group's faces.
class Members {
 public:
  Members(const Scene& scene, const std::string& group) : faces_(scene.faces().size()) {
    std::set<int> objects;
    facets_.resize(scene.facets().size());
    points_.resize(scene.points().size());
    edges_.resize(scene.edges().size());
    for (const int f : scene.faces_named(group)) {
      faces_[f] = 1;
      facets_[scene.faces()[f].facet] = 1;
      objects.insert(scene.faces()[f].object);
      for (const int p : scene.face_points(f)) points_[p] = 1;
    }
    objects_.assign(objects.begin(), objects.end());
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      // A merged edge names one face of each facet along it.
      edges_[e] =
          std::ranges::any_of(scene.edges()[e].sides, [&](const Edge::Side& side) {
            return facets_[scene.faces()[side.face].facet] != 0;
          });
    }
  }

  [[nodiscard]] const std::vector<int>& objects() const { return objects_; }
  [[nodiscard]] bool vertex(int p) const { return points_[p] != 0; }
  [[nodiscard]] bool edge(int e) const { return edges_[e] != 0; }
  [[nodiscard]] bool has(const Generator& g) const {
    switch (g.kind) {
      case GeneratorKind::Vertex:
        return vertex(g.id);
      case GeneratorKind::Edge:
        return edge(g.id);
      case GeneratorKind::Face:
        return facets_[g.id] != 0;
    }
    return false;
  }

 private:
  std::vector<char> faces_, facets_, points_, edges_;
  std::vector<int> objects_;
};

/// Keeps the arcs for which `keep` holds, and the nodes at their ends or for which
/// `keep_node` holds; renumbers.
template <typename KeepArc, typename KeepNode>
Skeleton filtered(const Skeleton& whole, const KeepArc& keep, const KeepNode& keep_node) {
  Skeleton part;
  part.complete = whole.complete;
  part.vertices_done = whole.vertices_done;
  part.vertices_asked = whole.vertices_asked;
  part.predicates = whole.predicates;
  std::vector<char> kept(whole.nodes.size());
  for (const SkeletonArc& arc : whole.arcs) {
    if (keep(arc)) kept[arc.nodes[0]] = kept[arc.nodes[1]] = 1;
  }
  std::vector<std::uint32_t> renamed(whole.nodes.size());
  for (std::size_t n = 0; n < whole.nodes.size(); ++n) {
    const std::span<const Generator> generators = whole.generators(whole.nodes[n]);
    if (!kept[n] && !keep_node(generators)) continue;
    renamed[n] = static_cast<std::uint32_t>(part.nodes.size());
    part.nodes.push_back(whole.nodes[n]);
    part.nodes.back().first_generator =
        static_cast<std::uint32_t>(part.generator_pool.size());
    part.generator_pool.insert(part.generator_pool.end(), generators.begin(),
                               generators.end());
  }
  for (SkeletonArc arc : whole.arcs) {
    if (!keep(arc)) continue;
    arc.nodes = {renamed[arc.nodes[0]], renamed[arc.nodes[1]]};
    part.arcs.push_back(arc);
  }
  return part;
}

/// The union of two skeletons of one scene.  Equal nodes have equal kinds and generators,
/// equal arcs equal vertex, edge and range.
Skeleton united(const Skeleton& a, const Skeleton& b) {
  Skeleton both;
  both.complete = a.complete && b.complete;
  both.vertices_done = a.vertices_done + b.vertices_done;
  both.vertices_asked = a.vertices_asked + b.vertices_asked;
  both.predicates = a.predicates + b.predicates;
  using NodeKey = std::tuple<NodeKind, bool, bool, std::vector<Generator>>;
  std::map<NodeKey, std::uint32_t> known;
  std::map<std::tuple<int, int, double>, SkeletonArc> arcs;
  for (const Skeleton* one : {&a, &b}) {
    std::vector<std::uint32_t> renamed;
    for (const SkeletonNode& node : one->nodes) {
      const std::span<const Generator> generators = one->generators(node);
      const auto [entry, is_new] = known.try_emplace(
          NodeKey{node.kind, node.self, node.end, {generators.begin(), generators.end()}},
          static_cast<std::uint32_t>(both.nodes.size()));
      renamed.push_back(entry->second);
      if (!is_new) continue;
      both.nodes.push_back(node);
      both.nodes.back().first_generator =
          static_cast<std::uint32_t>(both.generator_pool.size());
      both.generator_pool.insert(both.generator_pool.end(), generators.begin(),
                                 generators.end());
    }
    for (SkeletonArc arc : one->arcs) {
      arc.nodes = {renamed[arc.nodes[0]], renamed[arc.nodes[1]]};
      arcs.try_emplace({arc.vertex, arc.edge, arc.range[0]}, arc);
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
  return filtered(
      build_ev_skeleton(scene, request),
      [&](const SkeletonArc& arc) {
        return (a.vertex(arc.vertex) && b.edge(arc.edge)) ||
               (b.vertex(arc.vertex) && a.edge(arc.edge));
      },
      [&](std::span<const Generator> generators) {
        const auto on = [&](const Members& m) {
          return std::ranges::any_of(generators,
                                     [&](const Generator& g) { return m.has(g); });
        };
        return on(a) && on(b);
      });
}

Skeleton build_through(const Scene& scene, const SkeletonRequest& request,
                       const std::string& group) {
  const Members members(scene, group);
  SkeletonRequest by_vertex = request, by_edge = request;
  by_vertex.vertex_objects = members.objects();
  by_edge.edge_objects = members.objects();
  Skeleton first = build_ev_skeleton(scene, by_vertex);
  Skeleton second = build_ev_skeleton(scene, by_edge);
  return filtered(
      united(first, second),
      [&](const SkeletonArc& arc) {
        return members.vertex(arc.vertex) || members.edge(arc.edge);
      },
      [&](std::span<const Generator> generators) {
        return std::ranges::any_of(generators,
                                   [&](const Generator& g) { return members.has(g); });
      });
}

}  // namespace

Skeleton build_selected(const Scene& scene, const SkeletonRequest& request,
                        const Selection& selection) {
  if (selection.between) return build_between(scene, request, *selection.between);
  if (selection.through) return build_through(scene, request, *selection.through);
  return build_ev_skeleton(scene, request);
}

}  // namespace sightline::viewers
