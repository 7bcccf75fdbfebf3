#include "viewers/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline::viewers {
namespace {

/// Some room is left around what is framed.
constexpr double kFilled = 0.94;

Point corner_of(const std::array<Point, 2>& box, int i) {
  return {box[i & 1].x(), box[(i >> 1) & 1].y(), box[(i >> 2) & 1].z()};
}

}  // namespace

Point eye_direction(int up_axis, double elevation, double turn) {
  Point up = Point::Zero(), ahead = Point::Zero();
  up[up_axis] = 1;
  ahead[(up_axis + 1) % 3] = 1;
  const Point aside = up.cross(ahead);
  const double azimuth = 0.31 + 2 * M_PI * turn;
  return std::sin(elevation) * up +
         std::cos(elevation) * (std::cos(azimuth) * ahead + std::sin(azimuth) * aside);
}

Camera frame(const std::array<Point, 2>& box, const Point& towards_eye, const Point& up,
             double aspect) {
  const auto& [low, high] = box;
  Camera camera;
  camera.target = 0.5 * (low + high);
  camera.up = up;
  const double slope_y = std::tan(0.5 * camera.field_of_view) * kFilled;
  const double slope_x = slope_y * aspect;
  const Point right = up.cross(towards_eye).normalized();
  const Point top = towards_eye.cross(right).normalized();
  double distance = 1e-3 * (high - low).norm();
  // Each round finds the distance, then centres the picture.
  for (int round = 0; round < 4; ++round) {
    distance = 0;
    std::array<double, 4> reach{-1e300, 1e300, -1e300, 1e300};
    for (int i = 0; i < 8; ++i) {
      const Point d = corner_of(box, i) - camera.target;
      const double depth = d.dot(towards_eye);
      distance = std::max({distance, depth + std::abs(d.dot(right)) / slope_x,
                           depth + std::abs(d.dot(top)) / slope_y});
    }
    for (int i = 0; i < 8; ++i) {
      const Point d = corner_of(box, i) - camera.target;
      const double z = distance - d.dot(towards_eye);
      reach[0] = std::max(reach[0], d.dot(right) / z);
      reach[1] = std::min(reach[1], d.dot(right) / z);
      reach[2] = std::max(reach[2], d.dot(top) / z);
      reach[3] = std::min(reach[3], d.dot(top) / z);
    }
    camera.target += 0.5 * distance *
                     ((reach[0] + reach[1]) * right + (reach[2] + reach[3]) * top) * 0.9;
  }
  camera.eye = camera.target + distance * towards_eye;
  return camera;
}

Camera look_from(const Point& eye, const Point& at, const std::array<Point, 2>& box,
                 int up_axis, double aspect) {
  const Point forward = (at - eye).normalized();
  Camera camera;
  camera.eye = eye;
  camera.up = Point::Unit(up_axis);
  // Straight up or down, the picture's top is where another axis points.
  if (camera.up.cross(forward).norm() < 1e-6) {
    camera.up = Point::Unit((up_axis + 2) % 3);
  }
  const Point right = forward.cross(camera.up).normalized();
  const Point top = right.cross(forward);
  double slope = 0, farthest = 0;
  for (int i = 0; i < 8; ++i) {
    const Point d = corner_of(box, i) - eye;
    const double depth = d.dot(forward);
    const double aside = std::max(std::abs(d.dot(top)), std::abs(d.dot(right)) / aspect);
    slope = std::max(slope,
                     depth > 0 ? aside / depth : std::numeric_limits<double>::infinity());
    farthest = std::max(farthest, d.norm());
  }
  camera.field_of_view = std::clamp(2 * std::atan(slope / kFilled), 1e-6, kWidestView);
  // How far `at` lies does not count: the distance is the scale of what is looked at.
  camera.target = eye + farthest * forward;
  return camera;
}

}  // namespace sightline::viewers
