// What an eye sees, as values: the viewpoint, the facets that are seen, and the
// visibility map of vertices, edges and regions that they make.
//
// What counts as seen, as an edge, a vertex and a region of the map is defined in
// docs/point_view.md, case by case.  The visibility map: McKenna, Worst-case optimal
// hidden-surface removal, 1987; its labelled structure: the image structure graph of
// Koenderink and van Doorn, The internal representation of solid shape with respect to
// vision, 1979.
// Neighbours: point_view.h finds all this.

#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "linespace/exact_position.h"
#include "linespace/generator.h"
#include "linespace/scene.h"

namespace sightline {

/// From where the scene is seen.
struct Viewpoint {
  enum class Kind : std::uint8_t { Eye, Direction };
  Kind kind = Kind::Eye;
  /// The eye; or the direction in which it is infinitely far away, so that sight runs the
  /// other way.  The length of a direction says nothing.
  ExactPosition at;
};

[[nodiscard]] Viewpoint eye_at(const Point& eye);
/// Throws InvalidInput for the null vector.
[[nodiscard]] Viewpoint eye_far_along(const Point& direction);
/// Coordinates as decimal numbers, which are read as the nearest doubles, or as fractions
/// "p/q" of integers, which are exact.  Throws InvalidInput for other text, for what is
/// not finite, and for a direction of length 0.
[[nodiscard]] Viewpoint viewpoint(Viewpoint::Kind kind,
                                  const std::array<std::string, 3>& coordinates);

/// Where the eye is: the first that holds.
enum class EyePlace : std::uint8_t {
  Corner,  ///< on a corner of the scene
  Edge,    ///< inside an edge
  Facet,   ///< inside a facet
  Inside,  ///< in the material of a closed object
  Free     ///< elsewhere; a direction always is
};

enum class MapVertexKind : std::uint8_t {
  Corner,   ///< a corner of the scene
  T,        ///< an edge passes behind a nearer one
  Touch,    ///< a point in space, no corner, in which edges meet or one meets a facet
  Accident  ///< points in space of different depth that the eye sees in one
};

enum class MapEdgeKind : std::uint8_t {
  Silhouette,  ///< of an edge of several faces: on one side is seen what lies behind
  Crease,      ///< both sides meet there, more than half a turn apart on the eye's side
  Valley,      ///< the same, less than half a turn
  Boundary,    ///< of an edge of one face: on one side is seen what lies behind
  Contact,     ///< facets of different objects meet there
  Crossing,    ///< two facets cut through each other
  Cut          ///< a side of the box that cuts the view ends a facet there
};

/// A line in space of which a map edge shows a part: an edge of the scene; where two
/// facets cut through each other (the smaller id first); or where a side of the box that
/// cuts the view ends a facet (the facet, and -1).
struct MapLine {
  int edge = -1;
  std::array<int, 2> facets{-1, -1};  ///< of a crossing or a cut; else -1
  /// Of a cut: 0 to 5 for the sides x0, y0, z0, x1, y1, z1 of the box; else -1.
  int box_side = -1;
  friend auto operator<=>(const MapLine&, const MapLine&) = default;
};

struct MapVertex {
  MapVertexKind kind;
  int corner;         ///< a point id: Corner only, else -1
  MapLine near, far;  ///< T only
  /// Towards the vertex, a unit vector, rounded; for a direction the point of the plane
  /// through the origin across it where the vertex is seen.
  Point at;
};

struct MapEdge {
  MapLine line;
  MapEdgeKind kind;
  std::array<int, 2> ends;  ///< vertices
  /// Regions beside it, going from the first end to the second, as the eye sees it; -1
  /// where an eye on the scene would look into material.
  int left, right;
  /// The piece of the line in space, rounded.
  std::array<Point, 2> segment;
};

/// A connected open set of directions in which one patch is seen, or the background.
struct MapRegion {
  std::vector<int> patches;  ///< one; several where patches coincide; none: background
  std::vector<int> facets;   ///< of the patches, those seen here, ascending
  /// Steradians, or the area of the projection; nullopt if infinite.
  std::optional<double> measure;
  /// Closed walks along the boundary with the region on the left; 2 e stands for edge e
  /// from its first end to its second, 2 e + 1 for the other way.
  std::vector<std::vector<int>> boundary;
};

/// A facet of which some area is seen.
struct SeenFacet {
  int facet;
  bool front;  ///< it is the front that is seen
  int pieces;  ///< connected parts that are seen
  /// Solid angle (sr), or area of the projection onto a plane across the direction (scene
  /// units squared).
  double measure;
  /// Of the solid angle with the eye (sr per scene unit); nullopt for a direction, and
  /// where the view is not general.
  std::optional<Eigen::Vector3d> gradient;
};

enum class AccidentKind : std::uint8_t {
  EdgeOn,          ///< a facet seen from its plane
  EndOn,           ///< an edge seen along its line
  CornerOnEdge,    ///< a corner behind an edge, or the other way round
  CornerOnCorner,  ///< two corners in one line of sight
  ThreeEdges,      ///< three edges in one line of sight
  AlongEdge,       ///< two edges, not on one line in space, overlap in the picture
  OnScene          ///< the eye lies on a facet, an edge or a corner
};

struct Accident {
  AccidentKind kind;
  std::vector<Generator> generators;  ///< ascending
  friend auto operator<=>(const Accident&, const Accident&) = default;
};

/// What a drawing may show besides the map.
struct FurtherLine {
  enum class Kind : std::uint8_t {
    Seam,   ///< seen, between two facets of one patch
    Hidden  ///< a piece of an edge that nearer faces hide
  };
  Kind kind;
  MapLine line;
  std::array<Point, 2> at;       ///< its ends in the picture, as MapVertex::at
  std::array<Point, 2> segment;  ///< the piece in space, rounded
};

struct PointView {
  Viewpoint eye;
  EyePlace place;
  /// Corner: the point id; Edge: edges; Facet: facets; Inside: objects; ascending.
  std::vector<int> place_ids;

  std::vector<SeenFacet> facets;  ///< ascending
  std::vector<MapVertex> vertices;
  std::vector<MapEdge> edges;
  std::vector<MapRegion> regions;
  int components;         ///< of vertices and edges together
  int background_pieces;  ///< regions of background
  int seams;              ///< pieces of seams that are seen

  /// The labelled structure is the same for all eyes near by.
  /// With a box that cuts the view: for the box as it is.
  bool general;
  /// Each with what it is made of.  Where many things are seen in one, as in a plane of
  /// many facets, which of them are told together may depend on the scene's order.
  std::vector<Accident> accidents;
  /// Equal for two views of one scene iff their labelled structures are; empty where the
  /// view is not general.
  std::string structure;
};

}  // namespace sightline
