#include "tests/support/invariant_scenes.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "linespace/predicates.h"
#include "tests/support/generators.h"

namespace sightline::testing {
namespace {

constexpr int kGrid = 6;

/// Points and faces of one object before it is put into a scene.
struct Mesh {
  std::vector<Point> points;
  std::vector<std::vector<int>> faces;
};

void add(PolygonSoup& soup, const Mesh& mesh, const std::string& kind) {
  const int first = static_cast<int>(soup.vertices.size());
  soup.vertices.insert(soup.vertices.end(), mesh.points.begin(), mesh.points.end());
  PolygonSoup::Group group{kind + std::to_string(soup.groups.size()), {}};
  for (std::vector<int> face : mesh.faces) {
    for (int& v : face) v += first;
    group.faces.push_back(static_cast<int>(soup.polygons.size()));
    soup.polygons.push_back(std::move(face));
  }
  soup.groups.push_back(std::move(group));
}

/// The image of the unit cube under corner + x a + y b + z c, for (a, b, c) right-handed.
Mesh parallelepiped(const Point& corner, const Point& a, const Point& b, const Point& c) {
  Mesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.points.push_back(corner + (k & 1) * a + ((k >> 1) & 1) * b + (k >> 2) * c);
  }
  mesh.faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return mesh;
}

Mesh box(const Point& low, const Point& size) {
  return parallelepiped(low, {size[0], 0, 0}, {0, size[1], 0}, {0, 0, size[2]});
}

/// Half a box, cut along a diagonal of its sides across an axis.
Mesh wedge(const Point& low, const Point& size, int axis, int corner_left_out) {
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  std::vector<Point> profile;
  for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
    Point p = low;
    p[u] += x * size[u];
    p[v] += y * size[v];
    profile.push_back(p);
  }
  profile.erase(profile.begin() + corner_left_out);
  Mesh mesh;
  for (const Point& p : profile) mesh.points.push_back(p);
  for (const Point& p : profile) {
    mesh.points.push_back(p);
    mesh.points.back()[axis] += size[axis];
  }
  mesh.faces = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
  return mesh;
}

/// An L-shaped prism: a box without the quarter at the high ends of two axes.
Mesh ell(const Point& low, const Point& size, int axis) {
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const double mu = std::max(1.0, std::floor(size[u] / 2));
  const double mv = std::max(1.0, std::floor(size[v] / 2));
  Mesh mesh;
  for (int k = 0; k < 2; ++k) {
    for (const auto& [x, y] : std::vector<std::pair<double, double>>{{0, 0},
                                                                     {size[u], 0},
                                                                     {size[u], mv},
                                                                     {mu, mv},
                                                                     {mu, size[v]},
                                                                     {0, size[v]}}) {
      Point p = low;
      p[u] += x;
      p[v] += y;
      p[axis] += k * size[axis];
      mesh.points.push_back(p);
    }
  }
  // Each end as two convex faces, so that cuts find convex polygons only.
  mesh.faces = {{3, 2, 1, 0}, {5, 4, 3, 0}, {6, 7, 8, 9}, {6, 9, 10, 11}};
  for (int k = 0; k < 6; ++k) {
    const int next = (k + 1) % 6;
    mesh.faces.push_back({k, next, next + 6, k + 6});
  }
  return mesh;
}

Mesh rectangle(const Point& low, const Point& size, int axis) {
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  Mesh mesh;
  for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
    Point p = low;
    p[u] += x * size[u];
    p[v] += y * size[v];
    mesh.points.push_back(p);
  }
  mesh.faces = {{0, 1, 2, 3}};
  return mesh;
}

Point grid_corner(Random& random, int low, int high) {
  const int x = random.integer(low, high);
  const int y = random.integer(low, high);
  return {double(x), double(y), double(random.integer(low, high))};
}

std::optional<Mesh> tetrahedron(Random& random) {
  Mesh mesh;
  for (int k = 0; k < 4; ++k) mesh.points.push_back(grid_corner(random, 0, kGrid));
  const Sign s = orient3d(mesh.points[0], mesh.points[1], mesh.points[2], mesh.points[3]);
  if (s == Sign::Zero) return std::nullopt;
  // Outwards: the fourth corner behind the first face.
  mesh.faces = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  const Point n =
      (mesh.points[1] - mesh.points[0]).cross(mesh.points[2] - mesh.points[0]);
  if (n.dot(mesh.points[3] - mesh.points[0]) > 0) {
    for (auto& face : mesh.faces) std::ranges::reverse(face);
  }
  return mesh;
}

