#include "tests/shadows/mesh_proof/mesh_plane.h"

#include <algorithm>
#include <cmath>

namespace sightline::testing {
namespace {

double cross_of(const Flat& u, const Flat& v) { return u[0] * v[1] - u[1] * v[0]; }

double value(const std::array<double, 6>& f, const Flat& p) {
  return (f[0] * p[0] + f[1] * p[1] + f[3]) * p[0] + (f[2] * p[1] + f[4]) * p[1] + f[5];
}

Flat gradient(const std::array<double, 6>& f, const Flat& p) {
  return {2 * f[0] * p[0] + f[1] * p[1] + f[3], f[1] * p[0] + 2 * f[2] * p[1] + f[4]};
}

bool curved(const ShadowMesh::Edge& e) {
  return e.conic[0] != 0 || e.conic[1] != 0 || e.conic[2] != 0;
}

Vec3 normal_of(const NaiveShadowFace& face) {
  return cross(face.corners[1] - face.corners[0], face.corners[2] - face.corners[0]);
}

}  // namespace

MeshPlane::MeshPlane(const Scene& scene, std::span<const NaiveShadowFace> faces,
                     const ShadowMesh& mesh, bool front)
    : mesh_(&mesh), low_(mesh.vertices.front()), high_(low_) {
  const auto &x = mesh.frame.x_axis, &y = mesh.frame.y_axis;
  for (int w = 0; w < 3; ++w) {
    const int u = (w + 1) % 3, v = (w + 2) % 3;
    if (x[u] == 1 && x[v] == 0 && y[u] == 0 && y[v] == 1) w_ = w;
  }
  for (const Flat& p : mesh.vertices) {
    low_ = low_.cwiseMin(p);
    high_ = high_.cwiseMax(p);
  }
  // Of a facet that rounding has bent, the face whose corners the mesh has.
  const auto missing = [&](int face) {
    return std::ranges::count_if(faces[face].corners, [&](const Vec3& c) {
      return std::ranges::none_of(mesh.vertices, [&](const Flat& p) {
        return c[(w_ + 1) % 3] == p[0] && c[(w_ + 2) % 3] == p[1];
      });
    });
  };
  const auto& of_facet = scene.facets()[mesh.facet].faces;
  const int face = scene.facets()[mesh.facet].planar
                       ? of_facet[0]
                       : *std::ranges::min_element(of_facet, {}, missing);
  const Vec3 n = normal_of(faces[face]);
  offset_ = dot(n, faces[face].corners[0]);
  normal_ = n;
  if (!front) {
    normal_ = Rational(-1) * n;
    offset_ = -offset_;
  }
  for (int e = 0; e < static_cast<int>(mesh.edges.size()); ++e) {
    std::vector<Flat> line = mesh.edges[e].polyline;
    for (int k = 0; k < (curved(mesh.edges[e]) ? 5 : 0); ++k) {
      std::vector<Flat> finer{line[0]};
      for (std::size_t i = 1; i < line.size(); ++i) {
        const Flat way = line[i] - line[i - 1];
        finer.push_back(
            onto(e, 0.5 * (line[i] + line[i - 1]), Flat(-way[1], way[0]).normalized()));
        finer.push_back(line[i]);
      }
      line = std::move(finer);
    }
    double length = 0;
    for (std::size_t i = 1; i < line.size(); ++i)
      length += (line[i] - line[i - 1]).norm();
    lines_.push_back(std::move(line));
    lengths_.push_back(length);
  }
}

Flat MeshPlane::onto(int edge, Flat p, const Flat& way) const {
  const auto& f = mesh_->edges[edge].conic;
  for (int i = 0; i < 6; ++i) {
    const double slope = gradient(f, p).dot(way);
    if (slope == 0) break;
    p -= value(f, p) / slope * way;
  }
  return p;
}

Vec3 MeshPlane::lift(const Flat& p) const {
  const int u = (w_ + 1) % 3, v = (w_ + 2) % 3;
  Vec3 x;
  x[u] = p[0];
  x[v] = p[1];
  x[w_] = (offset_ - normal_[u] * x[u] - normal_[v] * x[v]) / normal_[w_];
  return x;
}

MeshPlane::EdgePoint MeshPlane::edge_point(int edge, double t) const {
  const std::vector<Flat>& line = lines_[edge];
  double left = t * lengths_[edge];
  std::size_t k = 0;
  while (k + 2 < line.size() && left > (line[k + 1] - line[k]).norm()) {
    left -= (line[k + 1] - line[k]).norm();
    ++k;
  }
  const Flat way = (line[k + 1] - line[k]).normalized();
  const Flat across(-way[1], way[0]);
  EdgePoint point{line[k] + left * way, across};
  if (!curved(mesh_->edges[edge])) return point;
  point.at = onto(edge, point.at, across);
  const Flat slope = gradient(mesh_->edges[edge].conic, point.at).normalized();
  point.left = slope.dot(across) < 0 ? Flat(-slope) : slope;
  return point;
}

void MeshPlane::add_crossings(int edge, const Flat& p, const Flat& q,
                              std::vector<Crossing>& out) const {
  const std::vector<Flat>& line = lines_[edge];
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const Flat &a = line[k], &b = line[k + 1];
    const double s = cross_of(b - a, p - a), t = cross_of(b - a, q - a);
    if ((s > 0) == (t > 0)) continue;
    const double u = cross_of(q - p, a - p), v = cross_of(q - p, b - p);
    if ((u > 0) == (v > 0)) continue;
    double at = s / (s - t);
    if (curved(mesh_->edges[edge])) {
      const Flat x = onto(edge, p + at * (q - p), (q - p).normalized());
      const double better = (x - p).dot(q - p) / (q - p).squaredNorm();
      if (std::abs(better - at) * (q - p).norm() < 0.1 * lengths_[edge]) at = better;
    }
    out.push_back({at, edge, t > 0});
  }
}

std::vector<MeshPlane::Crossing> MeshPlane::crossings(const Flat& p,
                                                      const Flat& q) const {
  std::vector<Crossing> result;
  for (int e = 0; e < static_cast<int>(lines_.size()); ++e)
    add_crossings(e, p, q, result);
  std::ranges::sort(result, {}, &Crossing::at);
  return result;
}

}  // namespace sightline::testing
