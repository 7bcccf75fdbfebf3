// From where to look: the best viewpoints, few viewpoints that together see everything,
// and the next best one after those that there are.
//
//   const Scene scene(read_mesh("solid.obj"));
//   const BestViews best = best_views(scene, {}, ViewMeasure::Faces, 3);
//   std::cout << best.views[0].value << " of at most " << best.bound << '\n';
//
// Finding is search: views from many viewpoints, improved from there.  What is told as a
// bound is proved, by parts of view space from all of which a patch cannot be seen
// (docs/viewpoints.md).  Every value is that of the exact view (point_view.h) from `at`.
//
// Viewpoint entropy: Vazquez, Feixas, Sbert and Heidrich 2001.  Covers: set cover, by
// branch and bound.  Neighbour: aspect_graph.h, what view space and aspects are.

#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "aspect/aspect_graph.h"
#include "linespace/request.h"
#include "linespace/scene.h"
#include "linespace/visibility_map.h"

namespace sightline {

/// How good a view is.  With `of`, what is seen of these faces alone counts.
enum class ViewMeasure : std::uint8_t {
  Faces,       ///< patches that are seen
  Area,        ///< of the surface that is seen, scene units squared
  SolidAngle,  ///< of what is seen (sr); of a direction the projected area
  Entropy,     ///< of the patches' and the background's solid angles over 4 pi, in bits
  Structure    ///< vertices of the map
};

/// Of AspectRequest: projection, label, bounds, of, samples, seed.
struct ViewpointRequest : AspectRequest {
  ViewpointRequest() {
    label = AspectLabel::Faces;
    samples = 642;
  }
  /// Further viewpoints to begin with, as of an aspect graph.
  std::vector<Viewpoint> first;
};

/// A viewpoint in general position, with what its exact view shows.
struct ChosenView {
  Viewpoint at;
  std::vector<int> facets;  ///< that are seen, ascending
  double value;
};

struct BestViews {
  /// The best first, no two of one label.
  std::vector<ChosenView> views;
  /// No view of view space has more; infinite where nothing is proved.
  double bound;
  bool certified;     ///< the viewpoints are those of a certified aspect graph
  std::size_t taken;  ///< views
  bool complete;
};

enum class CoverGoal : std::uint8_t {
  Parts,  ///< some of each patch, or a given share of its area
  Whole   ///< every point that is seen from somewhere
};

struct ViewCover {
  std::vector<ChosenView> views;  ///< value: what each adds (patches; Whole: area)
  /// So many at least are needed; proved.
  int lower_bound;
  bool optimal;  ///< lower_bound is the number of views
  /// Patches, each by one of its facets, no two of which any view sees: the proof of
  /// lower_bound where there are so many of them.
  std::vector<int> apart;
  /// No view sees more patches than this; infinite if nothing is proved.  The other proof
  /// of lower_bound: patches divided by it.
  double most_patches;
  std::size_t patches;  ///< that are seen from somewhere
  /// Steps of the search for the fewest of the viewpoints tried, and whether it is done.
  std::size_t search_steps;
  bool search_finished;
  std::vector<int> never_seen;  ///< facets of which nothing is seen from anywhere; proved
  /// Facets that no view has shown, without a proof that none can; and, of goals by area,
  /// those of which `views` show less than was wanted.
  std::vector<int> unsettled, short_of;
  bool certified;
  std::size_t taken;
  bool complete;
};

/// At least one view is asked for, entropy of eyes only (Perspective); throws
/// InvalidInput, also as find_aspects does, and Stopped before there is any view.
/// Cost: request.samples views, then some hundred for each of the views improved.
[[nodiscard]] BestViews best_views(const Scene& scene, const ViewpointRequest& request,
                                   ViewMeasure measure, int count);

/// share, in (0, 1]: of Parts, the views together see at least this share of the area of
/// each patch that any of the viewpoints tried sees; nullopt: some of it.
[[nodiscard]] ViewCover cover_views(const Scene& scene, const ViewpointRequest& request,
                                    CoverGoal goal, std::optional<double> share = {});

/// The view that adds most patches to those that these views see; its value is how many.
/// No view where nothing is added by any viewpoint tried.
[[nodiscard]] BestViews next_view(const Scene& scene, const ViewpointRequest& request,
                                  std::span<const Viewpoint> seen);

}  // namespace sightline
