// Points for shadow_scenes.h.

#include <algorithm>
#include <array>

#include "tests/support/generators.h"
#include "tests/support/shadow_scenes.h"

namespace sightline::testing {
namespace {

Vec3 some_corner(Random& random, const Scene& scene) {
  return exact(
      scene.point(random.integer(0, static_cast<int>(scene.points().size()) - 1)));
}

int some_face(Random& random, const Scene& scene) {
  return random.integer(0, static_cast<int>(scene.faces().size()) - 1);
}

std::array<Vec3, 2> some_side(Random& random, const Scene& scene) {
  const auto corners = scene.face_points(some_face(random, scene));
  const int n = static_cast<int>(corners.size()), k = random.integer(0, n - 1);
  return {exact(scene.point(corners[k])), exact(scene.point(corners[(k + 1) % n]))};
}

Vec3 on(const std::array<Vec3, 2>& line, const Rational& at) {
  return line[0] + at * (line[1] - line[0]);
}

/// Inside a side: its middle, thirds and so on.
Vec3 some_side_point(Random& random, const Scene& scene) {
  return on(some_side(random, scene), Rational(random.integer(1, 5), 6));
}

Vec3 face_normal(const Scene& scene, int f) {
  const auto corners = scene.face_points(f);
  const Vec3 a = exact(scene.point(corners[0])), b = exact(scene.point(corners[1])),
             c = exact(scene.point(corners[2]));
  return cross(b - a, c - a);
}

/// On the line through two points, mostly beyond the second.
Vec3 beyond(Random& random, const Vec3& a, const Vec3& b) {
  return on({a, b}, Rational(random.integer(3, 24), 8));
}

/// A point of the line through an edge's point and two further edges, beyond them.
std::optional<Vec3> through_three_edges(Random& random, const Scene& scene) {
  const Vec3 p = some_side_point(random, scene);
  const auto second = some_side(random, scene), third = some_side(random, scene);
  const Vec3 u = cross(second[0] - p, second[1] - p);
  const Vec3 v = cross(third[0] - p, third[1] - p);
  const Vec3 along = cross(u, v);
  if (is_zero(along)) return std::nullopt;
  // Where the line meets the third edge: in the plane through it across the line.
  const Vec3 normal = cross(third[1] - third[0], v);
  const Rational slope = dot(normal, along);
  if (slope.sign() == 0) return std::nullopt;
  const Vec3 meets = p + Rational(dot(normal, third[0] - p) / slope) * along;
  return beyond(random, p, meets);
}

Vec3 on_some_face(Random& random, int f, const Scene& scene) {
  const auto corners = scene.face_points(f);
  const int k = random.integer(1, static_cast<int>(corners.size()) - 2);
  const Vec3 a = exact(scene.point(corners[0])), b = exact(scene.point(corners[k])),
             c = exact(scene.point(corners[k + 1]));
  const Rational s(random.integer(1, 6), 7), t(random.integer(1, 6), 7);
  return a + Rational(s * (1 - t)) * (b - a) + Rational(s * t) * (c - a);
}

/// In the plane of the face, anywhere.
Vec3 in_plane(Random& random, int f, const Scene& scene) {
  const auto corners = scene.face_points(f);
  const Vec3 a = exact(scene.point(corners[0])), b = exact(scene.point(corners[1])),
             c = exact(scene.point(corners[2]));
  return a + Rational(random.integer(-16, 16), 8) * (b - a) +
         Rational(random.integer(-16, 16), 8) * (c - a);
}

Vec3 small_integers(Random& random, const Scene& scene) {
  Vec3 result;
  for (int i = 0; i < 3; ++i) {
    result[i] = Rational(random.integer(static_cast<int>(scene.bounds()[0][i]) - 1,
                                        static_cast<int>(scene.bounds()[1][i]) + 1));
  }
  return result;
}

Vec3 event_point(Random& random, const Scene& scene) {
  switch (random.integer(0, 7)) {
    case 0:
      return small_integers(random, scene);
    case 1:  // EV, also under seams and T-junctions
      return beyond(random, some_corner(random, scene), some_side_point(random, scene));
    case 2:
      return beyond(random, some_side_point(random, scene), some_corner(random, scene));
    case 3:  // in the plane of a face
      return in_plane(random, some_face(random, scene), scene);
    case 4:
      return on_some_face(random, some_face(random, scene), scene);
    case 5:  // at feet
      return random.one_in(2) ? some_corner(random, scene)
                              : some_side_point(random, scene);
    case 6:
      return beyond(random, some_corner(random, scene), some_corner(random, scene));
    default:
      for (int i = 0; i < 20; ++i) {
        if (const auto p = through_three_edges(random, scene)) return *p;
      }
      return small_integers(random, scene);
  }
}

}  // namespace

std::vector<AskedPoint> random_asked_points(const Scene& scene, std::uint64_t seed,
                                            int count) {
  Random random(seed);
  std::vector<AskedPoint> result;
  for (int i = 0; i < count; ++i) {
    if (i % 2 == 0) {
      Point p;
      for (int k = 0; k < 3; ++k) {
        p[k] = random.uniform(scene.bounds()[0][k] - 0.5, scene.bounds()[1][k] + 0.5);
      }
      const Point n = random.direction();
      result.push_back(
          {exact(p), random.one_in(4) ? std::nullopt : std::optional(exact(n))});
      continue;
    }
    const int f = some_face(random, scene);
    const auto corners = scene.face_points(f);
    const int k = random.integer(1, static_cast<int>(corners.size()) - 2);
    const double s = random.uniform(), t = random.uniform();
    const Point &a = scene.point(corners[0]), &b = scene.point(corners[k]),
                &c = scene.point(corners[k + 1]);
    const Point p = a + s * ((1 - t) * (b - a) + t * (c - a));
    const Vec3 n = face_normal(scene, f);
    result.push_back({exact(p), scene.turned(f) ? Rational(-1) * n : n});
  }
  return result;
}

std::vector<AskedPoint> event_asked_points(const Scene& scene, std::uint64_t seed,
                                           int count) {
  Random random(seed);
  std::vector<AskedPoint> result;
  for (int i = 0; i < count; ++i) {
    AskedPoint point{event_point(random, scene), std::nullopt};
    if (random.one_in(10)) {
      for (Rational& x : point.at) x += Rational(random.integer(-9, 9) * 0x1p-60);
    }
    if (!random.one_in(4)) {
      // Of some face, so that horizons pass edges; or small integers.
      point.normal = face_normal(scene, some_face(random, scene));
      if (random.one_in(2)) point.normal = Rational(-1) * *point.normal;
      if (random.one_in(4)) {
        point.normal =
            Vec3{Rational(random.integer(-2, 2)), Rational(random.integer(-2, 2)),
                 Rational(random.integer(1, 3))};
      }
    }
    result.push_back(std::move(point));
  }
  return result;
}

}  // namespace sightline::testing
