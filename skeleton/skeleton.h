// The visibility skeleton: the critical line sets of a scene (EV, through a vertex and an
// edge; EEE, through three edges), exactly, with the extremal stabbing lines at their
// ends.
//
// Solid mode as the project's contract defines it.  A generator is a point id or an edge
// id of the scene; contacts are derived from geometry, so that touching solids count as
// their union.

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "linespace/occlusion.h"
#include "linespace/predicates.h"
#include "linespace/request.h"
#include "linespace/scene.h"

namespace sightline {

/// What an extremal stabbing line is held by, vertex first in the name; Degenerate lines
/// have more contacts than four degrees of freedom need; Saddle is a line through a
/// corner along which two of that corner's own edges line up (objects that are not
/// convex); Pierce is where an edge enters a face (overlapping objects).
enum class NodeKind : std::uint8_t {
  VV,
  VEE,
  EVE,
  FvE,
  EEEE,
  FEE,
  Saddle,
  Pierce,
  Degenerate
};

enum class GeneratorKind : std::uint8_t { Vertex, Edge, Face };

/// A feature of the scene that a line touches: a point id, an edge id or a facet id.
struct Generator {
  GeneratorKind kind;
  std::int32_t id;
  friend auto operator<=>(const Generator&, const Generator&) = default;
};

/// An extremal stabbing line.
struct SkeletonNode {
  NodeKind kind;
  /// Two contacts are on one object (counted under "..._self").
  bool self = false;
  /// The last contact is a corner at which the line enters its solid: the line ends there
  /// rather than grazes (counted under "end").
  bool end = false;
  /// EEEE: which of the two lines through the four edges.
  bool second = false;
  /// Generators in order along the line: `count` of them from Skeleton::generators().
  std::uint32_t first_generator = 0;
  std::uint32_t generator_count = 0;
  /// The outermost contacts, rounded to double.
  std::array<Point, 2> segment;
};

/// Bound on the error of the parameters in an arc's `range`, where the precision is
/// Exact.
inline constexpr double kRangeError = 0x1p-40;

/// A maximal open interval of an edge that one vertex sees and supports.
struct SkeletonArc {
  std::int32_t vertex;  ///< point id
  std::int32_t edge;    ///< edge id
  bool self = false;    ///< vertex and edge are of one object
  /// Parameters along the edge (0 at points[0], 1 at points[1]), rounded to double, of
  /// the ends of the open interval, and the nodes there.
  std::array<double, 2> range;
  std::array<std::uint32_t, 2> nodes;
};

/// A connected set of lines through three edges that support and see along them.
struct EeeArc {
  /// Edge ids in order along the line, starting from the one that `range` is told on.
  std::array<std::int32_t, 3> edges;
  bool self = false;  ///< two of the edges are of one object
  /// Parameters on edges[0], rounded, of the ends of the open interval, and the nodes.
  std::array<double, 2> range;
  std::array<std::uint32_t, 2> nodes;
};

/// Which part of the skeleton is wanted.
struct SkeletonRequest : Request {
  /// Kinds of line sets that build_skeleton() looks for; with EV come the VV, VEE, FvE
  /// and EVE nodes, with EEE the VEE, EVE, EEEE and FEE nodes.
  bool ev = true, eee = true;
  /// Only EV arcs whose vertex is on one of these objects; empty means all.
  std::vector<int> vertex_objects;
  /// Only EV arcs whose edge is on one of these objects; empty means all.
  std::vector<int> edge_objects;
  /// Only EEE arcs whose outer edges are one on an object of the first list, the other on
  /// one of the second; both empty means all.
  std::array<std::vector<int>, 2> outer_objects;
  /// Only EEE arcs with an edge on one of these objects; empty means all.
  std::vector<int> through_objects;
  /// Only generators inside this box (corner of smallest, of largest coordinates).
  std::optional<std::array<Point, 2>> region;
};

/// Immutable; safe to share between threads.  Deterministic: EV arcs are ordered by
/// vertex, edge and parameter, EEE arcs by outer and middle edges, whatever the number of
/// threads.
struct Skeleton {
  std::vector<SkeletonNode> nodes;
  std::vector<SkeletonArc> arcs;  ///< EV
  std::vector<EeeArc> eee_arcs;
  std::vector<Generator> generator_pool;
  bool complete = true;
  std::size_t vertices_done = 0, vertices_asked = 0;
  /// First edges of EEE arcs, each with all edges of higher number.
  std::size_t edges_done = 0, edges_asked = 0;
  StageCounts predicates;

  [[nodiscard]] std::span<const Generator> generators(const SkeletonNode& node) const {
    return {generator_pool.data() + node.first_generator, node.generator_count};
  }
};

/// Builds the EV arcs of a scene with the nodes at their ends, and the EVE nodes.  What
/// else lies along their lines: skeleton_lines.h.
[[nodiscard]] Skeleton build_ev_skeleton(const Scene& scene,
                                         const SkeletonRequest& request = {});

/// Builds the kinds asked for: the EV part as build_ev_skeleton, then the EEE arcs with
/// the nodes at their ends, which they share with the EV part where both are asked.
[[nodiscard]] Skeleton build_skeleton(const Scene& scene,
                                      const SkeletonRequest& request = {});

}  // namespace sightline
