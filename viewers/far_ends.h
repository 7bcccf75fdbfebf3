// What lies at both far ends of a skeleton's lines: the one place where this module asks.

#pragma once

#include <array>
#include <optional>
#include <vector>

#include "skeleton/graph.h"
#include "skeleton/skeleton_lines.h"

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

/// Along the line of an arc at parameter s (SkeletonLines::line); EEE: nullopt where s is
/// not inside the range, or rounding leaves no such line.
[[nodiscard]] std::optional<FarEnds> far_ends(const Scene& scene,
                                              const SkeletonLines& lines,
                                              const SkeletonArc& arc, double s);

/// Along a node's line; nullopt where SkeletonLines gives none.
[[nodiscard]] std::optional<FarEnds> far_ends(const Scene& scene,
                                              const SkeletonLines& lines,
                                              const Skeleton& skeleton,
                                              const SkeletonNode& node);

/// Numbers of the file's polygons that the faces came from, ascending.
[[nodiscard]] std::vector<int> source_polygons(const Scene& scene,
                                               const std::vector<int>& faces);

/// The point of an edge at parameter s, rounded to double.
[[nodiscard]] Point point_on_edge(const Scene& scene, const Edge& edge, double s);

}  // namespace sightline::viewers
