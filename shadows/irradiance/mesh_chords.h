// The edges of a discontinuity mesh as chords that are short enough.

#pragma once

#include <functional>
#include <vector>

#include "shadows/shadow_mesh.h"

namespace sightline::internal {

/// A straight stand-in for a part of an edge of the mesh.
struct MeshChord {
  Eigen::Vector2d from, to;
  int left, right;  ///< faces of the mesh; -1 outside of the receiver
  /// The edge's part lies this near to the chord, in units of the frame; 0 of a straight
  /// one.
  double height;
  int order;  ///< as ShadowMesh::Edge says; 0 where there is none
  /// What the caller's measure says of it.
  double error = 0;
};

/// Parts of curves are halved until the measure of the chord is at most `wanted`, or
/// halves would be 2^-8 of what the mesh's polyline has.
[[nodiscard]] std::vector<MeshChord> mesh_chords(
    const ShadowMesh& mesh, double wanted,
    const std::function<double(const MeshChord&)>& measure);

}  // namespace sightline::internal
