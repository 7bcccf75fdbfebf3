#include "tests/shadows/mesh_proof/small_lit_scenes.h"

#include "tests/support/add_box.h"
#include "tests/support/add_polygons.h"
#include "tests/support/generators.h"

namespace sightline::testing {
namespace {

/// A number between two integers; an integer itself where all is aligned.
struct Numbers {
  Random& random;
  bool aligned;
  double operator()(int low, int high) const {
    // 53 bits would make all numbers of the naive oracle long.
    return aligned ? random.integer(low, high)
                   : random.integer(64 * low, 64 * high) / 64.0;
  }
};

void add_light(ShadowScene& s, const Numbers& number, int kind) {
  const double x = number(-1, 1), y = number(-1, 1), z = number(6, 7);
  const double a = number(1, 2), b = number(1, 2);
  const std::vector<Point> square{
      {x - a, y - b, z}, {x - a, y + b, z}, {x + a, y + b, z}, {x + a, y - b, z}};
  const std::vector<Point> triangle{
      {x, y, number(5, 6)}, {x + 1, y + 2, number(6, 7)}, {x + 2, y, number(6, 7)}};
  s.lights = {"light"};
  if (kind == 0) add_polygons(s.soup, "light", {square});
  if (kind == 1) add_polygons(s.soup, "light", {triangle});
  if (kind != 2) return;
  add_polygons(s.soup, "light", {square});
  std::vector<Point> aside = triangle;
  for (Point& p : aside) p += Point(4, -1, 0);
  add_polygons(s.soup, "second", {aside});
  s.lights.emplace_back("second");
}

void add_tetrahedron(PolygonSoup& soup, const std::string& name, const Numbers& number,
                     const Point& at) {
  const Point a = at, b = at + Point(number(1, 2), number(0, 1), 0);
  const Point c = at + Point(number(0, 1) / 4, number(1, 2), number(0, 1) / 2);
  const Point d = at + Point(0.25, 0.5, number(1, 2));
  add_polygons(soup, name, {{a, c, b}, {a, b, d}, {b, c, d}, {c, a, d}});
}

void add_blocker(PolygonSoup& soup, const std::string& name, const Numbers& number) {
  const double x = number(-3, 2), y = number(-3, 2), z = number(1, 3);
  const double w = number(1, 2), d = number(1, 2);
  switch (number.random.integer(0, 4)) {
    case 0:
      add_polygons(soup, name,
                   {{{x, y, z}, {x + w, y, z}, {x + w, y + d, z}, {x, y + d, z}}});
      break;
    case 1:
      add_polygons(soup, name,
                   {{{x, y, 0}, {x + w, y + d, 0}, {x + w, y + d, z}, {x, y, z}}});
      break;
    case 2:
      add_box(soup, name.c_str(), {x, y, 0}, {x + w, y + d, z});
      break;
    case 3:
      add_tetrahedron(soup, name, number, {x, y, z});
      break;
    default:
      add_polygons(
          soup, name,
          {{{x, y, z}, {x + 2, y, z}, {x + 2, y + 2, z}, {x, y + 2, z}},
           {{x + 0.5, y + 1, z - 1}, {x + 1.5, y + 1, z - 1}, {x + 1, y + 1, z + 1}}});
  }
}

}  // namespace

std::vector<ShadowScene> small_lit_scenes() {
  std::vector<ShadowScene> result;
  for (int i = 0; i < 24; ++i) {
    Random random(static_cast<std::uint64_t>(i) + 1);
    const Numbers number{random, i % 3 == 2};
    ShadowScene scene{"small " + std::to_string(i), {}, {}, {}};
    add_polygons(scene.soup, "ground",
                 {{{-6, -6, 0}, {6, -6, 0}, {6, 6, 0}, {-6, 6, 0}}});
    add_light(scene, number, i % 4 == 3 ? 2 : i % 2);
    for (int k = 0; k < 1 + i % 3; ++k)
      add_blocker(scene.soup, "blocker" + std::to_string(k), number);
    result.push_back(std::move(scene));
  }
  return result;
}

}  // namespace sightline::testing
