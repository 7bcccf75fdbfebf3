#include "linespace/view/sight_triangle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline::internal {
namespace {

// Far above what rounding does to a dot product of coordinates that are themselves
// rounded a few times; too large only costs a question.
constexpr double kMargin = 0x1p-40;

}  // namespace

SightTriangle::SightTriangle(const EyeSpace& eye, int line) {
  const auto [p, q] = eye.scene().lines()[line].ends;
  const Point a = eye.scene().position(p);
  const Point b = eye.scene().position(q);
  const Point& e = eye.rounded_eye();
  const double infinity = std::numeric_limits<double>::infinity();
  double size = std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
  for (int i = 0; i < 3; ++i) {
    around_.min[i] = std::min(a[i], b[i]);
    around_.max[i] = std::max(a[i], b[i]);
    if (!eye.is_direction()) {
      around_.min[i] = std::min(around_.min[i], e[i]);
      around_.max[i] = std::max(around_.max[i], e[i]);
    }
  }
  if (!eye.is_direction()) size = std::max(size, e.cwiseAbs().maxCoeff());
  for (int i = 0; i < 3; ++i) {
    around_.min[i] -= kMargin * size;
    around_.max[i] += kMargin * size;
    if (eye.is_direction() && e[i] < 0) around_.min[i] = -infinity;
    if (eye.is_direction() && e[i] > 0) around_.max[i] = infinity;
  }
  // Towards the eye from either end, of length 1.
  const Eigen::Vector3d da = eye.is_direction() ? e.normalized() : (e - a).normalized();
  const Eigen::Vector3d db = eye.is_direction() ? da : (e - b).normalized();
  const Eigen::Vector3d along = (b - a).normalized();
  const Eigen::Vector3d n = along.cross(da);
  if (!(n.squaredNorm() > 0x1p-60)) return;  // nearly end-on: the box alone
  // Short against coordinates that are rounded, its directions may be wrong.
  const bool is_rounded =
      eye.scene().is_constructed(p) || eye.scene().is_constructed(q) || !eye.is_double();
  const double shortest =
      eye.is_direction() ? (b - a).norm()
                         : std::min({(b - a).norm(), (e - a).norm(), (e - b).norm()});
  if (is_rounded && shortest < 0x1p-12 * size) return;
  // The plane of the triangle, from both sides; the planes through its two sides across
  // it.
  add(n, n.dot(a), size);
  add(-n, -n.dot(a), size);
  const Eigen::Vector3d at_a = n.cross(da), at_b = db.cross(n);
  add(at_a, at_a.dot(a), size);
  add(at_b, at_b.dot(b), size);
}

void SightTriangle::add(const Eigen::Vector3d& normal, double offset, double size) {
  if (!(normal.squaredNorm() > 0)) return;
  sides_[count_++] = {normal, offset + 4 * kMargin * size, 4 * kMargin};
}

bool SightTriangle::misses(const Box& box) const {
  for (int i = 0; i < 3; ++i) {
    if (box.max[i] < around_.min[i] || box.min[i] > around_.max[i]) return true;
  }
  for (int k = 0; k < count_; ++k) {
    const HalfSpace& h = sides_[k];
    double least = 0, size = 0;  // of normal . x over the box
    for (int i = 0; i < 3; ++i) {
      least += h.normal[i] * (h.normal[i] > 0 ? box.min[i] : box.max[i]);
      size += std::abs(box.min[i]) + std::abs(box.max[i]);
    }
    if (least > h.offset + h.margin * size) return true;
  }
  return false;
}

}  // namespace sightline::internal
