// The steps that turn a PolygonSoup into a Scene, one .cpp file per idea.

#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "linespace/predicates.h"
#include "linespace/scene.h"
#include "linespace/work/stage.h"

namespace sightline::internal {

/// Disjoint sets of 0..n-1; the representative is the smallest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(int i, int j) {
    i = find(i);
    j = find(j);
    if (i < j) {
      parent_[j] = i;
    } else {
      parent_[i] = j;
    }
  }

 private:
  std::vector<int> parent_;
};

/// Which way a, b, c turn when dropped along a coordinate axis (0, 1, 2), seen against
/// it.
[[nodiscard]] Sign orient2d(int axis, const Point& a, const Point& b, const Point& c);

/// Convex pieces of one polygon of the file.
struct PolygonPieces {
  /// Positions in `vertices`' numbering, piece after piece.
  std::vector<int> corners;
  /// For each corner: the side from it to the next one of its piece is a diagonal.
  std::vector<std::uint8_t> is_diagonal;
  std::vector<int> sizes;
  bool zero_area = false;
  bool planar = true;
  bool convex = true;
  bool crossing = false;
  /// Scene units, rounded; only for polygons that are not planar.
  double off_plane = 0;
};

/// Cuts a polygon without consecutive repeats into exactly planar convex pieces.  A
/// convex planar one stays whole; any other is triangulated by clipping ears, in the
/// coordinate plane onto which it projects largest, with exact signs, shortest diagonal
/// first.
[[nodiscard]] PolygonPieces cut_into_pieces(std::span<const Point> vertices,
                                            std::span<const int> ring);

/// A side of a face, under its two end points in ascending order.
struct HalfEdge {
  int low, high;
  int face;
  int object;
  bool forward;   ///< the face runs from low to high
  bool diagonal;  ///< a cut inside a polygon of the file
};

/// The half-edges of one object between the same two points, from position `first` on:
/// those that follow each other.
[[nodiscard]] inline std::span<const HalfEdge> same_edge(std::span<const HalfEdge> sorted,
                                                         std::size_t first) {
  const HalfEdge& e = sorted[first];
  std::size_t end = first + 1;
  while (end < sorted.size() && sorted[end].low == e.low && sorted[end].high == e.high &&
         sorted[end].object == e.object) {
    ++end;
  }
  return sorted.subspan(first, end - first);
}

/// Faces run along the edge equally often in both directions: so it is at all edges of a
/// closed surface.
[[nodiscard]] inline bool is_balanced(std::span<const HalfEdge> edge) {
  return 2 * std::ranges::count(edge, true, &HalfEdge::forward) == std::ssize(edge);
}

/// An edge of the mesh: `count` half-edges of one object from `first` on.
struct MeshEdge {
  int first, count;
  EdgeKind kind;
};

/// Fills a Scene, step by step in the order of run().
struct SceneBuilder {
  Scene& scene;
  const SceneOptions& options;
  Stage& stage;

  SceneBuilder(Scene& target, const SceneOptions& how, Stage& told)
      : scene(target), options(how), stage(told) {}

  std::vector<int> weld;                  // file vertex -> first one at its coordinates
  std::vector<std::uint8_t> is_diagonal;  // per entry of Scene::corners_
  std::vector<HalfEdge> half_edges;       // by low, object, high
  std::vector<MeshEdge> mesh_edges;       // without the cuts inside polygons
  std::vector<std::uint8_t> bulges;  // per object: no edge is exactly reflex or worse
  std::vector<int> inexact_faces;    // faces with a neighbour declared coplanar

  void run();

  void check_usable() const;  // validate.cpp
  void check_duplicates();
  void report(std::string kind, std::string message, std::vector<int> faces,
              std::vector<int> vertices = {});

  void weld_vertices();  // scene.cpp
  void make_faces();
  void number_points();
  void index_faces();
  void find_bounds();

  void make_objects();  // objects.cpp
  void describe_objects();

  void drop_copies();  // copies.cpp

  void turn_shells();  // shells.cpp
  void turn_face(int face);
  void report_inside_out(const std::vector<int>& shell, bool is_part, int around);

  void collect_half_edges();  // edges.cpp
  void classify_edges();
  struct DeclaredFlat;
  void join_flat(int f, int g, bool exact, DisjointSets& regions);
  std::size_t pass_diagonals(std::size_t begin, std::size_t end, DisjointSets& regions);
  EdgeKind kind_between(const HalfEdge& e, const HalfEdge& f, DisjointSets& regions,
                        DeclaredFlat& declared);
  void report_non_manifold(const MeshEdge& edge);
  void report_declared(DeclaredFlat declared);
  void count_kinds();
  void make_facets(DisjointSets& regions);
  void join_edges();
  void name_sides(std::span<const int> edge_of);
  void index_edges();
};

/// Face ids, ascending, of the faces that the wanted polygons of the file (1, for each)
/// repeat: those of them that have no face of their own, since drop_copies() left them
/// out.
[[nodiscard]] std::vector<int> repeated_faces(const Scene& scene,
                                              const std::vector<std::uint8_t>& wanted);

/// The plane of a face, as three points: its first three corners.
[[nodiscard]] inline std::array<Point, 3> plane_corners(const Scene& scene, int face) {
  const auto ids = scene.face_points(face);
  return {scene.point(ids[0]), scene.point(ids[1]), scene.point(ids[2])};
}

}  // namespace sightline::internal
