#include "linespace/view/first_seen.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace sightline::internal {
namespace {

// A box that the ray certainly misses; by rounded arithmetic with a margin.
class RayBoxes {
 public:
  RayBoxes(const EyeSpace& eye, const PicturePoint& at)
      : origin_(eye.is_direction() ? eye.drawn_at(at.vector()) : eye.rounded_eye()),
        way_(eye.is_direction() ? eye.rounded_eye().normalized()
                                : eye.drawn_at(at.vector())),
        one_way_(!eye.is_direction()),
        error_(kMargin + 4 * static_cast<double>(at.error())) {}

  [[nodiscard]] bool misses(const Box& box) const {
    Eigen::Vector3d c, half;
    for (int i = 0; i < 3; ++i) {
      c[i] = 0.5 * (box.min[i] + box.max[i]) - origin_[i];
      half[i] = 0.5 * (box.max[i] - box.min[i]);
    }
    const double size = c.cwiseAbs().sum() + half.sum() + origin_.cwiseAbs().sum();
    const double slack = error_ * size;
    if (one_way_ && c.dot(way_) + half.dot(way_.cwiseAbs()) < -slack) return true;
    const Eigen::Vector3d n = c.cross(way_);
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      if (std::abs(n[i]) >
          half[j] * std::abs(way_[k]) + half[k] * std::abs(way_[j]) + slack) {
        return true;
      }
    }
    return false;
  }

 private:
  static constexpr double kMargin = 0x1p-40;
  Point origin_;
  Eigen::Vector3d way_;
  bool one_way_;
  double error_;
};

// The determinant of three picture vectors, two of them of scene points.
Rational side_value(const EyeSpace& eye, int p, int q, const ExactPoint& x) {
  return exact_dot(x, exact_cross(eye.exact_vector(p), eye.exact_vector(q)));
}

}  // namespace

bool contains(const EyeSpace& eye, int face, const PictureRay& ray) {
  const auto corners = eye.scene().corners(face);
  const Sign front = eye.front(face);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const int p = corners[k];
    const int q = corners[(k + 1) % corners.size()];
    Sign s = orient(PicturePoint(eye, p), PicturePoint(eye, q), ray.at) * front;
    for (std::size_t i = 0; s == Sign::Zero && i < ray.beside.size(); ++i) {
      s = static_cast<Sign>(side_value(eye, p, q, ray.beside[i]).sign()) * front;
    }
    if (s != Sign::Positive) return false;
  }
  return true;
}

Nearness::Nearness(const EyeSpace& eye, int face) {
  const auto t = plane_points(eye.scene().scene(), face);
  std::array<ExactPoint, 3> v;
  for (int i = 0; i < 3; ++i) v[i] = eye.exact_vector(t[i]);
  const Rational whole = exact_dot(v[0], exact_cross(v[1], v[2]));
  for (int i = 0; i < 3; ++i) {
    const ExactPoint n = exact_cross(v[(i + 1) % 3], v[(i + 2) % 3]);
    const Rational weight = quotient(eye.exact_height(t[i]), whole);
    for (int j = 0; j < 3; ++j) gradient_[j] += weight * n[j];
  }
}

std::vector<int> faces_near(const EyeSpace& eye, const PicturePoint& at,
                            std::span<const std::uint8_t> possibly_seen) {
  const ViewScene& scene = eye.scene();
  const RayBoxes boxes(eye, at);
  std::vector<int> faces;
  scene.silhouettes().face_tree().traverse(
      [&](const Box& box) { return !boxes.misses(box); },
      [&](std::uint32_t item) {
        const int face = static_cast<int>(item);
        if (possibly_seen[face] == 0 || boxes.misses(scene.silhouettes().face_box(face)))
          return;
        if (eye.front(face) != Sign::Zero) faces.push_back(face);
      });
  std::ranges::sort(faces);
  return faces;
}

std::vector<int> first_seen(const EyeSpace& eye, const PictureRay& ray,
                            std::span<const std::uint8_t> possibly_seen) {
  std::vector<int> faces = faces_near(eye, ray.at, possibly_seen);
  std::erase_if(faces, [&](int face) { return !contains(eye, face, ray); });
  if (faces.size() < 2) return faces;
  std::vector<int> first;
  std::vector<Rational> nearest;  // at the point, and the slopes beside it
  for (const int face : faces) {
    const Nearness nearness(eye, face);
    std::vector<Rational> here{nearness.at(ray.at.exact())};
    for (const ExactPoint& v : ray.beside) here.push_back(nearness.at(v));
    if (!first.empty() && here < nearest) continue;
    if (first.empty() || nearest < here) first.clear();
    first.push_back(face);
    nearest = std::move(here);
  }
  return first;
}

}  // namespace sightline::internal
