// The planar map (arrangement) of arcs of lines and conics inside a polygon: vertices,
// edges and faces, exactly.
//
//   const PlanarMap map(curves, outline);
//   for (int f = 0; f < map.face_count(); ++f) use(map.interior_point(f), map.area(f));
//
// Laws.  Which curves cross, in which order along each, the cyclic order of edges around
// a vertex, tangent ones included, and which face lies in which are decided exactly.
// Crossings and ends that coincide are one vertex.  Pieces of curves that coincide are
// one edge.  The answer does not depend on the order of the input: numbers of vertices,
// edges and faces included, unless two curves coincide from end to end.
//
// Half-edges.  Edge e has the half-edges 2e, from its first vertex to its second, and 2e
// + 1, back.  The face of a half-edge lies on its left.  next() runs along the boundary
// of that face: counter-clockwise on its outer boundary, clockwise around its holes.
//
// The map knows nothing of light.  Neighbours: plane_curve.h (input).

#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "shadows/planar/planar_data.h"
#include "shadows/planar/plane_curve.h"

namespace sightline::internal {

/// A part of an input curve: from s = from to s = to of its own parameter, which may run
/// backwards.  Rounded.
struct CurvePart {
  int id;
  double from, to;
};

struct ReducedMap;

class PlanarMap {
 public:
  /// Of curves inside a polygon, whose sides are edges of the map, too.
  /// Ids may repeat; where two curves with one id coincide, it is listed once.  Throws
  /// InvalidInput for a curve that is a point, whose ends are not in order or that leaves
  /// the outline, and for an outline without area.
  /// Runs on the threads of TBB's arena that it is called in; the answer does not depend
  /// on them.  Hears a stop of the calling thread (linespace/work/stop_scope.h).
  /// Cost: near-linear in curves and crossings for curves that are short compared with
  /// the outline.
  PlanarMap(std::span<const PlaneCurve> curves, const PlaneOutline& outline);

  [[nodiscard]] int vertex_count() const {
    return static_cast<int>(data_->vertices.size());
  }
  [[nodiscard]] int edge_count() const { return static_cast<int>(data_->edges.size()); }
  [[nodiscard]] int half_edge_count() const { return 2 * edge_count(); }
  [[nodiscard]] int face_count() const { return static_cast<int>(data_->faces.size()); }

  /// Rounded: see the law above.
  [[nodiscard]] const PlanarVertex& vertex(int v) const { return data_->vertices[v]; }
  /// Half-edges that start at v, counter-clockwise.
  [[nodiscard]] std::span<const int> star(int v) const { return data_->stars[v]; }

  [[nodiscard]] static int twin(int h) { return h ^ 1; }
  [[nodiscard]] static int edge_of(int h) { return h >> 1; }
  [[nodiscard]] int origin(int h) const { return data_->edges[h >> 1].ends[h & 1]; }
  [[nodiscard]] int target(int h) const { return origin(twin(h)); }
  [[nodiscard]] int next(int h) const { return data_->next[h]; }
  /// kOutside: no face, the plane around the outline and inside its holes.
  static constexpr int kOutside = -1;
  [[nodiscard]] int face(int h) const { return data_->face[h]; }

  /// Ids of the curves that run along an edge, ascending; none of a mere side of the
  /// outline.
  [[nodiscard]] std::span<const int> curves(int e) const { return data_->curves[e]; }
  [[nodiscard]] bool on_outline(int e) const { return data_->edges[e].outline; }
  [[nodiscard]] bool straight(int e) const { return data_->support_of_edge(e).straight; }

  /// A half-edge of the outer boundary of a face.
  [[nodiscard]] int outer_boundary(int f) const { return data_->faces[f].outer; }
  /// A half-edge of each hole of a face.  A tree of edges in a face is a hole, too.
  [[nodiscard]] std::span<const int> holes(int f) const { return data_->faces[f].holes; }

  // ---- edges

  /// Coefficients of x^2, x y, y^2, x, y and 1: integers without a common factor, the
  /// first that is not zero positive.  Zero on the edge.
  [[nodiscard]] std::array<Rational, 6> implicit_form(int e) const;
  /// Which part of the input curve `id` an edge is, from its first vertex to its second.
  /// Requires one of curves(e).
  [[nodiscard]] CurvePart part(int e, int id) const;
  /// A point of the edge, t = 0 at its first vertex, t = 1 at its second, rounded.
  [[nodiscard]] Eigen::Vector2d point(int e, double t) const;
  /// A point strictly inside the edge, exactly on it.
  [[nodiscard]] PlanePoint exact_point(int e) const;
  /// From the first vertex to the second, at most so far from the edge (or 2^16 steps).
  [[nodiscard]] std::vector<Eigen::Vector2d> polyline(int e, double deviation) const;

  // ---- faces

  /// A point strictly inside, proved exactly; its coordinates are doubles unless the face
  /// is too narrow for them.  Cost: linear in the edges of its boundary.
  [[nodiscard]] PlanePoint interior_point(int f) const;
  /// In closed form, rounded: off by some 1e-15 of the square of the face's size for each
  /// edge.
  [[nodiscard]] double area(int f) const;

  // ---- fewer edges

  /// The map after edges are taken out: faces merge, a vertex that is left without an
  /// edge goes, and so does one at which two edges of one curve (the same ids) meet and
  /// no other.  Vertices, edges and faces that are left keep their order.  Throws
  /// InvalidInput for an edge of the outline.  Cost: as for finding faces, no crossings.
  [[nodiscard]] ReducedMap without(std::span<const int> edges) const;

 private:
  explicit PlanarMap(std::shared_ptr<const PlanarData> data) : data_(std::move(data)) {}

  std::shared_ptr<const PlanarData> data_;
};

/// A map and what became of the edges and faces of the one that it was made from.
struct ReducedMap {
  PlanarMap map;
  std::vector<int> edge_of;  ///< of each old edge the new one it is a part of; -1: out
  std::vector<int> face_of;  ///< of each old face the new one it is a part of
};

}  // namespace sightline::internal
