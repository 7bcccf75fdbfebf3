#include "viewers/queries/mesh_answer.h"

#include <fmt/format.h>

#include <set>

#include "viewers/queries/shadow_answer.h"

namespace sightline::viewers {
namespace {

/// Counts of one mesh, or of many.
struct MeshCounts {
  std::size_t vertices = 0, faces = 0, edges = 0;
  std::set<int> structures;
  std::array<std::size_t, kShadowEdgeKinds> kinds{};

  void add(const ShadowMesh& mesh) {
    vertices += mesh.vertices.size();
    faces += mesh.faces.size();
    edges += mesh.edges.size();
    for (const ShadowMesh::Face& f : mesh.faces) structures.insert(f.structure);
    for (const ShadowMesh::Edge& e : mesh.edges) ++kinds[static_cast<int>(e.kind)];
  }
};

Json counts_json(const MeshCounts& counts) {
  Json edges;
  for (const ShadowEdgeKind kind :
       {ShadowEdgeKind::EV, ShadowEdgeKind::EE, ShadowEdgeKind::EEE, ShadowEdgeKind::Face,
        ShadowEdgeKind::Contact, ShadowEdgeKind::Plane, ShadowEdgeKind::Boundary}) {
    edges[std::string(name(kind))] = counts.kinds[static_cast<int>(kind)];
  }
  return {{"vertices", counts.vertices},
          {"faces", counts.faces},
          {"structures", counts.structures.size()},
          {"edges", edges}};
}

Json pair_json(const Eigen::Vector2d& p) { return Json::array({p[0], p[1]}); }

/// What a mesh is made of.
Json list_json(const ShadowMesh& mesh) {
  Json vertices = Json::array(), edges = Json::array(), faces = Json::array();
  for (const auto& v : mesh.vertices) vertices.push_back(pair_json(v));
  for (const ShadowMesh::Edge& e : mesh.edges) {
    Json points = Json::array();
    for (const auto& p : e.polyline) points.push_back(pair_json(p));
    Json edge{{"kind", name(e.kind)}, {"generators", e.generators},
              {"order", nullptr},     {"ends", e.ends},
              {"left", e.left},       {"right", e.right},
              {"conic", e.conic},     {"points", points}};
    if (e.order) edge["order"] = *e.order;
    edges.push_back(std::move(edge));
  }
  for (const ShadowMesh::Face& f : mesh.faces) {
    faces.push_back({{"class", name(f.shadow)},
                     {"structure", f.structure},
                     {"area", f.area},
                     {"away", f.away},
                     {"inside", point_json(f.inside)}});
  }
  return {{"facet", mesh.facet},
          {"frame",
           {{"origin", point_json(mesh.frame.origin)},
            {"x", point_json(mesh.frame.x_axis)},
            {"y", point_json(mesh.frame.y_axis)}}},
          {"vertices", vertices},
          {"edges", edges},
          {"faces", faces}};
}

Json structures_json(const Shadows& shadows) {
  Json all = Json::array();
  for (const auto& boundaries : shadows.structures)
    all.push_back(structure_json(boundaries));
  return all;
}

}  // namespace

std::string_view name(ShadowEdgeKind kind) {
  switch (kind) {
    case ShadowEdgeKind::Boundary:
      return "boundary";
    case ShadowEdgeKind::Contact:
      return "contact";
    case ShadowEdgeKind::Plane:
      return "plane";
    case ShadowEdgeKind::Face:
      return "face";
    case ShadowEdgeKind::EE:
      return "EE";
    case ShadowEdgeKind::EV:
      return "EV";
    case ShadowEdgeKind::EEE:
      break;
  }
  return "EEE";
}

void add_shadows(Json& answer, const Shadows& shadows, bool with_lists) {
  MeshCounts all;
  Json& receivers = answer["receivers"] = Json::array();
  for (const ReceiverShadows& r : shadows.receivers) {
    MeshCounts counts;
    for (const ShadowMesh& mesh : r.meshes) {
      counts.add(mesh);
      all.add(mesh);
    }
    Json receiver{{"group", r.name},
                  {"area", r.area},
                  {"umbra_area", r.umbra_area},
                  {"penumbra_area", r.penumbra_area},
                  {"lit_area", r.lit_area},
                  {"away_area", r.away_area},
                  {"area_error_bound", r.area_error_bound},
                  {"umbra_components", r.umbra_components},
                  {"mesh", counts_json(counts)}};
    if (with_lists) {
      Json& facets = receiver["facets"] = Json::array();
      for (const ShadowMesh& mesh : r.meshes) facets.push_back(list_json(mesh));
    }
    receivers.push_back(std::move(receiver));
  }
  answer["mesh"] = counts_json(all);
  if (with_lists) answer["structures"] = structures_json(shadows);
  if (!shadows.missing.empty()) answer["missing"] = shadows.missing;
}

std::string receiver_csv(const ReceiverShadows& r) {
  MeshCounts counts;
  for (const ShadowMesh& mesh : r.meshes) counts.add(mesh);
  std::string quoted = "\"";
  for (const char c : r.name) quoted += c == '"' ? "\"\"" : std::string(1, c);
  quoted += '"';
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", quoted, r.area,
                     r.umbra_area, r.penumbra_area, r.lit_area, r.away_area,
                     r.area_error_bound, r.umbra_components, counts.vertices,
                     counts.edges, counts.faces, counts.structures.size());
}

}  // namespace sightline::viewers
