// The drawn patch of an EEE arc is where the arc's lines are, to the deviation promised.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "linespace/mesh_io.h"
#include "skeleton/build.h"

namespace sightline {
namespace {

double distance_to_segment(const Point& x, const Point& a, const Point& b) {
  const Point d = b - a;
  const double t = std::clamp((x - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
  return (x - a - t * d).norm();
}

double distance_to_triangle(const Point& x, const Point& a, const Point& b,
                            const Point& c) {
  const Point normal = (b - a).cross(c - a);
  const double twice_area = normal.norm();
  const bool inside = (b - a).cross(x - a).dot(normal) >= 0 &&
                      (c - b).cross(x - b).dot(normal) >= 0 &&
                      (a - c).cross(x - c).dot(normal) >= 0;
  if (inside && twice_area > 0) return std::abs((x - a).dot(normal)) / twice_area;
  return std::min({distance_to_segment(x, a, b), distance_to_segment(x, b, c),
                   distance_to_segment(x, c, a)});
}

double distance_to_strip(const Point& x, const std::vector<std::array<Point, 2>>& rungs) {
  double best = 1e300;
  for (std::size_t i = 1; i < rungs.size(); ++i) {
    const auto& [p0, q0] = rungs[i - 1];
    const auto& [p1, q1] = rungs[i];
    best = std::min(
        {best, distance_to_triangle(x, p0, q0, p1), distance_to_triangle(x, q0, q1, p1)});
  }
  return best;
}

class SwathOfArcs : public testing::Test {
 protected:
  SwathOfArcs()
      : scene_(read_mesh(std::string(SIGHTLINE_EXAMPLES) + "/scenes/room.obj")),
        skeleton_(build_skeleton(scene_, eee_only())),
        size_((scene_.bounds()[1] - scene_.bounds()[0]).norm()) {}

  static SkeletonRequest eee_only() {
    SkeletonRequest request;
    request.ev = false;
    return request;
  }

  Scene scene_;
  Skeleton skeleton_;
  double size_;
};

TEST_F(SwathOfArcs, LinesMeetTheMiddleEdgeAndEndAtTheNodes) {
  ASSERT_GT(skeleton_.eee().size(), 1000U);
  for (const SkeletonArc& arc : skeleton_.eee()) {
    const Swath surface = swath_of(scene_, arc).value();
    const auto& middle = scene_.edges()[arc.edges()[1]].points;
    const Point &m0 = scene_.point(middle[0]), &m1 = scene_.point(middle[1]);
    for (const double t : {0.1, 0.5, 0.9}) {
      const auto [p, q] = surface.line(arc.range[0] + t * (arc.range[1] - arc.range[0]));
      // Two lines meet where the vector between any points of theirs has no part along
      // their common normal.
      const Point normal = (q - p).cross(m1 - m0);
      if (normal.norm() < 1e-6 * size_ * size_) continue;
      EXPECT_LT(std::abs((m0 - p).dot(normal.normalized())), 1e-9 * size_);
    }
    for (const int end : {0, 1}) {
      const auto line = surface.line(arc.range[end]);
      const SkeletonNode& node = skeleton_.nodes[arc.nodes[end]];
      const auto& [a, b] = node.segment;
      for (const Point& x : line) {
        EXPECT_LT((x - a).cross(b - a).norm() / (b - a).norm(), 1e-6 * size_) << end;
      }
      // Lines in the planes of faces and those that end on the way may start elsewhere.
      if (node.kind != NodeKind::VEE && node.kind != NodeKind::EVE &&
          node.kind != NodeKind::EEEE) {
        continue;
      }
      if (node.end) continue;
      const bool turned = (a - line[0]).norm() > (b - line[0]).norm();
      EXPECT_LT((line[0] - (turned ? b : a)).norm(), 1e-6 * size_) << end;
      EXPECT_LT((line[1] - (turned ? a : b)).norm(), 1e-6 * size_) << end;
    }
  }
}

TEST_F(SwathOfArcs, StripKeepsToItsDeviationAndNeedsIt) {
  double largest = 0;  // share of the deviation allowed
  std::size_t subdivided = 0;
  for (const double share : {1e-2, 1e-3}) {
    const double deviation = share * size_;
    for (std::size_t i = 0; i < skeleton_.eee().size(); i += 17) {
      const SkeletonArc& arc = skeleton_.eee()[i];
      const Swath surface = swath_of(scene_, arc).value();
      const auto rungs = surface.rungs(arc.range, deviation);
      ASSERT_GE(rungs.size(), 2U);
      subdivided += rungs.size() > 2 ? 1 : 0;
      for (int j = 0; j <= 40; ++j) {
        const double s = arc.range[0] + (arc.range[1] - arc.range[0]) * j / 40.0;
        const auto [p, q] = surface.line(s);
        for (int k = 1; k < 20; ++k) {
          const double distance = distance_to_strip(p + k / 20.0 * (q - p), rungs);
          EXPECT_LE(distance, deviation * (1 + 1e-9)) << i;
          largest = std::max(largest, distance / deviation);
        }
      }
    }
  }
  EXPECT_GT(subdivided, 20U);
  // The bound is not idle: somewhere the strip uses a good part of it.
  EXPECT_GT(largest, 0.35);
}

TEST_F(SwathOfArcs, SubdivisionFollowsTheDeviation) {
  std::size_t coarse = 0, fine = 0;
  for (const SkeletonArc& arc : skeleton_.eee()) {
    const Swath surface = swath_of(scene_, arc).value();
    coarse += surface.rungs(arc.range, 1e-2 * size_).size();
    fine += surface.rungs(arc.range, 1e-4 * size_).size();
  }
  EXPECT_GT(fine, 3 * coarse);
}

}  // namespace
}  // namespace sightline
