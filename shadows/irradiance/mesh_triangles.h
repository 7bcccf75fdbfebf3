// The faces of a discontinuity mesh cut into triangles.

#pragma once

#include <array>
#include <vector>

#include "shadows/irradiance/mesh_chords.h"

namespace sightline::internal {

struct MeshTriangle {
  static constexpr int kUnknown = -2;
  std::array<Eigen::Vector2d, 3> corners;  ///< counter-clockwise
  int face;                                ///< of the mesh; kUnknown where chords cross
  /// The largest error of a chord that is a side of it.
  double chord_error;
};

/// Constrained Delaunay triangles of the chords, without those outside of the receiver.
[[nodiscard]] std::vector<MeshTriangle> mesh_triangles(
    const std::vector<MeshChord>& chords);

}  // namespace sightline::internal
