// SolidIndex against a naive oracle: winding numbers along random rays in rational
// arithmetic.

#include "linespace/scene/solid_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/exact.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

using internal::SolidIndex;
using testing::dot;
using testing::exact;
using testing::Random;
using testing::Rational;
using testing::sgn;
using testing::Vec3;

// How the ray from p in that direction passes a face: 1 from its back to its front, -1
// the other way, 0 not at all; nullopt when it meets a side or runs in the plane, and the
// direction has to be replaced.
std::optional<int> passes(const std::vector<Vec3>& face, const Vec3& p,
                          const Vec3& direction) {
  const Vec3 normal = cross(face[1] - face[0], face[2] - face[0]);
  const Rational slope = dot(normal, direction);
  if (sgn(slope) == 0) return std::nullopt;
  const Rational t = dot(normal, face[0] - p) / slope;
  if (t < 0) return 0;
  const Vec3 hit = p + t * direction;
  bool on_side = false;
  for (std::size_t k = 0; k < face.size(); ++k) {
    const Vec3 along = face[(k + 1) % face.size()] - face[k];
    const int s = sgn(dot(normal, cross(along, hit - face[k])));
    if (s < 0) return 0;
    on_side = on_side || s == 0;
  }
  if (on_side) return std::nullopt;
  return sgn(slope);
}

bool is_on(const std::vector<Vec3>& face, const Vec3& p) {
  const Vec3 normal = cross(face[1] - face[0], face[2] - face[0]);
  if (sgn(dot(normal, p - face[0])) != 0) return false;
  for (std::size_t k = 0; k < face.size(); ++k) {
    const Vec3 along = face[(k + 1) % face.size()] - face[k];
    if (sgn(dot(normal, cross(along, p - face[k]))) < 0) return false;
  }
  return true;
}

// With the fronts that the file gives; or of the faces with material behind them alone.
std::optional<int> naive_winding(const Scene& scene, int object, const Point& at,
                                 Random& random, bool solid_only = false) {
  const Vec3 p = exact(at);
  std::vector<std::vector<Vec3>> faces;
  for (const int f : scene.objects()[object].faces) {
    faces.emplace_back();
    for (const int id : scene.face_points(f)) {
      faces.back().push_back(exact(scene.point(id)));
    }
    if (is_on(faces.back(), p)) return std::nullopt;
    if (!scene.turned(f)) continue;
    std::reverse(faces.back().begin(), faces.back().end());
    if (solid_only) faces.pop_back();
  }
  for (;;) {
    const Vec3 direction{random.integer(-999, 999), random.integer(-999, 999),
                         random.integer(-999, 999)};
    int count = 0;
    bool general = true;
    for (std::size_t f = 0; f < faces.size() && general; ++f) {
      const auto turns = passes(faces[f], p, direction);
      general = turns.has_value();
      if (general) count += *turns;
    }
    if (general) return count;
  }
}

// A soup to which closed surfaces are added, all in integer coordinates before `map`.
struct Builder {
  PolygonSoup soup;
  Random& random;
  Eigen::Matrix3d map = Eigen::Matrix3d::Identity();

  int vertex(double x, double y, double z) {
    soup.vertices.push_back(map * Point(x, y, z));
    return static_cast<int>(soup.vertices.size()) - 1;
  }
  void group(const std::string& name, std::size_t first_face) {
    soup.groups.push_back({name, {}});
    for (std::size_t f = first_face; f < soup.polygons.size(); ++f) {
      soup.groups.back().faces.push_back(static_cast<int>(f));
    }
  }
  // A box whose sides are cut into parts x parts quads; turned inside out on demand.
  void box(const std::array<int, 3>& low, const std::array<int, 3>& high, int parts,
           bool inside_out) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int end = 0; end < 2; ++end) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const auto at = [&](int i, int j) {
          std::array<double, 3> p{};
          p[axis] = end == 0 ? low[axis] : high[axis];
          p[u] = low[u] + static_cast<double>((high[u] - low[u]) * i) / parts;
          p[v] = low[v] + static_cast<double>((high[v] - low[v]) * j) / parts;
          return vertex(p[0], p[1], p[2]);
        };
        for (int i = 0; i < parts; ++i) {
          for (int j = 0; j < parts; ++j) {
            std::vector<int> quad{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
            if ((end == 0) != inside_out) std::swap(quad[1], quad[3]);
            soup.polygons.push_back(quad);
          }
        }
      }
    }
  }
  // A prism over an L, or over a star-shaped outline: not convex.
  void prism(int x, int y, int z, int height, bool inside_out) {
    const std::vector<std::array<int, 2>> outline{{0, 0}, {4, 0}, {4, 1},
                                                  {1, 1}, {1, 3}, {0, 3}};
    std::vector<int> floor, roof;
    for (const auto& p : outline) {
      floor.push_back(vertex(x + p[0], y + p[1], z));
      roof.push_back(vertex(x + p[0], y + p[1], z + height));
    }
    const auto add = [&](std::vector<int> ring) {
      if (inside_out) std::reverse(ring.begin(), ring.end());
      soup.polygons.push_back(std::move(ring));
    };
    add(roof);
    add({floor.rbegin(), floor.rend()});
    for (std::size_t k = 0; k < floor.size(); ++k) {
      const std::size_t next = (k + 1) % floor.size();
      add({floor[k], floor[next], roof[next], roof[k]});
    }
  }
};

