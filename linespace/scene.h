// A scene: polygons with names, validated once and immutable from then on.
//
// Coordinates are the doubles that the file gave, never snapped or rounded.  On top of
// the polygons stand the derived things that visibility is about: distinct points, convex
// faces, maximal coplanar facets, exactly classified edges, corners, objects.
// Neighbours: mesh_io.h reads files into a PolygonSoup; occlusion.h asks a scene what
// blocks a line.

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

#include "linespace/request.h"

namespace sightline {

namespace internal {
struct SceneBuilder;
}

using Point = Eigen::Vector3d;

struct Ball {
  Point centre;
  double radius;  ///< scene units
};

/// The caller's input cannot be used; what() is one line that names the element.
class InvalidInput : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a careful modeller would not have meant; the scene is used as it is.
struct Defect {
  std::string kind;  ///< "zero area", "repeated vertex", "non-planar polygon", ...
  std::string message;
  std::vector<int> faces;     ///< polygon numbers in the file, from 0
  std::vector<int> vertices;  ///< vertex numbers in the file, from 0
};

/// Polygons as a file gives them: indices into vertices, faces in file order.
struct PolygonSoup {
  /// Groups may overlap (OBJ allows it): a face belongs to the object of the first group
  /// that lists it, and is found under the names of all.
  struct Group {
    std::string name;
    std::vector<int> faces;  ///< indices into `polygons`, ascending
    /// Further names of the same faces, so that these are listed once: groups of their
    /// own that come right behind this one.
    std::vector<std::string> aliases = {};
  };
  std::vector<Point> vertices;
  std::vector<std::vector<int>> polygons;  ///< indices into `vertices`, from 0
  std::vector<Group> groups;               ///< empty when the file names none
  std::string source;                      ///< file name, for messages
  std::vector<Defect> defects;             ///< of the file itself, found while reading
};

/// Seen from outside: Convex is a ridge, Reflex a valley, Flat neither, Boundary has one
/// face, NonManifold three or more, or two of inconsistent orientation.  Two coplanar
/// faces folded back onto each other are the edge of an infinitely thin sheet: Convex.
enum class EdgeKind : std::uint8_t { Convex, Reflex, Flat, Boundary, NonManifold };

/// A convex polygon, exactly planar, with its front on the side where it is
/// counter-clockwise: outside, for a closed object, also one that the file lists inside
/// out (Scene::turned).  Its first three corners are never collinear, so that they give
/// its plane; further corners may lie on a side (angle of 180 degrees).  A polygon of the
/// file that is not convex or not exactly planar becomes several triangles of one
/// `source`.
struct Face {
  int first_corner;  ///< position of its points in Scene::face_points
  int corner_count;
  int source;  ///< number of the polygon in the file
  int facet;
  int object;
};

/// A maximal connected region of one object's faces across flat edges.
struct Facet {
  int object;
  std::vector<int> faces;
  /// True when all its points lie in one plane exactly.
  bool planar;
};

/// A maximal straight edge that is not flat, between the same facets all along.
struct Edge {
  std::array<int, 2> points;  ///< end points, the smaller id first
  EdgeKind kind;
  int object;
  /// The faces at the edge (one for Boundary, two for Convex and Reflex, any number for
  /// NonManifold), and whether the edge runs from points[0] to points[1] in the face's
  /// own counter-clockwise order.  Of a chain of collinear mesh edges merged into one, a
  /// face of each adjacent facet.
  struct Side {
    int face;
    bool forward;
  };
  std::vector<Side> sides;
};

/// What an object is made of: a named group, or a connected component after welding.
struct Object {
  std::string name;
  std::vector<int> faces;
  /// Every edge is used equally often in both directions.
  bool closed;
  /// Closed, bounded on the inside (positive volume; one inside out is turned first), all
  /// its edges convex or flat, and every point on or behind every face's plane.
  bool convex;
  /// Closed, and the file lists some closed part of it (a shell) clockwise seen from
  /// outside: a room, with air inside.
  bool inside_out = false;
};

struct SceneOptions {
  /// Two faces whose planes differ by at most this angle (radians) share a flat edge.
  double flatness = 0;
  /// Polygon numbers, ascending: as if these were not in the file.  All keep their
  /// numbers, and groups their names.
  std::vector<int> without = {};
};

/// Counts of the mesh's own edges, collinear ones not merged, by kind, with the fronts of
/// the file: a ridge of an object turned inside out counts as reflex.
struct MeshEdgeCounts {
  int convex = 0, reflex = 0, flat = 0, boundary = 0, nonmanifold = 0;
};

/// Immutable; safe to share between threads.
class Scene {
 public:
  /// Validates and derives everything.  Throws InvalidInput for what no analysis can use:
  /// non-finite coordinates, a coordinate other than 0 whose magnitude is outside
  /// [2^-140, 2^140], indices out of range, no faces.  Other defects are kept in
  /// defects(); faces of zero area block nothing and are left out of faces().  Of the
  /// request, budget, stop and progress count; throws Stopped.  Cost: n log n for n
  /// faces.
  explicit Scene(PolygonSoup soup, const SceneOptions& options = {},
                 const Request& request = {});

  /// Distinct points used by faces, in order of first use: point ids index this.
  [[nodiscard]] std::span<const Point> points() const { return points_; }
  [[nodiscard]] const Point& point(int id) const { return points_[id]; }

