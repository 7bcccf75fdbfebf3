// Looking things up in a finished skeleton: which arcs meet at a node, which arcs and
// nodes a vertex, an edge or a facet generates; and the local structure that every node
// must have.

#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "skeleton/graph.h"

namespace sightline {

/// Immutable; safe to share between threads; keeps references to scene and skeleton.
/// Built in time linear in its size; every look-up is a slice of an array, no geometry.
class SkeletonIndex {
 public:
  /// `skeleton` must be of this scene.
  SkeletonIndex(const Scene& scene, const Skeleton& skeleton);

  /// Numbers of the arcs that end at a node, EV first; an arc that both begins and ends
  /// there twice.
  [[nodiscard]] std::span<const std::uint32_t> arcs_at(std::uint32_t node) const {
    return slice(node_arcs_, node_starts_, node);
  }
  /// Numbers of the arcs with that generator: a vertex's EV arcs, an edge's EV and EEE
  /// arcs; none for a facet.
  [[nodiscard]] std::span<const std::uint32_t> arcs_of(const Generator& generator) const;
  /// Nodes with that generator among their contacts.
  [[nodiscard]] std::span<const std::uint32_t> nodes_of(const Generator& generator) const;

  /// What general position demands of every node and this skeleton does not have, one
  /// line each, naming the node; empty when all is well.  Solid mode, as ends of arcs:
  ///   VV 4 EV;  VEE 1 EV and 2 EEE;  FvE 1 EV;  EVE, EEEE, FEE 2 EEE;
  ///   FF none (what meets there are lines in a face's plane along an edge);
  /// an `end` node of VEE or FEE ends 1 EEE arc.  Degenerate, saddle, pierce, `_self`
  /// nodes and the other `end` nodes are not in general position and not asked.  Polygon
  /// mode, with n(v, x) edges at corner v that are not between two backs, seen from x:
  ///   VV n(v, w) + n(w, v) EV;  VEE 1 EV and n(v, e) EEE;  EVE and EEEE 2 EEE;
  ///   FvE 2 EV where the face lies beyond the corner, else 1;
  ///   FEE 3 EEE where the face is an outer contact, else 2;
  /// `end` or not.  Not asked there: corners that are neither convex nor of a sheet,
  /// faces of sheets.  Requires a complete skeleton of both kinds.
  [[nodiscard]] std::vector<std::string> check_invariants() const;

 private:
  template <class T>
  [[nodiscard]] static std::span<const T> slice(const std::vector<T>& items,
                                                const std::vector<std::uint32_t>& starts,
                                                std::size_t i) {
    return {items.data() + starts[i], starts[i + 1] - starts[i]};
  }
  [[nodiscard]] std::size_t slot(const Generator& generator) const;

  const Scene& scene_;
  const Skeleton& skeleton_;
  std::size_t points_, edges_, facets_;
  std::vector<std::uint32_t> node_starts_, arc_starts_, used_starts_;
  std::vector<std::uint32_t> node_arcs_, generator_arcs_, generator_nodes_;
};

}  // namespace sightline
