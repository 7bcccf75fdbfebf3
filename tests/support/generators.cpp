#include "tests/support/generators.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>

namespace sightline::testing {
namespace {

using Integer = std::int64_t;
__extension__ using Wide = __int128;
using GridPoint = std::array<Integer, 3>;

GridPoint operator-(const GridPoint& a, const GridPoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

GridPoint cross(const GridPoint& a, const GridPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
          a[0] * b[1] - a[1] * b[0]};
}

Wide dot(const GridPoint& a, const GridPoint& b) {
  return Wide(a[0]) * b[0] + Wide(a[1]) * b[1] + Wide(a[2]) * b[2];
}

/// A convex polyhedron on the integer grid, inside the sphere of its centre and radius
/// (grid units; a rounding of one unit per coordinate included).
struct Polytope {
  std::vector<GridPoint> vertices;
  std::vector<std::vector<int>> faces;
  Point centre;
  double radius;
};

/// The hull of points in general position; nullopt when four are coplanar on its boundary
/// or two coincide.  Brute force over triples.
std::optional<Polytope> hull(const std::vector<GridPoint>& points) {
  const int n = static_cast<int>(points.size());
  Polytope result;
  std::vector<int> new_id(n, -1);
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      for (int k = j + 1; k < n; ++k) {
        const GridPoint normal = cross(points[j] - points[i], points[k] - points[i]);
        int in_front = 0, behind = 0, on = 0;
        for (int l = 0; l < n; ++l) {
          if (l == i || l == j || l == k) continue;
          const Wide side = dot(normal, points[l] - points[i]);
          ++(side > 0 ? in_front : side < 0 ? behind : on);
        }
        if (in_front > 0 && behind > 0) continue;
        if (on > 0) return std::nullopt;
        if (in_front > 0) {
          result.faces.push_back({i, k, j});
        } else {
          result.faces.push_back({i, j, k});
        }
      }
    }
  }
  for (std::vector<int>& face : result.faces) {
    for (int& v : face) {
      if (new_id[v] < 0) {
        new_id[v] = static_cast<int>(result.vertices.size());
        result.vertices.push_back(points[v]);
      }
      v = new_id[v];
    }
  }
  if (result.vertices.size() < 4) return std::nullopt;
  return result;
}

bool separates(const GridPoint& axis, const Polytope& p, const Polytope& q) {
  const auto range = [&](const Polytope& r) {
    Wide lo = dot(axis, r.vertices[0]), hi = lo;
    for (const GridPoint& v : r.vertices) {
      const Wide x = dot(axis, v);
      lo = std::min(lo, x);
      hi = std::max(hi, x);
    }
    return std::pair{lo, hi};
  };
  const auto [p_lo, p_hi] = range(p);
  const auto [q_lo, q_hi] = range(q);
  return p_hi < q_lo || q_hi < p_lo;
}

std::vector<GridPoint> edge_directions(const Polytope& p) {
  std::vector<GridPoint> result;
  for (const std::vector<int>& face : p.faces) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      const int a = face[i], b = face[(i + 1) % face.size()];
      if (a < b) result.push_back(p.vertices[b] - p.vertices[a]);
    }
  }
  return result;
}

/// No point in common, by separating axes: exact, since all numbers are integers.
bool disjoint(const Polytope& p, const Polytope& q) {
  // The spheres hold the rounded points too, so a gap of a unit is no rounding error.
  if ((p.centre - q.centre).norm() > p.radius + q.radius + 1) return true;
  for (const Polytope* r : {&p, &q}) {
    for (const std::vector<int>& face : r->faces) {
      const GridPoint& a = r->vertices[face[0]];
      if (separates(cross(r->vertices[face[1]] - a, r->vertices[face[2]] - a), p, q)) {
        return true;
      }
    }
  }
  const std::vector<GridPoint> q_edges = edge_directions(q);
  for (const GridPoint& e : edge_directions(p)) {
    for (const GridPoint& f : q_edges) {
      if (separates(cross(e, f), p, q)) return true;
    }
  }
  return false;
}

