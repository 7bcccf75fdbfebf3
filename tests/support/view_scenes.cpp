#include "tests/support/view_scenes.h"

#include <array>
#include <cmath>

#include "tests/support/add_box.h"
#include "tests/support/add_polygons.h"
#include "tests/support/generators.h"
#include "tests/support/invariant_scenes.h"

namespace sightline::testing {
namespace {

/// A box whose fronts are inside.
void add_room(PolygonSoup& soup, const char* name, const Point& low, const Point& high) {
  const std::size_t first = soup.polygons.size();
  add_box(soup, name, low, high);
  for (std::size_t f = first; f < soup.polygons.size(); ++f) {
    std::swap(soup.polygons[f][1], soup.polygons[f][3]);
  }
}

/// A room of 8 x 6 x 4 with boxes on its floor and against its walls, and a table.
PolygonSoup room(std::uint64_t seed) {
  Random random(seed);
  PolygonSoup soup;
  add_room(soup, "room", {0, 0, 0}, {8, 6, 4});
  for (int i = 0; i < 2 + static_cast<int>(seed % 4); ++i) {
    const double x = 2 * i, y = random.one_in(2) ? 0 : random.integer(1, 4);
    const double z = random.one_in(3) ? random.integer(1, 2) : 0;
    add_box(
        soup, ("box" + std::to_string(i)).c_str(), {x, y, z},
        {x + random.integer(1, 2), y + random.integer(1, 2), z + random.integer(1, 2)});
  }
  if (random.one_in(2)) {
    add_polygons(soup, "picture", {{{8, 1, 1}, {8, 5, 1}, {8, 5, 3}, {8, 1, 3}}});
  }
  return soup;
}

/// A house of two rooms side by side, each an inner shell of its own, with a box in each;
/// some rooms share a wall without thickness.
PolygonSoup house(std::uint64_t seed) {
  Random random(seed);
  PolygonSoup soup;
  const double wall = random.integer(0, 1);
  add_box(soup, "house", {-1, -1, -1}, {9, 5, 4});
  add_room(soup, "left", {0, 0, 0}, {4 - wall, 4, 3});
  add_room(soup, "right", {4, 0, 0}, {8, 4, 3});
  for (int i = 0; i < 2; ++i) {
    const double x = 4 * i + random.integer(0, 1), y = random.integer(0, 2);
    add_box(soup, ("box" + std::to_string(i)).c_str(), {x, y, 0},
            {x + 1, y + 2, random.integer(1, 3) * 1.0});
  }
  return soup;
}

/// Upright and level rectangles and slanted triangles, which cross, on small integers.
PolygonSoup sheets(std::uint64_t seed) {
  Random random(seed);
  PolygonSoup soup;
  const auto coordinate = [&] { return static_cast<double>(random.integer(0, 5)); };
  for (int i = 0; i < 10 + static_cast<int>(seed % 6); ++i) {
    const int axis = random.integer(0, 3);
    const Point low(coordinate(), coordinate(), coordinate());
    std::vector<Point> polygon;
    if (axis < 3) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      polygon.assign(4, low);
      const double width = random.integer(1, 3), height = random.integer(1, 3);
      polygon[1][u] += width;
      polygon[2][u] += width;
      polygon[2][v] += height;
      polygon[3][v] += height;
    } else {
      Point a, b;
      do {
        a = Point(coordinate(), coordinate(), coordinate());
        b = Point(coordinate(), coordinate(), coordinate());
      } while ((a - low).cross(b - low).isZero());
      polygon = {low, a, b};
    }
    add_polygons(soup, "sheet" + std::to_string(i), {polygon});
  }
  return soup;
}

/// Frames of four planks, flat sheets with a hole or boxes with a shaft, in front of
/// boxes.
PolygonSoup frames(std::uint64_t seed) {
  Random random(seed);
  PolygonSoup soup;
  for (int i = 0; i < 2; ++i) {
    const double z = 3 * i + random.integer(0, 1);
    const double x = random.integer(-1, 1), y = random.integer(-1, 1);
    const auto point = [&](double u, double v) { return Point(x + u, y + v, z); };
    add_polygons(soup, "frame" + std::to_string(i),
                 {{point(0, 0), point(4, 0), point(3, 1), point(1, 1)},
                  {point(4, 0), point(4, 4), point(3, 3), point(3, 1)},
                  {point(4, 4), point(0, 4), point(1, 3), point(3, 3)},
                  {point(0, 4), point(0, 0), point(1, 1), point(1, 3)}});
  }
  for (int i = 0; i < 1 + static_cast<int>(seed % 3); ++i) {
    const Point low(random.integer(0, 3), random.integer(0, 3), -2 - 3 * i);
    add_box(soup, ("box" + std::to_string(i)).c_str(), low,
            low + Point(random.integer(1, 3), random.integer(1, 3), 1));
  }
  return soup;
}

/// Boxes of one footprint on one another and beside each other, and sheets on their
/// sides, some of them twice.
PolygonSoup stacks(std::uint64_t seed) {
  Random random(seed);
  PolygonSoup soup;
  double z = 0;
  for (int i = 0; i < 2 + static_cast<int>(seed % 3); ++i) {
    const double height = random.integer(1, 2);
    const double inset = random.one_in(3) ? 1 : 0;
    add_box(soup, ("box" + std::to_string(i)).c_str(), {inset, inset, z},
            {4 - inset, 4, z + height});
    z += height;
  }
  add_box(soup, "beside", {4, 0, 0}, {5, 4, random.integer(1, 4) * 1.0});
  for (int i = 0; i < 3; ++i) {
    const double x = random.integer(0, 2), w = random.integer(1, 2);
    const double y = random.one_in(2) ? 4 : 5;
    add_polygons(soup, "sheet" + std::to_string(i),
                 {{{x, y, 0}, {x, y, 2}, {x + w, y, 2}, {x + w, y, 0}}});
  }
  return soup;
}

using Numbers = std::array<Rational, 2>;

Rational fraction(Random& random, int low, int high) {
  const int below = random.integer(1, 7);
  return Rational(random.integer(low * below, high * below), below);
}

/// Anywhere: doubles, integers or fractions in the scene's box and around it.
Vec3 anywhere(Random& random, const Scene& scene) {
  const int way = random.integer(0, 2);
  Vec3 result;
  const double far = random.one_in(12) ? 0x1p40 : 1;
  for (int i = 0; i < 3; ++i) {
    const double low = scene.bounds()[0][i], high = scene.bounds()[1][i];
    const double margin = far * (high - low + 1);
    const double x = random.uniform(low - margin, high + margin);
    if (way == 0) result[i] = Rational(x);
    if (way == 1) result[i] = Rational(std::round(x));
    if (way == 2) result[i] = Rational(static_cast<long>(std::round(x * 21)), 21);
  }
  return result;
}

Vec3 some_direction(Random& random) {
  const int way = random.integer(0, 2);
  Vec3 result{};
  while (is_zero(result)) {
    for (Rational& x : result) {
      x = way == 0 ? Rational(random.uniform(-1, 1)) : Rational(random.integer(-3, 3));
    }
    if (way == 2) result[random.integer(0, 2)] += fraction(random, -2, 2);
  }
  return result;
}

/// A corner of a face and the ways to two others.
std::array<Vec3, 3> some_face(Random& random, const Scene& scene) {
  const int f = random.integer(0, static_cast<int>(scene.faces().size()) - 1);
  const auto corners = scene.face_points(f);
  const int n = static_cast<int>(corners.size());
  const int k = random.integer(0, n - 1);
  const Vec3 a = exact(scene.point(corners[k]));
  return {a, exact(scene.point(corners[(k + 1) % n])) - a,
          exact(scene.point(corners[(k + 2) % n])) - a};
}

std::array<Vec3, 2> some_edge(Random& random, const Scene& scene) {
  const int e = random.integer(0, static_cast<int>(scene.edges().size()) - 1);
  const auto& ends = scene.edges()[e].points;
  return {exact(scene.point(ends[0])), exact(scene.point(ends[1]))};
}

Vec3 special_point(Random& random, const Scene& scene, bool on) {
  if (random.one_in(2)) {
    const auto [a, u, v] = some_face(random, scene);
    if (on) {
      // Of the triangle to two corners in a row.
      const Rational s(random.integer(1, 6), 7), t(random.integer(1, 6), 7);
      return a + Rational(s * (1 - t)) * u + Rational(s * t) * v;
    }
    return a + fraction(random, -3, 3) * u + fraction(random, -3, 3) * v;
  }
  const auto [a, b] = some_edge(random, scene);
  if (on && random.one_in(2)) return a;
  const Rational s = on ? Rational(random.integer(1, 5), 6) : fraction(random, -3, 4);
  return a + s * (b - a);
}

Vec3 special_direction(Random& random, const Scene& scene, bool along) {
  Vec3 result{};
  while (is_zero(result)) {
    const auto [a, u, v] = some_face(random, scene);
    const auto [from, to] = some_edge(random, scene);
    if (along) {
      result = random.one_in(2) ? to - from : cross(u, v);
    } else {
      result = fraction(random, -3, 3) * u + fraction(random, -3, 3) * v;
    }
    if (random.one_in(8)) result[random.integer(0, 2)] += Rational(0x1p-60);
  }
  return result;
}

}  // namespace

