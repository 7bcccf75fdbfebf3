// A facet of a receiver as a polygon in two exact coordinates.

#pragma once

#include <optional>

#include "linespace/light/source_patches.h"
#include "shadows/planar/plane_curve.h"
#include "shadows/shadow_mesh.h"

namespace sightline::internal {

/// The two coordinates are those of space without the one along which the plane's normal
/// is largest, so that scene points have doubles.
class ReceiverPlane {
 public:
  /// patch: of faces that hang together, on the side that receives.
  explicit ReceiverPlane(const SourcePatch& patch);

  [[nodiscard]] const PlaneOutline& outline() const { return outline_; }
  /// Exact, of length other than 1, towards the side that receives.
  [[nodiscard]] const ExactPoint& normal() const { return normal_; }
  /// An area in the two coordinates times this is one in space.
  [[nodiscard]] double area_factor() const { return area_factor_; }
  /// Of the outline, scene units squared.
  [[nodiscard]] double area() const;
  /// The larger extent of the outline in the two coordinates.
  [[nodiscard]] double size() const;
  [[nodiscard]] ShadowMesh::Frame frame() const;

  [[nodiscard]] ExactPoint lift(const PlanePoint& p) const;
  [[nodiscard]] PlanePoint drop(const ExactPoint& p) const { return {p[u_], p[v_]}; }
  /// Of a point with a weight, one of the two coordinates times its weight.
  template <class T>
  [[nodiscard]] std::array<T, 3> drop(const std::array<T, 4>& p) const {
    return {p[u_], p[v_], p[3]};
  }

  /// The pieces of a segment inside the outline; those along its sides are left out.
  [[nodiscard]] std::vector<std::array<PlanePoint, 2>> clip(const PlanePoint& a,
                                                            const PlanePoint& b) const;
  /// The pieces inside where the plane n . x + k = 0 cuts the receiver; none where the
  /// two planes are parallel.
  [[nodiscard]] std::vector<std::array<PlanePoint, 2>> cut_by(const ExactPoint& n,
                                                              const Rational& k) const;

 private:
  void find_outline(const SourcePatch& patch);
  [[nodiscard]] bool contains(const PlanePoint& p) const;

  int u_ = 0, v_ = 1, w_ = 2;
  ExactPoint normal_;
  Rational offset_;  // normal . x + offset = 0
  double area_factor_ = 1;
  PlaneOutline outline_;
};

}  // namespace sightline::internal
