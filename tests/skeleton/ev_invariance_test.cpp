// The EV skeleton does not depend on how its scene is written down: moved to other axes,
// mirrored, scaled by a power of two, or in another order, it is the same in counts and
// incidences.

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "linespace/scene.h"
#include "skeleton/graph.h"
#include "skeleton/request.h"
#include "tests/support/ev_skeleton.h"
#include "tests/support/generators.h"
#include "tests/support/library_skeleton.h"

namespace sightline {
namespace {

using testing::CanonicalSkeleton;
using testing::Random;

/// Coordinate i of an image is sign[i] * 2^exponent times coordinate axis[i].
struct Motion {
  std::array<int, 3> axis = {0, 1, 2};
  std::array<int, 3> sign = {1, 1, 1};
  int exponent = 0;

  [[nodiscard]] Point apply(const Point& p) const {
    Point q;
    for (int i = 0; i < 3; ++i) q[i] = std::ldexp(sign[i] * p[axis[i]], exponent);
    return q;
  }
  [[nodiscard]] Point undo(const Point& q) const {
    Point p;
    for (int i = 0; i < 3; ++i) p[axis[i]] = std::ldexp(sign[i] * q[i], -exponent);
    return p;
  }
  /// Turns inside out what is not turned back.
  [[nodiscard]] bool mirrors() const {
    const bool odd = (axis[1] - axis[0] + 3) % 3 != 1;
    return odd != (sign[0] * sign[1] * sign[2] < 0);
  }
};

PolygonSoup moved(PolygonSoup soup, const Motion& motion) {
  for (Point& p : soup.vertices) p = motion.apply(p);
  if (motion.mirrors()) {
    for (std::vector<int>& face : soup.polygons) std::ranges::reverse(face);
  }
  return soup;
}

/// The same solids: vertices, faces, groups and each face's first corner reordered.
PolygonSoup reordered(const PolygonSoup& soup, std::uint64_t seed) {
  Random random(seed);
  const auto permutation = [&](std::size_t n) {
    std::vector<int> p(n);
    std::iota(p.begin(), p.end(), 0);
    random.shuffle(p);
    return p;
  };
  const std::vector<int> new_vertex = permutation(soup.vertices.size());
  const std::vector<int> new_face = permutation(soup.polygons.size());
  PolygonSoup result;
  result.source = soup.source + ", reordered";
  result.vertices.resize(soup.vertices.size());
  for (std::size_t v = 0; v < soup.vertices.size(); ++v) {
    result.vertices[new_vertex[v]] = soup.vertices[v];
  }
  result.polygons.resize(soup.polygons.size());
  for (std::size_t f = 0; f < soup.polygons.size(); ++f) {
    std::vector<int> face = soup.polygons[f];
    for (int& v : face) v = new_vertex[v];
    std::ranges::rotate(
        face, face.begin() + random.integer(0, static_cast<int>(face.size()) - 1));
    result.polygons[new_face[f]] = std::move(face);
  }
  result.groups = soup.groups;
  for (PolygonSoup::Group& group : result.groups) {
    for (int& f : group.faces) f = new_face[f];
    std::ranges::sort(group.faces);
  }
  random.shuffle(result.groups);
  return result;
}

/// Every quad as two triangles, by the one or the other diagonal.
PolygonSoup triangulated(const PolygonSoup& soup, std::uint64_t seed) {
  Random random(seed);
  PolygonSoup result;
  result.source = soup.source + ", triangulated";
  result.vertices = soup.vertices;
  for (const PolygonSoup::Group& group : soup.groups) {
    PolygonSoup::Group parts{group.name, {}};
    const auto add = [&](std::vector<int> face) {
      parts.faces.push_back(static_cast<int>(result.polygons.size()));
      result.polygons.push_back(std::move(face));
    };
    for (const int f : group.faces) {
      std::vector<int> face = soup.polygons[f];
      if (face.size() != 4) {
        add(std::move(face));
        continue;
      }
      if (random.one_in(2)) std::ranges::rotate(face, face.begin() + 1);
      add({face[0], face[1], face[2]});
      add({face[0], face[2], face[3]});
    }
    result.groups.push_back(std::move(parts));
  }
  return result;
}

CanonicalSkeleton skeleton_of(const PolygonSoup& soup, const Motion& motion = {},
                              int threads = 0) {
  const Scene scene(soup);
  SkeletonRequest request;
  request.threads = threads;
  return testing::canonical(scene, testing::build_ev_skeleton(scene, request),
                            [&](const Point& p) { return motion.undo(p); });
}

void expect_same(const CanonicalSkeleton& expected, const CanonicalSkeleton& actual) {
  EXPECT_EQ(actual.counts(), expected.counts());
  EXPECT_EQ(testing::difference(actual, "the other", expected, "the original", 2), "");
}

/// Scenes of every sort, with their names in `source`.
std::vector<PolygonSoup> scenes() {
  std::vector<PolygonSoup> result = {
      testing::random_polytopes(3, 5, {.density = 0.25}),
      testing::random_parallelepipeds(4, 5, {.density = 0.25}),
      testing::random_boxes(5, 6),
      testing::rotated_boxes(6, 4),
      testing::city(7, 60),
      testing::grid_city(8, 72),
      testing::grid_city(9, 72, {.may_touch = true}),
  };
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    result.push_back(testing::random_boxes(
        seed, 6, {.grid = 5, .may_touch = true, .min_size = 1, .max_size = 3}));
    result.back().source = "grid boxes of seed " + std::to_string(seed);
  }
  for (const testing::Touching kind : testing::all_touching()) {
    result.push_back(testing::touching_boxes(kind));
  }
  return result;
}

TEST(EvInvariance, AxesAndSigns) {
  const std::vector<Motion> motions = {
      {.axis = {1, 2, 0}},                        // turned
      {.axis = {1, 0, 2}},                        // mirrored
      {.axis = {0, 1, 2}, .sign = {-1, 1, 1}},    // mirrored
      {.axis = {0, 1, 2}, .sign = {-1, 1, -1}},   // turned
      {.axis = {2, 1, 0}, .sign = {1, -1, 1}},    // turned
      {.axis = {2, 0, 1}, .sign = {-1, -1, -1}},  // mirrored
  };
  for (const PolygonSoup& soup : scenes()) {
    SCOPED_TRACE(soup.source);
    const CanonicalSkeleton original = skeleton_of(soup);
    EXPECT_FALSE(original.arcs.empty() && original.nodes.empty());
    for (const Motion& motion : motions) {
      SCOPED_TRACE(::testing::Message()
                   << "axes " << motion.axis[0] << motion.axis[1] << motion.axis[2]
                   << " signs " << motion.sign[0] << motion.sign[1] << motion.sign[2]);
      expect_same(original, skeleton_of(moved(soup, motion), motion));
    }
  }
}

TEST(EvInvariance, PowersOfTwo) {
  for (const PolygonSoup& soup : scenes()) {
    SCOPED_TRACE(soup.source);
    const CanonicalSkeleton original = skeleton_of(soup);
    for (const int exponent : {-70, -1, 3, 90}) {
      SCOPED_TRACE(::testing::Message() << "times 2^" << exponent);
      const Motion motion{.exponent = exponent};
      expect_same(original, skeleton_of(moved(soup, motion), motion));
    }
  }
}

TEST(EvInvariance, OrderOfVerticesFacesAndGroups) {
  for (const PolygonSoup& soup : scenes()) {
    SCOPED_TRACE(soup.source);
    const CanonicalSkeleton original = skeleton_of(soup);
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      SCOPED_TRACE(::testing::Message() << "order " << seed);
      expect_same(original, skeleton_of(reordered(soup, seed)));
    }
  }
}