void add_group(PolygonSoup& soup, std::string group_name,
               const std::vector<Point>& vertices,
               const std::vector<std::vector<int>>& faces) {
  const int first = static_cast<int>(soup.vertices.size());
  soup.vertices.insert(soup.vertices.end(), vertices.begin(), vertices.end());
  PolygonSoup::Group group;
  group.name = std::move(group_name);
  for (std::vector<int> face : faces) {
    for (int& v : face) v += first;
    group.faces.push_back(static_cast<int>(soup.polygons.size()));
    soup.polygons.push_back(std::move(face));
  }
  soup.groups.push_back(std::move(group));
}

/// Draws shapes until `count` of them are disjoint.  make(random, centre, radius) returns
/// an optional Polytope around centre, all in grid units.
template <class Make>
PolygonSoup scatter(std::uint64_t seed, int count, const PolytopeOptions& options,
                    const std::string& prefix, Make&& make) {
  Random random(seed);
  const double scale = std::ldexp(1.0, options.bits);
  const double mean_radius = (options.min_radius + options.max_radius) / 2;
  const double ball = 4.19 * mean_radius * mean_radius * mean_radius;
  const double side =
      std::max(std::cbrt(count * ball / options.density), 2.5 * options.max_radius) *
      scale;
  // Products of the hull and of the separating axes stay below 2^63 and 2^127.
  if (side > 0x1p30 || options.max_radius * scale > 0x1p28) {
    throw std::runtime_error("random_polytopes: too many bits");
  }
  // Buckets as wide as a diameter: only neighbours can meet.
  const double width = 2 * options.max_radius * scale + 4;
  const int buckets = static_cast<int>(side / width) + 1;
  std::vector<std::vector<int>> bucket(static_cast<std::size_t>(buckets) * buckets *
                                       buckets);
  const auto bucket_of = [&](double x) {
    return std::clamp(static_cast<int>(x / width), 0, buckets - 1);
  };
  std::vector<Polytope> placed;
  long tries = 0;
  while (static_cast<int>(placed.size()) < count) {
    if (++tries > 2000L * count + 10000) {
      throw std::runtime_error("random_polytopes: no room at this density");
    }
    const double radius = random.uniform(options.min_radius, options.max_radius) * scale;
    Point centre;
    for (double& x : centre) x = random.uniform(radius, side - radius);
    std::optional<Polytope> shape = make(random, centre, radius);
    if (!shape) continue;
    shape->centre = centre;
    shape->radius = radius + 4;  // corners are rounded to the grid, axes before them
    const std::array<int, 3> at = {bucket_of(centre[0]), bucket_of(centre[1]),
                                   bucket_of(centre[2])};
    bool free = true;
    for (int x = std::max(at[0] - 1, 0); x <= std::min(at[0] + 1, buckets - 1); ++x) {
      for (int y = std::max(at[1] - 1, 0); y <= std::min(at[1] + 1, buckets - 1); ++y) {
        for (int z = std::max(at[2] - 1, 0); z <= std::min(at[2] + 1, buckets - 1); ++z) {
          for (const int other : bucket[(x * buckets + y) * buckets + z]) {
            free = free && disjoint(*shape, placed[other]);
          }
        }
      }
    }
    if (!free) continue;
    bucket[(at[0] * buckets + at[1]) * buckets + at[2]].push_back(
        static_cast<int>(placed.size()));
    placed.push_back(std::move(*shape));
  }
  PolygonSoup soup;
  soup.source = prefix + " of seed " + std::to_string(seed);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    std::vector<Point> vertices;
    for (const GridPoint& v : placed[i].vertices) {
      vertices.emplace_back(static_cast<double>(v[0]) / scale,
                            static_cast<double>(v[1]) / scale,
                            static_cast<double>(v[2]) / scale);
    }
    add_group(soup, prefix + std::to_string(i), vertices, placed[i].faces);
  }
  return soup;
}

GridPoint rounded(const Point& p) {
  return {std::llround(p[0]), std::llround(p[1]), std::llround(p[2])};
}

