#include "linespace/picture/eye_space.h"

#include <Eigen/Geometry>
#include <cmath>

#include "linespace/numbers/exact_position.h"

namespace sightline::internal {
namespace {

constexpr long double kLongUnit = 0x1p-64L;

// Sum of |u_i| |v_j| |w_k| over the six terms of a determinant.
long double permanent(const LongVector& u, const LongVector& v, const LongVector& w) {
  return u[0] * (v[1] * w[2] + v[2] * w[1]) + u[1] * (v[2] * w[0] + v[0] * w[2]) +
         u[2] * (v[0] * w[1] + v[1] * w[0]);
}

// det(p, q, r) as det(p, q - p, r - p), which loses less where the three are close.
LongValue determinant(const LongVector& p, const LongVector& q, const LongVector& r) {
  LongVector size, u, v, eu, ev;  // |p|, |q - p|, |r - p|, and the errors of the last two
  LongVector du, dv;
  for (int i = 0; i < 3; ++i) {
    du[i] = q[i] - p[i];
    dv[i] = r[i] - p[i];
    size[i] = std::abs(p[i]);
    u[i] = std::abs(du[i]);
    v[i] = std::abs(dv[i]);
    // Components are off by 4 units at most, and a difference by one more.
    eu[i] = 6 * kLongUnit * (std::abs(q[i]) + size[i]);
    ev[i] = 6 * kLongUnit * (std::abs(r[i]) + size[i]);
    v[i] += ev[i];
  }
  const long double value = dot(p, cross(du, dv));
  // The component of p is off by 4 units; two products and three additions follow.
  return {value, permanent(size, u, ev) + permanent(size, eu, v) +
                     12 * kLongUnit * permanent(size, u, v)};
}

}  // namespace

long double long_double(const Rational& x) {
  const auto high = static_cast<double>(x);
  if (!std::isfinite(high) || high == 0) return high;
  const Rational rest = x - Rational(high);
  return static_cast<long double>(high) + static_cast<long double>(nearest_double(rest));
}

EyeSpace::EyeSpace(const ViewScene& scene, const Viewpoint& eye)
    : scene_(&scene),
      direction_(eye.kind == Viewpoint::Kind::Direction),
      eye_(exact_point(eye.at)),
      rounded_eye_(eye.at.nearest),
      is_double_(eye.at.is_double[0] && eye.at.is_double[1] && eye.at.is_double[2]),
      vectors_(static_cast<LongVector*>(std::calloc(
                   static_cast<std::size_t>(scene.point_count()), sizeof(LongVector))),
               &std::free),
      fronts_(scene.scene().faces().size(), 2) {
  for (int i = 0; i < 3; ++i) {
    if (!is_admissible(rounded_eye_[i])) {
      throw InvalidInput("the eye: coordinate " + std::to_string(i) +
                         " has a magnitude outside [2^-140, 2^140]");
    }
  }
  if (!direction_) return;
  // Of the direction d with its largest component k: x = d_k p_i - d_i p_k and y the same
  // with j, so that the rows' cross product is d_k d; swapped where d_k is negative.
  rounded_eye_.cwiseAbs().maxCoeff(&axis_);
  const int k = axis_;
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  const auto row = [&](int axis) {
    ExactPoint r{};
    r[axis] = eye_[k];
    r[k] = -eye_[axis];
    return r;
  };
  across_ = {row(i), row(j)};
  if (eye_[k] < 0) std::swap(across_[0], across_[1]);
  // Both rows over the power of two that brings the scene's picture to size 1.
  const auto& box = scene.scene().bounds();
  const double extent =
      std::max(box[0].cwiseAbs().maxCoeff(), box[1].cwiseAbs().maxCoeff());
  const int exponent = std::ilogb(extent > 0 ? extent : 1) + std::ilogb(rounded_eye_[k]);
  const Rational scale(std::ldexp(1.0, -exponent));
  for (ExactPoint& r : across_) {
    for (Rational& x : r) x *= scale;
  }
  // The area in x and y is scale^2 d_k (A . d), and A . d / |d| is asked.
  const long double length =
      std::sqrt(static_cast<long double>(nearest_double(exact_dot(eye_, eye_))));
  area_factor_ = 1 / (std::ldexp(1.0L, -2 * exponent) *
                      std::abs(static_cast<long double>(rounded_eye_[k])) * length);
}

const ExactPoint& EyeSpace::exact_vector(int point) const {
  const auto [it, is_new] = exact_vectors_.try_emplace(point);
  if (is_new) it->second = vector_to(scene_->exact(point));
  return it->second;
}

ExactPoint EyeSpace::vector_to(const ExactPoint& p) const {
  return direction_ ? ExactPoint{exact_dot(across_[0], p), exact_dot(across_[1], p), 1}
                    : exact_difference(eye_, p);
}

const LongVector& EyeSpace::vector(int point) const {
  LongVector& known = vectors_[point];
  if (known == LongVector{}) {
    if (!direction_ && is_double_ && !scene_->is_constructed(point)) {
      const Point& p = scene_->scene().point(point);
      for (int i = 0; i < 3; ++i) {
        known[i] = static_cast<long double>(rounded_eye_[i]) - p[i];
      }
    } else {
      const ExactPoint& v = exact_vector(point);
      known = LongVector{long_double(v[0]), long_double(v[1]), long_double(v[2])};
    }
  }
  return known;
}

Rational EyeSpace::exact_height(int point) const {
  return direction_ ? height_of(scene_->exact(point)) : Rational(1);
}

Rational EyeSpace::height_of(const ExactPoint& p) const {
  if (!direction_) return 1;
  return eye_[axis_] < 0 ? Rational(-p[axis_]) : p[axis_];
}

Rational EyeSpace::exact_orient_value(int p, int q, int r) const {
  return exact_dot(exact_vector(p), exact_cross(exact_vector(q), exact_vector(r)));
}

LongValue EyeSpace::orient_value(int p, int q, int r) const {
  return determinant(vector(p), vector(q), vector(r));
}

Sign EyeSpace::orient(int p, int q, int r) const {
  if (p == q || q == r || p == r) return Sign::Zero;
  const bool given = !scene_->is_constructed(p) && !scene_->is_constructed(q) &&
                     !scene_->is_constructed(r);
  if (!direction_ && is_double_ && given) {
    const Scene& s = scene_->scene();
    return orient3d(s.point(p), s.point(q), s.point(r), rounded_eye_);
  }
  const LongValue v = orient_value(p, q, r);
  if (std::abs(v.value) > v.error || v.error == 0 ||
      thread_precision == Precision::Double) {
    ++thread_stage_counts().by_double;
    return static_cast<Sign>((v.value > 0) - (v.value < 0));
  }
  ++thread_stage_counts().by_exact;
  return static_cast<Sign>(exact_orient_value(p, q, r).sign());
}

Sign EyeSpace::front(int face) const {
  std::int8_t& known = fronts_[face];
  if (known == 2) {
    const auto t = plane_points(scene_->scene(), face);
    known = static_cast<std::int8_t>(orient(t[0], t[1], t[2]));
  }
  return static_cast<Sign>(known);
}

bool EyeSpace::end_on(int line) const {
  const auto [a, b] = scene_->lines()[line].ends;
  const LongVector n = cross(vector(a), vector(b));
  const LongVector& u = vector(a);
  const LongVector& v = vector(b);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const long double permanent = std::abs(u[j] * v[k]) + std::abs(u[k] * v[j]);
    if (std::abs(n[i]) > 16 * kLongUnit * permanent) return false;
  }
  return exact_cross(exact_vector(a), exact_vector(b)) == ExactPoint{};
}

Point EyeSpace::drawn_at(const LongVector& v) const {
  if (!direction_) {
    const long double length = std::sqrt(dot(v, v));
    return {static_cast<double>(-v[0] / length), static_cast<double>(-v[1] / length),
            static_cast<double>(-v[2] / length)};
  }
  // The point p across d with across_ p = (x, y): p = (x (r1 x d) - y (r0 x d)) / n,
  // where n = d . (r0 x r1).
  const Eigen::Vector3d d = rounded_eye_.normalized();
  const Eigen::Vector3d r0 = rounded(across_[0]), r1 = rounded(across_[1]);
  const double n = d.dot(r0.cross(r1));
  return (static_cast<double>(v[0]) * r1.cross(d) -
          static_cast<double>(v[1]) * r0.cross(d)) /
         n;
}

}  // namespace sightline::internal
