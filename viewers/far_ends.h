// What lies at both far ends of a skeleton's lines: the one place where this module asks.

#pragma once

#include <array>
#include <optional>

#include "linespace/occlusion.h"
#include "skeleton/ev_skeleton.h"

namespace sightline::viewers {

/// The maximal free segment through a line of the skeleton.
struct FarEnds {
  /// Its ends; where `faces` is empty, a point on the way to the outside, at a distance
  /// of the scene's diameter beyond the outermost contact.
  std::array<Point, 2> points;
  /// Polygons of the file (ascending) that end it; empty means the outside.
  std::array<std::vector<int>, 2> faces;
  /// Grazing contacts along it, in order.
  std::vector<Contact> contacts;
};

/// Along the line through an arc's vertex and the point of its edge at parameter s.
/// nullopt when rounding hides the line from itself.
[[nodiscard]] std::optional<FarEnds> far_ends(const Scene& scene,
                                              const OcclusionIndex& index,
                                              const SkeletonArc& arc, double s);

/// Along a node's line.
[[nodiscard]] std::optional<FarEnds> far_ends(const Scene& scene,
                                              const OcclusionIndex& index,
                                              const SkeletonNode& node);

/// The point of an edge at parameter s, rounded to double.
[[nodiscard]] Point point_on_edge(const Scene& scene, const Edge& edge, double s);

}  // namespace sightline::viewers
