// The visual events of a source: all lines that graze the scene and reach the source, by
// where on receivers its visible part changes.
//
//   SourceEventsRequest request;
//   request.source_faces = scene.faces_named("light");
//   const SourceEvents events = source_events(scene, request);
//   for (const SourceArc& arc : events.arcs) ...
//
// A source is any faces; they shine from their fronts.  The outline of those that lie in
// one plane, face alike and overlap or touch along an edge makes events wherever it lies:
// in mid air, in the plane of a ceiling, in a hole of one.  How, and what is complete
// about it: docs/source_events.md.
// Neighbours: build.h builds the skeleton of a scene, whose arcs have no source.

#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "linespace/exact_position.h"
#include "linespace/request.h"
#include "linespace/scene.h"

namespace sightline {

/// What lines up, as seen from the points at which the lines of an arc end; where several
/// apply, the first.
enum class SourceArcKind : std::uint8_t {
  Face,  ///< two edges of one facet, which is seen edge-on
  EE,    ///< two other edges of one plane, seen along each other
  EV,    ///< a vertex and an edge
  EEE    ///< three edges
};

/// What the lines of an arc pass through.
struct SourceGenerator {
  enum class Kind : std::uint8_t {
    Vertex,        ///< point id
    Edge,          ///< edge id
    SourceCorner,  ///< position in SourceOutline::corners
    SourceSide,    ///< position in SourceOutline::sides
    Touch,         ///< two edges cross in space: position in SourceEvents::touches
    Horizon        ///< facet id of a receiver whose plane cuts the source
  };
  Kind kind;
  int id;
  friend auto operator<=>(const SourceGenerator&, const SourceGenerator&) = default;
};

/// An end of a piece: the position in the arc's lines, and what is met there.
struct SourceCut {
  enum class Cause : std::uint8_t {
    GeneratorEnd,  ///< an end of a generator edge
    FaceSide,      ///< a side of a face is met: `edge` is its edge, -1 for a flat side
    SourceSide,    ///< the lines leave the source: `id` is the side
    Pierce,        ///< a generator edge passes through a face
    Crossing       ///< two faces cross each other
  };
  Cause cause;
  int id = -1;    ///< FaceSide, Pierce: polygon number in the file; SourceSide: the side
  int edge = -1;  ///< FaceSide: an edge id
  double at = 0;  ///< rounded, to 2^-48 of itself
  /// The same exactly: "p/q" or "(a + b sqrt(d)) / c".
  std::string exact;
  Point on_receiver;  ///< where the line ends, rounded
};

/// A family of lines of one parameter that reach the source, with the parts of it whose
/// lines end on one receiver.
struct SourceArc {
  SourceArcKind kind;
  int outline;  ///< position in SourceEvents::outlines
  /// A vertex, corner or touch and an edge or side, where positions are told; or three
  /// edges or sides.  EEE: positions are told on the first, which is the farthest from
  /// the source.  Three of which two lie in one plane: the lines are those of that plane
  /// through the first, and positions are told on the second.  Two things that cross the
  /// plane of a receiver and are seen in one in it, and its horizon: one line.
  std::vector<SourceGenerator> generators;
  /// Face, EE: two edges of one plane that are seen along each other.
  std::optional<std::array<SourceGenerator, 2>> in_line;
  int facet = -1;  ///< Face: seen edge-on
  bool curved;     ///< the lines mark conics, else straight segments
  struct Piece {
    int polygon;  ///< number in the file: the receiver's
    bool front;   ///< the lines come from its front
    std::array<SourceCut, 2> ends;
  };
  std::vector<Piece> pieces;  ///< one at least
};

/// All source faces of one plane that face alike.
struct SourceOutline {
  std::vector<int> polygons;  ///< numbers in the file, ascending
  struct Side {
    std::array<ExactPosition, 2> ends;
    /// Polygon number: the segment in which a face that reaches in front of the source
    /// meets its plane; -1: a side of the outline, the source on the left from its front.
    int foot_of;
  };
  std::vector<Side> sides;
  std::vector<ExactPosition> corners;  ///< ends of sides, and where they cross
};

struct SourceEvents {
  std::vector<SourceOutline> outlines;
  std::vector<SourceArc> arcs;
  struct Touch {
    std::array<int, 2> edges;
    ExactPosition point;
  };
  std::vector<Touch> touches;
  bool complete = true;

  /// EV: connected parts of families through a vertex and an edge.  EEE: the same of
  /// families that mark conics.  EE: pairs of edges, and face: facets, with lines along
  /// them.
  struct Counts {
    std::size_t ev = 0, eee = 0, ee = 0, face = 0;
  };
  [[nodiscard]] Counts counts() const;
};

struct SourceEventsRequest : Request {
  std::vector<int> source_faces;  ///< face ids
  /// Faces on whose fronts lines end; empty: all.
  std::vector<int> receivers;
  /// Faces on whose backs they may end, too.
  std::vector<int> receivers_behind;
};

/// Exact, and the same whatever the number of threads.  Complete: where the structure of
/// the visible part of the source differs between two points of a receiver, there is the
/// end of a line of an arc on the way, or the receiver's outline, a foot of a blocker on
/// it, or the plane of a source face.  Not minimal: lines that pass exactly through sides
/// of faces count as free.  Throws InvalidInput where there are no source faces.  Of the
/// request budget, stop, progress and threads are heard; the precision is always Exact.
/// Cost: docs/source_events.md.
[[nodiscard]] SourceEvents source_events(const Scene& scene,
                                         const SourceEventsRequest& request);

}  // namespace sightline