std::array<int, 3> corner(Random& random, int low, int high) {
  return {random.integer(low, high), random.integer(low, high),
          random.integer(low, high)};
}

// Boxes and prisms on a coarse grid: nested, overlapping, touching, flush; some turned
// inside out, some of two surfaces, some with many faces; the whole perhaps sheared or
// scaled by a map that keeps it exact, or turned so that nothing stays on a grid.
PolygonSoup seeded_soup(Random& random) {
  Builder b{{}, random};
  switch (random.integer(0, 3)) {
    case 0:
      b.map << 1, 2, 0, 0, 1, 1, 1, 0, 1;  // sheared
      break;
    case 1:
      b.map *= std::ldexp(1, random.integer(-60, 60));
      break;
    case 2:
      b.map << 0.36, 0.48, -0.8, -0.8, 0.6, 0, 0.48, 0.64, 0.6;  // turned, rounded
      break;
    default:
      break;
  }
  const int objects = random.integer(2, 6);
  for (int o = 0; o < objects; ++o) {
    const std::size_t first = b.soup.polygons.size();
    const int surfaces = random.one_in(3) ? 2 : 1;
    for (int s = 0; s < surfaces; ++s) {
      const bool inside_out = random.one_in(4);
      if (random.one_in(3)) {
        b.prism(random.integer(0, 3), random.integer(0, 3), random.integer(0, 3),
                random.integer(1, 4), inside_out);
        continue;
      }
      const auto low = corner(random, 0, 4);
      auto high = corner(random, 1, 4);
      for (int k = 0; k < 3; ++k) high[k] += low[k];
      b.box(low, high, random.one_in(3) ? 4 : 1, inside_out);
    }
    b.group("object" + std::to_string(o), first);
  }
  return std::move(b.soup);
}

// All corners, middles of sides and of faces, and points between any two of these.
std::vector<Point> asked_points(const Scene& scene, Random& random) {
  std::vector<Point> points(scene.points().begin(), scene.points().end());
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    const auto ids = scene.face_points(static_cast<int>(f));
    points.emplace_back(0.5 * (scene.point(ids[0]) + scene.point(ids[1])));
    points.emplace_back(0.5 * (scene.point(ids[0]) + scene.point(ids[2])));
  }
  const int known = static_cast<int>(points.size()) - 1;
  for (int i = 0; i < 60; ++i) {
    points.emplace_back(
        0.5 * (points[random.integer(0, known)] + points[random.integer(0, known)]));
  }
  random.shuffle(points);
  points.resize(std::min<std::size_t>(points.size(), 40));
  return points;
}

TEST(SolidIndex, WindsAsTheNaiveOracleOnSeededScenes) {
  int on_surface = 0, inside = 0, outside = 0, in_air = 0;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    Random random(seed);
    const Scene scene(seeded_soup(random));
    const SolidIndex index(scene);
    for (const Point& p : asked_points(scene, random)) {
      bool in_solid = false;
      for (std::size_t o = 0; o < scene.objects().size(); ++o) {
        if (!scene.objects()[o].closed) continue;
        const auto want = naive_winding(scene, static_cast<int>(o), p, random);
        ASSERT_EQ(index.winding(static_cast<int>(o), p), want)
            << "seed " << seed << ", object " << o << ", at " << p.transpose();
        in_solid =
            in_solid ||
            naive_winding(scene, static_cast<int>(o), p, random, true).value_or(0) > 0;
        (!want ? on_surface : *want > 0 ? inside : *want < 0 ? in_air : outside)++;
      }
      ASSERT_EQ(index.in_solid(p), in_solid) << "seed " << seed;
    }
  }
  // The scenes reach every outcome often.
  EXPECT_GT(on_surface, 50);
  EXPECT_GT(inside, 50);
  EXPECT_GT(outside, 50);
  EXPECT_GT(in_air, 20);
}

TEST(SolidIndex, HoldsWhatLiesInABoxButNotWhatTouchesIt) {
  const Scene scene(
      testing::boxes_soup({{{0, 0, 0}, {4, 4, 4}}, {{4, 1, 1}, {5, 2, 2}}}));
  const SolidIndex index(scene);
  EXPECT_TRUE(index.in_solid({1, 1, 1}));
  EXPECT_TRUE(index.in_solid({3.9999999999999996, 2, 2}));
  EXPECT_FALSE(index.in_solid({4, 2, 2}));      // on a side
  EXPECT_FALSE(index.in_solid({4, 1.5, 1.5}));  // on both boxes, where they touch
  EXPECT_FALSE(index.in_solid({4, 4, 1}));      // on an edge
  EXPECT_FALSE(index.in_solid({0, 0, 0}));      // in a corner
  EXPECT_FALSE(index.in_solid({5, 5, 5}));
}

}  // namespace
}  // namespace sightline
