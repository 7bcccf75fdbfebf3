#include "tests/support/visibility_cases.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <stdexcept>

#include "tests/support/generators.h"

namespace sightline::testing {
namespace {

using Corners = std::vector<Point>;

/// Axis-aligned, at height z.
Corners plate(double z, double x0, double y0, double x1, double y1) {
  return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}
/// The segment from (x0, z0) to (x1, z1), swept along y in [-8, 8].
Corners screen(double x0, double z0, double x1, double z1) {
  return {{x0, -8, z0}, {x1, -8, z1}, {x1, 8, z1}, {x0, 8, z0}};
}

// Two squares; no line between them leaves [-4, 4]^2.
const Corners kBottom = plate(0, -4, -4, 4, 4);
const Corners kTop = plate(4, -4, -4, 4, 4);

class Cases {
 public:
  void add(const std::string& name, bool visible, std::vector<Corners> occluders,
           Corners a = kBottom, Corners b = kTop) {
    cases.push_back({name, {std::move(a), std::move(b), std::move(occluders)}, visible});
  }
  std::vector<VisibilityCase> cases;
};

/// A wall z = 2 around [-4, 4]^2 in two or more tiles.
void add_walls(Cases& cases, double w) {
  const double far = 8;
  const auto halves = [&](double left, double right) {
    return std::vector{plate(2, -far, -far, left, far), plate(2, right, -far, far, far)};
  };
  cases.add("halves that share an edge", false, halves(0, 0));
  cases.add("halves with a slit", true, halves(0, w));
  cases.add("halves that overlap", false, halves(w, 0));
  cases.add("a wall that ends at the shaft's edge", false, {plate(2, -4, -4, 4, 4)});
  cases.add("a wall that ends short of the shaft's edge", true,
            {plate(2, -4, -4, 4 - w, 4)});
  const std::vector<Corners> tee = {plate(2, -far, -far, far, 0),
                                    plate(2, -far, 0, 1, far), plate(2, 1, 0, far, far)};
  cases.add("T-junction", false, tee);
  std::vector<Corners> open_tee = tee;
  open_tee[2] = plate(2, 1 + w, 0, far, far);
  cases.add("T-junction with a slit", true, open_tee);
  open_tee[2] = plate(2, 1, w, far, far);
  cases.add("T-junction with a slit along the long tile", true, open_tee);
  const std::vector<Corners> quarters = {
      plate(2, -far, -far, 0, 0), plate(2, 0, -far, far, 0), plate(2, 0, 0, far, far),
      plate(2, -far, 0, 0, far)};
  cases.add("quarters that meet in a corner", false, quarters);
  std::vector<Corners> cut = quarters;
  cut[2] = {{w, 0, 2}, {far, 0, 2}, {far, far, 2}, {0, far, 2}, {0, w, 2}};
  cases.add("quarters with a corner cut off", true, cut);
  cases.add("triangles that share the diagonal", false,
            {{{-far, -far, 2}, {far, -far, 2}, {far, far, 2}},
             {{-far, -far, 2}, {far, far, 2}, {-far, far, 2}}});
  cases.add("triangles with a slit along the diagonal", true,
            {{{-far, -far, 2}, {far, -far, 2}, {far, far, 2}},
             {{-far, -far + w, 2}, {far, far + w, 2}, {-far, far, 2}}});
  // Four oblong plates around a hole that is a point, or a square.
  const auto pinwheel = [&](double h) {
    return std::vector{plate(2, -far, -far, h, 0), plate(2, h, -far, far, h),
                       plate(2, 0, h, far, far), plate(2, -far, 0, 0, far)};
  };
  cases.add("closed pinwheel", false, pinwheel(0));
  cases.add("pinwheel with a square hole", true, pinwheel(w));
  cases.add("half-walls that overlap in exactly their edges", false,
            {plate(1, -far, -far, 0, far), plate(1, 0, -far, far, far),
             plate(3, 0, -far, far, far)});
}

/// Screens whose cross-section is connected from one side of the shaft to the other.
void add_screens(Cases& cases, double w) {
  cases.add("crossing screens", false,
            {screen(-6, 1.5, 2, 2.5), screen(-2, 2.5, 6, 1.5)});
  // The first ends on the second, at (0, 2.25).
  cases.add("a screen that ends on another", false,
            {screen(-8, 1.25, 0, 2.25), screen(-2, 2.5, 6, 1.5)});
  // Lines that pass its end and then below the second rise by at most 1/8 to the left:
  // they come from far outside.
  cases.add("a screen that ends before another, which covers the gap", false,
            {screen(-8, 1.25, -8 * w, 2.25 - w), screen(-2, 2.5, 6, 1.5)});
  cases.add("folded screen", false,
            {screen(-6, 1, -2, 3), screen(-2, 3, 2, 1), screen(2, 1, 6, 3)});
  cases.add("folded screen with a slit", true,
            {screen(-6, 1, -2, 3), screen(-2, 3, 2, 1), screen(2 + w, 1, 6, 3)});
  // Lines pass x > c at z = 1 and x < -c at z = 3; the steepest, from (4, 0) to (-4, 4),
  // passes 2 and -2.
  const auto steps = [&](double c) {
    return std::vector{screen(-8, 1, c, 1), screen(-c, 3, 8, 3)};
  };
  cases.add("steps that meet the steepest line", false, steps(2));
  cases.add("steps just below the steepest line", true, steps(2 - w));
  // The same with corners on the steepest lines in two directions at once: plates that
  // leave only x > c and y > c at z = 1, x < -c and y < -c at z = 3.
  const auto corners = [&](double c) {
    return std::vector{plate(1, -8, -8, c, 8), plate(1, -8, -8, 8, c),
                       plate(3, -c, -8, 8, 8), plate(3, -8, -c, 8, 8)};
  };
  cases.add("corners on the longest diagonal", false, corners(2));
  cases.add("corners just off the longest diagonal", true, corners(2 - w));
  // A corner of one triangle over a corner of the other, both on the middle axis.
  const auto wedges = [&](double shift) {
    return std::vector<Corners>{
        {{0, 0, 1}, {-16, 16, 1}, {-16, -16, 1}},
        {{0, 0, 1}, {16, -16, 1}, {16, 16, 1}},
        {{0, shift, 3}, {16, 16 + shift, 3}, {-16, 16 + shift, 3}},
        {{0, -shift, 3}, {-16, -16 - shift, 3}, {16, -16 - shift, 3}}};
  };
  cases.add("wedges with corners on one line", true, wedges(0));
}

/// Occluders in the plane of a, or across it.
void add_at_the_ends(Cases& cases, double w) {
  cases.add("a covered exactly", false, {kBottom});
  cases.add("a covered by two that share an edge", false,
            {plate(0, -4, -4, 0, 4), plate(0, 0, -4, 4, 4)});
  cases.add("a covered but for a slit", true,
            {plate(0, -4, -4, 0, 4), plate(0, w, -4, 4, 4)});
  cases.add("b covered but for a corner", true,
            {{{-4, -4, 4}, {4, -4, 4}, {4, 4 - w, 4}, {4 - w, 4, 4}, {-4, 4, 4}}});
  // What is left of a is x in [3, 4]; from there to b, at z = 2, x is in [-1/2, 4].
  cases.add("rest of a hidden by a wall", false,
            {plate(0, -4, -4, 3, 4), plate(2, -0.5, -4, 4, 4)});
  cases.add("rest of a not quite hidden by a wall", true,
            {plate(0, -4, -4, 3, 4), plate(2, -0.5 + w, -4, 4, 4)});
  const Corners fin = {{0, -8, -1}, {0, 8, -1}, {0, 8, 1}, {0, -8, 1}};
  cases.add("a fin across a", true, {fin});
  cases.add("a fin across a with a roof", false, {fin, plate(1, -8, -8, 8, 8)});
  cases.add("a fin across a with half a roof that touches it", false,
            {fin, plate(1, -8, -8, 0, 8), plate(0, 0, -4, 4, 4)});
  cases.add("a fin across a with half a roof that does not touch it", true,
            {fin, plate(1, -8, -8, -w, 8), plate(0, 0, -4, 4, 4)});
  cases.add("a box around a, but for a slit below its lid", true,
            {screen(-5, -1, -5, 1), screen(5, -1, 5, 1 - w), plate(1, -5, -8, 5, 8)},
            kBottom, {{6, -4, 0}, {6, 4, 0}, {6, 4, 4}, {6, -4, 4}});
  cases.add("a box around a, closed on the side of b", false,
            {screen(-5, -1, -5, 1), screen(5, -1, 5, 1), plate(1, -5, -8, 5, 8)}, kBottom,
            {{6, -4, 0}, {6, 4, 0}, {6, 4, 4}, {6, -4, 4}});
}

/// Lines that leave a and reach b in or near the planes z = 0 of plates: a and b upright.
void add_along_planes(Cases& cases, double w) {
  const auto upright = [](double x, double z0, double z1) {
    return Corners{{x, -1, z0}, {x, 1, z0}, {x, 1, z1}, {x, -1, z1}};
  };
  const Corners a = upright(-4, 0, w), b = upright(4, 0, w);
  // Every extremal line of the corridor that does not pass from one plate to the other
  // lies in one of their planes.
  const Corners floor = plate(0, -2, -4, 2, 4), ceiling = plate(w, -2, -4, 2, 4);
  cases.add("corridor between two plates", true, {floor, ceiling}, a, b);
  cases.add("corridor seen from higher ends", true, {floor, ceiling}, upright(-4, -1, 1),
            upright(4, -1, 1));
  const Corners door = {{0, -4, 0}, {0, 4, 0}, {0, 4, w}, {0, -4, w}};
  cases.add("corridor with a door", false, {floor, ceiling, door}, a, b);
  cases.add("a plate edge-on", true, {floor}, upright(-4, -1, 1), upright(4, -1, 1));
  cases.add("a plate edge-on between flat ends", true, {floor}, a, b);
  // At x = -2 a line must be below the plate's plane, at x = 2 above it, and so crosses
  // the plane between; the plate lies there, but for a gap of the width.
  const auto low = upright(-4, -1, 0), high = upright(4, 0, 1);
  const auto hook = [&](double gap) {
    return std::vector<Corners>{plate(0, -2 + gap, -4, 2, 4),
                                {{-2, -4, 0}, {-2, 4, 0}, {-2, 4, 4}, {-2, -4, 4}},
                                {{2, -4, -4}, {2, 4, -4}, {2, 4, 0}, {2, -4, 0}}};
  };
  cases.add("hook closed by a plate", false, hook(0), low, high);
  cases.add("hook with a gap beside the plate", true, hook(w), low, high);
}

void add_lenses(Cases& cases) {
  for (const int k : {10, 20, 30, 40}) {
    const double epsilon = std::ldexp(1, -k);
    const auto add = [&](const char* kind, bool visible, double e) {
      VisibilityInstance i = lens_instance(e);
      cases.add(std::string(kind) + " 2^-" + std::to_string(k), visible, i.occluders, i.a,
                i.b);
    };
    add("lens", true, epsilon);
    add("inverted lens", false, -epsilon);
  }
  const VisibilityInstance i = lens_instance(0);
  cases.add("tangent lens", false, i.occluders, i.a, i.b);
}

}  // namespace

VisibilityInstance lens_instance(double epsilon) {
  // A line is x = x0 + p z, y = y0 + q z, |x|, |y| <= 1 for z in [-5, 5].  With
  // P(s) = y(s) - s x(s), a quadratic in s, the first three triangles leave
  //   P(-3) < 0, P(-1) > 0, P(3) > 0,
  // so P(1) = -P(-3)/3 + P(-1) + P(3)/3 > 0.  The fourth edge, (u, u + epsilon, 1 + u/4),
  // is passed below when P(1) + x(1) (q - p) / (4 - p) < epsilon.  If x(1) (q - p) >= 0,
  // this needs epsilon > 0, and epsilon > 0 suffices for some (x = y = 0 moved a little).
  // Otherwise write X = x(1), Y = p - q, of one sign, S = X + Y: the three inequalities
  // give P(1) > 4 |S| / 3 (from P(-3), P(3) when S > 0; P(-3), P(-1) when S < 0), more
  // than X Y / (4 - p), since |X| <= 1 and |p|, |q| <= 2/5.  So none is left then, but
  // within about epsilon.
  static constexpr double kFar = 16;
  const auto triangle = [](double s, double blocked) -> Corners {
    return {{-kFar, -kFar * s, s}, {kFar, kFar * s, s}, {0, blocked * 4 * kFar, s}};
  };
  const Corners fourth = {{-kFar, -kFar + epsilon, 1 - kFar / 4},
                          {kFar, kFar + epsilon, 1 + kFar / 4},
                          {0, 4 * kFar, 1}};
  return {{{-1, -1, -5}, {1, -1, -5}, {0, 1, -5}},
          {{-1, -1, 5}, {1, -1, 5}, {0, 1, 5}},
          {triangle(-3, 1), triangle(-1, -1), fourth, triangle(3, -1)}};
}

std::vector<VisibilityCase> known_visibility_cases(double width) {
  Cases cases;
  add_walls(cases, width);
  add_screens(cases, width);
  add_at_the_ends(cases, width);
  add_along_planes(cases, width);
  add_lenses(cases);
  return cases.cases;
}

VisibilityInstance slab_instance(std::uint64_t seed, int n, double s) {
  Random random(seed);
  const double h = std::sqrt(3.0) / 4;
  const auto end = [&](double z) {
    return Corners{{0.5, 0, z}, {-0.25, h, z}, {-0.25, -h, z}};
  };
  VisibilityInstance instance{end(0), end(1), {}};
  for (int i = 0; i < n; ++i) {
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const Corners& a = instance.a;
    Point centre = a[0] + u * (a[1] - a[0]) + v * (a[2] - a[0]);
    centre[2] = random.uniform();
    const double radius = s * random.uniform(0.5, 1.5) / std::sqrt(3.0);
    const Point x = random.direction();
    Point y;
    do {
      y = x.cross(random.direction());
    } while (y.norm() < 0.1);
    y.normalize();
    instance.occluders.push_back({centre + radius * x,
                                  centre + radius * (-0.5 * x + 2 * h * y),
                                  centre + radius * (-0.5 * x - 2 * h * y)});
  }
  return instance;
}

VisibilityInstance grid_instance(std::uint64_t seed, int n, int side) {
  Random random(seed);
  const auto coordinate = [&] { return static_cast<double>(random.integer(0, side)); };
  const auto point = [&] {
    const double x = coordinate(), y = coordinate();
    return Point(x, y, coordinate());
  };
  const auto polygon = [&]() -> Corners {
    while (true) {
      const Point p = point(), q = point(), r = point();
      switch (random.integer(0, 3)) {
        case 0: {  // axis-aligned
          const int k = random.integer(0, 2), i = (k + 1) % 3, j = (k + 2) % 3;
          if (p[i] == q[i] || p[j] == q[j]) break;
          Corners c(4, p);
          c[1][i] = c[2][i] = q[i];
          c[2][j] = c[3][j] = q[j];
          return c;
        }
        case 1: {  // a parallelogram
          const Point fourth = p + r - q;
          if ((q - p).cross(r - p).isZero(0) || fourth.minCoeff() < 0 ||
              fourth.maxCoeff() > side) {
            break;
          }
          return {p, q, r, fourth};
        }
        default:
          if ((q - p).cross(r - p).isZero(0)) break;
          return {p, q, r};
      }
    }
  };
  const auto flat = [&](double z) -> Corners {
    while (true) {
      Corners c = {point(), point(), point()};
      for (Point& p : c) p[2] = z;
      if (!(c[1] - c[0]).cross(c[2] - c[0]).isZero(0)) return c;
    }
  };
  VisibilityInstance instance;
  const bool opposite = !random.one_in(3);
  instance.a = opposite ? flat(0) : polygon();
  instance.b = opposite ? flat(side) : polygon();
  for (int i = 0; i < n; ++i) {
    // Every third is large, or hardly anything would be hidden.
    if (random.one_in(3)) {
      const double z = random.integer(opposite ? 1 : 0, opposite ? side - 1 : side);
      const double cut = random.integer(0, side);
      instance.occluders.push_back(random.one_in(2) ? plate(z, 0, 0, cut + 1, side)
                                                    : plate(z, cut - 1, 0, side, side));
    } else {
      instance.occluders.push_back(polygon());
    }
  }
  return instance;
}

namespace {

Point on_grid(const Point& p) {
  constexpr double kGrid = 0x1p20;
  return {std::nearbyint(p[0] * kGrid) / kGrid, std::nearbyint(p[1] * kGrid) / kGrid,
          std::nearbyint(p[2] * kGrid) / kGrid};
}

}  // namespace

std::vector<std::vector<Point>> bulge(int k, double half_width, double height) {
  const auto at = [&](int i, int j) {
    const double x = 2.0 * i / k - 1, y = 2.0 * j / k - 1;
    const double z = 0.5 + height * (1 - x * x) * (1 - y * y);
    return on_grid({half_width * x, half_width * y, z});
  };
  std::vector<std::vector<Point>> triangles;
  for (int i = 0; i < k; ++i) {
    for (int j = 0; j < k; ++j) {
      triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return triangles;
}

std::vector<std::vector<Point>> ball(const Point& centre, double radius, int rings) {
  const double pi = std::acos(-1.0);
  const auto at = [&](int i, int j) {
    const double down = pi * i / rings, around = pi * (j % (2 * rings)) / rings;
    const double out = i == 0 || i == rings ? 0 : std::sin(down);
    return on_grid(centre + radius * Point(out * std::cos(around), out * std::sin(around),
                                           std::cos(down)));
  };
  std::vector<std::vector<Point>> triangles;
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < 2 * rings; ++j) {
      if (i > 0) triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i < rings - 1)
        triangles.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
    }
  }
  return triangles;
}