/// Corner i of a box has the larger x, y, z where bits 0, 1, 2 of i are set; faces are
/// counter-clockwise seen from outside when the axes are right-handed.
const std::vector<std::vector<int>>& box_faces() {
  static const std::vector<std::vector<int>> faces = {
      {0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  return faces;
}

void add_box(PolygonSoup& soup, std::string group_name, const AlignedBox& box) {
  std::vector<Point> vertices;
  for (int i = 0; i < 8; ++i) {
    vertices.emplace_back((i & 1 ? box.max : box.min)[0], (i & 2 ? box.max : box.min)[1],
                          (i & 4 ? box.max : box.min)[2]);
  }
  add_group(soup, std::move(group_name), vertices, box_faces());
}

bool apart(const AlignedBox& a, const AlignedBox& b, bool may_touch) {
  for (int i = 0; i < 3; ++i) {
    if (may_touch ? a.max[i] <= b.min[i] || b.max[i] <= a.min[i]
                  : a.max[i] < b.min[i] || b.max[i] < a.min[i]) {
      return true;
    }
  }
  return false;
}

/// A unit quaternion, uniform on the rotations, as a matrix.
Eigen::Matrix3d random_rotation(Random& random) {
  double w, x, y, z, squared_norm;
  do {
    w = random.uniform(-1, 1);
    x = random.uniform(-1, 1);
    y = random.uniform(-1, 1);
    z = random.uniform(-1, 1);
    squared_norm = w * w + x * x + y * y + z * z;
  } while (squared_norm > 1 || squared_norm < 0.01);
  const double s = 2 / squared_norm;
  Eigen::Matrix3d m;
  m << 1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),
      s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x),
      s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y);
  return m;
}

int buildings_for(int polygon_count) {
  if (polygon_count < 12) throw std::runtime_error("a city needs at least 12 polygons");
  return (polygon_count - 6) / 6;
}

}  // namespace

Point Random::direction() {
  Point p;
  double squared_norm;
  do {
    for (double& x : p) x = uniform(-1, 1);
    squared_norm = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
  } while (squared_norm > 1 || squared_norm < 0.01);
  const double norm = std::sqrt(squared_norm);
  return {p[0] / norm, p[1] / norm, p[2] / norm};
}

PolygonSoup random_polytopes(std::uint64_t seed, int count,
                             const PolytopeOptions& options) {
  return scatter(seed, count, options, "polytope",
                 [&](Random& random, const Point& centre, double radius) {
                   std::vector<GridPoint> points(
                       random.integer(options.min_vertices, options.max_vertices));
                   for (GridPoint& p : points)
                     p = rounded(centre + radius * random.direction());
                   return hull(points);
                 });
}

PolygonSoup random_parallelepipeds(std::uint64_t seed, int count,
                                   const PolytopeOptions& options) {
  return scatter(
      seed, count, options, "parallelepiped",
      [&](Random& random, const Point& centre, double radius) -> std::optional<Polytope> {
        std::array<GridPoint, 3> axes;
        for (GridPoint& a : axes) {
          // Half the diagonal is at most 1.5 times the longest axis.
          a = rounded(radius * random.uniform(0.35, 0.66) * random.direction());
        }
        const Wide volume = dot(cross(axes[0], axes[1]), axes[2]);
        if (static_cast<double>(volume < 0 ? -volume : volume) <
            0.02 * radius * radius * radius) {
          return std::nullopt;
        }
        if (volume < 0) std::swap(axes[0], axes[1]);
        Polytope result;
        Point corner = centre;
        for (const GridPoint& a : axes) {
          corner -= Point(static_cast<double>(a[0]), static_cast<double>(a[1]),
                          static_cast<double>(a[2])) /
                    2;
        }
        for (int i = 0; i < 8; ++i) {
          GridPoint v = rounded(corner);
          for (int k = 0; k < 3; ++k) {
            if ((i >> k & 1) == 0) continue;
            for (int c = 0; c < 3; ++c) v[c] += axes[k][c];
          }
          result.vertices.push_back(v);
        }
        result.faces = box_faces();
        return result;
      });
}

