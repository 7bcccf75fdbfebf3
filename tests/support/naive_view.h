// The exact view from a point by brute force in exact integers, written from the
// contract's definitions ("sightline look"), to check linespace/point_view.h; shares no
// code with it but the names of kinds.
//
// The picture is cut into convex cells: of each plane's faces everything is taken away
// that a face of another plane hides, face after face; the background is what no face
// covers.  All else is read off the cells: two cells side by side with one patch are one
// region, other borders are the map's edges.

#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "linespace/visibility_map.h"
#include "tests/support/exact.h"

namespace sightline::testing {

struct NaiveEye {
  Viewpoint::Kind kind;
  Vec3 at;
};

struct NaiveFacet {
  int facet;
  bool front;
  int pieces;
  double measure;
  /// Directions only: exactly the area times the length of the direction, "p/q".
  std::string scaled_area;
};

/// Where in space a map edge lies: all scene edges that overlap it in space, ascending;
/// or all pairs of facets, the smaller first, that cut through each other there.
struct NaiveLine {
  std::vector<int> edges;
  std::vector<std::array<int, 2>> crossings;
  /// The straight line itself in exact numbers, the same from everywhere.
  std::string in_space;
  friend auto operator<=>(const NaiveLine&, const NaiveLine&) = default;
};

struct NaiveVertex {
  MapVertexKind kind;
  int corner = -1;      ///< Corner only
  NaiveLine near, far;  ///< T only
  /// Corner only: no edge of the map ends there, so that it may be read as a touch.
  bool or_touch = false;
  /// The nearest point in space of the edges that meet here.
  Vec3 in_space;
};

struct NaiveEdge {
  NaiveLine line;
  /// More than one where the definition gives parts of the edge different kinds; none for
  /// two patches in one plane, of one object, for which it has no kind.
  std::vector<MapEdgeKind> kinds;
  /// Several scene edges lie there side by side, or facets coincide beside it: Boundary
  /// or Silhouette, Contact or Crease is a matter of reading.
  bool several = false;
  std::array<int, 2> ends{-1, -1};
  int left = -1, right = -1;  ///< regions, from the first end to the second
  std::array<Vec3, 2> in_space;
};

struct NaiveRegion {
  /// What is seen: every facet, ascending; empty for the background.
  std::vector<int> facets;
  /// Numbers of patches: one, or those that coincide.
  std::vector<int> patches;
  std::optional<double> measure;  ///< nullopt if infinite
};

struct NaiveView {
  EyePlace place;
  std::vector<int> place_ids;
  std::vector<NaiveFacet> facets;  ///< ascending
  std::vector<NaiveVertex> vertices;
  std::vector<NaiveEdge> edges;
  std::vector<NaiveRegion> regions;
  int components = 0;
  int background_pieces = 0;
  /// Maximal straight pieces between two different sets of facets of one region.
  int seams = 0;
  /// The same, cut where an edge of the map meets the seam.
  int seams_between_edges = 0;
  /// Names every vertex, edge and region by scene elements, sorted.
  std::string structure;
};

/// The map of a view by the names of scene elements: equal texts for equal labelled
/// structures.
[[nodiscard]] std::string structure_of(const NaiveView& view);

/// What the views of a scene share.  Keeps a reference to the scene.
class NaiveViewer {
 public:
  explicit NaiveViewer(const Scene& scene);
  [[nodiscard]] NaiveView view(const NaiveEye& eye) const;
  /// Whether the structure is the same at four eyes that are nearer than 2^-400 to this
  /// one, two of them opposite: true by the definition unless all four lie on one event.
  [[nodiscard]] bool general(const NaiveEye& eye) const;

  /// Number of the patch as it is seen from the facet's front or from its back: a sheet
  /// joins whatever hangs together with it, on both sides.
  [[nodiscard]] int patch_of(int facet, bool front) const;

 private:
  const Scene& scene_;
  std::vector<int> patches_;  ///< of facets, whatever the side
};

}  // namespace sightline::testing
