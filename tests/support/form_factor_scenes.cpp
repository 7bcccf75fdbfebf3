#include "tests/support/form_factor_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/support/add_polygons.h"
#include "tests/support/random_geometry.h"

namespace sightline::testing {
namespace {

using Polygon = std::vector<Point>;
using Polygons = std::vector<Polygon>;

/// Across an axis, at this position, over two ranges of the next two coordinates; the
/// front towards larger coordinates if `up`.
Polygon sheet(int axis, double at, bool up, const std::array<double, 2>& u,
              const std::array<double, 2>& v) {
  Polygon p(4);
  for (int k = 0; k < 4; ++k) {
    p[k][axis] = at;
    p[k][(axis + 1) % 3] = u[k == 1 || k == 2];
    p[k][(axis + 2) % 3] = v[k >= 2];
  }
  if (!up) std::ranges::reverse(p);
  return p;
}

Polygons box(const Point& low, const Point& high, bool room = false) {
  Polygons faces;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    faces.push_back(sheet(axis, low[axis], room, {low[u], high[u]}, {low[v], high[v]}));
    faces.push_back(sheet(axis, high[axis], !room, {low[u], high[u]}, {low[v], high[v]}));
  }
  return faces;
}

const Polygon kFloor = sheet(2, 0, true, {0, 1}, {0, 1});
const Polygon kCeiling = sheet(2, 1, false, {0, 1}, {0, 1});
const Polygon kWall = sheet(0, 0, true, {0, 1}, {0, 1});

/// Makes one scene of a kind.
class Maker {
 public:
  Maker(std::string name, int seed) : random_(1000 + seed) {
    scene_.name = std::move(name);
    scene_.surfaces = {"from", "to"};
  }
  void add(const std::string& group, const Polygons& polygons) {
    add_polygons(scene_.soup, group, polygons);
  }
  void two_sided(const std::string& group) { scene_.both_sides.push_back(group); }
  void surfaces(std::vector<std::string> groups) { scene_.surfaces = std::move(groups); }
  RandomGeometry& random() { return random_; }
  /// A multiple of 1/n in [low, high].
  double part(int n, double low, double high) {
    const int from = static_cast<int>(std::ceil(low * n));
    return random_.integer(from, static_cast<int>(std::floor(high * n))) / (1.0 * n);
  }
  Point point() { return random_.point(Terrain::Uniform) * 0.5 + Point::Constant(0.5); }
  Polygon triangle() {
    const Point at = point();
    Polygon p;
    for (int k = 0; k < 3; ++k) p.push_back(at + 0.5 * (point() - Point::Constant(0.5)));
    return p;
  }
  std::array<double, 2> range(int n) {
    const double a = part(n, 0, 0.75);
    return {a, a + part(n, 0.125, 0.5)};
  }
  /// Turned and made three times as large by a matrix of integers.
  void turn() {
    for (Point& p : scene_.soup.vertices) {
      p = Point{2 * p.x() - 2 * p.y() + p.z(), p.x() + 2 * p.y() + 2 * p.z(),
                2 * p.x() + p.y() - 2 * p.z()};
    }
    // This one mirrors; its faces are listed the other way round.
    for (auto& polygon : scene_.soup.polygons) std::ranges::reverse(polygon);
  }
  FormFactorScene take() { return std::move(scene_); }