std::optional<Mesh> triangle(Random& random) {
  Mesh mesh;
  for (int k = 0; k < 3; ++k) mesh.points.push_back(grid_corner(random, 0, kGrid));
  if (collinear(mesh.points[0], mesh.points[1], mesh.points[2])) return std::nullopt;
  mesh.faces = {{0, 1, 2}};
  return mesh;
}

void add_overlapping(PolygonSoup& soup, Random& random) {
  const Point low = grid_corner(random, 0, kGrid - 2);
  const Point size = grid_corner(random, 1, 4);
  switch (random.integer(0, 7)) {
    case 0:
    case 1:
      return add(soup, box(low, size), "box");
    case 2:
    case 3:
      return add(soup, wedge(low, size, random.integer(0, 2), random.integer(0, 3)),
                 "wedge");
    case 4:
      return add(soup, ell(low, size.cwiseMax(2), random.integer(0, 2)), "ell");
    case 5:
      return add(soup, rectangle(low, size, random.integer(0, 2)), "sheet");
    case 6:
      if (const auto mesh = tetrahedron(random)) add(soup, *mesh, "tetrahedron");
      return;
    default:
      if (const auto mesh = triangle(random)) add(soup, *mesh, "triangle");
      return;
  }
}

bool boxes_overlap(const AlignedBox& a, const AlignedBox& b) {
  for (int k = 0; k < 3; ++k) {
    if (a.min[k] >= b.max[k] || b.min[k] >= a.max[k]) return false;
  }
  return true;
}

/// Solids in boxes with disjoint interiors, and sheets against their sides.
struct TouchingPlacer {
  PolygonSoup& soup;
  Random& random;
  std::vector<AlignedBox> taken;

  bool place(const Point& low, const Point& size) {
    AlignedBox b;
    for (int k = 0; k < 3; ++k) {
      b.min[k] = low[k];
      b.max[k] = low[k] + size[k];
    }
    if (std::ranges::any_of(taken, [&](const auto& t) { return boxes_overlap(t, b); })) {
      return false;
    }
    taken.push_back(b);
    return true;
  }
  void ground() {
    const Point low(0, 0, -1), size(kGrid, kGrid, 1);
    if (place(low, size)) add(soup, box(low, size), "ground");
  }
  /// Beside a solid that is there, sharing a part of a side, an edge or a corner.
  void solid() {
    for (int tried = 0; tried < 40; ++tried) {
      const Point size = grid_corner(random, 1, 3);
      Point low = grid_corner(random, 0, kGrid - 1);
      if (!taken.empty()) {
        const AlignedBox& at =
            taken[random.integer(0, static_cast<int>(taken.size()) - 1)];
        const int axis = random.integer(0, 2);
        low[axis] = random.one_in(2) ? at.max[axis] : at.min[axis] - size[axis];
        for (const int k : {(axis + 1) % 3, (axis + 2) % 3}) {
          low[k] = random.integer(static_cast<int>(at.min[k] - size[k]),
                                  static_cast<int>(at.max[k]));
        }
      }
      if (!place(low, size)) continue;
      const int what = random.integer(0, 5);
      const int axis = random.integer(0, 2);
      if (what == 0)
        return add(soup, wedge(low, size, axis, random.integer(0, 3)), "wedge");
      if (what == 1 && size.minCoeff() >= 2)
        return add(soup, ell(low, size, axis), "ell");
      return add(soup, box(low, size), "box");
    }
  }
  /// In the plane of a solid's side, or standing on it.
  void sheet() {
    if (taken.empty()) return;
    const AlignedBox& at = taken[random.integer(0, static_cast<int>(taken.size()) - 1)];
    const int axis = random.integer(0, 2);
    Point low, size;
    for (int k = 0; k < 3; ++k) {
      size[k] = random.integer(1, 3);
      low[k] = random.integer(static_cast<int>(at.min[k] - size[k]),
                              static_cast<int>(at.max[k]));
    }
    const int stand = random.one_in(2) ? axis : (axis + random.integer(1, 2)) % 3;
    low[stand] = random.one_in(2) ? at.max[stand] : at.min[stand];
    add(soup, rectangle(low, size, axis), "sheet");
  }
};

