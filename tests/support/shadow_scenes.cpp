#include "tests/support/shadow_scenes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>

#include "tests/support/add_box.h"
#include "tests/support/add_polygons.h"
#include "tests/support/generators.h"
#include "tests/support/view_scenes.h"

namespace sightline::testing {
namespace {

using Polygon = std::vector<Point>;

/// The box of a soup, its coordinates rounded outwards to integers.
std::array<Point, 2> box_of(const PolygonSoup& soup) {
  Point low = soup.vertices[0], high = low;
  for (const Point& p : soup.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return {Point(low.array().floor()), Point(high.array().ceil())};
}

/// Level, with its front below.
Polygon level(double x0, double y0, double x1, double y1, double z) {
  return {{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}};
}

std::string range(std::size_t first, std::size_t last) {
  return "#" + std::to_string(first) + "-" + std::to_string(last);
}

/// A place for lights over a scene.
struct Place {
  Random& random;
  double x0, y0, x1, y1, z;  ///< over its box, in integers; the light is about at z
  [[nodiscard]] double dx() const { return x1 - x0; }
  [[nodiscard]] double dy() const { return y1 - y0; }
};

using AddLight = void (*)(ShadowScene&, const Place&);

void light_in_air(ShadowScene& s, const Place& p) {
  Polygon light;
  const double x = p.x0 + 0.3 * p.dx(), y = p.y0 + 0.3 * p.dy();
  for (const auto& [u, v] : {std::array{0.0, 0.0}, {0.0, 0.5}, {0.4, 0.0}}) {
    light.emplace_back(x + u * p.dx(), y + v * p.dy(), p.z + p.random.uniform(-0.5, 0.5));
  }
  add_polygons(s.soup, "light", {light});
  s.lights = {"light"};
}

void level_light(ShadowScene& s, const Place& p) {
  add_polygons(s.soup, "light", {level(p.x0 + 1, p.y0, p.x0 + 3, p.y0 + 2, p.z)});
  s.lights = {"light"};
}

/// Nine polygons of a ceiling, one or two of which shine.
void light_flush_with_ceiling(ShadowScene& s, const Place& p) {
  const std::size_t first = s.soup.polygons.size();
  std::vector<Polygon> ceiling;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      ceiling.push_back(level(p.x0 + i * p.dx(), p.y0 + j * p.dy(),
                              p.x0 + (i + 1) * p.dx(), p.y0 + (j + 1) * p.dy(), p.z));
    }
  }
  for (Polygon& polygon : ceiling) {
    for (Point& corner : polygon) corner -= Point(p.dx(), p.dy(), 0);
  }
  add_polygons(s.soup, "ceiling", ceiling);
  s.lights = {range(first + 4, first + 4 + p.random.integer(0, 1))};
}

/// A ceiling with a hole, in which a light of its own lies.
void light_let_in(ShadowScene& s, const Place& p) {
  const double x = p.x0 + 1, y = p.y0 + 1, w = 2, far = 2 + p.dx();
  std::vector<Polygon> ceiling{level(x - far, y - far, x + w + far, y, p.z),
                               level(x - far, y, x, y + w, p.z),
                               level(x + w, y, x + w + far, y + w, p.z),
                               level(x - far, y + w, x + w + far, y + w + far, p.z)};
  add_polygons(s.soup, "ceiling", ceiling);
  add_polygons(s.soup, "light", {level(x, y, x + w, y + w, p.z)});
  s.lights = {"light"};
}

/// A light with a side on a wall, or flat on it.
void light_at_wall(ShadowScene& s, const Place& p) {
  const double x = p.x1, top = p.z + 1;
  add_polygons(s.soup, "wall",
               {{{x, p.y0 - 1, 0}, {x, p.y0 - 1, top}, {x, p.y1, top}, {x, p.y1, 0}}});
  const double y0 = p.y0, y1 = p.y0 + 2;
  if (p.random.one_in(2)) {
    add_polygons(s.soup, "light", {level(x - 2, y0, x, y1, p.z)});
  } else {
    add_polygons(s.soup, "light",
                 {{{x, y0, p.z - 2}, {x, y0, p.z}, {x, y1, p.z}, {x, y1, p.z - 2}}});
  }
  s.lights = {"light"};
}

/// A window as the middle one of five polygons of a wall.
void window_of_wall(ShadowScene& s, const Place& p) {
  const double x = p.x0 - 1, y0 = p.y0, y1 = p.y0 + 1, y2 = p.y0 + 3, y3 = p.y1 + 2;
  const double z0 = p.z - 6, z1 = p.z - 4, z2 = p.z - 2, z3 = p.z;
  const auto upright = [&](double a, double b, double c, double d) {
    return Polygon{{x, a, c}, {x, b, c}, {x, b, d}, {x, a, d}};
  };
  const std::size_t first = s.soup.polygons.size();
  add_polygons(s.soup, "wall",
               {upright(y0, y3, z0, z1), upright(y0, y1, z1, z2), upright(y1, y2, z1, z2),
                upright(y2, y3, z1, z2), upright(y0, y3, z2, z3)});
  s.lights = {range(first + 2, first + 2)};
}

void light_like_an_l(ShadowScene& s, const Place& p) {
  const double x = p.x0, y = p.y0, z = p.z;
  add_polygons(s.soup, "light",
               {{{x, y, z},
                 {x, y + 3, z},
                 {x + 1, y + 3, z},
                 {x + 1, y + 1, z},
                 {x + 3, y + 1, z},
                 {x + 3, y, z}}});
  s.lights = {"light"};
  if (p.random.one_in(3)) s.two_sided = {"light"};
}

/// A frame of four polygons, or of one with a cut from outside to the hole.
void light_with_hole(ShadowScene& s, const Place& p) {
  const double z = p.z;
  const Point o(p.x0, p.y0, z);
  const std::array<Point, 4> out{o, o + Point(0, 4, 0), o + Point(4, 4, 0),
                                 o + Point(4, 0, 0)};
  const std::array<Point, 4> in{o + Point(1, 1, 0), o + Point(1, 3, 0),
                                o + Point(3, 3, 0), o + Point(3, 1, 0)};
  std::vector<Polygon> light;
  if (p.random.one_in(2)) {
    for (int i = 0; i < 4; ++i) {
      const int j = (i + 1) % 4;
      light.push_back({out[i], out[j], in[j], in[i]});
    }
  } else {
    light.push_back(
        {out[0], out[1], out[2], out[3], out[0], in[0], in[3], in[2], in[1], in[0]});
  }
  add_polygons(s.soup, "light", light);
  s.lights = {"light"};
}

/// Three lights, of which two touch or lie on one another, one twice.
void several_lights(ShadowScene& s, const Place& p) {
  const double x = p.x0, y = p.y0, shift = p.random.integer(1, 3);
  add_polygons(s.soup, "first", {level(x, y, x + 2, y + 2, p.z)});
  add_polygons(s.soup, "second", {level(x + shift, y + 1, x + shift + 2, y + 3, p.z)});
  add_polygons(s.soup, "third",
               {{{x - 1, y, p.z - 3}, {x - 1, y + 2, p.z - 3}, {x - 1, y + 1, p.z}}});
  s.lights = {"first", "second", "third"};
  if (p.random.one_in(2)) s.two_sided = {"second"};
}

/// A box that shines to all sides, or a polytope.
void closed_lamp(ShadowScene& s, const Place& p) {
  if (p.random.one_in(2)) {
    add_box(s.soup, "lamp", {p.x0 + 1, p.y0 + 1, p.z - 1}, {p.x0 + 3, p.y0 + 2, p.z});
  } else {
    const Point at(p.x0 + 0.5 * p.dx(), p.y0 + 0.5 * p.dy(), p.z + 1);
    PolygonSoup lamp =
        random_polytopes(p.random.integer(1, 99), 1, {.max_vertices = 6, .density = 0.3});
    std::vector<Polygon> polygons;
    for (const auto& polygon : lamp.polygons) {
      polygons.emplace_back();
      for (const int v : polygon) polygons.back().push_back(at + lamp.vertices[v]);
    }
    add_polygons(s.soup, "lamp", polygons);
  }
  s.lights = {"lamp"};
}

/// Upright and wide, through the middle of everything, from both sides.
void light_through_all(ShadowScene& s, const Place& p) {
  const double x = p.x0 + 1, y0 = p.y0, y1 = p.y1, z = p.z;
  const double tilt = p.random.integer(0, 1);
  add_polygons(s.soup, "light",
               {{{x, y0, z}, {x, y1, z}, {x + tilt, y1, z - 5}, {x + tilt, y0, z - 5}}});
  s.lights = {"light"};
  s.two_sided = {"light"};
}

/// A quadrilateral turned in doubles: two triangles, each in its plane.
void bent_light(ShadowScene& s, const Place& p) {
  const PolygonSoup box = rotated_boxes(p.random.integer(1, 99), 1);
  const Point shift = Point(p.x0 + 1, p.y0 + 1, p.z) - box.vertices[box.polygons[0][0]];
  Polygon light;
  for (const int v : box.polygons[0]) light.push_back(box.vertices[v] + shift);
  add_polygons(s.soup, "light", {light});
  s.lights = {"light"};
  s.two_sided = {"light"};
}

constexpr std::array<std::pair<const char*, AddLight>, 12> kLights{
    {{"in air", light_in_air},
     {"level", level_light},
     {"flush", light_flush_with_ceiling},
     {"let in", light_let_in},
     {"at wall", light_at_wall},
     {"window", window_of_wall},
     {"L", light_like_an_l},
     {"holed", light_with_hole},
     {"several", several_lights},
     {"lamp", closed_lamp},
     {"through", light_through_all},
     {"bent", bent_light}}};

/// Corners of the others in the middle of a side are made its own.
std::vector<Polygon> without_tees(const std::vector<Polygon>& polygons) {
  std::vector<Polygon> result;
  for (const Polygon& polygon : polygons) {
    result.emplace_back();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      std::map<double, Point> on_side{{0, a}};
      for (const Polygon& other : polygons) {
        for (const Point& p : other) {
          const double at = (p - a).dot(b - a) / (b - a).squaredNorm();
          if ((p - a).cross(b - a).isZero() && at > 0 && at < 1) on_side[at] = p;
        }
      }
      for (const auto& [at, p] : on_side) result.back().push_back(p);
    }
  }
  return result;
}