 private:
  FormFactorScene scene_;
  RandomGeometry random_;
};

void general(Maker& m) {
  m.add("from", {m.triangle()});
  Polygon to = m.triangle();
  for (Point& p : to) p.z() += 0.5;
  m.add("to", {to});
  m.add("between", {m.triangle(), m.triangle(), m.triangle()});
  m.two_sided("from");
  m.two_sided("to");
}

void aligned_boxes(Maker& m) {
  m.add("from", {kFloor});
  m.add("to", {kCeiling, kWall});
  for (int k = 0; k < 3; ++k) {
    const Point low{m.part(8, 0, 0.75), m.part(8, 0, 0.75), m.part(8, 0, 0.75)};
    m.add("box" + std::to_string(k), box(low, low + Point{0.25, 0.375, 0.25}));
  }
}

void slivers(Maker& m) {
  const double thin = std::ldexp(1, -m.random().integer(4, 9));
  const double hair = std::ldexp(1, -20);
  const double x = m.part(16, 0.25, 0.75);
  m.add("from", {{{x, 0, 0}, {x + thin, 0, 0}, {x, 1, 0}}});
  m.add("to", {kCeiling, sheet(2, 0.75, false, {1, 1 + thin}, {0, 1})});
  m.add("between", {sheet(0, x, true, {m.part(8, 0, 0.5), 1}, {0.25, 0.25 + hair}),
                    sheet(2, 0.5, true, {0, x}, {0, 1}),
                    {{0.5, 0.25, 0.25}, {0.5 + hair, 0.5, 0.25}, {0.75, 0.75, 0.5}}});
}

void slit(Maker& m) {
  const double width = std::ldexp(1, -20), x = m.part(16, 0.25, 0.75);
  m.add("from", {kFloor});
  m.add("to", {kCeiling, kWall});
  const double z = m.part(16, 0.25, 0.75);
  m.add("between",
        {sheet(2, z, true, {-2, x}, {-2, 3}), sheet(2, z, true, {x + width, 3}, {-2, 3}),
         sheet(1, m.part(8, 0.25, 0.75), true, {0.125, 0.5}, {0.25, 0.875})});
}

void fins(Maker& m) {
  m.add("from", {kFloor});
  m.add("to", {kCeiling, kWall});
  const double x = m.part(8, 0.25, 0.75), h = m.part(8, 0.25, 0.75);
  m.add("on a side", {sheet(0, 1, true, {m.part(8, 0, 0.5), 1}, {0, h})});
  m.add("inside", {sheet(0, x, true, {m.part(8, 0, 0.25), m.part(8, 0.5, 1)}, {0, h})});
  m.add("on a corner", {{{0, 0, 0}, {m.part(8, 0.25, 1), 0.25, 0.5}, {0, 0.5, h}}});
  m.add("from above", {{{1, 1, 1}, {0.5, 1, h}, {1, 0.5, h}}});
}

void touching(Maker& m) {
  m.add("from", {kFloor});
  m.add("to", {kWall, sheet(1, 1, false, {0, 1}, {0, 1})});
  m.add("in the corner",
        box({0, 0, 0}, {m.part(8, 0.125, 0.5), m.part(8, 0.125, 0.5), 0.25}));
  m.add("at the side", {{{0, 0.5, 0},
                         {m.part(8, 0.25, 0.75), 0.5, 0.125},
                         {0.25, m.part(8, 0.625, 0.875), 0.75}}});
  m.add("on it", box({0.625, 0.25, 0}, {0.875, 0.5, m.part(8, 0.25, 0.75)}));
}

void coplanar(Maker& m) {
  m.add("from", {kFloor});
  m.add("to", {kCeiling, kWall});
  m.add("on the floor", {sheet(2, 0, true, m.range(8), m.range(8)),
                         sheet(2, 0, false, m.range(8), {-0.5, 0.5})});
  m.add("on the wall", {sheet(0, 0, true, m.range(8), m.range(8))});
  const double z = m.part(8, 0.25, 0.75);
  m.add("overlapping", {sheet(2, z, true, m.range(8), m.range(8)),
                        sheet(2, z, true, m.range(8), m.range(8)),
                        sheet(2, z, false, m.range(8), m.range(8))});
}

void partly_behind(Maker& m) {
  m.add("from", {kFloor});
  m.add("to", {sheet(0, 0.25, true, {0, 1}, {-0.5, 1}),
               {{0.5, 0, -0.25}, {0.5, 1, -0.25}, {0.25, 1, 0.75}, {0.25, 0, 0.75}}});
  m.add("across", {sheet(1, m.part(8, 0.25, 0.75), true, {-0.5, 0.5}, {0, 0.75}),
                   {{-0.5, 0.25, 0.5}, {0.75, 0.5, 0.25}, {0.75, 0.75, 0.5}},
                   sheet(0, m.part(16, 0.375, 0.75), true, {0.25, 0.5}, {-0.5, 0.5})});
}

void crossing_sheets(Maker& m) {
  m.add("from", {kFloor});
  m.add("to", {kCeiling});
  m.add("sheets", {sheet(2, 0.25, true, m.range(8), m.range(8)),
                   sheet(2, 0.5, true, m.range(8), m.range(8)),
                   sheet(0, m.part(8, 0.25, 0.75), true, m.range(8), {0.125, 0.75}),
                   {{0.125, 0.125, 0.25}, {0.875, 0.25, 0.75}, {0.5, 0.875, 0.5}}});
}

void both_sides(Maker& m) {
  m.add("from", {kFloor});
  m.add("to", {sheet(2, 0.5, true, {0.125, 0.875}, {0.25, m.part(8, 0.5, 1)})});
  m.two_sided("to");
  m.add("leaning",
        {{{0.25, 0, 0.25}, {0.75, 0, 0.75}, {0.75, 1, 0.75}, {0.25, 1, 0.25}}});
  m.two_sided("leaning");
  m.surfaces({"from", "to", "leaning"});
  m.add("between", {sheet(0, m.part(8, 0.25, 0.75), true, m.range(8), m.range(8)),
                    sheet(2, m.part(8, 0.125, 0.375), true, m.range(8), m.range(8))});
}

void solids(Maker& m) {
  m.add("from", box({0, 0, 0}, {0.5, 0.5, m.part(8, 0.25, 0.5)}));
  m.add("to", box({m.part(8, 0.625, 0.75), 0.25, 0.125}, {1, 1, 0.75}));
  m.add("box", box({0.5, m.part(8, 0, 0.25), 0}, {0.625, 0.5, 0.25}));
  m.add("ground", {sheet(2, 0, true, {-0.5, 1.5}, {-0.5, 1.5})});
  m.surfaces({"from", "to", "ground"});
}

void room(Maker& m) {
  m.add("from", box({0, 0, 0}, {1, 1, 1}, true));
  m.surfaces({"from"});
  m.add("standing", box({m.part(8, 0.125, 0.5), 0.25, 0}, {0.75, 0.5, 0.5}));
  m.add("in a corner", box({0.75, 0.75, m.part(8, 0, 0.5)}, {1, 1, 0.75}));
}

/// Blockers whose sides meet in points and run along one another.
void seams(Maker& m) {
  m.add("from", {kFloor});
  m.add("to", {kCeiling, kWall});
  const double x = m.part(8, 0.25, 0.75), y = m.part(8, 0.25, 0.75);
  const double z = m.part(8, 0.25, 0.5);
  m.add("roof", {sheet(2, z, true, {0, x}, {0, y}),
                 sheet(2, z, true, {x, 1}, {y, 1}),
                 {{x, 0, z}, {1, 0, z + 0.25}, {1, y, z + 0.25}, {x, y, z}}});
}

/// Far beside their size.
void far_apart(Maker& m) {
  m.add("from", {sheet(2, 0, true, {0, 0.0625}, {0, 0.0625})});
  const double x = m.part(8, 0, 0.5);
  m.add("to", {sheet(2, 4, false, {x, x + 0.0625}, {0, 0.0625}),
               sheet(2, 4, false, {-2, 2}, {-2, 2})});
  m.add("between", {sheet(2, 2, true, {0.5 * x, 0.5 * x + 0.03125}, {0, 0.03125}),
                    sheet(2, 0.0625, true, {0.03125, 1}, {0.015625, 1})});
}

}  // namespace

