// Builds the visibility skeleton of a scene, exactly: whole, or the part that a request
// names.
//
//   const Scene scene(read_mesh("room.obj"));
//   SkeletonRequest request;
//   request.events = EventMode::Polygon;
//   const Skeleton skeleton = build_skeleton(scene, request);
//   for (const SkeletonArc& arc : skeleton.arcs) ...
//
// Durand, Drettakis and Puech 1997; how: docs/ev_skeleton.md, docs/eee_skeleton.md.

#pragma once

#include "skeleton/graph.h"
#include "skeleton/request.h"

namespace sightline {

/// Builds what is asked for: the EV arcs with the nodes at their ends and the EVE nodes;
/// the EEE arcs with the nodes at theirs, which they share with the EV arcs where both
/// are asked; the FF nodes.  What else lies along their lines: skeleton_lines.h.
[[nodiscard]] Skeleton build_skeleton(const Scene& scene,
                                      const SkeletonRequest& request = {});

}  // namespace sightline
