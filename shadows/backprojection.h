// Backprojection: which part of an area light a point sees, exactly.
//
// Every decision is exact: whether anything is seen, whether all of it, and which edges
// bound the part that is seen.  Areas, form factors and gradients are rounded, with
// stated bounds.  What hides, and what does not, is defined in docs/shadows.md, case by
// case.
//
//   const BackprojectionIndex index(scene, light_source(scene, {{"lamp"}}));
//   const Backprojection seen = index.from({.at = {1, 2, 0}, .normal = {{0, 0, 1}}});
//   std::cout << seen.visible_fraction << ' ' << *seen.form_factor << '\n';
//
// Neighbours: light_source.h names the light; light_seen.h is what is answered;
// point_view.h sees everything, not a light alone.

#pragma once

#include <memory>
#include <optional>

#include "linespace/exact_position.h"
#include "linespace/request.h"
#include "linespace/scene.h"
#include "shadows/light_seen.h"
#include "shadows/light_source.h"

namespace sightline {

namespace internal {
class SourceScene;
}

/// Who asks: a point, and perhaps the normal of the surface there.
struct ShadowPoint {
  ExactPosition at;
  /// Of any length but 0: what lies at or below its horizon is not seen.
  std::optional<ExactPosition> normal;
};
/// A point of doubles.
[[nodiscard]] ShadowPoint shadow_point(const Point& at);
[[nodiscard]] ShadowPoint shadow_point(const Point& at, const Eigen::Vector3d& normal);
/// The point moved along the normal of a polygon of the file exactly onto its plane, with
/// that normal, towards where the file lists it counter-clockwise.  A polygon that
/// rounding has bent counts by its first triangle.  Throws InvalidInput for a number that
/// no polygon with an area has.
[[nodiscard]] ShadowPoint shadow_point_on(const Scene& scene, int polygon,
                                          const ExactPosition& at);
/// The same for a face of the scene, on the side on which the file lists it
/// counter-clockwise, or on the other.
[[nodiscard]] ShadowPoint shadow_point_on_face(const Scene& scene, int face,
                                               const ExactPosition& at, bool front);
[[nodiscard]] ShadowPoint shadow_point_on_face(const Scene& scene, int face,
                                               const Point& at, bool front);

/// What to find besides the class, the fraction and the form factor.
struct BackprojectionOptions {
  bool gradient = false;
  bool boundaries = false;
};

/// Immutable; from() may be called from several threads.  Keeps a reference to the scene.
class BackprojectionIndex {
 public:
  /// Cost: n log n for n faces.  Of the request, budget and stop are heard; throws
  /// Stopped.
  BackprojectionIndex(const Scene& scene, const LightSource& source,
                      const Request& request = {});
  ~BackprojectionIndex();
  BackprojectionIndex(BackprojectionIndex&&) noexcept;

  /// Throws InvalidInput for a point with a coordinate other than 0 whose magnitude is
  /// outside [2^-140, 2^140], and for a normal that is 0.  Cost: grows with the square of
  /// the faces that hide a part of the source, at worst.
  [[nodiscard]] Backprojection from(const ShadowPoint& point,
                                    const BackprojectionOptions& options = {}) const;

  /// For this module: what all points share.
  [[nodiscard]] const internal::SourceScene& source_scene() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sightline
