// The library's exact view from a point against the naive one.

#pragma once

#include <string>
#include <vector>

#include "linespace/point_view.h"
#include "tests/support/naive_view.h"
#include "tests/support/view_scenes.h"

namespace sightline::testing {

/// The same eye, with nothing rounded.
[[nodiscard]] Viewpoint viewpoint_of(const NaiveEye& eye);

/// Everything in which the two answers differ, a line each.  The map is compared only for
/// eyes that are free or inside; rounded positions to 1e-9 of their size.
[[nodiscard]] std::vector<std::string> differences(const NaiveEye& eye,
                                                   const NaiveView& naive,
                                                   const PointView& view);

/// Both views of one scene.  Keeps a reference to it.
class SceneComparison {
 public:
  explicit SceneComparison(const Scene& scene) : viewer_(scene), index_(scene) {}
  /// `general` too, at five times the cost, if asked.  An exception of either side is a
  /// difference.
  [[nodiscard]] std::vector<std::string> differences(const NaiveEye& eye,
                                                     bool general) const;
  /// For each eye and one near it: one side says that their labelled structures are
  /// equal, the other that they are not.
  [[nodiscard]] std::vector<std::string> structure_differences(
      const std::vector<NaiveEye>& eyes) const;

  /// Gradients against differences of naive solid angles at twelve eyes near by, where
  /// these have the same structure and third derivatives are small.
  [[nodiscard]] std::vector<std::string> gradient_differences(const NaiveEye& eye) const;

 private:
  NaiveViewer viewer_;
  PointViewIndex index_;
};

/// The scene with as many groups and polygons left out as may be, so that there still are
/// differences.
[[nodiscard]] PolygonSoup smallest_differing(const PolygonSoup& soup, const NaiveEye& eye,
                                             bool general);

struct ViewRun {
  int eyes;                 ///< a scene
  std::uint64_t seed;       ///< another choice of eyes
  bool general;             ///< compare `general` too, and structures
  int every = 1;            ///< of this many scenes one
  bool large = false;       ///< large_view_scenes() instead
  bool barely_off = false;  ///< eyes_barely_off() instead
  bool on_scene = true;     ///< eyes on facets, edges and corners too
  int most_reports = 10;
};
/// Compares on view_scenes(); reports of the smallest cases.
[[nodiscard]] std::vector<std::string> compare_views(const ViewRun& run);

/// Scene (as OBJ), eye and differences.
[[nodiscard]] std::string report(const PolygonSoup& soup, const NaiveEye& eye,
                                 const std::vector<std::string>& differences);

}  // namespace sightline::testing
