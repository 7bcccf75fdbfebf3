// Form factors of a scene: which share of what a surface sends out arrives where.
//
// The form factor from surface i to surface j is the share of the power that i sends
// out, each of its points evenly (as a Lambertian emitter), that reaches j with nothing
// in between.  What blocks, what fronts are, and where the rest goes is defined in
// docs/form_factors.md, together with which part of the error bounds is proved.
//
//   const std::vector<FormFactorSurface> surfaces = surfaces_of_groups(scene, {});
//   const FormFactors f = form_factors(scene, surfaces, {.accuracy = 1e-6});
//   std::cout << f.at(0, 1) << " +- " << f.error_bound << '\n';
//
// Neighbours: form_factor_surfaces.h names the surfaces; polygon_form_factor.h for two
// polygons with nothing in between; point_form_factor.h for a point and a polygon;
// backprojection.h for a point and a light among blockers.

#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "linespace/point_view.h"
#include "linespace/predicates.h"
#include "linespace/request.h"
#include "linespace/scene.h"
#include "shadows/form_factor_surfaces.h"

namespace sightline {

struct FormFactorRequest : Request {
  /// Largest error of an entry, others, outside and backs included.
  double accuracy = 1e-10;
  /// Sky: the part of what leaves the scene within 90 degrees of this direction.
  std::optional<Eigen::Vector3d> up;
};

/// One row: where goes what surface i sends out?
struct FormFactorRow {
  std::vector<int> to;         ///< surfaces with an entry that is not 0, ascending
  std::vector<double> factor;  ///< of these
  double others = 0;           ///< fronts of faces that are of no surface
  double outside = 0;          ///< nothing: it leaves the scene
  double backs = 0;            ///< backs of faces, and the inside of solids at once
  double sky = 0;              ///< the part of outside that leaves upwards
};

struct FormFactors {
  std::vector<std::string> names;
  std::vector<double> areas;  ///< scene units squared
  /// Rows that were done, from the first on; all unless the budget ended.
  std::vector<FormFactorRow> rows;
  /// No entry is further off than this.
  double error_bound = 0;
  /// Of fronts that lie on one another: row sums are larger than 1 there.
  double coincident_area = 0;
  bool complete = true;
  std::int64_t pairs = 0;    ///< that were looked at
  std::int64_t open = 0;     ///< with nothing in between
  std::int64_t partial = 0;  ///< integrated among blockers
  StageCounts predicates;

  [[nodiscard]] double at(int from, int to) const;
  /// Of the row's entries, without others, outside and backs.
  [[nodiscard]] double row_sum(int from) const;
};

/// Nothing is normalised, symmetrised or clamped.  A hidden pair is exactly 0, and one
/// that sees through an opening of any width is not.  Heard of the request: accuracy, up,
/// threads, budget, progress and stop.  Throws Stopped before there is a row.
[[nodiscard]] FormFactors form_factors(const Scene& scene,
                                       std::span<const FormFactorSurface> surfaces,
                                       const FormFactorRequest& request = {});

/// The same with rows that add up to 1 (others, outside and backs included) and with
/// A_i F_ij = A_j F_ji, as solvers may want it: each A_i F_ij times d_i d_j, the rest of
/// a row times d_i, d near 1.  What is 0 stays 0.  Surfaces that are asked for twice, or
/// lie on one another, make no exact solution; then the nearest found stays.  Requires
/// all rows.
struct EnforcedFactors {
  FormFactors factors;
  double moved = 0;      ///< the largest change of an entry
  double left_over = 0;  ///< the largest distance of a row's sum from 1 after that
};
[[nodiscard]] EnforcedFactors enforced(const FormFactors& factors);

/// Where goes what an element of surface at a point sends out?
struct PointFactors {
  std::vector<double> factors;  ///< to each surface
  double others = 0, outside = 0, backs = 0, sky = 0;
};

/// Immutable; at() may be called from several threads.  Keeps a reference to the scene.
class PointFactorIndex {
 public:
  /// Of the request, budget and stop are heard; throws Stopped.
  PointFactorIndex(const Scene& scene, std::span<const FormFactorSurface> surfaces,
                   const Request& request = {});
  ~PointFactorIndex();
  PointFactorIndex(PointFactorIndex&&) noexcept;

  /// What is met is decided exactly (point_view.h); factors are within 1e-12.  normal: of
  /// any length but 0.  up: as in FormFactorRequest.  Throws InvalidInput for a point
  /// that PointViewIndex refuses.  Cost: a view.
  [[nodiscard]] PointFactors at(
      const Viewpoint& eye, const Eigen::Vector3d& normal,
      const std::optional<Eigen::Vector3d>& up = std::nullopt) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sightline
