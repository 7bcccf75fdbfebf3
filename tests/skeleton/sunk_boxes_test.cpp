// Boxes sunk into a slab make the same union as boxes that stand on it.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "linespace/scene.h"
#include "skeleton/build.h"
#include "tests/support/ev_skeleton.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

// Of an arc: each generator by its points, those of edges with feet at height 0 and in
// order; then where it ends, on its (first) edge, likewise.
using Arc = std::vector<double>;

class ArcWriter {
 public:
  explicit ArcWriter(const Scene& scene) : scene_(scene) {}

  void add_point(const Point& p) { arc_.insert(arc_.end(), p.begin(), p.end()); }
  void add_edge(int edge) {
    auto [e0, e1] = ends_of(edge);
    if (before(e1, e0)) std::swap(e0, e1);
    add_point(e0);
    add_point(e1);
  }
  void add_range(int edge, const std::array<double, 2>& range) {
    const auto& ends = scene_.edges()[edge].points;
    const Point e0 = scene_.point(ends[0]);
    const Point e1 = scene_.point(ends[1]);
    std::array<Point, 2> at{e0 + range[0] * (e1 - e0), e0 + range[1] * (e1 - e0)};
    const auto [f0, f1] = ends_of(edge);
    if (before(f1, f0)) std::swap(at[0], at[1]);
    for (const Point& p : at) add_point(p);
  }
  // All edges' points lie in the plane of the slab's top.
  [[nodiscard]] bool on_the_ground(std::initializer_list<int> edges) const {
    return std::all_of(edges.begin(), edges.end(), [&](int edge) {
      const auto [e0, e1] = ends_of(edge);
      return e0[2] == 0 && e1[2] == 0;
    });
  }
  [[nodiscard]] Arc take() { return std::exchange(arc_, {}); }

 private:
  [[nodiscard]] std::array<Point, 2> ends_of(int edge) const {
    std::array<Point, 2> ends;
    for (int k = 0; k < 2; ++k) {
      ends[k] = scene_.point(scene_.edges()[edge].points[k]);
      if (ends[k][2] == -1) ends[k][2] = 0;
    }
    return ends;
  }
  static bool before(const Point& p, const Point& q) {
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  }

  const Scene& scene_;
  Arc arc_;
};

// EV arcs, sorted, but for those whose lines lie in the plane of the slab's top.
std::vector<Arc> ev_arcs_off_the_ground(const PolygonSoup& soup) {
  const Scene scene(soup);
  ArcWriter writer(scene);
  std::vector<Arc> arcs;
  for (const SkeletonArc& a : testing::build_ev_skeleton(scene).arcs) {
    if (scene.point(a.vertex())[2] == 0 && writer.on_the_ground({a.edge()})) continue;
    writer.add_point(scene.point(a.vertex()));
    writer.add_edge(a.edge());
    writer.add_range(a.edge(), a.range);
    arcs.push_back(writer.take());
  }
  std::sort(arcs.begin(), arcs.end());
  return arcs;
}

// The same for EEE arcs.
std::vector<Arc> eee_arcs_off_the_ground(const PolygonSoup& soup) {
  const Scene scene(soup);
  ArcWriter writer(scene);
  const Skeleton skeleton = build_skeleton(scene, {});
  std::vector<Arc> arcs;
  for (const SkeletonArc& a : skeleton.eee()) {
    if (writer.on_the_ground({a.edges()[0], a.edges()[1], a.edges()[2]})) continue;
    for (const int edge : a.edges()) writer.add_edge(edge);
    writer.add_range(a.edges()[0], a.range);
    arcs.push_back(writer.take());
  }
  std::sort(arcs.begin(), arcs.end());
  return arcs;
}

void expect_same(const std::vector<Arc>& standing, const std::vector<Arc>& sunk,
                 const std::string& where) {
  ASSERT_EQ(standing.size(), sunk.size()) << where;
  for (std::size_t i = 0; i < sunk.size(); ++i) {
    for (std::size_t k = 0; k < sunk[i].size(); ++k) {
      // Parameters are off by kRangeError at most, coordinates are below 64.
      ASSERT_NEAR(standing[i][k], sunk[i][k], 64 * 2 * kRangeError) << where;
    }
  }
}

TEST(SunkBoxes, HaveTheArcsOfStandingOnesOffTheGround) {
  for (const bool square : {false, true}) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      const auto city = [&](double bottom) {
        return testing::street_city(seed, 60, {.square = square, .bottom = bottom});
      };
      const std::string where =
          (square ? "square, seed " : "street, seed ") + std::to_string(seed);
      const std::vector<Arc> standing = ev_arcs_off_the_ground(city(0));
      EXPECT_GT(standing.size(), 500u);
      expect_same(standing, ev_arcs_off_the_ground(city(-1)), where + ", EV");
      const std::vector<Arc> eee = eee_arcs_off_the_ground(city(0));
      EXPECT_GT(eee.size(), 300u);
      expect_same(eee, eee_arcs_off_the_ground(city(-1)), where + ", EEE");
    }
  }
}

}  // namespace
}  // namespace sightline