std::vector<FormFactorScene> form_factor_scenes() {
  struct Kind {
    const char* name;
    void (*make)(Maker&);
  };
  static constexpr std::array kKinds{Kind{"general", general},
                                     Kind{"aligned boxes", aligned_boxes},
                                     Kind{"slivers", slivers},
                                     Kind{"slit", slit},
                                     Kind{"fins", fins},
                                     Kind{"touching", touching},
                                     Kind{"coplanar", coplanar},
                                     Kind{"partly behind", partly_behind},
                                     Kind{"crossing", crossing_sheets},
                                     Kind{"both sides", both_sides},
                                     Kind{"solids", solids},
                                     Kind{"room", room},
                                     Kind{"seams", seams},
                                     Kind{"far apart", far_apart}};
  std::vector<FormFactorScene> scenes;
  for (int seed = 0; seed < 4; ++seed) {
    for (const Kind& kind : kKinds) {
      Maker maker(std::string(kind.name) + " " + std::to_string(seed),
                  static_cast<int>(scenes.size()));
      kind.make(maker);
      if (seed % 2 == 1) maker.turn();
      scenes.push_back(maker.take());
    }
  }
  return scenes;
}

PolygonSoup enclosure_with_boxes(int n, int boxes, unsigned seed) {
  RandomGeometry random(seed);
  Polygons room;
  for (const Polygon& wall : box({0, 0, 0}, {1, 1, 1}, true)) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const Point u = wall[1] - wall[0], v = wall[3] - wall[0];
        const auto corner = [&](int a, int b) {
          return Point(wall[0] + (1.0 * a / n) * u + (1.0 * b / n) * v);
        };
        room.push_back(
            {corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)});
      }
    }
  }
  Polygons faces;
  for (int k = 0; k < boxes; ++k) {
    Point low, high;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = random.integer(2, 44) / 64.0;
      high[axis] = low[axis] + random.integer(4, 16) / 64.0;
    }
    if (k % 3 == 0) low[(k / 3) % 3] = 0;
    for (const Polygon& face : box(low, high)) faces.push_back(face);
  }
  PolygonSoup soup;
  add_polygons(soup, "room", room);
  add_polygons(soup, "boxes", faces);
  return soup;
}

}  // namespace sightline::testing
