#include "tests/shadows/mesh_walk.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

namespace sightline::testing {
namespace {

using Flat = Eigen::Vector2d;

struct Crossing {
  double at;
  int edge;
  bool to_left;  // towards the left face of the edge
};

double cross(const Flat& u, const Flat& v) { return u[0] * v[1] - u[1] * v[0]; }

// Where the segment from p to q crosses a polyline.
void add_crossings(const ShadowMesh& mesh, int e, const Flat& p, const Flat& q,
                   std::vector<Crossing>& out) {
  const auto& line = mesh.edges[e].polyline;
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const Flat &a = line[k], &b = line[k + 1];
    const double s = cross(b - a, p - a), t = cross(b - a, q - a);
    if ((s > 0) == (t > 0)) continue;
    const double u = cross(q - p, a - p), v = cross(q - p, b - p);
    if ((u > 0) == (v > 0)) continue;
    out.push_back({s / (s - t), e, t > 0});
  }
}

// Of a facet that rounding has bent, the face in whose plane the mesh lies.
int face_of(const Scene& scene, const ShadowMesh& mesh) {
  const Eigen::Vector3d normal = mesh.frame.x_axis.cross(mesh.frame.y_axis);
  const auto& faces = scene.facets()[mesh.facet].faces;
  const auto off = [&](int face) {
    double most = 0;
    for (const int p : scene.face_points(face))
      most = std::max(most, std::abs(normal.dot(scene.point(p) - mesh.frame.origin)));
    return most;
  };
  return *std::ranges::min_element(faces, {}, off);
}

std::string told(const std::vector<SeenBoundary>& boundaries) {
  std::ostringstream out;
  for (const SeenBoundary& b : boundaries) {
    out << b.source_face << ':';
    for (const auto& names : b.sides) {
      out << ' ';
      for (const SeenSide& n : names) out << "SECH"[static_cast<int>(n.kind)] << n.id;
    }
    out << " | ";
  }
  return out.str();
}

}  // namespace

MeshWalk walk_mesh(const Scene& scene, const BackprojectionIndex& light,
                   const Shadows& shadows, const ShadowMesh& mesh, bool front,
                   std::uint64_t seed, int count, int samples) {
  MeshWalk walk;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  Flat low = mesh.vertices.front(), high = low;
  for (const Flat& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  const double size = (high - low).maxCoeff();
  const int face = face_of(scene, mesh);
  const auto point = [&] {
    return Flat(low + (high - low).cwiseProduct(Flat(unit(random), unit(random))));
  };
  for (int i = 0; i < count; ++i) {
    const Flat p = point(), q = point();
    std::vector<Crossing> crossings;
    for (int e = 0; e < static_cast<int>(mesh.edges.size()); ++e)
      add_crossings(mesh, e, p, q, crossings);
    std::ranges::sort(crossings, {}, &Crossing::at);
    walk.crossings += static_cast<int>(crossings.size());
    for (std::size_t c = 0; c + 1 < crossings.size(); ++c) {
      const Crossing &from = crossings[c], &to = crossings[c + 1];
      const ShadowMesh::Edge &e = mesh.edges[from.edge], &g = mesh.edges[to.edge];
      const int here = from.to_left ? e.left : e.right;
      // Polylines of conics are chords: near them the sides may be told wrong.
      const double slack = (e.polyline.size() > 2 || g.polyline.size() > 2) ? 1e-2 : 1e-9;
      if ((to.at - from.at) * (q - p).norm() < slack * size) continue;
      const int there = to.to_left ? g.right : g.left;
      // Two edges so near to each other may have been told in the wrong order.
      const auto near = [&](std::size_t k) {
        return k < crossings.size() && (crossings[k + 1].at - crossings[k].at) < 1e-9;
      };
      if ((c > 0 && near(c - 1)) || (c + 2 < crossings.size() && near(c + 1))) continue;
      if (here != there) {
        walk.differences.push_back("face " + std::to_string(here) + " becomes " +
                                   std::to_string(there) + " on the way");
        continue;
      }
      if (here < 0) continue;
      ++walk.stretches;
      for (int k = 0; k < samples; ++k) {
        const double inset = slack > 1e-3 ? 0.25 : 0.01;
        const double t =
            from.at + (to.at - from.at) * (inset + (1 - 2 * inset) * unit(random));
        const Flat x = p + t * (q - p);
        const Point at =
            mesh.frame.origin + x[0] * mesh.frame.x_axis + x[1] * mesh.frame.y_axis;
        Backprojection seen = light.from(shadow_point_on_face(scene, face, at, front),
                                         {.boundaries = true});
        for (SeenBoundary& b : seen.boundaries) b.corners.clear();
        const ShadowMesh::Face& f = mesh.faces[here];
        const std::string expected = told(shadows.structures[f.structure]);
        if (told(seen.boundaries) == expected && seen.shadow == f.shadow) continue;
        std::ostringstream out;
        out.precision(17);
        out << "facet " << mesh.facet << " at " << at.transpose() << ": "
            << told(seen.boundaries) << " but the mesh says " << expected;
        walk.differences.push_back(out.str());
        break;
      }
    }
  }
  return walk;
}

}  // namespace sightline::testing
