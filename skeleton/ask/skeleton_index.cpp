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

SkeletonIndex::SkeletonIndex(const Scene& scene, const Skeleton& skeleton)
    : scene_(scene),
      skeleton_(skeleton),
      points_(scene.points().size()),
      edges_(scene.edges().size()),
      facets_(scene.facets().size()) {
  const std::vector<SkeletonArc>& arcs = skeleton.arcs;
  group<std::uint32_t>(
      skeleton.nodes.size(),
      [&](const auto& add) {
        for (std::uint32_t i = 0; i < arcs.size(); ++i) {
          for (const std::uint32_t node : arcs[i].nodes) add(node, i);
        }
      },
      node_starts_, node_arcs_);
  const std::size_t slots = points_ + edges_ + facets_;
  group<std::uint32_t>(
      slots,
      [&](const auto& add) {
        for (std::uint32_t i = 0; i < arcs.size(); ++i) {
          if (arcs[i].is_ev()) {
            add(slot({GeneratorKind::Vertex, arcs[i].vertex()}), i);
            add(slot({GeneratorKind::Edge, arcs[i].edge()}), i);
          } else {
            for (const std::int32_t e : arcs[i].edges()) {
              add(slot({GeneratorKind::Edge, e}), i);
            }
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

std::span<const std::uint32_t> SkeletonIndex::arcs_of(const Generator& generator) const {
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
    for (const std::uint32_t a : arcs_at(i)) ++(skeleton_.arcs[a].is_ev() ? ev : eee);
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
