// What is left out at a glance can be left out: ridges that no line touches, faces that
// nothing enters by, blockers that are not in the way.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include "linespace/blockers/blocker_list.h"
#include "linespace/blockers/facing_faces.h"
#include "tests/support/generators.h"

namespace sightline::internal {
namespace {

std::vector<PolygonSoup> soups() {
  return {testing::random_polytopes(1, 25, {.density = 0.2}), testing::city(2, 120),
          testing::grid_city(3, 120)};
}

Point random_point(testing::Random& random, const Scene& scene) {
  const auto& [low, high] = scene.bounds();
  Point p;
  for (int i = 0; i < 3; ++i) {
    const double size = high[i] - low[i];
    p[i] = random.uniform(low[i] - 0.2 * size, high[i] + 0.2 * size);
  }
  return p;
}

// At corners of the scene many points are exactly in planes of ridges.
TEST(RidgeSides, AreThoseOfThePlanes) {
  for (const PolygonSoup& soup : soups()) {
    const Scene scene(soup);
    const Silhouettes g(scene);
    testing::Random random(1);
    int none = 0, seen = 0, in_plane = 0;
    for (int trial = 0; trial < 60; ++trial) {
      const Point p = trial % 2 == 0
                          ? random_point(random, scene)
                          : scene.point(scene.corners()[random.integer(
                                0, static_cast<int>(scene.corners().size()) - 1)]);
      const Point q = random_point(random, scene);
      const auto items = g.ridge_tree().items();
      for (std::size_t k = 0; k < items.size(); ++k) {
        const Ridge& r = g.ridges()[items[k]];
        const auto untouched = [&](const Point& x) {
          return r.contact(r.a(x), r.b(x)) == EdgeContact::None;
        };
        in_plane += r.a(p) == Sign::Zero || r.b(p) == Sign::Zero ? 1 : 0;
        none += untouched(p) ? 1 : 0;
        if (g.ridge_sides(k).never_touched_from(p)) {
          ++seen;
          EXPECT_TRUE(untouched(p)) << "ridge " << items[k];
        }
        if (g.ridge_sides(k).never_touched_from(p, q)) {
          EXPECT_TRUE(untouched(p) && untouched(q) && r.a(p) == r.a(q));
        }
      }
    }
    EXPECT_GT(seen, 0.98 * none);
    EXPECT_GT(in_plane, 50);
  }
}

// Towards any of its points, a convex solid is entered by a face that is told.
TEST(FacingFaces, HoldTheFaceThatIsEnteredBy) {
  for (const PolygonSoup& soup : soups()) {
    const Scene scene(soup);
    const Silhouettes g(scene);
    FacingFaces facing(g);
    testing::Random random(5);
    int left_out = 0, entered = 0;
    for (int trial = 0; trial < 40; ++trial) {
      const std::array<Point, 2> ends{random_point(random, scene),
                                      random_point(random, scene)};
      facing.begin(ends);
      for (std::size_t o = 0; o < scene.objects().size(); ++o) {
        const auto& faces = scene.objects()[o].faces;
        ASSERT_TRUE(g.convex_solid(static_cast<int>(o)));
        const auto told = facing.of(static_cast<int>(o));
        left_out += static_cast<int>(faces.size() - told.size());
        Point inside = Point::Zero();
        for (const int f : faces) inside += scene.point(scene.face_points(f)[0]);
        inside /= static_cast<double>(faces.size());
        const Point from = ends[0] + random.uniform() * (ends[1] - ends[0]);
        // The last plane passed from its front to its back.
        double last = 0;
        int by = -1;
        for (const int f : faces) {
          const double d0 = g.face_plane(f).value(from).value;
          const double d1 = g.face_plane(f).value(inside).value;
          if (d0 <= 0 || d0 / (d0 - d1) < last) continue;
          last = d0 / (d0 - d1);
          by = f;
        }
        if (by < 0) continue;  // from inside
        ++entered;
        EXPECT_NE(std::find(told.begin(), told.end(), by), told.end())
            << "face " << by << " of object " << o;
      }
    }
    EXPECT_GT(entered, 500);
    EXPECT_GT(left_out, 500);
  }
}

// From on and beside a solid all its faces are told.
TEST(FacingFaces, AreAllFromInsideTheBox) {
  const Scene scene(testing::boxes_soup({{{0, 0, 0}, {2, 2, 2}}}));
  const Silhouettes g(scene);
  FacingFaces facing(g);
  for (const Point& p : {Point{1, 1, 2}, Point{2, 2, 2}, Point{1, 1, 1}}) {
    facing.begin(std::span(&p, 1));
    EXPECT_EQ(facing.of(0).size(), 6);
  }
  const Point beside{1, 1, 3};
  facing.begin(std::span(&beside, 1));
  EXPECT_EQ(facing.of(0).size(), 1);
  const std::array<Point, 2> ends{Point{1, 1, 3}, Point{3, 1, 3}};
  facing.begin(ends);
  EXPECT_EQ(facing.of(0).size(), 2);
  // In the plane of the upper face, on neither side of it.
  const Point level{5, 1, 2};
  facing.begin(std::span(&level, 1));
  EXPECT_EQ(facing.of(0).size(), 2);
}

// Of the list and, where it is too long, of the tree: those that a look at all finds.
TEST(BlockerList, TellsAllThatMayBeInTheWay) {
  bool too_many = false;
  std::vector<PolygonSoup> scenes = soups();
  scenes.push_back(testing::triangle_soup(4, 2000));
  for (const PolygonSoup& soup : scenes) {
    const Scene scene(soup);
    const Silhouettes g(scene);
    BlockerList list(g);
    testing::Random random(9);
    std::size_t met = 0;
    for (int trial = 0; trial < 30; ++trial) {
      const Point at = random_point(random, scene);
      const std::array<Point, 2> corners{random_point(random, scene),
                                         random_point(random, scene)};
      const Box group = box_of(corners);
      list.forget();
      EXPECT_FALSE(list.listed());
      list.list({at, at, group}, centre(group) - at);
      EXPECT_TRUE(list.listed());
      too_many |= list.size() > 512;
      Point e0, e1;
      for (int i = 0; i < 3; ++i) {
        e0[i] = random.uniform(group.min[i], group.max[i]);
        e1[i] = random.uniform(group.min[i], group.max[i]);
      }
      const Shaft hull(at, e0, e1);
      std::vector<std::int32_t> told;
      EXPECT_FALSE(list.any_of(hull, [&](std::int32_t blocker) {
        told.push_back(blocker);
        return false;
      }));
      std::vector<std::int32_t> all;
      for (const std::int32_t blocker : g.blockers()) {
        if (hull.may_meet(g.blocker_box(blocker))) all.push_back(blocker);
      }
      std::sort(told.begin(), told.end());
      std::sort(all.begin(), all.end());
      EXPECT_EQ(told, all);
      met += all.size();
      int visits = 0;
      EXPECT_EQ(list.any_of(hull, [&](std::int32_t) { return ++visits == 2; }),
                all.size() >= 2);
      EXPECT_LE(visits, 2);
    }
    EXPECT_GT(met, 30);
  }
  EXPECT_TRUE(too_many);
}

// Every face is of one blocker.
TEST(Blockers, HoldEveryFaceOnce) {
  std::vector<PolygonSoup> scenes = soups();
  scenes.push_back(testing::triangle_soup(4, 50));
  scenes.push_back(
      testing::random_polytopes(2, 5, {.min_vertices = 30, .max_vertices = 40}));
  for (const PolygonSoup& soup : scenes) {
    const Scene scene(soup);
    const Silhouettes g(scene);
    std::vector<int> faces;
    for (const std::int32_t blocker : g.blockers()) {
      if (blocker < 0) {
        faces.push_back(~blocker);
      } else {
        const auto& of_solid = scene.objects()[blocker].faces;
        faces.insert(faces.end(), of_solid.begin(), of_solid.end());
      }
      const Box& box = g.blocker_box(blocker);
      const std::set<int> last(faces.end() - 1, faces.end());
      for (const int f : last) {
        for (const int p : scene.face_points(f)) {
          for (int i = 0; i < 3; ++i) {
            EXPECT_LE(box.min[i], scene.point(p)[i]);
            EXPECT_GE(box.max[i], scene.point(p)[i]);
          }
        }
      }
    }
    std::sort(faces.begin(), faces.end());
    EXPECT_EQ(faces.size(), scene.faces().size());
    EXPECT_EQ(std::adjacent_find(faces.begin(), faces.end()), faces.end());
  }
}

}  // namespace
}  // namespace sightline::internal