/// A room whose ceiling or wall has a light among its polygons, and boxes in it.
ShadowScene lit_room(std::uint64_t seed) {
  Random random(seed);
  ShadowScene result{"lit room " + std::to_string(seed), {}, {}, {}};
  const bool window = random.one_in(2);
  std::vector<Polygon> room{{{0, 0, 0}, {6, 0, 0}, {6, 6, 0}, {0, 6, 0}},
                            {{0, 0, 0}, {0, 0, 4}, {6, 0, 4}, {6, 0, 0}},
                            {{6, 0, 0}, {6, 0, 4}, {6, 6, 4}, {6, 6, 0}},
                            {{6, 6, 0}, {6, 6, 4}, {0, 6, 4}, {0, 6, 0}}};
  // The ceiling in three stripes, the middle one in three; or the last wall so.
  const auto at = [&](double u, double v) {
    return window ? Point(0, v, u * 4 / 6) : Point(u, v, 4);
  };
  const auto part = [&](double u0, double v0, double u1, double v1) {
    return Polygon{at(u0, v0), at(u0, v1), at(u1, v1), at(u1, v0)};
  };
  for (const auto& [v0, v1] : {std::array{0.0, 1.5}, {4.5, 6.0}}) {
    room.push_back({at(0, v0), at(0, v1), at(1.5, v1), at(4.5, v1), at(6, v1), at(6, v0),
                    at(4.5, v0), at(1.5, v0)});
  }
  for (const auto& [u0, u1] : {std::array{0.0, 1.5}, {1.5, 4.5}, {4.5, 6.0}}) {
    room.push_back(part(u0, 1.5, u1, 4.5));
  }
  room.push_back(window ? level(0, 0, 6, 6, 4)
                        : Polygon{{0, 6, 0}, {0, 6, 4}, {0, 0, 4}, {0, 0, 0}});
  // With T-junctions the room is not closed.
  add_polygons(result.soup, "room", random.one_in(4) ? room : without_tees(room));
  result.lights = {"#7-7"};
  for (int i = 0; i < 3; ++i) {
    const double x = 2 * i, y = random.one_in(3) ? 0 : random.integer(1, 4);
    const double z = random.one_in(3) ? 1 : 0;
    add_box(
        result.soup, ("box" + std::to_string(i)).c_str(), {x, y, z},
        {x + random.integer(1, 2), y + random.integer(1, 2), z + random.integer(1, 3)});
  }
  return result;
}

