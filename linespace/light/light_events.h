// All curves on receivers where the structure of the visible part of a source can change:
// the traces of lines that graze the scene and reach the source.
//
// Each is a family of lines of one parameter (line_family.h) that meet the closed source
// (a patch of it) on one side, pass no face's inside between, and end on a face of the
// scene on the other: the receiver.  Its pieces are the parts, between exact positions,
// whose lines end on one receiver.
//
// Complete: between two neighbouring points of a receiver with different structures there
// is a trace, or the receiver's outline, a foot of a blocker on it, or the plane of a
// source face.  Not minimal: along some traces nothing changes.  What is conservative:
// - a line counts as free where it passes through sides of faces, though their surfaces
//   may close it;
// - lines of a plane are told by the points of that plane that they pass through: where
//   two edges are seen along each other, or a facet is seen edge-on, several families on
//   one line may overlap.

#pragma once

#include <vector>

#include "linespace/light/light_space.h"
#include "linespace/light/light_traces.h"
#include "linespace/light/source_patches.h"
#include "linespace/request.h"

namespace sightline::internal {

struct LightEvents {
  std::vector<SourcePatch> patches;
  std::vector<LightTrace> traces;  ///< each with a piece at least
  bool complete = true;
  /// Families that were looked at beyond the first tests; for measurements.
  std::size_t families = 0;
};

struct LightEventsRequest : Request {
  std::vector<int> source_faces;  ///< these shine from their fronts
  std::vector<int> source_backs;  ///< these from their backs
  /// Faces on whose fronts traces are wanted; empty: all.
  std::vector<int> receivers;
  /// Also on their backs.
  std::vector<int> receive_behind;
};

/// Deterministic: the traces are in an order that does not depend on the number of
/// threads.  Of the request budget and stop are heard: then what is there is returned,
/// marked incomplete.
[[nodiscard]] LightEvents light_events(const LightSpace& space,
                                       const LightEventsRequest& request);

}  // namespace sightline::internal