PolygonSoup boxes_soup(const std::vector<AlignedBox>& boxes) {
  PolygonSoup soup;
  soup.source = "boxes";
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    add_box(soup, "box" + std::to_string(i), boxes[i]);
  }
  return soup;
}

PolygonSoup random_boxes(std::uint64_t seed, int count, const BoxOptions& options) {
  Random random(seed);
  std::vector<AlignedBox> boxes;
  long tries = 0;
  while (static_cast<int>(boxes.size()) < count) {
    if (++tries > 10000L * count) throw std::runtime_error("random_boxes: no room");
    AlignedBox box;
    for (int i = 0; i < 3; ++i) {
      if (options.grid > 0) {
        const int lo = std::max(1, static_cast<int>(options.min_size));
        const int hi = std::max(lo, static_cast<int>(options.max_size));
        const int size = std::min(random.integer(lo, hi), options.grid);
        box.min[i] = random.integer(0, options.grid - size);
        box.max[i] = box.min[i] + size;
      } else {
        const double size =
            options.side * random.uniform(options.min_size, options.max_size);
        box.min[i] = random.uniform(0, options.side - size);
        box.max[i] = box.min[i] + size;
      }
    }
    if (std::ranges::all_of(boxes, [&](const AlignedBox& other) {
          return apart(box, other, options.may_touch);
        })) {
      boxes.push_back(box);
    }
  }
  return boxes_soup(boxes);
}

PolygonSoup rotated_boxes(std::uint64_t seed, int count) {
  Random random(seed);
  struct Turned {
    Point centre;
    std::array<Point, 3> half;  // along the box's own axes
  };
  std::vector<Turned> boxes;
  const double side = 2.2 * std::cbrt(static_cast<double>(count)) + 1;
  const auto are_apart = [](const Turned& a, const Turned& b) {
    std::vector<Point> axes(a.half.begin(), a.half.end());
    axes.insert(axes.end(), b.half.begin(), b.half.end());
    for (const Point& p : a.half) {
      for (const Point& q : b.half) axes.push_back(p.cross(q));
    }
    for (const Point& axis : axes) {
      double reach = 0;
      for (int i = 0; i < 3; ++i) {
        reach += std::abs(axis.dot(a.half[i])) + std::abs(axis.dot(b.half[i]));
      }
      // Coordinates are below 100 and rounded in the 16th digit: this gap is no rounding.
      if (std::abs(axis.dot(a.centre - b.centre)) > reach + 1e-6 * axis.norm()) {
        return axis.norm() > 1e-3;
      }
    }
    return false;
  };
  long tries = 0;
  while (static_cast<int>(boxes.size()) < count) {
    if (++tries > 10000L * count) throw std::runtime_error("rotated_boxes: no room");
    Turned box;
    for (double& x : box.centre) x = random.uniform(0, side);
    const Eigen::Matrix3d rotation = random_rotation(random);
    for (int i = 0; i < 3; ++i) box.half[i] = rotation.col(i) * random.uniform(0.3, 1);
    if (std::ranges::all_of(boxes,
                            [&](const Turned& other) { return are_apart(box, other); })) {
      boxes.push_back(box);
    }
  }
  PolygonSoup soup;
  soup.source = "rotated boxes of seed " + std::to_string(seed);
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    std::vector<Point> vertices;
    for (int i = 0; i < 8; ++i) {
      Point p = boxes[b].centre;
      for (int k = 0; k < 3; ++k) {
        if (i >> k & 1) {
          p += boxes[b].half[k];
        } else {
          p -= boxes[b].half[k];
        }
      }
      vertices.push_back(p);
    }
    add_group(soup, "box" + std::to_string(b), vertices, box_faces());
  }
  return soup;
}