/// Blockers by the names that view_scenes() gives them, with bent ones added.
std::vector<ViewScene> blockers() {
  std::map<std::string, PolygonSoup> known;
  for (ViewScene& s : view_scenes()) known[s.name] = std::move(s.soup);
  std::vector<ViewScene> result;
  for (const char* name : {"polytopes 1",
                           "parallelepipeds 1",
                           "boxes 1",
                           "grid 1",
                           "sheets 1",
                           "frames 1",
                           "stacks 1",
                           "triangles 1",
                           "polytopes 3",
                           "parallelepipeds 2",
                           "grid 2",
                           "sheets 2",
                           "frames 2",
                           "stacks 2",
                           "polytopes 5",
                           "boxes 2",
                           "grid 4",
                           "sheets 3",
                           "stacks 3",
                           "triangles 2",
                           "room 1",
                           "house 1",
                           "room of triangles 1",
                           "room 3"}) {
    result.push_back({name, known.at(name)});
  }
  for (const Touching kind :
       {Touching::OnSlab, Touching::Row, Touching::FaceOverlap, Touching::TeeJunction,
        Touching::CrossedEdges, Touching::Courtyard, Touching::Pyramid,
        Touching::EdgePart}) {
    const std::string label = "touching " + sightline::testing::name(kind);
    result.push_back({label, known.at(label)});
  }
  for (const auto& [name, soup] : known) {
    const bool crowd = name.starts_with("overlapping") || name.starts_with("touching ") ||
                       name.starts_with("repeated") || name.starts_with("non");
    if (crowd && (name.ends_with(" 1") || name.ends_with(" 2"))) {
      result.push_back({name, soup});
    }
  }
  result.push_back({"rotated boxes", rotated_boxes(1, 3)});
  result.push_back({"rotated boxes 2", rotated_boxes(2, 4)});
  return result;
}

}  // namespace

