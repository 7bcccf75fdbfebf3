#include "skeleton/build/between_faces.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <set>
#include <span>

namespace sightline::internal {
namespace {

// The points, edges and facets of some faces; all where none are named.
class Members {
 public:
  Members(const Scene& scene, std::span<const int> faces) : all_(faces.empty()) {
    if (all_) return;
    facets_.resize(scene.facets().size());
    points_.resize(scene.points().size());
    edges_.resize(scene.edges().size());
    for (const int f : faces) {
      facets_[scene.faces()[f].facet] = 1;
      for (const int p : scene.face_points(f)) points_[p] = 1;
    }
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      // A merged edge names one face of each facet along it.
      edges_[e] =
          std::ranges::any_of(scene.edges()[e].sides, [&](const Edge::Side& side) {
            return facets_[scene.faces()[side.face].facet] != 0;
          });
    }
  }

  [[nodiscard]] bool vertex(int p) const { return all_ || points_[p] != 0; }
  [[nodiscard]] bool facet(int f) const { return all_ || facets_[f] != 0; }
  [[nodiscard]] bool edge(int e) const { return all_ || (e >= 0 && edges_[e] != 0); }

 private:
  std::vector<char> points_, edges_, facets_;
  bool all_;
};

// What belongs to a part of the skeleton.
struct Part {
  std::function<bool(int vertex, int edge)> ev;
  std::function<bool(const SkeletonArc&)> eee;
  std::function<bool(int facet, int other)> ff;

  [[nodiscard]] bool has(const SkeletonArc& arc) const {
    return arc.is_ev() ? ev(arc.vertex(), arc.edge()) : eee(arc);
  }
  /// A line of two facets that both belong to it.
  [[nodiscard]] bool joins_facets(std::span<const Generator> generators) const {
    for (std::size_t i = 0; i < generators.size(); ++i) {
      for (std::size_t j = i + 1; j < generators.size(); ++j) {
        if (generators[i].kind == GeneratorKind::Face &&
            generators[j].kind == GeneratorKind::Face &&
            ff(generators[i].id, generators[j].id)) {
          return true;
        }
      }
    }
    return false;
  }

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
Skeleton filtered(const Skeleton& whole, const Part& part,
                  const SkeletonRequest& request) {
  Skeleton out;
  out.events = whole.events;
  out.complete = whole.complete;
  out.stopped_by = whole.stopped_by;
  out.vertices_done = whole.vertices_done;
  out.vertices_asked = whole.vertices_asked;
  out.edges_done = whole.edges_done;
  out.edges_asked = whole.edges_asked;
  out.facets_done = whole.facets_done;
  out.facets_asked = whole.facets_asked;
  out.predicates = whole.predicates;
  out.simplified = whole.simplified;
  std::erase_if(out.simplified.arcs, [&](const Simplified::Arc& arc) {
    return !part.ev(arc.vertex, arc.edge);
  });
  std::ranges::copy_if(whole.arcs, std::back_inserter(out.arcs),
                       [&](const SkeletonArc& arc) { return part.has(arc); });
  std::vector<char> kept(whole.nodes.size());
  for (const SkeletonArc& arc : out.arcs) kept[arc.nodes[0]] = kept[arc.nodes[1]] = 1;
  std::vector<std::uint32_t> renamed(whole.nodes.size());
  for (std::size_t n = 0; n < whole.nodes.size(); ++n) {
    const SkeletonNode& node = whole.nodes[n];
    const auto generators = whole.generators(node);
    if (!kept[n] && !(request.ev && part.lines_up(generators)) &&
        !(request.ff && part.joins_facets(generators))) {
      continue;
    }
    renamed[n] = static_cast<std::uint32_t>(out.nodes.size());
    copy_node(whole, node, out);
  }
  for (SkeletonArc& arc : out.arcs) {
    for (std::uint32_t& n : arc.nodes) n = renamed[n];
  }
  return out;
}

std::vector<int> objects_of(const Scene& scene, std::span<const int> faces) {
  std::set<int> objects;
  for (const int f : faces) objects.insert(scene.faces()[f].object);
  return {objects.begin(), objects.end()};
}

}  // namespace

std::optional<SkeletonPart> between_objects(const Scene& scene,
                                            const SkeletonPart& part) {
  const auto& faces = part.between_faces;
  if (faces[0].empty() && faces[1].empty()) return std::nullopt;
  SkeletonPart wider = part;
  wider.between_faces = {};
  // Arcs between other objects stay out, where no objects are asked for besides.
  if (part.outer_objects[0].empty() && part.outer_objects[1].empty()) {
    wider.outer_objects = {objects_of(scene, faces[0]), objects_of(scene, faces[1])};
  }
  return wider;
}

Skeleton between_faces(const Scene& scene, const Skeleton& wider,
                       const SkeletonRequest& request) {
  const Members a(scene, request.part.between_faces[0]);
  const Members b(scene, request.part.between_faces[1]);
  const Part part{[&](int vertex, int edge) {
                    return (a.vertex(vertex) && b.edge(edge)) ||
                           (b.vertex(vertex) && a.edge(edge));
                  },
                  [&](const SkeletonArc& arc) {
                    return (a.edge(arc.edges()[0]) && b.edge(arc.edges()[2])) ||
                           (b.edge(arc.edges()[0]) && a.edge(arc.edges()[2]));
                  },
                  [&](int f, int g) {
                    return (a.facet(f) && b.facet(g)) || (b.facet(f) && a.facet(g));
                  }};
  return filtered(wider, part, request);
}

}  // namespace sightline::internal