  /// Without copies: of a face that one object lists more than once, with the same
  /// corners in the same cyclic order, the first alone.
  [[nodiscard]] std::span<const Face> faces() const { return faces_; }
  /// Point ids of face f, counter-clockwise seen from its front.
  [[nodiscard]] std::span<const int> face_points(int f) const {
    return {corners_.data() + faces_[f].first_corner,
            static_cast<std::size_t>(faces_[f].corner_count)};
  }
  /// The file lists the face the other way round: its shell is turned inside out.
  [[nodiscard]] bool turned(int f) const { return sides_[f] == FaceSides::Turned; }
  /// Behind the face is the inside of its closed object; false for sheets, and for shells
  /// turned inside out, whose inside is air.
  [[nodiscard]] bool solid_behind(int f) const { return sides_[f] == FaceSides::Solid; }
  /// An object turned inside out, and one in whose material it lies: the inner shell of a
  /// house, which is as it should be.  Not marked `inside_out`; its faces are not turned.
  struct Hollow {
    int object, around;
  };
  [[nodiscard]] std::span<const Hollow> hollows() const { return hollows_; }
  [[nodiscard]] std::span<const Facet> facets() const { return facets_; }
  /// The generators: maximal straight edges, flat ones left out.
  [[nodiscard]] std::span<const Edge> edges() const { return edges_; }
  /// The edge that the side of face f from its corner k to the next lies on; -1 when the
  /// side is flat.
  [[nodiscard]] int edge_of_side(int f, int k) const {
    return side_edges_[faces_[f].first_corner + k];
  }
  /// Point ids at which some edge() ends, ascending: the vertices that generate events.
  [[nodiscard]] std::span<const int> corners() const { return corner_points_; }
  /// Edge ids that end at point p.
  [[nodiscard]] std::span<const int> edges_at(int p) const;
  /// Face ids that have point p as a corner.
  [[nodiscard]] std::span<const int> faces_at(int p) const;
  [[nodiscard]] std::span<const Object> objects() const { return objects_; }
  /// Index of the object of that name.  Throws InvalidInput, naming some that exist, when
  /// there is none.
  [[nodiscard]] int object_named(const std::string& name) const;
  /// Face ids, ascending, of the object or group of that name, or of `#i-j`: the polygons
  /// i to j of the file, both included; of a copy, the face that it repeats.  Throws
  /// InvalidInput when there is no such name or no such polygon.
  [[nodiscard]] std::vector<int> faces_named(const std::string& name) const;

  [[nodiscard]] const PolygonSoup& soup() const { return soup_; }
  /// A vertex of the file that has the coordinates of point p: the first one used.
  [[nodiscard]] int vertex_of(int p) const { return point_vertices_[p]; }
  /// What is wrong with the scene, found while loading: all but self-touching.
  [[nodiscard]] std::span<const Defect> defects() const { return defects_; }
  [[nodiscard]] const MeshEdgeCounts& mesh_edges() const { return mesh_edges_; }
  /// Number of closed, consistently oriented components.
  [[nodiscard]] int solids() const { return solids_; }
  /// Corner of the bounding box with the smallest, the largest coordinates.
  [[nodiscard]] const std::array<Point, 2>& bounds() const { return bounds_; }

 private:
  friend struct internal::SceneBuilder;

  PolygonSoup soup_;
  std::vector<Point> points_;
  std::vector<int> point_vertices_;
  std::vector<Face> faces_;
  std::vector<int> corners_;  // point ids of all faces, face after face
  std::vector<Facet> facets_;
  std::vector<Edge> edges_;
  std::vector<int> side_edges_;  // per entry of corners_
  std::vector<int> corner_points_;
  // Edges (faces) at point p: positions edge_starts_[p] to edge_starts_[p + 1] of
  // edge_ids_.
  std::vector<int> edge_starts_, edge_ids_;
  std::vector<int> face_starts_, face_ids_;
  std::vector<Object> objects_;
  std::unordered_map<std::string, int> object_names_;
  std::vector<Defect> defects_;
  MeshEdgeCounts mesh_edges_;
  int solids_ = 0;
  std::array<Point, 2> bounds_;
  enum class FaceSides : std::uint8_t { Sheet, Solid, Turned };
  std::vector<FaceSides> sides_;  // of faces
  std::vector<Hollow> hollows_;
};

/// The scene as if these objects, groups or polygon numbers `#i-j` were not in the file.
/// Polygons keep their numbers, and objects their names.  Throws InvalidInput for a name
/// that does not exist, and Stopped.
[[nodiscard]] Scene scene_without(const Scene& scene, std::span<const std::string> names,
                                  const Request& request = {});

/// Faces of one object that meet in more than the corners and edges they share: for each
/// polygon that meets another so, one defect of kind "self-touching", which names it and
/// one partner.  Exact.  Cost: about n log n for n faces, copies, fans and stars too; it
/// grows faster where many boxes of faces overlap that meet nobody.
[[nodiscard]] std::vector<Defect> find_self_touching(const Scene& scene);

/// Every defect of the scene: those found while loading, then find_self_touching.
/// The request's budget, stop and progress are heard, its other members are not asked.
/// Throws Stopped when time is over.
[[nodiscard]] std::vector<Defect> validate(const Scene& scene,
                                           const Request& request = {});

}  // namespace sightline
