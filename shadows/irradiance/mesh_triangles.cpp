#include "shadows/irradiance/mesh_triangles.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>

#include <map>

#include "linespace/picture/classes.h"

namespace sightline::internal {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<
    Kernel, CGAL::Triangulation_face_base_with_info_2<int, Kernel>>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel,
    CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_2<Kernel>,
                                         FaceBase>,
    CGAL::Exact_predicates_tag>;
using Vertex = Triangulation::Vertex_handle;
using Face = Triangulation::Face_handle;

class Triangulator {
 public:
  explicit Triangulator(const ShadowMesh& mesh) {
    for (const ShadowMesh::Edge& edge : mesh.edges) insert(edge);
    int count = 0;
    for (const Face f : delaunay_.finite_face_handles()) f->info() = count++;
    all_.assign(delaunay_.finite_face_handles().begin(),
                delaunay_.finite_face_handles().end());
  }

  MeshTriangles triangles() {
    const std::vector<int> faces = mesh_faces();
    Classes nodes(6 * all_.size());
    join_nodes(nodes);
    MeshTriangles out;
    std::map<int, int> numbers;
    for (std::size_t t = 0; t < all_.size(); ++t) {
      if (faces[t] == -1) continue;
      MeshTriangle triangle;
      triangle.face = faces[t];
      for (int i = 0; i < 3; ++i) {
        const auto& p = all_[t]->vertex(i)->point();
        triangle.corners[i] = {p.x(), p.y()};
      }
      for (int i = 0; i < 6; ++i) {
        const int root = nodes.root(static_cast<int>(6 * t) + i);
        triangle.nodes[i] =
            numbers.try_emplace(root, static_cast<int>(numbers.size())).first->second;
      }
      out.triangles.push_back(triangle);
    }
    out.node_count = static_cast<int>(numbers.size());
    return out;
  }

 private:
  void insert(const ShadowMesh::Edge& edge) {
    Vertex last;
    for (const Eigen::Vector2d& p : edge.polyline) {
      const Vertex v = delaunay_.insert(Kernel::Point_2(p.x(), p.y()));
      if (last != Vertex() && last != v) {
        delaunay_.insert_constraint(last, v);
        left_[{last, v}] = edge.left;
        left_[{v, last}] = edge.right;
      }
      last = v;
    }
  }

  // Of each triangle the mesh's face: told by an edge of the mesh along one of its sides,
  // or by a neighbour.
  [[nodiscard]] std::vector<int> mesh_faces() const {
    Classes parts(all_.size());
    for (const Face f : all_) {
      for (int i = 0; i < 3; ++i) {
        const Face g = f->neighbor(i);
        if (f->is_constrained(i) || delaunay_.is_infinite(g)) continue;
        parts.join(f->info(), g->info());
      }
    }
    std::vector<int> of_part(all_.size(), MeshTriangle::kUnknown);
    for (const Face f : all_) {
      for (int i = 0; i < 3; ++i) {
        const auto it = left_.find({f->vertex((i + 1) % 3), f->vertex((i + 2) % 3)});
        if (it != left_.end()) of_part[parts.root(f->info())] = it->second;
      }
    }
    std::vector<int> faces;
    for (const Face f : all_) faces.push_back(of_part[parts.root(f->info())]);
    return faces;
  }

  void join_nodes(Classes& nodes) const {
    for (const Face f : all_) {
      for (int i = 0; i < 3; ++i) {
        const Face g = f->neighbor(i);
        if (f->is_constrained(i) || delaunay_.is_infinite(g)) continue;
        for (const int c : {(i + 1) % 3, (i + 2) % 3})
          nodes.join(6 * f->info() + c, 6 * g->info() + g->index(f->vertex(c)));
        // Side i lies opposite corner i: its middle is the node 3 + (i + 1) % 3.
        nodes.join(6 * f->info() + 3 + (i + 1) % 3,
                   6 * g->info() + 3 + (g->index(f) + 1) % 3);
      }
    }
  }

  Triangulation delaunay_;
  std::vector<Face> all_;
  std::map<std::pair<Vertex, Vertex>, int> left_;
};

}  // namespace

MeshTriangles mesh_triangles(const ShadowMesh& mesh) {
  return Triangulator(mesh).triangles();
}

}  // namespace sightline::internal