namespace {

struct TouchingCase {
  Touching kind;
  const char* name;
  std::vector<AlignedBox> boxes;
};

const std::vector<TouchingCase>& touching_cases() {
  static const std::vector<TouchingCase> cases = {
      {Touching::FaceToFace,
       "face-to-face",
       {{{0, 0, 0}, {2, 2, 2}}, {{2, 0, 0}, {4, 2, 2}}}},
      {Touching::FacePart, "face-part", {{{0, 0, 0}, {2, 4, 4}}, {{2, 1, 1}, {4, 3, 2}}}},
      {Touching::FaceOverlap,
       "face-overlap",
       {{{0, 0, 0}, {2, 3, 3}}, {{2, 1, 2}, {4, 4, 5}}}},
      {Touching::FaceFlush,
       "face-flush",
       {{{0, 0, 0}, {2, 2, 2}}, {{2, 0, 0}, {5, 2, 4}}}},
      {Touching::Edge, "edge", {{{0, 0, 0}, {2, 2, 3}}, {{2, 2, 0}, {5, 4, 3}}}},
      {Touching::EdgePart, "edge-part", {{{0, 0, 0}, {2, 2, 3}}, {{2, 2, 1}, {5, 4, 5}}}},
      {Touching::EdgeOnFace,
       "edge-on-face",
       {{{0, 0, 0}, {2, 4, 4}}, {{2, 1, 4}, {3, 3, 6}}}},
      {Touching::CrossedEdges,
       "crossed-edges",
       {{{1, 0, 0}, {5, 2, 2}}, {{0, 1, 2}, {3, 4, 4}}}},
      {Touching::Corner, "corner", {{{0, 0, 0}, {2, 2, 2}}, {{2, 2, 2}, {5, 4, 3}}}},
      {Touching::CornerOnEdge,
       "corner-on-edge",
       {{{0, 0, 0}, {2, 2, 4}}, {{2, 2, 1}, {4, 3, 2}}}},
      {Touching::Stack,
       "stack",
       {{{0, 0, 0}, {2, 3, 1}}, {{0, 0, 1}, {2, 3, 3}}, {{0, 0, 3}, {2, 3, 4}}}},
      {Touching::Pyramid,
       "pyramid",
       {{{0, 0, 0}, {6, 6, 1}}, {{1, 1, 1}, {5, 5, 2}}, {{2, 2, 2}, {4, 3, 4}}}},
      {Touching::Row,
       "row",
       {{{0, 0, 0}, {1, 1, 1}},
        {{1, 0, 0}, {2, 1, 1}},
        {{2, 0, 0}, {3, 1, 1}},
        {{3, 0, 0}, {4, 1, 1}}}},
      {Touching::RowOfDifferent,
       "row-of-different",
       {{{0, 0, 0}, {1, 2, 2}},
        {{1, 0, 0}, {2, 2, 4}},
        {{2, 0, 0}, {3, 2, 1}},
        {{3, 0, 0}, {5, 2, 3}}}},
      {Touching::Around,
       "around",
       {{{2, 0, 0}, {4, 2, 3}},
        {{4, 2, 0}, {6, 4, 3}},
        {{2, 4, 0}, {4, 6, 3}},
        {{0, 2, 0}, {2, 4, 3}}}},
      {Touching::Courtyard,
       "courtyard",
       {{{0, 0, 0}, {5, 1, 2}},
        {{0, 1, 0}, {1, 4, 2}},
        {{4, 1, 0}, {5, 4, 2}},
        {{0, 4, 0}, {5, 5, 2}}}},
      {Touching::TeeJunction,
       "tee-junction",
       {{{0, 0, 0}, {2, 6, 4}}, {{2, 1, 0}, {4, 3, 2}}, {{2, 3, 0}, {4, 5, 3}}}},
      {Touching::OnSlab,
       "on-slab",
       {{{0, 0, -1}, {8, 6, 0}}, {{1, 1, 0}, {3, 3, 2}}, {{5, 2, 0}, {6, 5, 3}}}}};
  return cases;
}

const TouchingCase& touching_case(Touching kind) {
  for (const TouchingCase& c : touching_cases()) {
    if (c.kind == kind) return c;
  }
  throw std::runtime_error("touching_boxes: unknown kind");
}

}  // namespace

const std::vector<Touching>& all_touching() {
  static const std::vector<Touching> kinds = [] {
    std::vector<Touching> result;
    for (const TouchingCase& c : touching_cases()) result.push_back(c.kind);
    return result;
  }();
  return kinds;
}