VisibilityInstance transformed(const VisibilityInstance& instance, std::uint64_t seed) {
  Random random(seed);
  std::array<int, 3> axes = {0, 1, 2};
  for (int i = 2; i > 0; --i) std::swap(axes[i], axes[random.integer(0, i)]);
  std::array<int, 3> signs, shears, shift;
  for (int i = 0; i < 3; ++i) {
    signs[i] = random.one_in(2) ? 1 : -1;
    shears[i] = random.one_in(2) ? 0 : random.integer(-2, 2);
    shift[i] = random.integer(-3, 3);
  }
  const auto map = [&](const Point& p) {
    Point q;
    for (int i = 0; i < 3; ++i) q[i] = signs[i] * p[axes[i]] + shift[i];
    q[0] += shears[0] * q[1];
    q[1] += shears[1] * q[2];
    q[2] += shears[2] * q[0];
    return q;
  };
  const auto polygon = [&](const Corners& corners) {
    Corners result;
    for (const Point& p : corners) result.push_back(map(p));
    std::rotate(result.begin(),
                result.begin() + random.integer(0, static_cast<int>(corners.size()) - 1),
                result.end());
    if (random.one_in(2)) std::reverse(result.begin(), result.end());
    return result;
  };
  VisibilityInstance result{polygon(instance.a), polygon(instance.b), {}};
  for (const Corners& o : instance.occluders) result.occluders.push_back(polygon(o));
  random.shuffle(result.occluders);
  if (random.one_in(2)) std::swap(result.a, result.b);
  return result;
}

