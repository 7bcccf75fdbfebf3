#include "viewers/files/shadow_vtk.h"

#include <algorithm>

#include "viewers/pictures/trapezoids.h"
#include "viewers/queries/mesh_answer.h"
#include "viewers/queries/shadow_answer.h"

namespace sightline::viewers {
namespace {

using internal::Stage;
using Ring = std::vector<Eigen::Vector2d>;

Point in_space(const ShadowMesh& mesh, const Eigen::Vector2d& p) {
  return mesh.frame.origin + p[0] * mesh.frame.x_axis + p[1] * mesh.frame.y_axis;
}

Colour colour_of(ShadowClass shadow) {
  switch (shadow) {
    case ShadowClass::Umbra:
      return {0.16F, 0.18F, 0.26F};
    case ShadowClass::Penumbra:
      return {0.62F, 0.60F, 0.58F};
    case ShadowClass::Lit:
      break;
  }
  return {0.98F, 0.94F, 0.82F};
}

Colour colour_of(ShadowEdgeKind kind) {
  switch (kind) {
    case ShadowEdgeKind::Boundary:
      return {0.1F, 0.1F, 0.1F};
    case ShadowEdgeKind::Contact:
      return {0.45F, 0.25F, 0.1F};
    case ShadowEdgeKind::Plane:
      return {0.5F, 0.5F, 0.0F};
    case ShadowEdgeKind::Face:
      return {0.55F, 0.2F, 0.6F};
    case ShadowEdgeKind::EE:
      return {0.1F, 0.5F, 0.35F};
    case ShadowEdgeKind::EV:
      return {0.12F, 0.35F, 0.75F};
    case ShadowEdgeKind::EEE:
      break;
  }
  return {0.85F, 0.25F, 0.15F};
}

/// The chords of a face's boundary as closed rings.
std::vector<Ring> rings_of(const ShadowMesh& mesh, int face) {
  struct Way {
    std::array<int, 2> ends;
    Ring points;
  };
  std::vector<Way> ways;
  for (const ShadowMesh::Edge& e : mesh.edges) {
    if (e.left == e.right) continue;
    if (e.left == face) ways.push_back({e.ends, e.polyline});
    if (e.right == face) {
      ways.push_back({{e.ends[1], e.ends[0]}, e.polyline});
      std::ranges::reverse(ways.back().points);
    }
  }
  std::vector<Ring> rings;
  while (!ways.empty()) {
    Ring ring;
    const int first = ways.back().ends[0];
    int at = first;
    do {
      const auto next =
          std::ranges::find_if(ways, [&](const Way& way) { return way.ends[0] == at; });
      if (next == ways.end()) break;
      ring.insert(ring.end(), next->points.begin(), next->points.end() - 1);
      at = next->ends[1];
      ways.erase(next);
    } while (at != first);
    rings.push_back(std::move(ring));
  }
  return rings;
}

void add_face(Cells& cells, const ReceiverShadows& receiver, const ShadowMesh& mesh,
              int number) {
  const ShadowMesh::Face& face = mesh.faces[number];
  for (const Ring& part : trapezoids(rings_of(mesh, number))) {
    std::vector<vtkIdType> ids;
    for (const Eigen::Vector2d& p : part)
      ids.push_back(cells.add_point(in_space(mesh, p)));
    cells.add_polygon(ids, colour_of(face.shadow));
    cells.value("receiver", receiver.name);
    cells.value("facet", {mesh.facet});
    cells.value("face", {number});
    cells.value("class", std::string(name(face.shadow)));
    cells.value("structure", {face.structure});
    cells.value("area", {face.area});
  }
}

void add_edge(Cells& cells, const ReceiverShadows& receiver, const ShadowMesh& mesh,
              int number) {
  const ShadowMesh::Edge& edge = mesh.edges[number];
  for (std::size_t k = 0; k + 1 < edge.polyline.size(); ++k) {
    cells.add_line(in_space(mesh, edge.polyline[k]), in_space(mesh, edge.polyline[k + 1]),
                   colour_of(edge.kind));
    cells.value("receiver", receiver.name);
    cells.value("facet", {mesh.facet});
    cells.value("edge", {number});
    cells.value("kind", std::string(name(edge.kind)));
    cells.value("order", {edge.order.value_or(-1)});
    cells.value("left", {edge.left});
    cells.value("right", {edge.right});
  }
}

Cells surface_of(const ShadowVolume& volume, ShadowClass shadow) {
  Cells cells;
  std::vector<vtkIdType> ids;
  for (const ExactPosition& v : volume.vertices)
    ids.push_back(cells.add_point(v.nearest));
  for (std::size_t i = 0; i < volume.sides.size(); ++i) {
    const ShadowVolume::Side& side = volume.sides[i];
    std::vector<vtkIdType> corners;
    for (const int c : side.corners) corners.push_back(ids[c]);
    cells.add_polygon(corners, colour_of(shadow));
    cells.value("side", {static_cast<int>(i)});
    cells.value("kind", std::string(name(side.kind)));
    std::string generators;
    for (const std::string& g : side.generators)
      generators += (generators.empty() ? "" : "; ") + g;
    cells.value("generators", generators);
  }
  return cells;
}

/// fill(cells, receiver, mesh) for all meshes.
template <class Fill>
Cells cells_of(const Shadows& shadows, Stage& stage, Fill&& fill) {
  Cells cells;
  for (const ReceiverShadows& receiver : shadows.receivers) {
    for (const ShadowMesh& mesh : receiver.meshes) {
      stage.check(0.5);
      fill(cells, receiver, mesh);
    }
  }
  return cells;
}

}  // namespace

void add_shadow_blocks(std::map<std::string, Cells>& blocks, const Shadows& shadows,
                       Stage& stage) {
  blocks.emplace(
      "shadow_faces",
      cells_of(shadows, stage, [](Cells& cells, const auto& receiver, const auto& mesh) {
        for (int f = 0; f < static_cast<int>(mesh.faces.size()); ++f)
          add_face(cells, receiver, mesh, f);
      }));
  blocks.emplace(
      "shadow_edges",
      cells_of(shadows, stage, [](Cells& cells, const auto& receiver, const auto& mesh) {
        for (int e = 0; e < static_cast<int>(mesh.edges.size()); ++e)
          add_edge(cells, receiver, mesh, e);
      }));
  blocks.emplace(
      "shadow_vertices",
      cells_of(shadows, stage, [](Cells& cells, const auto& receiver, const auto& mesh) {
        for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v) {
          cells.add_vertex(in_space(mesh, mesh.vertices[v]), {0.1F, 0.1F, 0.12F});
          cells.value("receiver", receiver.name);
          cells.value("facet", {mesh.facet});
          cells.value("vertex", {v});
        }
      }));
}

void add_volume_blocks(std::map<std::string, Cells>& blocks,
                       const ShadowVolumes& volumes) {
  blocks.emplace("shadow_umbra", surface_of(volumes.umbra(), ShadowClass::Umbra));
  blocks.emplace("shadow_penumbra", surface_of(volumes.shadow(), ShadowClass::Penumbra));
}

}  // namespace sightline::viewers
