// Which part of the skeleton is wanted, and on what terms.

#pragma once

#include <array>
#include <optional>
#include <vector>

#include "linespace/generator.h"
#include "linespace/request.h"
#include "linespace/scene.h"

namespace sightline {

/// A part of the skeleton, by what its arcs must be on, in or between: all conditions
/// must hold, and what is left empty asks for nothing.  Such a part is computed on its
/// own, and is the same as in the whole.
struct SkeletonPart {
  /// Only EV arcs whose vertex is on one of these objects; empty means all.
  std::vector<int> vertex_objects;
  /// Only EV arcs whose edge is on one of these objects; empty means all.
  std::vector<int> edge_objects;
  /// Only arcs between these: EV arcs with the vertex on an object of one list and the
  /// edge on one of the other, EEE arcs with one outer edge on each; an empty list means
  /// all objects.
  std::array<std::vector<int>, 2> outer_objects;
  /// Only arcs between two groups of faces, and FF nodes of a facet of each.  A vertex is
  /// in a group if it is a corner of one of its faces, an edge if a face of one of its
  /// facets is.  An empty list means all faces.
  std::array<std::vector<int>, 2> between_faces;
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
  /// Only generators no farther than the radius from the centre, an edge with some point
  /// of it: what a viewpoint there has around it.  Decided exactly.  Centre and radius
  /// finite, the radius not below 0, else InvalidInput is thrown.
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

/// What of the skeleton is wanted: kinds of events, and which part.
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
  SkeletonPart part;
};

}  // namespace sightline
