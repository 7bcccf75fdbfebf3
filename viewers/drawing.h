// Scenes and skeletons as drawings: what is shown, in which colours, and from where.

#pragma once

#include <optional>

#include "skeleton/graph.h"
#include "viewers/camera.h"
#include "viewers/far_ends.h"
#include "viewers/picture.h"

namespace sightline::viewers {

/// The axis (0, 1, 2) that points up: the thinnest one of a flat scene, otherwise y, as
/// modellers and scanners have it, but z for STL, IFC and AC3D.
[[nodiscard]] int guess_up_axis(const Scene& scene);

/// Two different points.
struct Look {
  Point eye, at;
};

struct ViewOptions {
  int up_axis = -1;  ///< 0, 1, 2; -1 to guess
  int width = 1400, height = 980;
  /// What to look at: the camera frames half as much again; everything when empty.
  std::optional<std::array<Point, 2>> focus;
  /// Only what is inside this box is drawn, cut at its faces, and the camera frames it.
  std::optional<std::array<Point, 2>> box;
  /// From where to look, instead of from where most is seen; what is framed is held as
  /// look_from() does.
  std::optional<Look> look;
  /// Stop, budget and progress; view_scene() throws Stopped.
  Request request = {};
};

/// A scene ready to be drawn on.
struct SceneView {
  Camera camera;
  Drawing drawing;
  std::vector<char> polygon_shown;  ///< by polygon of the file: not left away
};

/// Every face with its edges, from the direction in which most is seen (the largest
/// entropy of visible facets over a fixed set of directions, after Vazquez et al. 2001).
/// Walls that would shut the viewer out are left away: a side of the bounding box that
/// thin things close by more than half.  With a box or a look nothing is left away.
[[nodiscard]] SceneView view_scene(const Scene& scene, const ViewOptions& options = {});

/// The smallest box that holds lines and polygons; requires one at least.
[[nodiscard]] std::array<Point, 2> bounds_of(std::span<const VeilTriangle> veils,
                                             std::span<const Stroke> strokes);

/// The camera for lines and polygons without a scene: all of them in the frame, z up
/// unless the options say otherwise.  Requires one at least.
[[nodiscard]] SceneView view_marks(std::span<const VeilTriangle> veils,
                                   std::span<const Stroke> strokes,
                                   const ViewOptions& options = {});

/// The triangle between vertex and edge part of each EV arc listed by number; `opacity`
/// of one.
void add_arcs(Drawing& drawing, const Scene& scene, const Skeleton& skeleton,
              std::span<const int> arcs, float opacity);

/// The deviation from surfaces that files and pictures keep to: this share of the scene's
/// diagonal.
constexpr double kEeeDeviation = 1e-3;

/// The arc's lines from end to end, to kEeeDeviation of the scene's diagonal
/// (Swath::rungs).
[[nodiscard]] std::vector<std::array<Point, 2>> rungs_of(const Scene& scene,
                                                         const SkeletonArc& arc);

/// Swath::spanned_volume of an arc: how much there is to see of its curvature.
[[nodiscard]] double spanned_volume(const Scene& scene, const SkeletonArc& arc);

/// The surface of an EEE arc between its outer edges, to kEeeDeviation.
void add_eee_arc(Drawing& drawing, const Scene& scene, const SkeletonArc& arc,
                 float opacity);

/// The whole edge, above everything that hides it by `hidden_opacity`.
void add_edge(Drawing& drawing, const Scene& scene, int edge, const Colour& colour,
              float width, float hidden_opacity);

/// An arc's lines from far end to far end: `rungs` are those lines in order along the
/// edge.  Neighbouring rungs that end on different faces are not joined.
struct RuledStrip {
  int arc;
  std::vector<FarEnds> rungs;
};

/// Sampled at `count` parameters of the arc, at least 2, and on both sides of every
/// change of far end that these samples show.
[[nodiscard]] RuledStrip ruled_strip(const Scene& scene, const SkeletonLines& lines,
                                     const Skeleton& skeleton, int arc, int count);

/// The strip as veils, and as strokes where it ends on a face that is shown: where the
/// shadow edges of a light in the vertex would lie.
void add_strip(SceneView& view, const Scene& scene, const Skeleton& skeleton,
               const RuledStrip& strip, float opacity);

/// The segments between the outermost contacts of the nodes listed.
void add_nodes(Drawing& drawing, const Skeleton& skeleton, std::span<const int> nodes,
               float opacity, float width);

/// A box's twelve edges, to show a region of interest.
void add_box(Drawing& drawing, const std::array<Point, 2>& box, const Colour& colour);

/// At most `limit` of the numbers 0 to size-1, evenly spread, always the same.
[[nodiscard]] std::vector<int> evenly_spread(std::size_t size, std::size_t limit);

}  // namespace sightline::viewers
