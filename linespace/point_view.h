// The exact view from a point: which part of which facet is seen, and the map they make.
//
// The eye is a point, or a point infinitely far away (a direction).  Every decision about
// what hides what, and in which order things cross in the picture, is the sign of exact
// arithmetic on the scene's doubles; only measures and drawings are rounded, with stated
// bounds.  What counts as seen, as an edge, a vertex and a region of the map is defined
// in docs/point_view.md, case by case.
//
//   const PointViewIndex index(scene);
//   const PointView view = index.view(eye_at({0, -10, 1.75}));
//   for (const SeenFacet& f : view.facets)
//     std::cout << f.facet << " is seen in " << f.pieces << " pieces: " << f.measure <<
//     '\n';
//
// The visibility map of a point: McKenna, Worst-case optimal hidden-surface removal,
// 1987; its labelled structure: the image structure graph of Koenderink and van Doorn,
// 1979. Neighbours: occlusion.h asks for one line of sight.

#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "linespace/request.h"
#include "linespace/scene.h"
#include "linespace/visibility_map.h"

namespace sightline {

namespace internal {
class ViewScene;
}

/// An axis-aligned box, its sides included.
struct ViewBox {
  ExactPosition low, high;
};
[[nodiscard]] ViewBox view_box(const Point& low, const Point& high);
/// Bounds x0, y0, z0, x1, y1, z1 in the texts of viewpoint() (visibility_map.h).  Throws
/// InvalidInput for other text, and for what PointViewIndex refuses.
[[nodiscard]] ViewBox view_box(const std::array<std::string, 6>& bounds);

/// What of a scene all its views share.  Immutable; view() may be called from several
/// threads.  Keeps a reference to the scene.
class PointViewIndex {
 public:
  /// Cost: n log n for n faces.  Of the request, budget and stop are heard; throws
  /// Stopped.
  explicit PointViewIndex(const Scene& scene, const Request& request = {});

  /// The scene cut to a box, as by a section or a crop box: all its views are those of
  /// what of the scene's faces lies in the box.  Nothing else is seen, hides, or has the
  /// eye on it; the eye may be anywhere.  What lies in a side of the box counts as
  /// inside; what has no area does not.  Cut exactly, in rationals.
  /// 1. Where a side of the box ends a facet there is an edge of the map of kind Cut,
  ///    named by the facet and the side (MapLine::box_side).  Edges of the scene in a
  ///    side of the box keep name and kind, by the facets that are left beside them.
  /// 2. Where a side cuts an edge of the scene the vertex is a Touch.
  /// 3. The box has no sides to be seen and the cut no caps.  An object of which
  ///    something is cut off is open, a sheet: its inside is no material, and through
  ///    the cut the backs of its facets are seen (SeenFacet::front is false).  So cut
  ///    material of a closed object is where its backs are seen.
  /// 4. General means: for the box as it is, and eyes nearby.
  /// Throws InvalidInput unless `low` is below `high` in each coordinate, and for
  /// coordinates that view() refuses.  Cost: as without, and rationals for the faces
  /// that are cut.
  PointViewIndex(const Scene& scene, const ViewBox& box, const Request& request = {});
  ~PointViewIndex();
  PointViewIndex(PointViewIndex&&) noexcept;

  /// Throws InvalidInput for an eye with a coordinate other than 0 whose magnitude is
  /// outside [2^-140, 2^140].  Cost: grows with the edges of the map, and with the groups
  /// of faces that are hidden, each of which takes one test.  Of the request, budget and
  /// stop are heard; throws Stopped.
  [[nodiscard]] PointView view(const Viewpoint& eye, const Request& request = {}) const;

  /// What of this is seen through a window: within the cone from the eye over a convex
  /// polygon, before it and beyond.  Measures are those of the parts within.  The
  /// window's sides are edges of the map with no name (MapLine{}), beyond which the
  /// region is -1. Throws InvalidInput for a polygon that is not convex, or that the eye
  /// sees edge-on.
  [[nodiscard]] PointView view_through(const Viewpoint& eye,
                                       std::span<const Point> window,
                                       const Request& request = {}) const;

  /// Seams that are seen, and what is hidden of the edges of the scene; edges seen end-on
  /// are left out.  Costs a view, and for the hidden some microseconds for each edge.
  [[nodiscard]] std::vector<FurtherLine> further_lines(const Viewpoint& eye, bool seams,
                                                       bool hidden,
                                                       const Request& request = {}) const;

  /// The patch of a facet as it is seen from its front or its back: facets, of all
  /// objects, that lie in one plane, face alike and hang together have one number.
  [[nodiscard]] int patch_of(int facet, bool front) const;

  /// For what stands on views within the library.
  [[nodiscard]] const internal::ViewScene& shared() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sightline
