// The faces of a discontinuity mesh cut into triangles.

#pragma once

#include <array>
#include <vector>

#include "shadows/shadow_mesh.h"

namespace sightline::internal {

struct MeshTriangle {
  static constexpr int kUnknown = -2;
  std::array<Eigen::Vector2d, 3> corners;  ///< counter-clockwise
  int face;  ///< of the mesh; kUnknown where rounded edges cross
  /// Nodes: the corners, then the middles of the sides 01, 12 and 20.  One number for
  /// nodes of neighbours that no edge of the mesh parts.
  std::array<int, 6> nodes;
};

struct MeshTriangles {
  std::vector<MeshTriangle> triangles;
  int node_count = 0;
};

/// Constrained Delaunay triangles of the edges' polylines, without those outside of the
/// receiver.
[[nodiscard]] MeshTriangles mesh_triangles(const ShadowMesh& mesh);

}  // namespace sightline::internal
