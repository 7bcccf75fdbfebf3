// What all searches for events of one patch of a source share.

#pragma once

#include <span>
#include <vector>

#include "linespace/light/light_space.h"
#include "linespace/light/light_traces.h"
#include "linespace/light/source_patches.h"

namespace sightline::internal {

/// A point that lines of a pencil pass through, with what is at it.
struct PencilPoint {
  LightFeature name;
  const LightPoint* point;
  std::vector<int> objects, facets;  ///< ascending
  std::vector<int> edges;            ///< of the space, that end or pass here
  std::vector<int> sides;            ///< of the patch, likewise
};

/// Keeps references.
struct PatchSpace {
  PatchSpace(const LightSpace& space, const SourcePatch& patch, int number);

  [[nodiscard]] bool in_front(int point) const { return signs[point] == Sign::Positive; }
  [[nodiscard]] bool edge_in_front(int edge) const {
    const auto& ends = space.edges()[edge].points;
    return in_front(ends[0]) || in_front(ends[1]);
  }

  const LightSpace& space;
  const SourcePatch& patch;
  int number;
  std::vector<LightLine> sides;
  /// By point of the scene: its height over the patch's plane (positive in front, up to
  /// a factor), and the exact sign of that.
  std::vector<Approx> heights;
  std::vector<Sign> signs;
  std::vector<int> front_faces, front_edges;  ///< with a point in front, ascending
  std::vector<std::uint8_t> faces_in_front;   ///< the same by face
  std::vector<Four<Approx>> hull;             ///< of the patch
  /// Corners of the scene in front, touches in front; then, from `own_points` on, the
  /// patch's corners.
  std::vector<PencilPoint> points;
  std::size_t own_points = 0;

 private:
  void find_points();
};

/// The point lies on the line.
[[nodiscard]] bool is_on_line(const LightPoint& v, const LightLine& l);

}  // namespace sightline::internal