std::string name(Touching kind) { return touching_case(kind).name; }

PolygonSoup touching_boxes(Touching kind) {
  PolygonSoup soup = boxes_soup(touching_case(kind).boxes);
  soup.source = name(kind);
  return soup;
}

PolygonSoup city(std::uint64_t seed, int polygon_count) {
  constexpr double kMinSide = 0.4, kMaxSide = 1.6, kStreet = 0.1, kCovered = 0.3;
  const int count = buildings_for(polygon_count);
  Random random(seed);
  const double side = std::sqrt(count / kCovered) + kMaxSide;
  const double width = kMaxSide + kStreet;
  const int buckets = static_cast<int>(side / width) + 1;
  std::vector<std::vector<AlignedBox>> bucket(static_cast<std::size_t>(buckets) *
                                              buckets);
  PolygonSoup soup;
  soup.source = "city of seed " + std::to_string(seed);
  add_box(soup, "ground", {{-1, -1, -1}, {side + 1, side + 1, 0}});
  long tries = 0;
  for (int placed = 0; placed < count;) {
    if (++tries > 1000L * count) throw std::runtime_error("city: no room");
    const double x_size = random.uniform(kMinSide, kMaxSide);
    const double y_size = random.uniform(kMinSide, kMaxSide);
    const double x = random.uniform(0, side - x_size);
    const double y = random.uniform(0, side - y_size);
    const double u = random.uniform();
    const AlignedBox box{{x, y, 0}, {x + x_size, y + y_size, 0.3 + 2.7 * u * u}};
    const int bx = static_cast<int>(x / width), by = static_cast<int>(y / width);
    bool free = true;
    for (int i = std::max(bx - 1, 0); i <= std::min(bx + 1, buckets - 1); ++i) {
      for (int j = std::max(by - 1, 0); j <= std::min(by + 1, buckets - 1); ++j) {
        for (const AlignedBox& other : bucket[i * buckets + j]) {
          free = free &&
                 (box.max[0] + kStreet < other.min[0] || other.max[0] + kStreet < x ||
                  box.max[1] + kStreet < other.min[1] || other.max[1] + kStreet < y);
        }
      }
    }
    if (!free) continue;
    bucket[bx * buckets + by].push_back(box);
    add_box(soup, "building" + std::to_string(placed++), box);
  }
  return soup;
}

PolygonSoup grid_city(std::uint64_t seed, int polygon_count,
                      const GridCityOptions& options) {
  const int count = buildings_for(polygon_count);
  Random random(seed);
  // Footprints of 1 to 3 units a side cover half of the ground when they may touch; with
  // streets of a unit they cannot cover much more than a quarter.
  const double covered = options.may_touch ? 0.5 : 0.18;
  const int side = static_cast<int>(std::sqrt(4 * count / covered)) + 3;
  std::vector<char> taken(static_cast<std::size_t>(side) * side, 0);
  PolygonSoup soup;
  soup.source = "grid city of seed " + std::to_string(seed);
  add_box(soup, "ground", {{-1, -1, -1}, {side + 1.0, side + 1.0, 0}});
  const int street = options.may_touch ? 0 : 1;
  long tries = 0;
  for (int placed = 0; placed < count;) {
    if (++tries > 10000L * count) throw std::runtime_error("grid_city: no room");
    const int x_size = random.integer(1, 3), y_size = random.integer(1, 3);
    const int x = random.integer(0, side - x_size), y = random.integer(0, side - y_size);
    const int height = random.integer(1, options.max_height);
    bool free = true;
    for (int i = std::max(x - street, 0); i < std::min(x + x_size + street, side); ++i) {
      for (int j = std::max(y - street, 0); j < std::min(y + y_size + street, side);
           ++j) {
        free = free && taken[i * side + j] == 0;
      }
    }
    if (!free) continue;
    for (int i = x; i < x + x_size; ++i) {
      for (int j = y; j < y + y_size; ++j) taken[i * side + j] = 1;
    }
    add_box(soup, "building" + std::to_string(placed++),
            {{double(x), double(y), 0},
             {double(x + x_size), double(y + y_size), double(height)}});
  }
  return soup;
}

