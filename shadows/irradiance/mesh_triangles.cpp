#include "shadows/irradiance/mesh_triangles.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "linespace/picture/classes.h"

namespace sightline::internal {
namespace {

// Of a point of the input; -1 of one where constraints cross.
struct PointNumber {
  int value = -1;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<
    Kernel, CGAL::Triangulation_face_base_with_info_2<int, Kernel>>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel,
    CGAL::Triangulation_data_structure_2<
        CGAL::Triangulation_vertex_base_with_info_2<PointNumber, Kernel>, FaceBase>,
    CGAL::Exact_predicates_tag>;
using Vertex = Triangulation::Vertex_handle;
using Face = Triangulation::Face_handle;

class Triangulator {
 public:
  explicit Triangulator(const std::vector<MeshChord>& chords) : chords_(&chords) {
    insert_points();
    for (std::size_t c = 0; c < chords.size(); ++c) {
      const auto [from, to] = ends_[c];
      if (from == to) continue;
      delaunay_.insert_constraint(vertices_[from], vertices_[to]);
      chord_[{from, to}] = static_cast<int>(c);
    }
    int count = 0;
    for (const Face f : delaunay_.finite_face_handles()) {
      f->info() = count++;
      all_.push_back(f);
    }
  }

  std::vector<MeshTriangle> triangles() {
    find_faces();
    std::vector<MeshTriangle> out;
    for (std::size_t t = 0; t < all_.size(); ++t) {
      if (faces_[t] == -1) continue;
      MeshTriangle triangle{{}, faces_[t], errors_[t]};
      for (int i = 0; i < 3; ++i) {
        const auto& p = all_[t]->vertex(i)->point();
        triangle.corners[i] = {p.x(), p.y()};
      }
      out.push_back(triangle);
    }
    return out;
  }

 private:
  // All at once, which is faster than one by one.
  void insert_points() {
    std::map<std::pair<double, double>, int> numbers;
    std::vector<std::pair<Kernel::Point_2, PointNumber>> points;
    const auto number = [&](const Eigen::Vector2d& p) {
      const auto [it, is_new] =
          numbers.try_emplace({p.x(), p.y()}, static_cast<int>(numbers.size()));
      if (is_new)
        points.emplace_back(Kernel::Point_2(p.x(), p.y()), PointNumber{it->second});
      return it->second;
    };
    for (const MeshChord& chord : *chords_)
      ends_.push_back({number(chord.from), number(chord.to)});
    delaunay_.insert(points.begin(), points.end());
    vertices_.resize(points.size());
    for (const Vertex v : delaunay_.finite_vertex_handles())
      vertices_[v->info().value] = v;
  }

  // The chord from one corner of a triangle to the next, and whether it runs that way.
  [[nodiscard]] std::pair<const MeshChord*, bool> chord(Vertex from, Vertex to) const {
    std::pair key(from->info().value, to->info().value);
    for (const bool forward : {true, false}) {
      const auto it = chord_.find(key);
      if (it != chord_.end()) return {&(*chords_)[it->second], forward};
      std::swap(key.first, key.second);
    }
    return {nullptr, true};
  }

  // Of each triangle the mesh's face: told by a chord along one of its sides, or by a
  // neighbour.
  void find_faces() {
    Classes parts(all_.size());
    for (const Face f : all_) {
      for (int i = 0; i < 3; ++i) {
        const Face g = f->neighbor(i);
        if (f->is_constrained(i) || delaunay_.is_infinite(g)) continue;
        parts.join(f->info(), g->info());
      }
    }
    errors_.assign(all_.size(), 0);
    std::vector<int> of_part(all_.size(), MeshTriangle::kUnknown);
    for (const Face f : all_) {
      for (int i = 0; i < 3; ++i) {
        if (!f->is_constrained(i)) continue;
        const auto [along, forward] =
            chord(f->vertex((i + 1) % 3), f->vertex((i + 2) % 3));
        if (along == nullptr) continue;
        of_part[parts.root(f->info())] = forward ? along->left : along->right;
        errors_[f->info()] = std::max(errors_[f->info()], along->error);
      }
    }
    for (const Face f : all_) faces_.push_back(of_part[parts.root(f->info())]);
  }

  const std::vector<MeshChord>* chords_;
  Triangulation delaunay_;
  std::vector<std::array<int, 2>> ends_;  // of chords, as numbers of points
  std::vector<Vertex> vertices_;
  std::map<std::pair<int, int>, int> chord_;  // by ends
  std::vector<Face> all_;
  std::vector<int> faces_;
  std::vector<double> errors_;
};

}  // namespace

std::vector<MeshTriangle> mesh_triangles(const std::vector<MeshChord>& chords) {
  return Triangulator(chords).triangles();
}

}  // namespace sightline::internal