void add_touching(PolygonSoup& soup, Random& random, int count) {
  TouchingPlacer placer{soup, random, {}};
  if (random.one_in(2)) placer.ground();
  // Some find no place beside the others.
  for (int tries = 0; static_cast<int>(soup.groups.size()) < count && tries < 1000;
       ++tries) {
    if (random.one_in(4)) {
      placer.sheet();
    } else {
      placer.solid();
    }
  }
}

/// Several meshes as one object, their equal corners being the same points.
Mesh joined(const std::vector<Mesh>& parts) {
  Mesh mesh;
  std::map<std::array<double, 3>, int> known;
  for (const Mesh& part : parts) {
    std::vector<int> id;
    for (const Point& p : part.points) {
      const auto [at, is_new] =
          known.try_emplace({p[0], p[1], p[2]}, static_cast<int>(mesh.points.size()));
      if (is_new) mesh.points.push_back(p);
      id.push_back(at->second);
    }
    for (std::vector<int> face : part.faces) {
      for (int& v : face) v = id[v];
      mesh.faces.push_back(std::move(face));
    }
  }
  return mesh;
}

/// Two boxes with a common edge or corner, or sheets that meet in one edge, in T, in X.
Mesh non_manifold(Random& random) {
  const Point low = grid_corner(random, 0, kGrid - 3);
  const Point size = grid_corner(random, 1, 2);
  const int axis = random.integer(0, 2);
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const auto side = [&](int along, double du, double dv) {
    Point p = low;
    p[u] += du;
    p[v] += dv;
    return rectangle(p, size, along);
  };
  switch (random.integer(0, 5)) {
    case 0: {  // a common edge
      Point other = low;
      other[u] += size[u];
      other[v] += size[v];
      return joined({box(low, size), box(other, size)});
    }
    case 1:  // a common corner
      return joined({box(low, size), box(low + size, size)});
    case 2:  // a T of three sheets
      return joined({side(u, 0, 0), side(u, 0, size[v]), side(v, 0, size[v])});
    case 3:  // an X of four
      return joined({side(u, 0, 0), side(u, 0, size[v]), side(v, 0, size[v]),
                     side(v, -size[u], size[v])});
    case 4: {  // a fin on a box's edge
      Point p = low;
      p[u] += size[u];
      return joined({box(low, size), rectangle(p, size, v)});
    }
    default: {  // a box standing inside another's side: T-junctions
      Point p = low;
      p[axis] += size[axis];
      return joined({box(low, size + Point(1, 1, 0)), box(p, Point(1, 1, 1))});
    }
  }
}

void repeat_faces(PolygonSoup& soup, Random& random, int share) {
  for (PolygonSoup::Group& group : soup.groups) {
    const std::vector<int> faces = group.faces;
    for (const int f : faces) {
      if (!random.one_in(share)) continue;
      std::vector<int> copy = soup.polygons[f];
      std::ranges::rotate(
          copy, copy.begin() + random.integer(0, static_cast<int>(copy.size()) - 1));
      group.faces.push_back(static_cast<int>(soup.polygons.size()));
      soup.polygons.push_back(std::move(copy));
    }
  }
}

// ---- other ways to write a scene down ----

PolygonSoup reordered(const PolygonSoup& soup, Random& random) {
  const auto permutation = [&](std::size_t n) {
    std::vector<int> p(n);
    std::iota(p.begin(), p.end(), 0);
    random.shuffle(p);
    return p;
  };
  const std::vector<int> new_vertex = permutation(soup.vertices.size());
  const std::vector<int> new_face = permutation(soup.polygons.size());
  PolygonSoup result = soup;
  for (std::size_t v = 0; v < soup.vertices.size(); ++v) {
    result.vertices[new_vertex[v]] = soup.vertices[v];
  }
  for (std::size_t f = 0; f < soup.polygons.size(); ++f) {
    std::vector<int> face = soup.polygons[f];
    for (int& v : face) v = new_vertex[v];
    std::ranges::rotate(
        face, face.begin() + random.integer(0, static_cast<int>(face.size()) - 1));
    result.polygons[new_face[f]] = std::move(face);
  }
  for (PolygonSoup::Group& group : result.groups) {
    for (int& f : group.faces) f = new_face[f];
    std::ranges::sort(group.faces);
  }
  random.shuffle(result.groups);
  return result;
}

