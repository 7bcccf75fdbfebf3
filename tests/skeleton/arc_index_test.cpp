// The index of arcs by space leaves out no arc that a path crosses: against asking all.

#include "skeleton/ask/arc_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "skeleton/build.h"
#include "skeleton/view_events.h"
#include "tests/support/eee_scenes.h"
#include "tests/support/generators.h"

namespace sightline {

// For messages.
std::ostream& operator<<(std::ostream& stream, const ViewEvent& e) {
  return stream << static_cast<int>(e.kind) << ":" << e.id << "/" << int{e.side} << "@"
                << e.u;
}

namespace {

/// Asks every arc of a scene, and the index.
class Compared {
 public:
  explicit Compared(const PolygonSoup& soup)
      : scene(soup),
        skeleton_(build_skeleton(scene)),
        ends_(scene, skeleton_),
        events_(scene, skeleton_, ends_),
        index_(scene, skeleton_, ends_),
        arcs_(skeleton_.arcs.size()) {
    std::iota(arcs_.begin(), arcs_.end(), 0U);
  }

  void check(const Point& a, const Point& b, const std::string& what) {
    auto by_index = events_.crossed(a, b);
    std::erase_if(by_index, [](const ViewEvent& e) { return e.kind == EventKind::F; });
    auto by_all = events_.crossed(a, b, arcs_);
    for (auto* list : {&by_index, &by_all}) {
      for (ViewEvent& e : *list) e.tie = false;
    }
    EXPECT_EQ(by_index, by_all)
        << what << " " << a.transpose() << " to " << b.transpose();
    found += by_all.size();
    const auto near = index_.near(a, b);
    asked += near ? near->size() : arcs_.size();
    ++paths;
  }

  [[nodiscard]] std::size_t arcs() const { return arcs_.size(); }
  [[nodiscard]] const internal::ArcIndex& index() const { return index_; }
  [[nodiscard]] double told() const {
    return static_cast<double>(std::ranges::count_if(
               arcs_, [&](std::uint32_t a) { return ends_.bounds_all(a); })) /
           static_cast<double>(arcs_.size());
  }

  Scene scene;
  std::size_t found = 0, asked = 0, paths = 0;

 private:
  Skeleton skeleton_;
  EndIndex ends_;
  ViewEvents events_;
  internal::ArcIndex index_;
  std::vector<std::uint32_t> arcs_;
};

Point direction(testing::Random& random) {
  Point d;
  do {
    for (int i = 0; i < 3; ++i) d[i] = std::round(16 * random.uniform(-1, 1)) / 16;
  } while (d.isZero());
  return d;
}

void check_random_paths(Compared& x, std::uint64_t seed, int count) {
  testing::Random random(seed);
  for (int i = 0; i < count; ++i) {
    const double beyond = i % 4 == 0 ? 3 : 0.05;
    const Point a = testing::grid_point(random, x.scene, beyond);
    x.check(a, testing::grid_point(random, x.scene, beyond), "long");
    x.check(a, a + 0x1p-6 * direction(random), "short");
    x.check(a, a + 0x1p-30 * direction(random), "tiny");
    Point b = a;
    b[i % 3] += random.uniform(-2, 2);
    if (!(a == b)) x.check(a, b, "along an axis");
    const double far = std::ldexp(1.0, 2 + 3 * (i % 12));
    x.check(a + far * direction(random), a, "from far");
    x.check(a + far * direction(random), a + far * direction(random), "far");
  }
}

/// Through points exactly on lines through two corners, so that arcs' ends and places
/// where their far ends change are met; through corners; along lines of both.
void check_aligned_paths(Compared& x, std::uint64_t seed, int count) {
  testing::Random random(seed);
  const auto corners = x.scene.corners();
  const auto corner = [&] {
    const auto n = static_cast<double>(corners.size());
    return x.scene.point(corners[static_cast<std::size_t>(random.uniform(0, n - 0.01))]);
  };
  for (int i = 0; i < count; ++i) {
    const Point v = corner();
    const Point w = corner();
    if (v == w) continue;
    const double times = std::ldexp(1.0, i % 5 - 2);
    const Point on = w + times * (w - v);
    const Point d = 0x1p-4 * direction(random);
    x.check(on - d, on + d, "through a line of two corners");
    x.check(v - d, v + d, "through a corner");
    x.check(v, w, "from corner to corner");
    x.check(on, w, "along a line of two corners");
    x.check(v, v + d, "from a corner");
  }
}

void report(const char* name, const Compared& x) {
  const auto paths = static_cast<double>(x.paths);
  std::printf(
      "%s: %zu arcs, %.2f told; %.1f boxes and %.1f bytes an arc; %zu paths, %.1f "
      "events and %.1f arcs asked each\n",
      name, x.arcs(), x.told(),
      static_cast<double>(x.index().boxes()) / static_cast<double>(x.arcs()),
      static_cast<double>(x.index().bytes()) / static_cast<double>(x.arcs()), x.paths,
      static_cast<double>(x.found) / paths, static_cast<double>(x.asked) / paths);
}

TEST(ArcIndex, LeavesOutNothingInGeneralPosition) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Compared x(testing::eee_scene(seed));
    check_random_paths(x, seed, 20);
    check_aligned_paths(x, seed, 20);
    EXPECT_GT(x.found, 100U);
  }
  Compared x(testing::random_polytopes(3, 20, {.density = 0.2}));
  check_random_paths(x, 3, 30);
  check_aligned_paths(x, 3, 30);
  report("polytopes", x);
  EXPECT_GT(x.found, 1000U);
  EXPECT_GT(x.told(), 0.9);
}

TEST(ArcIndex, LeavesOutNothingInAlignedScenes) {
  Compared city(testing::city(2, 60));
  check_random_paths(city, 2, 30);
  check_aligned_paths(city, 2, 60);
  report("city", city);
  EXPECT_GT(city.found, 1000U);
  std::vector<testing::AlignedBox> boxes;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double x = 2 * i;
      const double y = 2 * j;
      boxes.push_back({{x, y, 0}, {x + 1, y + 1, 1.0 + (i + j) % 2}});
    }
  }
  Compared grid(testing::boxes_soup(boxes));
  check_random_paths(grid, 4, 30);
  check_aligned_paths(grid, 4, 200);
  report("grid", grid);
  EXPECT_GT(grid.found, 1000U);
}

// Of the lines past the first two boxes those on one side end on the third, those on the
// other on the fourth; the one between grazes both and goes on, as no piece says.
TEST(ArcIndex, HasTheLineBetweenTwoPieces) {
  Compared x(testing::boxes_soup({{{0, -1, 0}, {1, 0, 1}},
                                  {{0, 5, 0}, {2, 6, 1.25}},
                                  {{-5, 10, 0}, {1, 12, 3}},
                                  {{1, 15, 0}, {7, 17, 3}}}));
  x.check({1, 20, 1.5}, {1, 20, 2.5}, "beyond both");
  EXPECT_GE(x.found, 1U);
}

TEST(ArcIndex, AsksFewArcsOfAShortPath) {
  Compared x(testing::random_polytopes(1, 30, {.density = 0.2}));
  testing::Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Point a = testing::grid_point(random, x.scene, 0);
    x.check(a, a + 0x1p-6 * direction(random), "short");
  }
  report("short paths", x);
  EXPECT_LT(static_cast<double>(x.asked),
            0.005 * static_cast<double>(x.paths) * static_cast<double>(x.arcs()));
  EXPECT_LT(static_cast<double>(x.index().bytes()), 140 * static_cast<double>(x.arcs()));
}

}  // namespace
}  // namespace sightline