PolygonSoup street_city(std::uint64_t seed, int polygon_count,
                        const StreetCityOptions& options) {
  constexpr std::array<double, 3> kSides{4, 6, 7};
  constexpr std::array<double, 5> kTops{3, 5, 8, 12, 20};
  constexpr double kLot = 10, kSlab = 5, kMargin = 10;
  if (!(options.bottom > -kSlab && options.bottom < 2)) {
    throw std::runtime_error("street_city: bottoms must be above -5 and below 2");
  }
  const int count = buildings_for(polygon_count);
  const int columns = static_cast<int>(std::ceil(std::sqrt(count)));
  const int rows = (count + columns - 1) / columns;
  Random random(seed);
  PolygonSoup soup;
  soup.source =
      (options.square ? "square" : "street") + (" city of seed " + std::to_string(seed));
  add_box(soup, "ground",
          {{-kMargin, -kMargin, -kSlab},
           {kLot * columns + kMargin, kLot * rows + kMargin, 0}});
  for (int i = 0; i < count; ++i) {
    std::array<double, 2> low{kLot * (i % columns), kLot * (i / columns)}, size;
    double top;
    if (options.square) {
      for (double& side : size) side = kSides[random.integer(0, 2)];
      top = kTops[random.integer(0, 4)];
    } else {
      for (double& x : low) x += random.uniform(0, 2);
      for (double& side : size) side = random.uniform(3, 7);
      top = random.uniform(2, 25);
    }
    add_box(
        soup, "building" + std::to_string(i),
        {{low[0], low[1], options.bottom}, {low[0] + size[0], low[1] + size[1], top}});
  }
  return soup;
}

PolygonSoup lit_city(int polygon_count, bool square) {
  PolygonSoup soup = street_city(1, polygon_count, {.square = square});
  Point low = soup.vertices[0], high = low;
  for (const Point& p : soup.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double half = 0.05 * std::min(high.x() - low.x(), high.y() - low.y());
  const double x = 0.5 * (low.x() + high.x()), y = 0.5 * (low.y() + high.y());
  const int v = static_cast<int>(soup.vertices.size());
  for (const auto& [dx, dy] : {std::pair(-1, -1), {-1, 1}, {1, 1}, {1, -1}})
    soup.vertices.emplace_back(x + dx * half, y + dy * half, 2 * high.z());
  soup.groups.push_back({"light", {static_cast<int>(soup.polygons.size())}});
  soup.polygons.push_back({v, v + 1, v + 2, v + 3});
  return soup;
}

namespace {

/// Appends the sides of a box as a group of 6 n^2 rectangles.
void add_cut_box(PolygonSoup& soup, const std::string& name, const AlignedBox& box, int n,
                 bool inwards) {
  PolygonSoup::Group group{name, {}};
  const auto at = [&](int axis, int step) {
    if (step == n) return box.max[axis];
    return box.min[axis] + (box.max[axis] - box.min[axis]) * step / n;
  };
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const bool upper = side % 2 == 1;
    for (int cell = 0; cell < n * n; ++cell) {
      std::vector<int> polygon;
      for (const auto& [i, j] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
        Point p;
        p[axis] = upper ? box.max[axis] : box.min[axis];
        p[u] = at(u, cell % n + i);
        p[v] = at(v, cell / n + j);
        polygon.push_back(static_cast<int>(soup.vertices.size()));
        soup.vertices.push_back(p);
      }
      if (upper == inwards) std::ranges::reverse(polygon);
      group.faces.push_back(static_cast<int>(soup.polygons.size()));
      soup.polygons.push_back(polygon);
    }
  }
  soup.groups.push_back(std::move(group));
}

}  // namespace