using Matrix = Eigen::Matrix3d;

Variant mapped(const std::string& name, const PolygonSoup& soup, const Matrix& m,
               const Point& shift) {
  const Matrix inverse = m.inverse();  // exact for the matrices used here, see its users
  Variant v{name, soup, [m, shift](const Point& p) -> Point { return m * p + shift; },
            [inverse, shift](const Point& p) -> Point { return inverse * (p - shift); }};
  for (Point& p : v.soup.vertices) p = v.map(p);
  if (m.determinant() < 0) {
    for (auto& face : v.soup.polygons) std::ranges::reverse(face);
  }
  return v;
}

Matrix random_axes(Random& random) {
  std::vector<int> axes{0, 1, 2};
  random.shuffle(axes);
  Matrix m = Matrix::Zero();
  for (int k = 0; k < 3; ++k) m(k, axes[k]) = random.one_in(2) ? 1 : -1;
  return m;
}

/// One coordinate plus small multiples of the others: the inverse is of small integers
/// too.
Matrix random_shear(Random& random) {
  Matrix m = Matrix::Identity();
  const int row = random.integer(0, 2);
  for (int k = 1; k < 3; ++k) m(row, (row + k) % 3) = random.integer(-2, 2);
  if (m.isIdentity()) m(row, (row + 1) % 3) = 1;
  return m;
}

/// Cuts the faces and edges of objects, without T-junctions within an object.
class Cutter {
 public:
  Cutter(const PolygonSoup& soup, Random& random) : soup_(soup), random_(random) {
    weld();
  }

  /// Faces along a diagonal, or into a fan around a point inside: a corner of another
  /// object there, or the middle of two corners.
  void cut_facets(int share) {
    for (PolygonSoup::Group& group : soup_.groups) {
      own_ = points_of(group);
      std::map<std::vector<int>, std::vector<std::vector<int>>> done;  // copies alike
      // Edges of other faces of the object: a cut along one would join the two.
      std::set<std::pair<int, int>> taken;
      for (const int f : group.faces) {
        const auto sides = sides_of(soup_.polygons[f]);
        taken.insert(sides.begin(), sides.end());
      }
      std::vector<int> faces = group.faces;
      for (const int f : faces) {
        const std::vector<int> face = soup_.polygons[f];
        std::vector<int> key = face;
        std::ranges::sort(key);
        auto [at, is_new] = done.try_emplace(key);
        if (is_new && random_.one_in(share)) at->second = cut(face);
        if (is_new && !is_apart(face, at->second, taken)) at->second.clear();
        if (at->second.empty()) continue;
        std::vector<std::vector<int>> pieces = at->second;
        if (turned(face, pieces[0])) {
          for (auto& piece : pieces) std::ranges::reverse(piece);
        }
        soup_.polygons[f] = pieces[0];
        for (std::size_t k = 1; k < pieces.size(); ++k) {
          group.faces.push_back(static_cast<int>(soup_.polygons.size()));
          soup_.polygons.push_back(pieces[k]);
        }
      }
    }
  }

  /// Edges at their middles and at corners of others that lie on them, in all faces of
  /// their object.
  void cut_edges(int share, bool middles) {
    for (PolygonSoup::Group& group : soup_.groups) {
      own_ = points_of(group);
      std::map<std::pair<int, int>, std::vector<int>>
          points;  // along the edge, low first
      for (const int f : group.faces) {
        const std::vector<int> face = soup_.polygons[f];
        std::vector<int> result;
        for (std::size_t k = 0; k < face.size(); ++k) {
          const int a = face[k];
          const int b = face[(k + 1) % face.size()];
          const auto key = std::minmax(a, b);
          auto [at, is_new] = points.try_emplace(key);
          if (is_new) at->second = points_on(key.first, key.second, share, middles);
          result.push_back(a);
          std::vector<int> between = at->second;
          if (a > b) std::ranges::reverse(between);
          result.insert(result.end(), between.begin(), between.end());
        }
        soup_.polygons[f] = result;
      }
    }
  }

  [[nodiscard]] const PolygonSoup& soup() const { return soup_; }

