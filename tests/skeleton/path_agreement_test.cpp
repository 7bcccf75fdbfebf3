// Two ways to the events of a path: by views that are computed on it, and by the arcs of
// the skeleton that it crosses.

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <set>

#include "linespace/view_path.h"
#include "skeleton/build.h"
#include "skeleton/view_events.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

struct Event {
  double u;
  PathEvent event;
};

std::vector<Event> by_views(const Scene& scene, const Point& a, const Point& b) {
  const std::vector<Viewpoint> path{eye_at(a), eye_at(b)};
  std::vector<Event> found;
  for (const PathChange& change : view_path(PointViewIndex(scene), path).changes) {
    for (const PathEvent& event : change.events) {
      if (event.kind != PathEventKind::Through) found.push_back({change.u, event});
    }
  }
  return found;
}

// Events with visible creases and corners behind are views' events too: polygon mode.
std::vector<Event> by_arcs(const Scene& scene, const Point& a, const Point& b) {
  SkeletonRequest request;
  request.events = EventMode::Polygon;
  const Skeleton skeleton = build_skeleton(scene, request);
  const EndIndex ends(scene, skeleton);
  std::vector<Event> found;
  for (const ViewEvent& e : ViewEvents(scene, skeleton, ends).crossed(a, b)) {
    PathEvent event{};
    if (e.kind == EventKind::EV) {
      const SkeletonArc& arc = skeleton.arcs[e.id];
      event = {
          PathEventKind::EV,
          {{GeneratorKind::Vertex, arc.vertex()}, {GeneratorKind::Edge, arc.edge()}}};
    } else if (e.kind == EventKind::EEE) {
      event.kind = PathEventKind::EEE;
      for (const auto edge : skeleton.arcs[e.id].edges()) {
        event.generators.push_back({GeneratorKind::Edge, edge});
      }
      std::ranges::sort(event.generators);
    } else {
      event = {PathEventKind::F, {{GeneratorKind::Face, static_cast<int>(e.id)}}};
    }
    found.push_back({e.u, std::move(event)});
  }
  return found;
}

TEST(PathAgreement, ViewsAndArcsGiveTheSameEvents) {
  std::size_t events = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Scene scene(
        testing::random_polytopes(seed, 6, {.min_vertices = 7, .max_vertices = 7}));
    testing::Random random(seed);
    std::array<Point, 2> p;
    for (Point& end : p) {
      for (int i = 0; i < 3; ++i) {
        end[i] = random.uniform(scene.bounds()[0][i] - 1, scene.bounds()[1][i] + 1);
      }
    }
    const std::vector<Event> views = by_views(scene, p[0], p[1]);
    const std::vector<Event> arcs = by_arcs(scene, p[0], p[1]);
    ASSERT_EQ(views.size(), arcs.size()) << "seed " << seed;
    for (std::size_t i = 0; i < views.size(); ++i) {
      EXPECT_NEAR(views[i].u, arcs[i].u, 1e-12) << "seed " << seed;
      EXPECT_EQ(views[i].event, arcs[i].event) << "seed " << seed << ", event " << i;
    }
    events += views.size();
  }
  std::cout << events << " events\n";
  EXPECT_GT(events, 100U);
}

}  // namespace
}  // namespace sightline
