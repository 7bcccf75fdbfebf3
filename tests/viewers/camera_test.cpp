// Cameras: what is framed is held, from outside, from inside and straight from above.

#include "viewers/camera.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace sightline::viewers {
namespace {

using Box = std::array<Point, 2>;

const Box kBox{Point(1, 2, 3), Point(5, 4, 4)};
constexpr double kAspect = 1.5;

struct Extent {
  double largest;  ///< 1: some corner lies on the border of the picture
  double nearest;  ///< depth of the nearest corner
};

Extent extent_on_picture(const Camera& camera, const Box& box) {
  const Point forward = (camera.target - camera.eye).normalized();
  const Point right = forward.cross(camera.up).normalized();
  const Point top = right.cross(forward);
  const double slope = std::tan(0.5 * camera.field_of_view);
  Extent extent{0, 1e300};
  for (int i = 0; i < 8; ++i) {
    const Point corner(box[i & 1].x(), box[(i >> 1) & 1].y(), box[i >> 2].z());
    const Point d = corner - camera.eye;
    const double depth = d.dot(forward);
    extent.nearest = std::min(extent.nearest, depth);
    extent.largest = std::max({extent.largest, std::abs(d.dot(top)) / (slope * depth),
                               std::abs(d.dot(right)) / (slope * depth * kAspect)});
  }
  return extent;
}

TEST(Camera, FrameHoldsTheBoxFromEverySide) {
  for (const double elevation : {0.1, 0.42, 1.1}) {
    for (int turn = 0; turn < 12; ++turn) {
      const Camera camera =
          frame(kBox, eye_direction(2, elevation, turn / 12.0), Point::UnitZ(), kAspect);
      const Extent extent = extent_on_picture(camera, kBox);
      EXPECT_GT(extent.nearest, 0);
      EXPECT_LT(extent.largest, 1.0);
      EXPECT_GT(extent.largest, 0.8);
    }
  }
}

TEST(Camera, LookFromOutsideHoldsTheBoxAtAnyDistance) {
  const Point middle = 0.5 * (kBox[0] + kBox[1]);
  for (const double distance : {10.0, 100.0, 1e5}) {
    for (int turn = 0; turn < 12; ++turn) {
      const Point eye = middle + distance * eye_direction(2, 0.3, turn / 12.0);
      const Camera camera = look_from(eye, middle, kBox, 2, kAspect);
      EXPECT_EQ(camera.eye, eye);
      EXPECT_NEAR(extent_on_picture(camera, kBox).largest, 0.94, 1e-6);
    }
  }
}

TEST(Camera, LookFromInsideHasTheWidestAngle) {
  const Point eye(2, 3, 3.5);
  const Camera camera = look_from(eye, {5, 3, 3.5}, kBox, 2, kAspect);
  EXPECT_EQ(camera.field_of_view, kWidestView);
  EXPECT_TRUE((camera.target - eye).normalized().isApprox(Point::UnitX()));
  EXPECT_EQ(camera.up, Point::UnitZ());
}

TEST(Camera, HowFarTheLookGoesDoesNotMatter) {
  const Point eye(2, 3, 3.5);
  const Camera one = look_from(eye, {3, 3, 3.5}, kBox, 2, kAspect);
  const Camera other = look_from(eye, {1e6, 3, 3.5}, kBox, 2, kAspect);
  EXPECT_TRUE(one.target.isApprox(other.target));
}

TEST(Camera, StraightFromAboveAnotherAxisPointsUp) {
  for (int axis = 0; axis < 3; ++axis) {
    const Point middle = 0.5 * (kBox[0] + kBox[1]);
    const Camera camera =
        look_from(middle + 20 * Point::Unit(axis), middle, kBox, axis, kAspect);
    EXPECT_EQ(camera.up, Point::Unit((axis + 2) % 3));
    EXPECT_NEAR(extent_on_picture(camera, kBox).largest, 0.94, 1e-6);
  }
}

}  // namespace
}  // namespace sightline::viewers