 private:
  static std::set<std::pair<int, int>> sides_of(const std::vector<int>& face) {
    std::set<std::pair<int, int>> sides;
    for (std::size_t k = 0; k < face.size(); ++k) {
      sides.insert(std::minmax({face[k], face[(k + 1) % face.size()]}));
    }
    return sides;
  }
  // The edges between the pieces are not taken; they are from now on.
  static bool is_apart(const std::vector<int>& face,
                       const std::vector<std::vector<int>>& pieces,
                       std::set<std::pair<int, int>>& taken) {
    std::set<std::pair<int, int>> between;
    for (const auto& piece : pieces) between.merge(sides_of(piece));
    for (const auto& side : sides_of(face)) between.erase(side);
    for (const auto& side : between) {
      if (taken.contains(side)) return false;
    }
    taken.merge(between);
    return true;
  }
  void weld() {
    std::vector<int> id;
    for (const Point& p : soup_.vertices) id.push_back(point(p));
    soup_.vertices = points_;
    for (auto& face : soup_.polygons) {
      for (int& v : face) v = id[v];
    }
  }
  int point(const Point& p) {
    const auto [at, is_new] =
        known_.try_emplace({p[0], p[1], p[2]}, static_cast<int>(points_.size()));
    if (is_new) points_.push_back(p);
    return at->second;
  }
  int vertex(const Point& p) {
    const int id = point(p);
    soup_.vertices = points_;
    return id;
  }
  const Point& at(int v) const { return points_[v]; }
  std::set<int> points_of(const PolygonSoup::Group& group) const {
    std::set<int> found;
    for (const int f : group.faces) {
      found.insert(soup_.polygons[f].begin(), soup_.polygons[f].end());
    }
    return found;
  }

  /// The piece runs against the face's turn.
  bool turned(const std::vector<int>& face, const std::vector<int>& piece) const {
    const auto normal = [&](const std::vector<int>& f) {
      Point sum = Point::Zero();
      for (std::size_t k = 1; k + 1 < f.size(); ++k) {
        sum += (at(f[k]) - at(f[0])).cross(at(f[k + 1]) - at(f[0]));
      }
      return sum;
    };
    return normal(face).dot(normal(piece)) < 0;
  }

  bool strictly_inside(const std::vector<int>& face, const Point& p) const {
    const Point n = (at(face[1]) - at(face[0])).cross(at(face[2]) - at(face[0]));
    if (n.dot(p - at(face[0])) != 0) return false;
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Point& a = at(face[k]);
      const Point& b = at(face[(k + 1) % face.size()]);
      if (!(n.dot((b - a).cross(p - a)) > 0)) return false;
    }
    return true;
  }

  std::vector<std::vector<int>> cut(const std::vector<int>& face) {
    std::vector<int> inside;
    for (std::size_t v = 0; v < points_.size(); ++v) {
      const int id = static_cast<int>(v);
      if (!own_.contains(id) && strictly_inside(face, points_[v])) inside.push_back(id);
    }
    int centre = -1;
    if (!inside.empty() && !random_.one_in(4)) {
      centre = inside[random_.integer(0, static_cast<int>(inside.size()) - 1)];
    } else if (face.size() > 3 && random_.one_in(2)) {
      const auto n = face.size();
      const int k = random_.integer(0, static_cast<int>(n) - 1);
      std::vector<int> order = face;
      std::ranges::rotate(order, order.begin() + k);
      return {{order[0], order[1], order[2]}, [&] {
                std::vector<int> rest{order[0]};
                rest.insert(rest.end(), order.begin() + 2, order.end());
                return rest;
              }()};
    } else {
      // Half way between a corner and the middle of the side after the next.
      const Point p = (2 * at(face[0]) + at(face[1]) + at(face[2])) / 4;
      if (strictly_inside(face, p)) centre = vertex(p);
      if (own_.contains(centre)) centre = -1;
    }
    std::vector<std::vector<int>> pieces;
    if (centre < 0) return pieces;
    for (std::size_t k = 0; k < face.size(); ++k) {
      pieces.push_back({face[k], face[(k + 1) % face.size()], centre});
    }
    return pieces;
  }

  std::vector<int> points_on(int low, int high, int share, bool middles) {
    std::vector<std::pair<double, int>> found;
    const Point p = at(low);
    const Point d = at(high) - p;
    for (std::size_t v = 0; v < points_.size(); ++v) {
      const int id = static_cast<int>(v);
      if (id == low || id == high || !collinear(p, at(high), points_[v])) continue;
      const double s = d.dot(points_[v] - p) / d.dot(d);
      if (s <= 0 || s >= 1) continue;
      // At a T-junction of the object itself a cut would join what the file does not.
      if (own_.contains(id)) continue;
      if (!middles && random_.one_in(share)) found.emplace_back(s, id);
    }
    if (middles && random_.one_in(share)) {
      const int id = vertex(p + d / 2);
      if (!own_.contains(id)) found.emplace_back(0.5, id);
    }
    std::ranges::sort(found);
    std::vector<int> ids;
    for (const auto& [s, v] : found) ids.push_back(v);
    return ids;
  }

  PolygonSoup soup_;
  Random& random_;
  std::map<std::array<double, 3>, int> known_;
  std::vector<Point> points_;
  std::set<int> own_;  // points of the object whose edges are cut
};

