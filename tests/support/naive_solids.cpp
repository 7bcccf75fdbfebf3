#include <map>
#include <utility>

#include "tests/support/naive_ev.h"
#include "tests/support/naive_solids_internal.h"

namespace sightline::testing {

Solids::Solids(const PolygonSoup& soup) {
  for (std::size_t s = 0; s < soup.groups.size(); ++s) {
    const int solid = static_cast<int>(s);
    std::map<Coordinates, int> ids;
    std::map<std::pair<int, int>, int> sides;  // directed side -> face
    faces_of_solid.emplace_back();
    for (const int f : soup.groups[s].faces) {
      SolidFace face;
      face.solid = solid;
      const int face_id = static_cast<int>(faces.size());
      for (const int v : soup.polygons[f]) {
        const Point& p = soup.vertices[v];
        const Coordinates key = {p[0] + 0.0, p[1] + 0.0, p[2] + 0.0};
        const auto [it, is_new] = ids.try_emplace(key, static_cast<int>(vertices.size()));
        if (is_new) {
          coordinates.push_back(key);
          vertices.push_back({Number(key[0]), Number(key[1]), Number(key[2])});
          solid_of_vertex.push_back(solid);
          faces_of_vertex.emplace_back();
        }
        face.vertices.push_back(it->second);
        faces_of_vertex[it->second].push_back(face_id);
      }
      for (std::size_t i = 0; i < face.vertices.size(); ++i) {
        sides[{face.vertices[i], face.vertices[(i + 1) % face.vertices.size()]}] =
            face_id;
      }
      face.plane = plane_through(vertices[face.vertices[0]], vertices[face.vertices[1]],
                                 vertices[face.vertices[2]]);
      faces_of_solid.back().push_back(face_id);
      faces.push_back(std::move(face));
    }
    for (const auto& [side, left] : sides) {
      if (side.first > side.second) continue;
      const auto twin = sides.find({side.second, side.first});
      if (twin == sides.end()) throw NotGeneral("a group is not closed");
      edges.push_back({side.first, side.second, left, twin->second, solid});
    }
    for (const int f : faces_of_solid.back()) {
      for (const auto& [key, v] : ids) {
        const bool on_face = std::ranges::count(faces[f].vertices, v) > 0;
        const int side = sign_of(faces[f].plane(vertices[v]));
        if (side > 0) throw NotGeneral("a group is not convex and outward");
        if (on_face && side != 0) throw NotGeneral("a face is not planar");
        if (!on_face && side == 0) throw NotGeneral("a group has coplanar faces");
      }
    }
  }
}

GeneratorKey Solids::vertex_key(int v, Met met) const {
  return {met == Met::End ? 'v' : 'V', {coordinates[v]}};
}

GeneratorKey Solids::edge_key(int e, Met met) const {
  GeneratorKey key{met == Met::End ? 'e' : 'E',
                   {coordinates[edges[e].a], coordinates[edges[e].b]}};
  std::ranges::sort(key.points);
  return key;
}

GeneratorKey Solids::face_key(int f) const {
  GeneratorKey key{'F', {}};
  for (const int v : faces[f].vertices) key.points.push_back(coordinates[v]);
  std::ranges::sort(key.points);
  return key;
}

bool Solids::supports_at_vertex(int v, const Vector& direction) const {
  return does_not_enter(faces_of_vertex[v], direction);
}

bool Solids::supports_at_edge(int e, const Vector& direction) const {
  return does_not_enter({edges[e].left, edges[e].right}, direction);
}

}  // namespace sightline::testing
