#include "shadows/seen/plane_frame.h"

#include <algorithm>
#include <cmath>

namespace sightline::internal {

PlaneFrame::PlaneFrame(const SourceScene& source, const SourcePlane& plane,
                       const EyeSpace& eye)
    : source_(&source), plane_(&plane), eye_(&eye) {
  const Scene& scene = source.scene().scene();
  const auto t = plane_points(scene, plane.faces.front());
  origin_ = exact_point(scene.point(t[0]));
  exact_normal_ = exact_cross(exact_difference(exact_point(scene.point(t[1])), origin_),
                              exact_difference(exact_point(scene.point(t[2])), origin_));
  if (!plane.fronts.front()) {
    for (Rational& x : exact_normal_) x = -x;
  }
  // Brought to size 1 before it is rounded.
  Rational size = 0;
  for (const Rational& x : exact_normal_) size = std::max(size, Rational(abs(x)));
  LongEigen n;
  for (int i = 0; i < 3; ++i) n[i] = long_double(exact_normal_[i] / size);
  const long double length = n.norm();
  normal_ = n / length;
  const ExactPoint apex = exact_difference(eye.eye(), origin_);
  apex_ = long_eigen(apex);
  height_ = long_double(exact_dot(exact_normal_, apex) / size) / length;
}

ExactPoint PlaneFrame::exact_place(const PicturePoint& p) const {
  // The ray E - v t meets the plane where n . (E - v t) = 0, E taken from the origin.
  const ExactPoint apex = exact_difference(eye_->eye(), origin_);
  const ExactPoint& v = p.exact();
  const Rational t =
      quotient(exact_dot(exact_normal_, apex), exact_dot(exact_normal_, v));
  return {apex[0] - v[0] * t, apex[1] - v[1] * t, apex[2] - v[2] * t};
}

PlaneFrame::Placed PlaneFrame::place(const PicturePoint& p) const {
  const Scene& scene = source_->scene().scene();
  if (p.point() >= 0 && !source_->scene().is_constructed(p.point()) &&
      source_->side(*plane_, p.point()) == Sign::Zero) {
    const LongEigen x =
        scene.point(p.point()).cast<long double>() - rounded(origin_).cast<long double>();
    return {x, 0x1p-63L * x.cwiseAbs().maxCoeff()};
  }
  const LongEigen v = long_eigen(p.vector());
  const long double down = normal_.dot(v);
  const long double t = height_ / down;
  const LongEigen x = apex_ - v * t;
  const long double error =
      (p.error() + 0x1p-60L) * std::abs(t) * (1 + 1 / std::abs(down)) +
      0x1p-60L * apex_.cwiseAbs().maxCoeff();
  return {x, error};
}

Point PlaneFrame::on_plane(const PicturePoint& p) const {
  const Placed placed = place(p);
  // From very near to the plane, or where points nearly coincide.
  constexpr long double kRounded = 1e-15L;
  if (!(placed.error <= kRounded * placed.at.cwiseAbs().maxCoeff())) {
    ExactPoint x = exact_place(p);
    for (int i = 0; i < 3; ++i) x[i] += origin_[i];
    return rounded(x);
  }
  return (placed.at + rounded(origin_).cast<long double>()).cast<double>();
}

}  // namespace sightline::internal
