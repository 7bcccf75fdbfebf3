#include "skeleton/nodes/node_line.h"

#include <CGAL/Gmpq.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <vector>

#include "linespace/lines/transversals.h"
#include "linespace/silhouettes/silhouettes.h"
#include "linespace/swaths/edge_cuts.h"

namespace sightline::internal {
namespace {

bool is_zero(const ExactPoint& a) { return a[0] == 0 && a[1] == 0 && a[2] == 0; }

// normal x = offset.
struct Plane {
  ExactPoint normal;
  Rational offset;
};
Plane plane_through(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c) {
  ExactPoint n = exact_cross(exact_difference(b, a), exact_difference(c, a));
  Rational offset = exact_dot(n, a);
  return {std::move(n), std::move(offset)};
}

using Points = std::array<ExactPoint, 2>;

// The common line of the first two planes that are not parallel.
std::optional<Points> common_line(const std::vector<Plane>& planes) {
  for (std::size_t j = 1; j < planes.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      const auto& [n, c] = planes[i];
      const auto& [m, d] = planes[j];
      const ExactPoint way = exact_cross(n, m);
      if (is_zero(way)) continue;
      // x = (c m x way + d way x n) / way^2.
      const ExactPoint a = exact_cross(m, way);
      const ExactPoint b = exact_cross(way, n);
      const Rational size = exact_dot(way, way);
      ExactPoint x, y;
      for (int k = 0; k < 3; ++k) {
        x[k] = (c * a[k] + d * b[k]) / size;
        y[k] = x[k] + way[k];
      }
      return Points{x, y};
    }
  }
  return std::nullopt;
}

Rational rational(const Ring& x) {
  const CGAL::Gmpq q(x);
  Rational r;
  mpq_set(r.backend().data(), q.mpq());
  return r;
}

// x / y where that is rational.
Rational ratio(const Surd& x, const Surd& y, const Ring& d,
               const std::optional<Ring>& root) {
  if (root) return rational(x.a + x.b * *root) / rational(y.a + y.b * *root);
  // By the conjugate of y: the part with the root is zero.
  return rational(x.a * y.a - x.b * y.b * d) / rational(y.a * y.a - y.b * y.b * d);
}

class NodeLines {
 public:
  NodeLines(const Scene& scene, std::span<const Generator> generators)
      : scene_(scene), generators_(generators) {
    for (const Generator& g : generators) {
      (g.kind == GeneratorKind::Vertex ? vertices_
       : g.kind == GeneratorKind::Edge ? edges_
                                       : facets_)
          .push_back(g.id);
    }
  }

  [[nodiscard]] std::optional<Points> rational_line(const SkeletonNode& node) const {
    if (vertices_.size() >= 2)
      return Points{point(vertices_.front()), point(vertices_.back())};
    if (node.kind == NodeKind::Pierce) {
      const auto x = pierced();
      if (!x) return std::nullopt;
      return vertices_.empty() ? through(*x) : Points{point(vertices_[0]), *x};
    }
    if (vertices_.size() == 1) return through(point(vertices_[0]));
    if (facets_.empty()) return std::nullopt;
    if (facets_.size() > 1) {
      std::vector<Plane> planes;
      for (const int f : facets_) planes.push_back(plane_of(f));
      if (const auto line = common_line(planes)) return line;
    }
    // Of a facet with several planes the one nearest to the node.
    std::optional<Points> nearest;
    double least = std::numeric_limits<double>::infinity();
    for (const Plane& plane : planes_of(facets_[0])) {
      const auto line = across(plane);
      if (!line) continue;
      const double off =
          distance(*line, node.segment[0]) + distance(*line, node.segment[1]);
      if (off < least) {
        least = off;
        nearest = line;
      }
    }
    return nearest;
  }

