// One facet's mesh as the tests walk on it: edges as fine polylines, places where a
// segment crosses them, and points of the facet's plane in rationals.
//
// Of the library only the answer is used: vertices, polylines, conics, faces at edges.

#pragma once

#include <span>
#include <vector>

#include "shadows/shadow_mesh.h"
#include "tests/support/naive_shadow.h"

namespace sightline::testing {

using Flat = Eigen::Vector2d;

class MeshPlane {
 public:
  /// faces: naive_shadow_faces of the scene.  front: the side that receives.  Keeps a
  /// reference to the mesh.
  MeshPlane(const Scene& scene, std::span<const NaiveShadowFace> faces,
            const ShadowMesh& mesh, bool front);

  [[nodiscard]] const ShadowMesh& mesh() const { return *mesh_; }
  /// A point of the plane, exactly on it.
  [[nodiscard]] Vec3 lift(const Flat& p) const;
  [[nodiscard]] const Vec3& normal() const { return normal_; }
  /// The largest extent of the facet in the mesh's two coordinates.
  [[nodiscard]] double size() const { return (high_ - low_).maxCoeff(); }
  [[nodiscard]] const Flat& low() const { return low_; }
  [[nodiscard]] const Flat& high() const { return high_; }

  [[nodiscard]] const std::vector<Flat>& line(int edge) const { return lines_[edge]; }
  [[nodiscard]] double length(int edge) const { return lengths_[edge]; }
  /// A point of an edge and the unit vector there to the left of the edge.
  struct EdgePoint {
    Flat at, left;
  };
  /// t: 0 at the first end, 1 at the second.
  [[nodiscard]] EdgePoint edge_point(int edge, double t) const;

  struct Crossing {
    double at;  ///< 0 at the segment's begin, 1 at its end
    int edge;
    bool to_left;  ///< into the face on the left of the edge
  };
  /// Where the segment from p to q crosses edges, in order.
  [[nodiscard]] std::vector<Crossing> crossings(const Flat& p, const Flat& q) const;

 private:
  void add_crossings(int edge, const Flat& p, const Flat& q,
                     std::vector<Crossing>& out) const;
  /// The point near p on the conic of the edge, moved along a direction.
  [[nodiscard]] Flat onto(int edge, Flat p, const Flat& way) const;

  const ShadowMesh* mesh_;
  Vec3 normal_;
  Rational offset_;  ///< normal . x = offset
  int w_ = 2;        ///< the coordinate of space that the mesh leaves out
  Flat low_, high_;
  std::vector<std::vector<Flat>> lines_;
  std::vector<double> lengths_;
};

}  // namespace sightline::testing
