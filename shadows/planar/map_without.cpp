// The map after edges are taken out; told in planar_map.h.

#include <algorithm>

#include "linespace/picture/classes.h"
#include "linespace/scene.h"
#include "shadows/planar/map_faces.h"
#include "shadows/planar/planar_map.h"

namespace sightline::internal {
namespace {

class Reduction {
 public:
  Reduction(const PlanarData& old, std::span<const int> edges)
      : old_(old), removed_(old.edges.size(), 0), degree_(old.vertices.size(), 0) {
    for (const int e : edges) {
      if (old.edges[e].outline) throw InvalidInput("a planar map keeps its outline");
      removed_[e] = 1;
    }
    for (std::size_t e = 0; e < removed_.size(); ++e) {
      if (removed_[e]) continue;
      for (const int v : old_.edges[e].ends) ++degree_[v];
    }
  }

  PlanarData run() {
    map_.geometry = old_.geometry;
    join_edges();
    number_vertices();
    find_faces(map_);
    return map_;
  }

  /// Of old edges; -1: taken out.
  std::vector<int> edge_of;

  [[nodiscard]] std::vector<int> face_of() const {
    Classes joined(old_.faces.size());
    for (std::size_t e = 0; e < removed_.size(); ++e) {
      if (removed_[e]) joined.join(old_.face[2 * e], old_.face[2 * e + 1]);
    }
    std::vector<int> of_set(old_.faces.size(), -1);
    for (std::size_t h = 0; h < old_.face.size(); ++h) {
      const int f = old_.face[h];
      if (removed_[h >> 1] || f < 0) continue;
      of_set[joined.root(f)] = map_.face[2 * edge_of[h >> 1] + (h & 1)];
    }
    std::vector<int> out(old_.faces.size());
    for (std::size_t f = 0; f < out.size(); ++f) {
      out[f] = of_set[joined.root(static_cast<int>(f))];
    }
    return out;
  }

 private:
  // f follows e on one curve, and nothing else is left where they meet.
  [[nodiscard]] bool continues(int e, int f) const {
    const PlanarEdge& first = old_.edges[e];
    const PlanarEdge& second = old_.edges[f];
    return first.arc == second.arc && first.ends[1] == second.ends[0] &&
           first.position[1] == second.position[0] && degree_[first.ends[1]] == 2 &&
           first.outline == second.outline &&
           first.inside_of_first == second.inside_of_first &&
           std::ranges::equal(old_.curves[e], old_.curves[f]) &&
           !(first.outline && is_corner(first.arc, first.position[1]));
  }
  [[nodiscard]] bool is_corner(int arc, int position) const {
    return std::ranges::binary_search(old_.geometry->corners[arc], position);
  }

  // The edges of an arc stand in its order.
  void join_edges() {
    edge_of.assign(old_.edges.size(), -1);
    int last = -1;
    for (int e = 0; e < static_cast<int>(old_.edges.size()); ++e) {
      if (removed_[e]) continue;
      if (last >= 0 && continues(last, e)) {
        PlanarEdge& joined = map_.edges.back();
        joined.ends[1] = old_.edges[e].ends[1];
        joined.position[1] = old_.edges[e].position[1];
        degree_[old_.edges[e].ends[0]] = 0;
      } else {
        map_.edges.push_back(old_.edges[e]);
        map_.curves.add(old_.curves[e]);
      }
      edge_of[e] = static_cast<int>(map_.edges.size()) - 1;
      last = e;
    }
  }

  // Vertices that are left keep their order, and so do half-edges around them.
  void number_vertices() {
    std::vector<int> number(old_.vertices.size(), -1);
    std::vector<int> star;
    for (int v = 0; v < static_cast<int>(number.size()); ++v) {
      if (degree_[v] == 0) continue;
      number[v] = static_cast<int>(map_.vertices.size());
      map_.vertices.push_back(old_.vertices[v]);
      star.clear();
      for (const int h : old_.stars[v]) {
        if (!removed_[h >> 1]) star.push_back(2 * edge_of[h >> 1] + (h & 1));
      }
      map_.stars.add(star);
    }
    for (PlanarEdge& e : map_.edges) {
      for (int& v : e.ends) v = number[v];
    }
  }

  const PlanarData& old_;
  std::vector<char> removed_;
  std::vector<int> degree_;  // 0 also of a vertex that joined two edges
  PlanarData map_;
};

}  // namespace

ReducedMap PlanarMap::without(std::span<const int> edges) const {
  Reduction reduction(*data_, edges);
  auto map = std::make_shared<const PlanarData>(reduction.run());
  return {PlanarMap(std::move(map)), reduction.edge_of, reduction.face_of()};
}

}  // namespace sightline::internal
