// A scene as form factors see it: sides of faces that send out and receive, what else may
// be met, what blocks, and the windows through which the rest leaves.

#pragma once

#include <array>
#include <span>
#include <vector>

#include "linespace/scene.h"
#include "linespace/scene/solid_index.h"
#include "shadows/factors/convex_merge.h"
#include "shadows/form_factor_surfaces.h"

namespace sightline::internal {

/// A convex polygon that sends out and receives by its front.
struct FactorSide {
  PointList polygon;
  /// A surface's number, or one of the below.
  int of;
  /// To which all of the surface belongs; -1 where there is no such one.
  int object = -1;
};

/// What a direction meets first, where it meets no surface.
enum Elsewhere : int { kOthers = -1, kBacks = -2, kOutside = -3 };

struct FactorScene {
  std::vector<double> areas;   ///< of the surfaces
  std::vector<double> buried;  ///< of them: at once inside a closed object
  /// Of them: on the scene's box, facing out; their areas, and areas times unit normals.
  std::vector<double> leaving;
  std::vector<Eigen::Vector3d> leaving_normal;
  std::vector<FactorSide> sides;      ///< of the surfaces, in their order
  std::vector<FactorSide> elsewhere;  ///< fronts, backs and windows
  std::vector<PointList> blockers;
  /// So many of the first ones have the material of a closed object behind them.
  std::size_t solid_blockers = 0;
  /// The convex closed object to which the blocker belongs, or -1.
  std::vector<int> blocker_object;
  double coincident_area = 0;

  /// What leaves at once into the half-space of a unit vector: an element with the normal
  /// n sends (1 + n . up) / 2 there.
  [[nodiscard]] double leaving_upwards(int surface, const Eigen::Vector3d& up) const {
    return 0.5 * (leaving[surface] + leaving_normal[surface].dot(up));
  }
};

/// For every face side, 2 f for the side that the file lists counter-clockwise and
/// 2 f + 1 for the other: what it is for a direction that meets it first, with polygons
/// in their plane; of a back, the parts that no front covers.  A face of several surfaces
/// is listed for each.
[[nodiscard]] std::vector<std::vector<FactorSide>> sides_by_face(
    const Scene& scene, std::span<const FormFactorSurface> surfaces);

[[nodiscard]] FactorScene factor_scene(const Scene& scene,
                                       std::span<const FormFactorSurface> surfaces);

/// Of fronts that lie on one another, counted as often as once less than they are.
[[nodiscard]] double coincident_area(const Scene& scene);

/// The corners of a face, counter-clockwise as seen from the side on which the file lists
/// it so, or from the other one.
[[nodiscard]] PointList listed_polygon(const Scene& scene, int face, bool back);

[[nodiscard]] double area_of(std::span<const Point> polygon);

}  // namespace sightline::internal