std::vector<ViewScene> view_scenes() {
  std::vector<ViewScene> result;
  const auto add = [&](const std::string& name, PolygonSoup soup) {
    result.push_back({name, std::move(soup)});
  };
  const auto add_seeds = [&](const std::string& name, int count, auto&& make) {
    for (int seed = 1; seed <= count; ++seed) {
      add(name + " " + std::to_string(seed), make(static_cast<std::uint64_t>(seed)));
    }
  };
  add_seeds("polytopes", 6, [](std::uint64_t s) {
    return random_polytopes(s, 2 + s % 4, {.max_vertices = 8, .density = 0.3});
  });
  add_seeds("parallelepipeds", 6, [](std::uint64_t s) {
    return random_parallelepipeds(s, 3 + s % 6, {.density = 0.25});
  });
  add_seeds("boxes", 4, [](std::uint64_t s) { return random_boxes(s, 3 + s % 8); });
  add_seeds("grid", 10, [](std::uint64_t s) {
    return random_boxes(s, 3 + s % 8,
                        {.grid = 5, .may_touch = true, .min_size = 1, .max_size = 3});
  });
  for (const Touching kind : all_touching()) {
    add("touching " + sightline::testing::name(kind), touching_boxes(kind));
  }
  add_seeds("room", 8, room);
  add_seeds("sheets", 8, sheets);
  add_seeds("frames", 6, frames);
  add_seeds("stacks", 6, stacks);
  add_seeds("city", 3,
            [](std::uint64_t s) { return grid_city(s, 30, {.may_touch = true}); });
  add_seeds("triangles", 4,
            [](std::uint64_t s) { return cut_into_triangles(stacks(s + 10)); });
  add_seeds("triangle soup", 2, [](std::uint64_t s) { return triangle_soup(s, 20); });
  for (const Crowd crowd :
       {Crowd::Overlapping, Crowd::Touching, Crowd::RepeatedFaces, Crowd::NonManifold}) {
    add_seeds(sightline::testing::name(crowd), 4,
              [&](std::uint64_t s) { return crowded_scene(crowd, s); });
  }
  add_seeds("house", 4, house);
  add_seeds("room of triangles", 2,
            [](std::uint64_t s) { return cut_into_triangles(room(s + 20)); });
  add_seeds("larger city", 2, [](std::uint64_t s) { return grid_city(s, 96); });
  add_seeds("larger crowd", 2, [](std::uint64_t s) { return random_boxes(s, 16); });
  return result;
}