Variant same_place(const std::string& name, PolygonSoup soup) {
  const auto identity = [](const Point& p) -> Point { return p; };
  return {name, std::move(soup), identity, identity};
}

}  // namespace

std::string name(Crowd crowd) {
  switch (crowd) {
    case Crowd::Overlapping:
      return "overlapping";
    case Crowd::Touching:
      return "touching";
    case Crowd::RepeatedFaces:
      return "repeated faces";
    case Crowd::NonManifold:
      return "non-manifold";
  }
  return "?";
}

PolygonSoup crowded_scene(Crowd crowd, std::uint64_t seed) {
  Random random(seed * 4 + static_cast<std::uint64_t>(crowd));
  PolygonSoup soup;
  soup.source = name(crowd) + " " + std::to_string(seed);
  const int count = random.integer(3, 8);
  switch (crowd) {
    case Crowd::Overlapping:
      while (static_cast<int>(soup.groups.size()) < count) add_overlapping(soup, random);
      break;
    case Crowd::Touching:
      add_touching(soup, random, count);
      break;
    case Crowd::RepeatedFaces:
      if (random.one_in(2)) {
        add_touching(soup, random, count);
      } else {
        while (static_cast<int>(soup.groups.size()) < count) {
          add_overlapping(soup, random);
        }
      }
      repeat_faces(soup, random, 3);
      break;
    case Crowd::NonManifold: {
      const int strange = random.integer(1, 3);
      for (int k = 0; k < strange; ++k) add(soup, non_manifold(random), "knot");
      while (static_cast<int>(soup.groups.size()) < count) add_overlapping(soup, random);
      break;
    }
  }
  return soup;
}

std::vector<Variant> variants_of(const PolygonSoup& soup, std::uint64_t seed) {
  Random random(seed);
  std::vector<Variant> result;
  result.push_back(same_place("order", reordered(soup, random)));
  result.push_back(mapped("axes", soup, random_axes(random), Point::Zero()));
  result.push_back(mapped("shear", soup, random_shear(random), Point::Zero()));
  const double far = std::ldexp(1, std::array{20, 24, 40}[random.integer(0, 2)]);
  Point shift = Point::Zero();
  shift[random.integer(0, 2)] = far;
  if (random.one_in(2)) shift[random.integer(0, 2)] = -far;
  result.push_back(mapped("translation", soup, Matrix::Identity(), shift));
  const double scale = std::ldexp(1, random.integer(-40, 40));
  result.push_back(mapped("scale", soup, scale * Matrix::Identity(), Point::Zero()));
  const auto cut = [&](const std::string& name, auto&& how) {
    Cutter cutter(soup, random);
    how(cutter);
    result.push_back(same_place(name, cutter.soup()));
  };
  cut("midpoints", [](Cutter& c) { c.cut_edges(2, true); });
  cut("edges at corners", [](Cutter& c) { c.cut_edges(1, false); });
  cut("facets", [](Cutter& c) { c.cut_facets(2); });
  PolygonSoup repeated = soup;
  repeat_faces(repeated, random, 4);
  result.push_back(same_place("repeated", std::move(repeated)));
  // All at once.
  Cutter cutter(soup, random);
  cutter.cut_facets(3);
  cutter.cut_edges(3, false);
  cutter.cut_edges(6, true);
  PolygonSoup all = cutter.soup();
  repeat_faces(all, random, 8);
  result.push_back(mapped("all at once", reordered(all, random),
                          random_shear(random) * random_axes(random), Point(64, 0, -32)));
  return result;
}

}  // namespace sightline::testing
