#include "linespace/scene/tight_boxes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

// Fewer faces than this share no set of their own, and so many sets are tried.
constexpr std::size_t kFew = 64;
constexpr int kTries = 32;
// A set is worth its tree where boxes are so many times less bulky.
constexpr double kTighter = 16;

}  // namespace

TightBoxes::TightBoxes(const Scene& scene, std::span<const int> faces)
    : scene_(scene),
      sets_{{Point::UnitX(), Point::UnitY(), Point::UnitZ()}},
      set_of_(faces.size(), 0) {
  const auto& [low, high] = scene.bounds();
  least_ = 0x1p-20 * (high - low).norm();
  if (faces.size() < kFew) return;
  // 1. The faces whose boxes along the axes are bulky.
  std::vector<std::size_t> loose;
  std::vector<double> best(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    hear_stop();
    best[i] = bulk(box(0, faces[i]));
    if (best[i] > kTighter * bulk(box(along(faces[i]), faces[i]))) loose.push_back(i);
  }
  // 2. The directions of one of them, which others that run alike take too, and again
  // with those that are left.
  for (int tries = 0; tries < kTries && loose.size() >= kFew; ++tries) {
    const Directions directions = along(faces[loose[loose.size() / 2]]);
    std::vector<std::size_t> left, taken;
    for (const std::size_t i : loose) {
      hear_stop();
      const bool tight = kTighter * bulk(box(directions, faces[i])) < best[i];
      (tight ? taken : left).push_back(i);
    }
    // One that runs as no others do.
    if (taken.size() < kFew) {
      loose.erase(loose.begin() + static_cast<std::ptrdiff_t>(loose.size() / 2));
      continue;
    }
    for (const std::size_t i : taken) set_of_[i] = count();
    sets_.push_back(directions);
    loose = std::move(left);
  }
}

Box TightBoxes::box(int set, int face) const { return box(sets_[set], face); }

// A product with a direction is off by at most three units of rounding of the sum of the
// sizes of its terms: one of the multiplication, two of the additions.
Box TightBoxes::box(const Directions& directions, int face) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kError = 4 * std::numeric_limits<double>::epsilon() / 2;
  Box box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  for (const int corner : scene_.face_points(face)) {
    const Point& p = scene_.point(corner);
    for (int k = 0; k < 3; ++k) {
      const double product = directions[k].dot(p);
      const double error = kError * directions[k].cwiseAbs().dot(p.cwiseAbs());
      box.min[k] = std::min(box.min[k], product - error);
      box.max[k] = std::max(box.max[k], product + error);
    }
  }
  return box;
}

// Along its longest side, across that in its plane, and across its plane.
TightBoxes::Directions TightBoxes::along(int face) const {
  const auto corners = scene_.face_points(face);
  Point side = Point::UnitX(), normal = Point::Zero();
  double longest = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point& p = scene_.point(corners[i]);
    const Point& q = scene_.point(corners[(i + 1) % corners.size()]);
    normal += (p - scene_.point(corners[0])).cross(q - scene_.point(corners[0]));
    const double length = (q - p).norm();
    if (length <= longest) continue;
    longest = length;
    side = (q - p) / length;
  }
  Point across = normal.cross(side);
  // A face so thin that its normal is lost may have any.
  if (!(across.norm() > 0)) across = side.unitOrthogonal();
  across.normalize();
  return {side, across, side.cross(across)};
}

double TightBoxes::bulk(const Box& box) const {
  double product = 1;
  for (int k = 0; k < 3; ++k) product *= box.max[k] - box.min[k] + least_;
  return product;
}

}  // namespace sightline::internal
