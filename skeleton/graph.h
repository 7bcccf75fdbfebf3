// The visibility skeleton as a value: the critical line sets of a scene (EV, through a
// vertex and an edge; EEE, through three edges) as arcs, the extremal stabbing lines at
// their ends as nodes.  skeleton/build.h makes it; what asks about it: skeleton_index.h,
// skeleton_lines.h, end_index.h, view_events.h.
//
// Solid and polygon mode as the project's contract defines them (docs/polygon_mode.md).
// Contacts are derived from geometry, so that touching solids count as their union.

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "linespace/generator.h"
#include "linespace/predicates.h"
#include "linespace/request.h"
#include "linespace/scene.h"
#include "linespace/swath.h"

namespace sightline {

/// What an extremal stabbing line is held by, vertex first in the name; Degenerate lines
/// have more contacts than four degrees of freedom need; FF lies in the planes of two
/// facets, and ends no arc; Saddle is a line through a
/// corner along which two of that corner's own edges line up (objects that are not
/// convex); Pierce is where an edge enters a face (overlapping objects).
enum class NodeKind : std::uint8_t {
  VV,
  VEE,
  EVE,
  FvE,
  EEEE,
  FEE,
  FF,
  Saddle,
  Pierce,
  Degenerate
};

/// An extremal stabbing line.
struct SkeletonNode {
  NodeKind kind;
  /// Two contacts are on one object (counted under "..._self").
  bool self = false;
  /// The first or the last contact is a corner at which the line enters its solid: the
  /// line ends there rather than grazes (counted under "end").  Polygon mode: no node of
  /// solid mode that grazes, docs/polygon_mode.md ("At a node").
  bool end = false;
  /// EEEE: which of the two lines through the four edges; Degenerate: which of two
  /// irrational lines through the same edges.
  bool second = false;
  /// Polygon mode: the free segment ends in the first, in the last contact.
  std::array<bool, 2> ends{};
  /// The generators in order along the line: `generator_count` of them, from
  /// `first_generator` on in Skeleton::generator_pool (see Skeleton::generators()).  The
  /// order does not depend on how the line was found: VV begins with the smaller vertex,
  /// VEE and FvE with their vertex, other kinds with the end whose generators are
  /// smaller.
  std::uint32_t first_generator = 0;
  std::uint32_t generator_count = 0;
  /// The outermost contacts, rounded to double.
  std::array<Point, 2> segment;
};

enum class ArcKind : std::uint8_t { EV, EEE };

/// A critical line set: a connected set of lines with the same contacts that support them
/// and see along them.  EV: through a vertex and an open interval of an edge; EEE:
/// through three edges.  In polygon mode either outer contact may be an end contact all
/// along.
struct SkeletonArc {
  /// EV: point id, edge id, -1.  EEE: edge ids in order along the line, starting from the
  /// one that `range` is told on.  By name: vertex(), edge(), edges().
  std::array<std::int32_t, 3> generators{-1, -1, -1};
  ArcKind kind = ArcKind::EV;
  bool self = false;           ///< two of the generators are of one object
  std::array<bool, 2> ends{};  ///< the first, the last generator is an end contact
  /// Parameters along the edge, EEE: along the first one (0 at points[0], 1 at
  /// points[1]), rounded to double, of the ends of the open interval, and the nodes
  /// there.
  std::array<double, 2> range{};
  std::array<std::uint32_t, 2> nodes{};

  [[nodiscard]] static SkeletonArc ev(std::int32_t vertex, std::int32_t edge) {
    return {.generators = {vertex, edge, -1}, .kind = ArcKind::EV};
  }
  [[nodiscard]] static SkeletonArc eee(const std::array<std::int32_t, 3>& edges) {
    return {.generators = edges, .kind = ArcKind::EEE};
  }
  [[nodiscard]] bool is_ev() const { return kind == ArcKind::EV; }
  /// EV only.
  [[nodiscard]] std::int32_t vertex() const { return generators[0]; }
  [[nodiscard]] std::int32_t edge() const { return generators[1]; }
  /// EEE only.
  [[nodiscard]] const std::array<std::int32_t, 3>& edges() const { return generators; }
};
static_assert(sizeof(SkeletonArc) == 40);

/// What SkeletonRequest::feature_size left out.
struct Simplified {
  double feature_size = 0;
  /// Edge ids, point ids and object numbers of the whole scene, ascending, whatever part
  /// of it was asked for; of objects all edges and corners are among the others.
  std::vector<std::int32_t> edges, vertices, objects;
  /// EV arcs of larger features, too short themselves.
  struct Arc {
    std::int32_t vertex, edge;
    std::array<double, 2> range;
  };
  std::vector<Arc> arcs;
};

/// Immutable; safe to share between threads.  Deterministic: EV arcs are ordered by
/// vertex, edge and parameter, EEE arcs by outer and middle edges, whatever the number of
/// threads.
struct Skeleton {
  std::vector<SkeletonNode> nodes;
  /// EV arcs, then EEE arcs.  An arc's number is its position here.
  std::vector<SkeletonArc> arcs;
  std::vector<Generator> generator_pool;
  EventMode events = EventMode::Solid;
  bool complete = true;
  std::size_t vertices_done = 0, vertices_asked = 0;
  /// First edges of EEE arcs, each with all edges of higher number.
  std::size_t edges_done = 0, edges_asked = 0;
  /// First facets of FF nodes, each with all facets of higher number.
  std::size_t facets_done = 0, facets_asked = 0;
  StoppedBy stopped_by = StoppedBy::Nothing;
  Simplified simplified;
  StageCounts predicates;

  /// The arcs of one kind.  Cost: logarithmic.
  [[nodiscard]] std::span<const SkeletonArc> ev() const& {
    return std::span(arcs).first(ev_count());
  }
  [[nodiscard]] std::span<const SkeletonArc> eee() const& {
    return std::span(arcs).subspan(ev_count());
  }
  void ev() const&& = delete;
  void eee() const&& = delete;
  [[nodiscard]] std::size_t ev_count() const {
    const auto end = std::ranges::partition_point(arcs, &SkeletonArc::is_ev);
    return static_cast<std::size_t>(end - arcs.begin());
  }

  /// Bytes of the nodes, arcs and generators: what Request::budget_bytes limits.
  [[nodiscard]] std::size_t bytes() const {
    return nodes.size() * sizeof(SkeletonNode) + arcs.size() * sizeof(SkeletonArc) +
           generator_pool.size() * sizeof(Generator);
  }
  [[nodiscard]] std::span<const Generator> generators(const SkeletonNode& node) const {
    return {generator_pool.data() + node.first_generator, node.generator_count};
  }
};

/// The lines that an arc is a part of, positions as in its `range`.  nullopt where the
/// three edges of an EEE arc lie so that their lines are no set of one parameter: two
/// edges in one line, or all in one plane.
[[nodiscard]] std::optional<Swath> swath_of(const Scene& scene, const SkeletonArc& arc);

}  // namespace sightline
