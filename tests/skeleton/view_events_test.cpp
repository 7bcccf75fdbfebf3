// Crossings of a path against the views themselves: exact lists of what is seen from many
// points of the path change only where an event is reported, and where one is, they do.

#include "skeleton/view_events.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <tuple>

#include "linespace/contact_internal.h"
#include "linespace/occlusion.h"
#include "linespace/scene.h"
#include "skeleton/edge_cuts_internal.h"
#include "skeleton/node_contacts_internal.h"
#include "tests/support/eee_scenes.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

using internal::exact_point;
using internal::LineScan;
using internal::Rational;

/// What a viewpoint sees in solid mode, told by ids: corners at which the line of sight
/// grazes; the sides of facets with such a corner; edges that cross in the view, both
/// grazed, the nearer first.  Computed from its definition.
struct View {
  std::set<int> corners;
  std::set<std::pair<int, int>> facets;
  std::set<std::pair<int, int>> crossings;
  friend bool operator==(const View&, const View&) = default;
};

class Viewer {
 public:
  explicit Viewer(const Scene& scene)
      : scene_(scene), index_(scene), generators_(scene, 1) {}

  [[nodiscard]] const OcclusionIndex& index() const { return index_; }

  [[nodiscard]] View view(const Point& x) const {
    View out;
    for (const int p : scene_.corners()) {
      if (grazes(x, scene_.point(p))) out.corners.insert(p);
    }
    for (int f = 0; f < static_cast<int>(scene_.faces().size()); ++f) {
      for (const int p : scene_.face_points(f)) {
        if (!out.corners.contains(p)) continue;
        const auto c = scene_.face_points(f);
        const Sign side =
            orient3d(scene_.point(c[0]), scene_.point(c[1]), scene_.point(c[2]), x);
        out.facets.insert({scene_.faces()[f].facet, static_cast<int>(side)});
      }
    }
    const int n = static_cast<int>(scene_.edges().size());
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        if (i != j && sees_crossing(x, i, j)) out.crossings.insert({i, j});
      }
    }
    return out;
  }

 private:
  [[nodiscard]] bool grazes(const Point& x, const Point& p) const {
    const auto faces = internal::faces_near_line(generators_, x, p);
    return internal::is_free(LineScan(scene_, faces, x, p));
  }

  // One point of `near` and one of `far` lie in line, both grazed, in this order, and
  // nothing hides them.
  [[nodiscard]] bool sees_crossing(const Point& x, int near, int far) const {
    const auto ends = [&](int e) {
      const auto& p = scene_.edges()[e].points;
      return std::array<Point, 2>{scene_.point(p[0]), scene_.point(p[1])};
    };
    const auto [n0, n1] = ends(near);
    const auto [f0, f1] = ends(far);
    const Sign a = orient3d(x, n0, n1, f0);
    if (a == Sign::Zero || orient3d(x, n0, n1, f1) != -a) return false;
    const Sign b = orient3d(x, f0, f1, n0);
    if (b == Sign::Zero || orient3d(x, f0, f1, n1) != -b) return false;
    // The far edge's point lies beyond the plane of the near edge, and on the same ray.
    const internal::ExactPoint e = exact_point(x);
    const internal::ExactPoint p0 = exact_point(n0), p1 = exact_point(n1);
    const internal::ExactPoint q0 = exact_point(f0), q1 = exact_point(f1);
    const auto meet = [](const auto& u0, const auto& u1, const Rational& s0,
                         const Rational& s1) {
      return internal::along(u0, u1, Rational(s0 / (s0 - s1)));
    };
    const auto p = meet(p0, p1, internal::exact_orient(e, q0, q1, p0),
                        internal::exact_orient(e, q0, q1, p1));
    const auto q = meet(q0, q1, internal::exact_orient(e, p0, p1, q0),
                        internal::exact_orient(e, p0, p1, q1));
    int axis = 0;
    while (q[axis] == e[axis]) ++axis;
    const Rational t = (p[axis] - e[axis]) / (q[axis] - e[axis]);
    if (t <= 0 || t >= 1) return false;
    const auto faces = internal::faces_near_line(generators_, x, internal::rounded(q));
    return internal::is_free(LineScan(scene_, faces, e, q));
  }

  const Scene& scene_;
  OcclusionIndex index_;
  internal::Generators generators_;
};