void write_visibility_json(const std::string& path,
                           const std::vector<VisibilityCase>& cases) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) throw std::runtime_error("cannot write " + path);
  const auto polygon = [&](const Corners& corners) {
    std::fprintf(file, "[");
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Point& p = corners[i];
      std::fprintf(file, "%s[%.17g, %.17g, %.17g]", i == 0 ? "" : ", ", p[0], p[1], p[2]);
    }
    std::fprintf(file, "]");
  };
  std::fprintf(file, "{\"instances\": [");
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const VisibilityCase& c = cases[i];
    std::fprintf(file, "%s\n {\"name\": \"%s\", \"expected\": %s,\n  \"a\": ",
                 i == 0 ? "" : ",", c.name.c_str(),
                 !c.visible   ? "null"
                 : *c.visible ? "true"
                              : "false");
    polygon(c.instance.a);
    std::fprintf(file, ",\n  \"b\": ");
    polygon(c.instance.b);
    std::fprintf(file, ",\n  \"occluders\": [");
    for (std::size_t k = 0; k < c.instance.occluders.size(); ++k) {
      if (k > 0) std::fprintf(file, ",\n    ");
      polygon(c.instance.occluders[k]);
    }
    std::fprintf(file, "]}");
  }
  std::fprintf(file, "\n]}\n");
  const bool failed = std::ferror(file) != 0;
  if (std::fclose(file) != 0 || failed) {
    throw std::runtime_error("cannot write " + path);
  }
}

}  // namespace sightline::testing
