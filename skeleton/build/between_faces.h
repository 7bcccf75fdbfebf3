// The part of a skeleton between two groups of faces: built between their objects, then
// cut down to the faces.

#pragma once

#include <optional>

#include "linespace/scene.h"
#include "skeleton/graph.h"
#include "skeleton/request.h"

namespace sightline::internal {

/// A part that contains the given one and asks for no faces; nullopt when that asks for
/// none either.
[[nodiscard]] std::optional<SkeletonPart> between_objects(const Scene& scene,
                                                          const SkeletonPart& part);

/// Of the wider part's skeleton what is between the request's groups of faces: its arcs
/// in their order, the nodes at their ends, those where two of its EV arcs line up
/// through a corner, and FF nodes of a facet of each.  Nodes are numbered anew.
[[nodiscard]] Skeleton between_faces(const Scene& scene, const Skeleton& wider,
                                     const SkeletonRequest& request);

}  // namespace sightline::internal
