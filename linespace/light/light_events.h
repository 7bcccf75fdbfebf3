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

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "linespace/light/light_space.h"
#include "linespace/light/line_family.h"
#include "linespace/light/source_patches.h"
#include "linespace/request.h"

namespace sightline::internal {

/// As in CONTRACT's kinds of edges of the mesh.
enum class LightEventKind : std::uint8_t {
  Face,  ///< two edges of one facet, seen edge-on
  EE,    ///< two other edges of one plane, seen along each other
  EV,
  EEE
};

/// A generator of an event.
struct LightFeature {
  enum class Kind : std::uint8_t {
    Vertex,        ///< point id
    Edge,          ///< edge id
    SourceCorner,  ///< position in the patch's corners
    SourceSide,    ///< position in the patch's sides
    Touch          ///< position in LightSpace::touches(): two edges cross there
  };
  Kind kind;
  int id;
  friend auto operator<=>(const LightFeature&, const LightFeature&) = default;
};

struct LightTrace {
  LightEventKind kind;
  int patch;  ///< of the source
  /// EV: the vertex, the edge.  EEE: three edges; positions are told on the first, the
  /// farthest from the source.  EE, Face: the two edges; then what the lines pass
  /// through: an edge or source side across the plane, or nothing where it is an end of
  /// one of the two.
  std::vector<LightFeature> generators;
  int facet = -1;  ///< Face: the one that is seen edge-on
  /// The points X(0), X(1) and Y(0), Y(1) whose joining lines are the family
  /// (line_family.h).  Straight traces: X(0) = X(1), and all lines lie in one plane.
  std::array<Four<Ring>, 2> first, last;
  [[nodiscard]] bool straight() const { return kind != LightEventKind::EEE; }

  struct Piece {
    int face;    ///< the receiver's face that the lines end on
    bool front;  ///< they come from its front
    std::array<QuadraticRoot, 2> range;
    std::array<double, 2> rounded;
    std::array<CutCause, 2> causes;
  };
  std::vector<Piece> pieces;
};

struct LightEvents {
  std::vector<SourcePatch> patches;
  std::vector<LightTrace> traces;  ///< each with a piece at least
  bool complete = true;
  /// Families that were looked at beyond the first tests; for measurements.
  std::size_t families = 0;
};

struct LightEventsRequest : Request {
  std::vector<int> source_faces;
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