// Rotated quads are no planes in doubles: there the two diagonals bound different solids.
TEST(EvInvariance, QuadsOrTriangles) {
  for (const PolygonSoup& soup : scenes()) {
    if (soup.source.starts_with("rotated")) continue;
    SCOPED_TRACE(soup.source);
    const CanonicalSkeleton original = skeleton_of(soup);
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      SCOPED_TRACE(::testing::Message() << "diagonals " << seed);
      expect_same(original, skeleton_of(triangulated(soup, seed)));
    }
  }
}

TEST(EvInvariance, Threads) {
  for (const PolygonSoup& soup : scenes()) {
    SCOPED_TRACE(soup.source);
    const Scene scene(soup);
    SkeletonRequest one, four;
    one.threads = 1;
    four.threads = 4;
    const Skeleton a = testing::build_ev_skeleton(scene, one),
                   b = testing::build_ev_skeleton(scene, four);
    ASSERT_EQ(a.ev().size(), b.ev().size());
    ASSERT_EQ(a.nodes.size(), b.nodes.size());
    for (std::size_t i = 0; i < a.ev().size(); ++i) {
      ASSERT_EQ(a.ev()[i].generators, b.ev()[i].generators);
      ASSERT_EQ(a.ev()[i].range, b.ev()[i].range);
      ASSERT_EQ(a.ev()[i].nodes, b.ev()[i].nodes);
    }
    for (std::size_t i = 0; i < a.nodes.size(); ++i) {
      ASSERT_EQ(a.nodes[i].kind, b.nodes[i].kind);
      ASSERT_TRUE(std::ranges::equal(a.generators(a.nodes[i]), b.generators(b.nodes[i])));
    }
  }
}

}  // namespace
}  // namespace sightline
