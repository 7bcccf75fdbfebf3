#include "skeleton/skeleton_index.h"

#include <array>

#include "skeleton/nodes/node_structure.h"

namespace sightline {
namespace {

// Groups values by slot: visit(add) calls add(slot, value) for all of them, the same way
// each time it is called.
template <class T, class Visit>
void group(std::size_t slots, const Visit& visit, std::vector<std::uint32_t>& starts,
           std::vector<T>& items) {
  starts.assign(slots + 1, 0);
  visit([&](std::size_t slot, const T&) { ++starts[slot + 1]; });
  for (std::size_t i = 0; i < slots; ++i) starts[i + 1] += starts[i];
  items.resize(starts[slots]);
  std::vector<std::uint32_t> next(starts.begin(), starts.end() - 1);
  visit([&](std::size_t slot, const T& value) { items[next[slot]++] = value; });
}

std::string name(NodeKind kind) {
  constexpr std::array kNames{"VV",  "VEE",    "EVE",    "FvE",       "EEEE",
                              "FEE", "saddle", "pierce", "degenerate"};
  return kNames[static_cast<std::size_t>(kind)];
}

}  // namespace

std::vector<ArcRef> all_arcs(const Skeleton& skeleton) {
  const std::size_t ev = skeleton.arcs.size();
  std::vector<ArcRef> arcs(ev + skeleton.eee_arcs.size());
  for (std::size_t i = 0; i < arcs.size(); ++i) arcs[i] = arc_at(i, ev);
  return arcs;
}

SkeletonIndex::SkeletonIndex(const Scene& scene, const Skeleton& skeleton)
    : scene_(scene),
      skeleton_(skeleton),
      points_(scene.points().size()),
      edges_(scene.edges().size()),
      facets_(scene.facets().size()) {
  const auto each_arc = [&](const auto& visit) {
    for (std::uint32_t i = 0; i < skeleton.arcs.size(); ++i) {
      visit(ArcRef{ArcKind::EV, i}, skeleton.arcs[i].nodes);
    }
    for (std::uint32_t i = 0; i < skeleton.eee_arcs.size(); ++i) {
      visit(ArcRef{ArcKind::EEE, i}, skeleton.eee_arcs[i].nodes);
    }
  };
  group<ArcRef>(
      skeleton.nodes.size(),
      [&](const auto& add) {
        each_arc([&](const ArcRef& arc, const std::array<std::uint32_t, 2>& nodes) {
          for (const std::uint32_t node : nodes) add(node, arc);
        });
      },
      node_starts_, node_arcs_);
  const std::size_t slots = points_ + edges_ + facets_;
  group<ArcRef>(
      slots,
      [&](const auto& add) {
        for (std::uint32_t i = 0; i < skeleton.arcs.size(); ++i) {
          const SkeletonArc& arc = skeleton.arcs[i];
          add(slot({GeneratorKind::Vertex, arc.vertex}), ArcRef{ArcKind::EV, i});
          add(slot({GeneratorKind::Edge, arc.edge}), ArcRef{ArcKind::EV, i});
        }
        for (std::uint32_t i = 0; i < skeleton.eee_arcs.size(); ++i) {
          for (const std::int32_t edge : skeleton.eee_arcs[i].edges) {
            add(slot({GeneratorKind::Edge, edge}), ArcRef{ArcKind::EEE, i});
          }
        }
      },
      arc_starts_, generator_arcs_);
  group<std::uint32_t>(
      slots,
      [&](const auto& add) {
        for (std::uint32_t i = 0; i < skeleton.nodes.size(); ++i) {
          for (const Generator& g : skeleton.generators(skeleton.nodes[i])) {
            add(slot(g), i);
          }
        }
      },
      used_starts_, generator_nodes_);
}

std::size_t SkeletonIndex::slot(const Generator& generator) const {
  const auto id = static_cast<std::size_t>(generator.id);
  switch (generator.kind) {
    case GeneratorKind::Vertex:
      return id;
    case GeneratorKind::Edge:
      return points_ + id;
    default:
      return points_ + edges_ + id;
  }
}

std::span<const ArcRef> SkeletonIndex::arcs_of(const Generator& generator) const {
  return slice(generator_arcs_, arc_starts_, slot(generator));
}

std::span<const std::uint32_t> SkeletonIndex::nodes_of(const Generator& generator) const {
  return slice(generator_nodes_, used_starts_, slot(generator));
}

std::vector<std::string> SkeletonIndex::check_invariants() const {
  std::vector<std::string> wrong;
  for (std::uint32_t i = 0; i < skeleton_.nodes.size(); ++i) {
    const auto expected = internal::node_structure(scene_, skeleton_, skeleton_.nodes[i]);
    if (!expected) continue;
    int ev = 0;
    int eee = 0;
    for (const ArcRef& arc : arcs_at(i)) ++(arc.kind == ArcKind::EV ? ev : eee);
    if (ev == expected->ev && eee == expected->eee) continue;
    wrong.push_back("node " + std::to_string(i) + ", " + name(skeleton_.nodes[i].kind) +
                    (skeleton_.nodes[i].end ? " end" : "") + ": ends " +
                    std::to_string(ev) + " EV and " + std::to_string(eee) +
                    " EEE arcs instead of " + std::to_string(expected->ev) + " and " +
                    std::to_string(expected->eee));
  }
  return wrong;
}

}  // namespace sightline
