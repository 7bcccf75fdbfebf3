// What an EEE arc claims, asked of lines beside it: 20,000 random lines close to random
// arcs, each pierces exactly those of the three solids on whose side it passes the edge,
// and nothing else.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <set>

#include "linespace/occlusion.h"
#include "linespace/scene.h"
#include "skeleton/build.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

Point on_edge(const Scene& scene, int edge, double s) {
  const auto& p = scene.edges()[edge].points;
  return scene.point(p[0]) + s * (scene.point(p[1]) - scene.point(p[0]));
}

/// Where the plane through p and the edge `middle` crosses the edge `last`.
Point opposite(const Scene& scene, const Point& p, int middle, int last) {
  const Point m0 = on_edge(scene, middle, 0), m1 = on_edge(scene, middle, 1);
  const Point n = (m0 - p).cross(m1 - p);
  const Point q0 = on_edge(scene, last, 0), q1 = on_edge(scene, last, 1);
  const double t = n.dot(p - q0) / n.dot(q1 - q0);
  return q0 + t * (q1 - q0);
}

/// A point inside the convex solid.
Point centre_of(const Scene& scene, int object) {
  Point sum = Point::Zero();
  int count = 0;
  for (const int f : scene.objects()[object].faces) {
    for (const int p : scene.face_points(f)) {
      sum += scene.point(p);
      ++count;
    }
  }
  return sum / count;
}

TEST(EeeNeighbours, LinesBesideAnArcPierceTheSolidsOnTheirSide) {
  constexpr double kShift = 1e-7, kBeyond = 1e-5;
  int asked = 0, wrong = 0;
  std::array<int, 8> patterns{};
  for (std::uint64_t seed = 1; asked < 20000 && seed < 100; ++seed) {
    const Scene scene(testing::random_polytopes(seed, 20, {.density = 0.25}));
    SkeletonRequest request;
    request.ev = false;
    const Skeleton skeleton = build_skeleton(scene, request);
    const OcclusionIndex index(scene);
    testing::Random random(seed);
    for (int k = 0; k < 1000 && asked < 20000; ++k) {
      const SkeletonArc& arc =
          skeleton.eee()[random.integer(0, static_cast<int>(skeleton.eee().size()) - 1)];
      const double width = arc.range[1] - arc.range[0];
      if (width < 1e-2) continue;  // the shift must not reach past its ends
      const double s = arc.range[0] + random.uniform(0.1, 0.9) * width;
      const Point p = on_edge(scene, arc.edges()[0], s);
      const Point q = opposite(scene, p, arc.edges()[1], arc.edges()[2]);
      const Point a = p + kShift * random.direction(),
                  b = q + kShift * random.direction();
      const Point d = (b - a).normalized();
      // The solids that the line should pierce.
      std::set<int> expected;
      int pattern = 0;
      bool clear = true;
      for (int i = 0; i < 3; ++i) {
        const int edge = arc.edges()[i];
        const Point g = on_edge(scene, edge, 1) - on_edge(scene, edge, 0);
        const Point n = d.cross(g.normalized());
        const Point from_edge = a - on_edge(scene, edge, 0);
        const double away = n.dot(from_edge);
        const int object = scene.edges()[edge].object;
        const double inward = n.dot(centre_of(scene, object) - on_edge(scene, edge, 0));
        // Too close to tell, or so steep along the edge that the shift moves the contact.
        clear = clear && std::abs(away) > 0.05 * kShift && n.norm() > 0.05;
        if ((away > 0) == (inward > 0)) {
          expected.insert(object);
          pattern |= 1 << i;
        }
      }
      if (!clear) continue;
      std::set<int> pierced;
      for (const Contact& contact : index.contacts(a - kBeyond * d, b + kBeyond * d)) {
        if (!contact.blocked) continue;
        for (const Touch& touch : contact.touches) {
          pierced.insert(scene.faces()[touch.face].object);
        }
      }
      ++asked;
      ++patterns[pattern];
      if (pierced != expected) {
        ++wrong;
        if (wrong <= 3) {
          ADD_FAILURE() << "seed " << seed << " arc of edges " << arc.edges()[0] << " "
                        << arc.edges()[1] << " " << arc.edges()[2] << " at " << s
                        << " in [" << arc.range[0] << ", " << arc.range[1] << "]";
        }
      }
    }
  }
  EXPECT_EQ(asked, 20000);
  EXPECT_EQ(wrong, 0);
  for (const int count : patterns) EXPECT_GT(count, 1000);
}

}  // namespace
}  // namespace sightline
