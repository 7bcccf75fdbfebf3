// What happens to the view of an eye on its way along a path, as values: events, what
// they change, and the stretches between them.
//
// Visual events: Koenderink and van Doorn, The internal representation of solid shape
// with respect to vision, 1979; EV and EEE: Gigus, Canny and Seidel, Efficiently
// computing and representing aspect graphs of polyhedral objects, 1991.
// Neighbours: view_path.h finds all this.

#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <vector>

#include "linespace/visibility_map.h"

namespace sightline {

enum class PathEventKind : std::uint8_t {
  EV,      ///< a corner, or a point in which edges touch, and an edge, or two corners
  EEE,     ///< three edges in one line of sight
  F,       ///< a facet seen edge-on
  Through  ///< the eye passes through a facet, an edge or a corner
};

struct PathEvent {
  PathEventKind kind;
  /// What is in one line of sight; F: the facet; Through: what the eye passes through.
  /// Ascending.
  std::vector<Generator> generators;
  friend auto operator<=>(const PathEvent&, const PathEvent&) = default;
};

/// Numbers of the map's elements.
struct MapCounts {
  int corners = 0, t_vertices = 0, touches = 0, accident_vertices = 0;
  int edges = 0, regions = 0, components = 0;
  friend bool operator==(const MapCounts&, const MapCounts&) = default;
};

/// A position at which the labelled structure changes.
struct PathChange {
  int segment;
  double u;  ///< within 2^-50
  /// All events at this position, at least one, ascending.
  std::vector<PathEvent> events;
  /// Facets of which area is seen after and not before, and the other way round: in the
  /// views of the stretches beside it (within one, facets of a patch may come and go
  /// without an event).  Front and back of a facet count as two.  Ascending.
  std::vector<int> appears, vanishes;
  MapCounts difference;  ///< after less before
};

/// A part of a segment on which the labelled structure is the same.
struct PathStretch {
  int segment;
  double u_from, u_to;
  /// From some eye of it; nullopt if not asked for.
  std::optional<PointView> view;
};

struct ViewPath {
  std::vector<PathChange> changes;     ///< in order
  std::vector<PathStretch> stretches;  ///< in order; they cover all of every segment
  /// False when budget or stop ended the work: then both lists end early.
  bool complete = true;
};

}  // namespace sightline
