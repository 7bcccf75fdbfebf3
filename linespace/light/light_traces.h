// The curves that a source's events mark on receivers, as values.

#pragma once

#include <array>
#include <compare>
#include <optional>
#include <vector>

#include "linespace/light/line_family.h"

namespace sightline::internal {

/// What lines up, as seen from the points of a trace; where several apply, the first.
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
    Touch,         ///< position in LightSpace::touches(): two edges cross there
    Horizon        ///< facet id: of a receiver whose plane cuts the source
  };
  Kind kind;
  int id;
  friend auto operator<=>(const LightFeature&, const LightFeature&) = default;
};

struct LightTrace {
  LightEventKind kind = LightEventKind::EV;
  int patch = 0;  ///< of the source
  /// What all lines of the family pass through: a vertex, corner or touch and an edge or
  /// side; or three edges or sides.  Of three on a conic positions are told on the first,
  /// which is the farthest from the source.  Of three of which two lie in one plane, the
  /// first is the one across that plane.  At a horizon: two things that are seen in one
  /// in the receiver's plane, the farther one first, and the horizon.
  std::vector<LightFeature> generators;
  /// Face and EE: two edges of one plane that the lines pass along.
  std::optional<std::array<LightFeature, 2>> in_line;
  int facet = -1;  ///< Face: the one that is seen edge-on; horizon: the receiver
  /// The trace is straight; else a conic.
  bool straight = true;
  /// The points X(0), X(1) and Y(0), Y(1) whose joining lines are the family
  /// (line_family.h).  Of straight traces X(0) = X(1), and all lines lie in one plane.
  /// At a horizon all four make one line, which lies in the receiver and is the trace.
  std::array<Four<Ring>, 2> first, last;

  struct Piece {
    int face = -1;      ///< the receiver's face that the lines end on
    bool front = true;  ///< they come from its front
    /// Positions in the family; at a horizon 0 and 1.
    std::array<QuadraticRoot, 2> range;
    std::array<double, 2> rounded;
    std::array<CutCause, 2> causes;
    /// The two ends of a straight trace on the receiver, with weights other than 0; of a
    /// conic, nothing.
    std::array<Four<Ring>, 2> ends;
  };
  std::vector<Piece> pieces;
};

}  // namespace sightline::internal