std::vector<ViewScene> large_view_scenes() {
  return {{"large grid city", grid_city(1, 252, {.may_touch = true})},
          {"large city", city(2, 240)},
          {"large crowd", random_boxes(3, 36)},
          {"large crowd of triangles", cut_into_triangles(random_boxes(4, 20))},
          {"large triangle soup", triangle_soup(5, 200)}};
}

std::vector<NaiveEye> view_eyes(const Scene& scene, std::uint64_t seed, int count) {
  Random random(seed);
  std::vector<NaiveEye> result;
  for (int i = 0; i < count; ++i) {
    const bool direction = random.one_in(3);
    const int third = i % 3;
    Vec3 at;
    if (direction) {
      at = third == 0 ? some_direction(random)
                      : special_direction(random, scene, third == 2);
    } else {
      at =
          third == 0 ? anywhere(random, scene) : special_point(random, scene, third == 2);
      if (third != 0 && random.one_in(8)) {
        // Not quite there.
        for (Rational& x : at) x += Rational(random.integer(-9, 9) * 0x1p-60);
      }
    }
    result.push_back({direction ? Viewpoint::Kind::Direction : Viewpoint::Kind::Eye, at});
  }
  return result;
}

std::vector<NaiveEye> eyes_barely_off(const Scene& scene, std::uint64_t seed, int count) {
  Random random(seed);
  const std::vector<NaiveEye> eyes = view_eyes(scene, seed, 2 * count + 3);
  std::vector<NaiveEye> result;
  for (std::size_t i = 0; static_cast<int>(result.size()) < count; ++i) {
    if (i % 3 == 0) continue;  // anywhere
    NaiveEye eye = eyes[i];
    Rational unit = 1;
    for (int bits = random.integer(40, 80); bits > 0; --bits) unit /= 2;
    const int only = random.integer(-3, 2);  // one coordinate, or all
    for (int axis = 0; axis < 3; ++axis) {
      if (only < 0 || only == axis) eye.at[axis] += random.integer(-9, 9) * unit;
    }
    result.push_back(std::move(eye));
  }
  return result;
}

}  // namespace sightline::testing
