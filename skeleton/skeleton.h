// The visibility skeleton: the critical line sets of a scene (EV, through a vertex and an
// edge; EEE, through three edges), exactly, with the extremal stabbing lines at their
// ends.
//
// Solid and polygon mode as the project's contract defines them (docs/polygon_mode.md). A
// generator is a point, an edge or a facet id of the scene; contacts are derived from
// geometry, so that touching solids count as their union.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "linespace/occlusion.h"
#include "linespace/predicates.h"
#include "linespace/request.h"
#include "linespace/scene.h"

namespace sightline {

/// Which contacts make events.  Solid: those at which the line grazes.  Polygon: the two
/// outermost ones may also be *end* contacts, a visible crease (convex or reflex edge) or
/// corner at which the line enters its solid, so that the free segment ends there.
enum class EventMode : std::uint8_t { Solid, Polygon };

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
  /// The first or the last contact is a corner at which the line enters its solid: the
  /// line ends there rather than grazes (counted under "end").  Polygon mode: no node of
  /// solid mode that grazes, docs/polygon_mode.md ("At a node").
  bool end = false;
  /// EEEE: which of the two lines through the four edges; Degenerate: which of two
  /// irrational lines through the same edges.
  bool second = false;
  /// Polygon mode: the free segment ends in the first, in the last contact.
  std::array<bool, 2> ends{};
  /// Generators in order along the line: `count` of them from Skeleton::generators().  VV
  /// begins with the smaller vertex, VEE and FvE with their vertex, others from the end
  /// with the smaller generators: however the line was found.
  std::uint32_t first_generator = 0;
  std::uint32_t generator_count = 0;
  /// The outermost contacts, rounded to double.
  std::array<Point, 2> segment;
};

/// Bound on the error of the parameters in an arc's `range`, where the precision is
/// Exact.
inline constexpr double kRangeError = 0x1p-40;

/// A maximal open interval of an edge that one vertex sees, with the same contacts: in
/// solid mode it grazes both, in polygon mode either may be an end contact all along.
struct SkeletonArc {
  std::int32_t vertex;         ///< point id
  std::int32_t edge;           ///< edge id
  bool self = false;           ///< vertex and edge are of one object
  std::array<bool, 2> ends{};  ///< the vertex, the edge is an end contact
  /// Parameters along the edge (0 at points[0], 1 at points[1]), rounded to double, of
  /// the ends of the open interval, and the nodes there.
  std::array<double, 2> range;
  std::array<std::uint32_t, 2> nodes;
};

/// A connected set of lines through three edges that support and see along them; in
/// polygon mode either outer edge may be an end contact all along.
struct EeeArc {
  /// Edge ids in order along the line, starting from the one that `range` is told on.
  std::array<std::int32_t, 3> edges;
  bool self = false;           ///< two of the edges are of one object
  std::array<bool, 2> ends{};  ///< the first, the last edge is an end contact
  /// Parameters on edges[0], rounded, of the ends of the open interval, and the nodes.
  std::array<double, 2> range;
  std::array<std::uint32_t, 2> nodes;
};

/// Which part of the skeleton is wanted.
struct SkeletonRequest : Request {
  /// Kinds of line sets that build_skeleton() looks for; with EV come the VV, VEE, FvE
  /// and EVE nodes, with EEE the VEE, EVE, EEEE and FEE nodes.
  bool ev = true, eee = true;
  EventMode events = EventMode::Solid;
  /// Whether FF nodes are looked for too: free lines in the planes of two facets, across
  /// the inside of both (of one object: `self`).  They end no arc, so they come only when
  /// asked for.  Facets in parallel planes have none, nor have those that are planar only
  /// up to a tolerance; a facet that the line crosses several times counts once.
  bool ff = false;
  /// Only EV arcs whose vertex is on one of these objects; empty means all.
  std::vector<int> vertex_objects;
  /// Only EV arcs whose edge is on one of these objects; empty means all.
  std::vector<int> edge_objects;
  /// Only arcs between these: EV arcs with the vertex on an object of one list and the
  /// edge on one of the other, EEE arcs with one outer edge on each; an empty list means
  /// all objects.
  std::array<std::vector<int>, 2> outer_objects;
  /// Only arcs with a generator on one of these objects; empty means all.
  std::vector<int> through_objects;
  /// Likewise of a source given by some of its faces: a corner of one, an edge of its
  /// facet.  With both, either will do.
  std::vector<int> through_faces;
  /// Then also arcs some of whose lines end there, that is, whose free segment has a face
  /// of the source at an end along some stretch: all arcs with lines that meet the
  /// source.  Exact, as SkeletonLines::ends.
  bool through_far_ends = false;
  /// Only generators inside this closed box (corner of smallest, of largest coordinates),
  /// an edge with both its ends.
  std::optional<std::array<Point, 2>> region;
  struct Ball {
    Point centre;
    double radius;  ///< scene units; finite, not below 0, else InvalidInput is thrown
  };
  /// Only generators no farther than the radius from the centre, an edge with some point
  /// of it: what a viewpoint there has around it.  Decided exactly.
  std::optional<Ball> near;
  /// Only arcs between two closed boxes, such as two rooms: EV arcs with the vertex in
  /// one and the edge (both ends) in the other, EEE arcs with the outer edges one in
  /// each.
  std::optional<std::array<std::array<Point, 2>, 2>> between_boxes;
  /// Features below this size (scene units) make no events but still occlude; 0 asks for
  /// everything.  Left out are edges shorter than it, corners all of whose edges are, so
  /// objects whose box has a shorter diagonal, and EV arcs on a shorter stretch of their
  /// edge.  Skeleton::simplified lists them.  What is left is a subset of the arcs at any
  /// smaller size.
  double feature_size = 0;
};

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

/// What ended the work before it was done.
enum class StoppedBy : std::uint8_t { Nothing, Seconds, Bytes, Request };

/// Immutable; safe to share between threads.  Deterministic: EV arcs are ordered by
/// vertex, edge and parameter, EEE arcs by outer and middle edges, whatever the number of
/// threads.
struct Skeleton {
  std::vector<SkeletonNode> nodes;
  std::vector<SkeletonArc> arcs;  ///< EV
  std::vector<EeeArc> eee_arcs;
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

  /// Of its nodes, arcs and generators: what Request::budget_bytes limits.
  [[nodiscard]] std::size_t bytes() const {
    return nodes.size() * sizeof(SkeletonNode) + arcs.size() * sizeof(SkeletonArc) +
           eee_arcs.size() * sizeof(EeeArc) + generator_pool.size() * sizeof(Generator);
  }
  [[nodiscard]] std::span<const Generator> generators(const SkeletonNode& node) const {
    return {generator_pool.data() + node.first_generator, node.generator_count};
  }
};

/// Builds what is asked for: the EV arcs with the nodes at their ends and the EVE nodes;
/// the EEE arcs with the nodes at theirs, which they share with the EV arcs where both
/// are asked; the FF nodes.  What else lies along their lines: skeleton_lines.h.
[[nodiscard]] Skeleton build_skeleton(const Scene& scene,
                                      const SkeletonRequest& request = {});

}  // namespace sightline