std::vector<ShadowScene> shadow_scenes() {
  std::vector<ShadowScene> result;
  const std::vector<ViewScene> all = blockers();
  for (std::size_t i = 0; i < 64; ++i) {
    const ViewScene& base = all[i % all.size()];
    const auto& [name, add_light] = kLights[(i + i / kLights.size()) % kLights.size()];
    Random random(i + 1);
    ShadowScene scene{
        base.name + ", " + name + " " + std::to_string(i), base.soup, {}, {}};
    const auto [low, high] = box_of(base.soup);
    // Over all, touching the highest thing, or among things.
    const double z = high[2] + random.integer(-1, 2);
    const double x0 = low[0] + random.integer(-1, 1), y0 = low[1] + random.integer(-1, 1);
    add_light(scene, {random, x0, y0, high[0], high[1], z});
    result.push_back(std::move(scene));
  }
  for (std::uint64_t seed = 1; seed <= 8; ++seed) result.push_back(lit_room(seed));
  return result;
}

std::vector<int> faces_of_groups(const Scene& scene,
                                 const std::vector<std::string>& groups) {
  std::vector<int> result;
  for (const std::string& group : groups) {
    const std::vector<int> faces = scene.faces_named(group);
    result.insert(result.end(), faces.begin(), faces.end());
  }
  std::ranges::sort(result);
  result.erase(std::ranges::unique(result).begin(), result.end());
  return result;
}

NaiveShadow naive_shadow(const Scene& scene, const ShadowScene& lit) {
  return NaiveShadow(naive_shadow_faces(scene, faces_of_groups(scene, lit.lights),
                                        faces_of_groups(scene, lit.two_sided)));
}

}  // namespace sightline::testing