struct Answers {
  Scene scene;
  Skeleton skeleton;
  EndIndex ends;
  ViewEvents events;
  explicit Answers(const PolygonSoup& soup)
      : scene(soup),
        skeleton(build_skeleton(scene)),
        ends(scene, skeleton),
        events(scene, skeleton, ends) {}
};

/// A point on a grid of 2^-8, so that steps of a 1024th of a path are exact.
Point grid_point(testing::Random& random, const Scene& scene, double beyond) {
  Point p;
  for (int i = 0; i < 3; ++i) {
    const double low = scene.bounds()[0][i];
    const double high = scene.bounds()[1][i];
    const double margin = beyond * (high - low);
    p[i] = std::round(256 * random.uniform(low - margin, high + margin)) / 256;
  }
  return p;
}

std::string difference(const View& x, const View& y) {
  std::string out;
  const auto add = [&](const char* what, const auto& p, const auto& q) {
    std::remove_cvref_t<decltype(p)> only;
    std::ranges::set_symmetric_difference(p, q, std::inserter(only, only.end()));
    if (!only.empty()) out += std::string(" ") + what + ::testing::PrintToString(only);
  };
  add("corners", x.corners, y.corners);
  add("facets", x.facets, y.facets);
  add("crossings", x.crossings, y.crossings);
  return out;
}

struct Tally {
  int changes = 0, unexplained = 0, single = 0, unseen = 0;
  std::array<int, 3> events{};
};

void follow(const Answers& answers, const Viewer& viewer, const Point& a, const Point& b,
            int steps, Tally& tally) {
  const auto events = answers.events.crossed(a, b);
  for (const ViewEvent& e : events) ++tally.events[static_cast<int>(e.kind)];
  View before = viewer.view(a);
  std::size_t next = 0;
  for (int k = 1; k <= steps; ++k) {
    const double u = static_cast<double>(k) / steps;
    const View now = viewer.view(a + u * (b - a));
    const std::size_t first = next;
    while (next < events.size() && events[next].u < u) ++next;
    const bool changed = !(now == before);
    tally.changes += static_cast<int>(changed);
    // Through a wall the view may change without an event.
    const double w = static_cast<double>(k - 1) / steps;
    const bool through_wall = !viewer.index().is_free(a + w * (b - a), a + u * (b - a));
    if (changed && next == first && !through_wall) {
      ++tally.unexplained;
      ADD_FAILURE() << "between " << w << " and " << u << difference(before, now);
    }
    if (next == first + 1 && events[first].kind != EventKind::F) {
      ++tally.single;
      if (!changed) ++tally.unseen;
    }
    before = now;
  }
}

TEST(ViewEvents, AreWhereTheViewChanges) {
  Tally tally;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const Answers answers(
        testing::random_polytopes(seed, 4, {.max_vertices = 6, .density = 0.25}));
    const Viewer viewer(answers.scene);
    testing::Random random(seed);
    for (int path = 0; path < 2; ++path) {
      const double beyond = path == 0 ? 0.1 : 1.5;
      const Point a = grid_point(random, answers.scene, beyond);
      const Point b = grid_point(random, answers.scene, beyond);
      follow(answers, viewer, a, b, 128, tally);
    }
  }
  EXPECT_EQ(tally.unexplained, 0);
  EXPECT_EQ(tally.unseen, 0);
  EXPECT_GT(tally.changes, 500);
  EXPECT_GT(tally.single, 250);
  for (const int count : tally.events) EXPECT_GT(count, 30);
  std::printf("%d changes, %d single events; EV %d EEE %d F %d\n", tally.changes,
              tally.single, tally.events[0], tally.events[1], tally.events[2]);
}

}  // namespace
}  // namespace sightline
