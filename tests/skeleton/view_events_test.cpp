// Crossings of a path against the views themselves: exact lists of what is seen from many
// points of the path change only where an event is reported, and where one is, they do.

#include "skeleton/view_events.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <tuple>

#include "linespace/contacts/contact.h"
#include "linespace/occlusion.h"
#include "linespace/scene.h"
#include "linespace/sight/line_probe.h"
#include "linespace/swaths/edge_cuts.h"
#include "skeleton/build.h"
#include "skeleton/nodes/node_contacts.h"
#include "tests/support/eee_scenes.h"
#include "tests/support/generators.h"

namespace sightline {

// For messages.
std::ostream& operator<<(std::ostream& stream, const ViewEvent& e) {
  return stream << static_cast<int>(e.kind) << ":" << e.id << "/" << int{e.side}
                << (e.tie ? "=" : "") << "@" << e.u;
}

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
      : scene_(scene), index_(scene), silhouettes_(scene) {}

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
    const auto faces = internal::faces_near_line(silhouettes_, x, p);
    return internal::is_free(silhouettes_, LineScan(scene_, faces, x, p));
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
    const auto faces = internal::faces_near_line(silhouettes_, x, internal::rounded(q));
    return internal::is_free(silhouettes_, LineScan(scene_, faces, e, q));
  }

  const Scene& scene_;
  OcclusionIndex index_;
  internal::Silhouettes silhouettes_;
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
      const Point a = testing::grid_point(random, answers.scene, beyond);
      const Point b = testing::grid_point(random, answers.scene, beyond);
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

// Without pieces every crossing is decided by its own line's contacts.
TEST(ViewEvents, PiecesAndContactsAgree) {
  Request nothing;
  nothing.budget_seconds = 0;
  std::size_t events = 0;
  const auto check = [&](const PolygonSoup& soup, std::uint64_t seed) {
    const Answers answers(soup);
    const EndIndex empty(answers.scene, answers.skeleton, nothing);
    ASSERT_FALSE(empty.complete());
    const ViewEvents by_contacts(answers.scene, answers.skeleton, empty);
    testing::Random random(seed);
    for (int path = 0; path < 4; ++path) {
      const Point a = testing::grid_point(random, answers.scene, 0.5);
      const Point b = testing::grid_point(random, answers.scene, 0.5);
      const auto found = answers.events.crossed(a, b);
      EXPECT_EQ(found, by_contacts.crossed(a, b)) << seed << " path " << path;
      events += found.size();
    }
  };
  for (std::uint64_t seed = 1; seed <= 8; ++seed) check(testing::eee_scene(seed), seed);
  check(testing::random_polytopes(3, 25, {.density = 0.2}), 3);
  check(testing::city(2, 60), 2);
  EXPECT_GT(events, 2000U);
}

TEST(ViewEvents, DoNotDependOnThePathsDirection) {
  const Answers answers(testing::random_polytopes(9, 25, {.density = 0.2}));
  testing::Random random(9);
  const Point a = testing::grid_point(random, answers.scene, 0.1);
  const Point b = testing::grid_point(random, answers.scene, 0.1);
  const auto there = answers.events.crossed(a, b);
  auto back = answers.events.crossed(b, a);
  std::ranges::reverse(back);
  ASSERT_EQ(there.size(), back.size());
  ASSERT_GT(there.size(), 100U);
  for (std::size_t i = 0; i < there.size(); ++i) {
    EXPECT_EQ(there[i].kind, back[i].kind);
    EXPECT_EQ(there[i].id, back[i].id);
    EXPECT_EQ(there[i].side, back[i].side);
    EXPECT_NEAR(there[i].u, 1 - back[i].u, 1e-9);
  }
}

TEST(ViewEvents, OfOneCubeAreTheTurnsOfItsFaces) {
  const Answers answers(testing::boxes_soup({{{0, 0, 0}, {1, 1, 1}}}));
  const auto events = answers.events.crossed({-2, 3, 0.5}, {4, 3.5, 0.75});
  ASSERT_EQ(events.size(), 2U);  // the planes x = 0 and x = 1
  EXPECT_EQ(events[0].kind, EventKind::F);
  EXPECT_DOUBLE_EQ(events[0].point[0], 0);
  EXPECT_DOUBLE_EQ(events[1].point[0], 1);
  EXPECT_FALSE(events[1].tie);
  EXPECT_EQ(answers.events.separating({-2, 3, 0.5}, {4, 3.5, 0.75}), events);
  // Through x = 0 and z = 1 at once.
  const auto both = answers.events.crossed({-1, 3, 2}, {1, 3, 0});
  ASSERT_EQ(both.size(), 2U);
  EXPECT_FALSE(both[0].tie);
  EXPECT_TRUE(both[1].tie);
  EXPECT_LT(both[0].id, both[1].id);
}

TEST(ViewEvents, CrossedTwiceDoNotSeparate) {
  const Answers answers(testing::random_polytopes(4, 30, {.density = 0.25}));
  testing::Random random(4);
  int undone = 0;
  for (int path = 0; path < 5; ++path) {
    const Point a = testing::grid_point(random, answers.scene, 0.3);
    const Point b = testing::grid_point(random, answers.scene, 0.3);
    const auto all = answers.events.crossed(a, b);
    const auto between = answers.events.separating(a, b);
    for (const ViewEvent& e : all) {
      const auto same = [&](const ViewEvent& x) {
        return x.kind == e.kind && x.id == e.id;
      };
      const auto times = std::ranges::count_if(all, same);
      EXPECT_LE(times, e.kind == EventKind::EEE ? 2 : 1);
      EXPECT_EQ(std::ranges::count_if(between, same), times % 2);
      undone += static_cast<int>(times == 2);
    }
  }
  std::printf("%d crossed twice\n", undone);
}

TEST(ViewEvents, RefuseWhatIsNoPath) {
  const Answers answers(testing::boxes_soup({{{0, 0, 0}, {1, 1, 1}}}));
  EXPECT_THROW((void)answers.events.crossed({1, 2, 3}, {1, 2, 3}), InvalidInput);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)answers.events.crossed({1, nan, 3}, {1, 2, 3}), InvalidInput);
}

}  // namespace
}  // namespace sightline