  // Through four of the edges, where these leave two lines at most, and meeting all.
  [[nodiscard]] std::vector<ExactLine> through_edges() const {
    const std::size_t n = edges_.size();
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t b = a + 1; b < n; ++b) {
        for (std::size_t c = b + 1; c < n; ++c) {
          for (std::size_t d = c + 1; d < n; ++d) {
            auto lines = transversals(line(a), line(b), line(c), line(d)).lines;
            if (lines.empty()) continue;
            std::erase_if(lines, [&](const ExactLine& l) { return !meets_all(l); });
            return lines;
          }
        }
      }
    }
    return {};
  }

  [[nodiscard]] LineThrough line(std::size_t edge) const {
    const auto& p = scene_.edges()[edges_[edge]].points;
    return {scene_.point(p[0]), scene_.point(p[1])};
  }
  [[nodiscard]] std::size_t edge_count() const { return edges_.size(); }

  // The line passes all corners, meets all edges' lines, and lies in all facets' planes.
  [[nodiscard]] bool touches_all(const Points& at, NodeKind kind) const {
    const auto& [a, b] = at;
    if (is_zero(exact_difference(b, a))) return false;
    return std::all_of(generators_.begin(), generators_.end(), [&](const Generator& g) {
      if (g.kind == GeneratorKind::Vertex)
        return is_zero(
            exact_cross(exact_difference(b, a), exact_difference(point(g.id), a)));
      if (g.kind == GeneratorKind::Edge) {
        const auto& p = scene_.edges()[g.id].points;
        return exact_orient(a, b, point(p[0]), point(p[1])) == 0;
      }
      if (kind == NodeKind::Pierce) return true;
      const auto planes = planes_of(g.id);
      return std::any_of(planes.begin(), planes.end(), [&](const Plane& p) {
        return exact_dot(p.normal, a) == p.offset && exact_dot(p.normal, b) == p.offset;
      });
    });
  }

 private:
  [[nodiscard]] ExactPoint point(int id) const { return exact_point(scene_.point(id)); }
  [[nodiscard]] Plane plane_of_face(int face) const {
    const auto p = plane_points(scene_, face);
    return plane_through(point(p[0]), point(p[1]), point(p[2]));
  }
  [[nodiscard]] Plane plane_of(int facet) const {
    return plane_of_face(scene_.facets()[facet].faces.front());
  }
  // All that a facet which is flat only by tolerance has.
  [[nodiscard]] std::vector<Plane> planes_of(int facet) const {
    if (scene_.facets()[facet].planar) return {plane_of(facet)};
    std::vector<Plane> out;
    for (const int f : scene_.facets()[facet].faces) out.push_back(plane_of_face(f));
    return out;
  }
  [[nodiscard]] bool meets_all(const ExactLine& l) const {
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      if (l.side(line(i)) != Sign::Zero || l.is_parallel(line(i))) return false;
    }
    return true;
  }

  // The line through x in the planes of it and the edges, and of the facets at it.
  [[nodiscard]] std::optional<Points> through(const ExactPoint& x) const {
    std::vector<Plane> planes;
    for (const int e : edges_) {
      const auto& p = scene_.edges()[e].points;
      Plane plane = plane_through(x, point(p[0]), point(p[1]));
      if (!is_zero(plane.normal)) planes.push_back(std::move(plane));
    }
    for (const int f : facets_) {
      for (Plane& plane : planes_of(f)) {
        if (exact_dot(plane.normal, x) == plane.offset)
          planes.push_back(std::move(plane));
      }
    }
    return common_line(planes);
  }

  [[nodiscard]] static double distance(const Points& line, const Point& p) {
    const Point a = rounded(line[0]);
    const Point way = rounded(line[1]) - a;
    return way.cross(p - a).norm() / way.norm();
  }

  // Where the edges cross the plane that the line lies in.
  [[nodiscard]] std::optional<Points> across(const Plane& plane) const {
    std::vector<ExactPoint> met;
    for (const int e : edges_) {
      const auto x = crossing(e, plane);
      if (!x) continue;
      if (!met.empty() && !is_zero(exact_difference(*x, met.front())))
        return Points{met.front(), *x};
      if (met.empty()) met.push_back(*x);
    }
    return std::nullopt;
  }
  [[nodiscard]] std::optional<ExactPoint> crossing(int edge, const Plane& plane) const {
    const auto& p = scene_.edges()[edge].points;
    const ExactPoint a = point(p[0]);
    const ExactPoint b = point(p[1]);
    const Rational from = exact_dot(plane.normal, a) - plane.offset;
    const Rational to = exact_dot(plane.normal, b) - plane.offset;
    if (from == to) return std::nullopt;
    return along(a, b, from / (from - to));
  }

  // Where an outer edge enters a face, which is listed next to it.
  [[nodiscard]] std::optional<ExactPoint> pierced() const {
    if (facets_.size() != 1 || edges_.empty()) return std::nullopt;
    const bool at_front = generators_[1].kind == GeneratorKind::Face &&
                          generators_[0].kind == GeneratorKind::Edge;
    return crossing(at_front ? edges_.front() : edges_.back(), plane_of(facets_[0]));
  }

  const Scene& scene_;
  std::span<const Generator> generators_;
  std::vector<int> vertices_, edges_, facets_;
};

}  // namespace

std::array<ExactPoint, 2> points_of(const ExactLine& line) {
  const ExactLine::Coordinates& c = line.coordinates();
  const auto root = rational_root(c.radicand);
  int axis = 0;
  while (internal::is_zero(c.d[axis], c.radicand)) ++axis;
  ExactPoint way, moment;
  for (int i = 0; i < 3; ++i) {
    way[i] = ratio(c.d[i], c.d[axis], c.radicand, root);
    moment[i] = ratio(c.m[i], c.d[axis], c.radicand, root);
  }
  const Rational size = exact_dot(way, way);
  ExactPoint x = exact_cross(way, moment);
  for (Rational& coordinate : x) coordinate /= size;
  return {x, ExactPoint{x[0] + way[0], x[1] + way[1], x[2] + way[2]}};
}

std::optional<NodeLine> line_of_node(const Scene& scene, const Skeleton& skeleton,
                                     const SkeletonNode& node) {
  const NodeLines lines(scene, skeleton.generators(node));
  if (const auto points = lines.rational_line(node)) {
    if (!lines.touches_all(*points, node.kind)) return std::nullopt;
    return NodeLine{*points, std::nullopt};
  }
  if (lines.edge_count() < 4) return std::nullopt;
  const auto off = [&](const ExactLine& l) {
    return std::min((l.contact(lines.line(0)).point - node.segment[0]).norm(),
                    (l.contact(lines.line(0)).point - node.segment[1]).norm());
  };
  const auto all = lines.through_edges();
  if (all.empty()) return std::nullopt;
  const ExactLine& found = *std::min_element(
      all.begin(), all.end(),
      [&](const ExactLine& a, const ExactLine& b) { return off(a) < off(b); });
  if (!found.is_rational()) return NodeLine{{}, found};
  return NodeLine{points_of(found), std::nullopt};
}

}  // namespace sightline::internal