PolygonSoup enclosure(std::uint64_t seed, int squares, int count) {
  Random random(seed);
  std::vector<AlignedBox> boxes;
  for (int tries = 0; static_cast<int>(boxes.size()) < count; ++tries) {
    if (tries > 10000 * count) throw std::runtime_error("enclosure: no room");
    AlignedBox box;
    for (int i = 0; i < 3; ++i) {
      const double size = random.uniform(0.1, 0.3);
      box.min[i] = random.uniform(0.02, 0.98 - size);
      box.max[i] = box.min[i] + size;
    }
    if (random.integer(0, 1) == 1) {
      const int axis = random.integer(0, 2);
      const double size = box.max[axis] - box.min[axis];
      const bool upper = random.integer(0, 1) == 1;
      box.min[axis] = upper ? 1 - size : 0;
      box.max[axis] = upper ? 1 : size;
    }
    if (std::ranges::all_of(
            boxes, [&](const AlignedBox& other) { return apart(box, other, false); })) {
      boxes.push_back(box);
    }
  }
  PolygonSoup soup;
  soup.source = "enclosure of seed " + std::to_string(seed);
  add_cut_box(soup, "room", {{0, 0, 0}, {1, 1, 1}}, squares, true);
  for (int i = 0; i < count; ++i) {
    add_cut_box(soup, "box" + std::to_string(i), boxes[i], std::max(1, squares / 10),
                false);
  }
  return soup;
}

PolygonSoup triangle_soup(std::uint64_t seed, int count) {
  Random random(seed);
  const auto point = [&](double size) {
    Point p;
    for (double& x : p) x = random.uniform(-size, size);
    return p;
  };
  const double size = 1.5 / std::sqrt(static_cast<double>(count));
  PolygonSoup soup;
  for (int i = 0; i < count; ++i) {
    const Point center = point(1);
    for (int c = 0; c < 3; ++c) soup.vertices.emplace_back(center + point(size));
    soup.polygons.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return soup;
}

PolygonSoup cut_into_triangles(const PolygonSoup& soup) {
  PolygonSoup result;
  result.source = soup.source;
  result.vertices = soup.vertices;
  std::vector<std::vector<int>> parts(soup.polygons.size());
  for (std::size_t f = 0; f < soup.polygons.size(); ++f) {
    const std::vector<int>& polygon = soup.polygons[f];
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
      parts[f].push_back(static_cast<int>(result.polygons.size()));
      result.polygons.push_back({polygon[0], polygon[i], polygon[i + 1]});
    }
  }
  for (const PolygonSoup::Group& group : soup.groups) {
    result.groups.push_back({.name = group.name, .faces = {}});
    std::vector<int>& faces = result.groups.back().faces;
    for (const int f : group.faces) {
      faces.insert(faces.end(), parts[f].begin(), parts[f].end());
    }
  }
  return result;
}

void write_obj(const std::string& path, const PolygonSoup& soup) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(
      std::fopen(path.c_str(), "w"), &std::fclose);
  if (!file) throw std::runtime_error(path + ": cannot be written");
  for (const Point& p : soup.vertices) {
    std::fprintf(file.get(), "v %.17g %.17g %.17g\n", p[0], p[1], p[2]);
  }
  const auto write_face = [&](const std::vector<int>& face) {
    std::fprintf(file.get(), "f");
    for (const int v : face) std::fprintf(file.get(), " %d", v + 1);
    std::fprintf(file.get(), "\n");
  };
  if (soup.groups.empty()) {
    for (const std::vector<int>& face : soup.polygons) write_face(face);
  }
  for (const PolygonSoup::Group& group : soup.groups) {
    std::fprintf(file.get(), "o %s\n", group.name.c_str());
    for (const int f : group.faces) write_face(soup.polygons[f]);
  }
  if (std::fflush(file.get()) != 0) throw std::runtime_error(path + ": write failed");
}

Point grid_point(Random& random, const Scene& scene, double beyond) {
  Point p;
  for (int i = 0; i < 3; ++i) {
    const double low = scene.bounds()[0][i];
    const double high = scene.bounds()[1][i];
    const double margin = beyond * (high - low);
    p[i] = std::round(256 * random.uniform(low - margin, high + margin)) / 256;
  }
  return p;
}

}  // namespace sightline::testing
