#include "viewers/queries/view_answer.h"

#include <fmt/format.h>

#include <algorithm>

#include "viewers/json_text.h"

namespace sightline::viewers {
namespace {

Json line_json(const MapLine& line) {
  if (line.edge >= 0) return line.edge;
  if (line.box_side >= 0)
    return {{"facet", line.facets[0]}, {"side", box_side_name(line.box_side)}};
  return {{"facets", line.facets}};
}

const char* measure_name(const PointView& view) {
  return view.eye.kind == Viewpoint::Kind::Eye ? "solid_angle" : "area";
}

Json facets_json(const Scene& scene, const PointView& view) {
  Json list = Json::array();
  for (const SeenFacet& seen : view.facets) {
    const int object = scene.facets()[seen.facet].object;
    Json j{{"facet", seen.facet},
           {"object", scene.objects()[object].name},
           {"faces", polygons_of(scene, seen.facet)},
           {"front", seen.front},
           {"pieces", seen.pieces},
           {measure_name(view), seen.measure},
           {"gradient", nullptr}};
    if (seen.gradient) j["gradient"] = point_json(*seen.gradient);
    list.push_back(std::move(j));
  }
  return list;
}

Json accidents_json(const Scene& scene, const PointView& view) {
  Json list = Json::array();
  for (const Accident& accident : view.accidents) {
    Json generators = Json::array();
    for (const Generator& g : accident.generators) {
      generators.push_back(generator_json(scene, g));
    }
    list.push_back(
        {{"kind", name(accident.kind)}, {"generators", std::move(generators)}});
  }
  return list;
}

Json vertices_json(const Scene& scene, const PointView& view) {
  Json list = Json::array();
  for (const MapVertex& v : view.vertices) {
    Json j{{"kind", name(v.kind)}};
    if (v.kind == MapVertexKind::Corner) {
      j["corner"] = v.corner;
      j["vertex"] = scene.vertex_of(v.corner);
    } else if (v.kind == MapVertexKind::T) {
      j["near"] = line_json(v.near);
      j["far"] = line_json(v.far);
    }
    j["at"] = point_json(v.at);
    list.push_back(std::move(j));
  }
  return list;
}

Json edges_json(const PointView& view) {
  Json list = Json::array();
  for (const MapEdge& e : view.edges) {
    list.push_back({{"edge", line_json(e.line)},
                    {"kind", name(e.kind)},
                    {"ends", e.ends},
                    {"left", e.left},
                    {"right", e.right},
                    {"segment", points_json(e.segment)}});
  }
  return list;
}

Json regions_json(const PointView& view) {
  Json list = Json::array();
  for (const MapRegion& r : view.regions) {
    Json boundary = Json::array();
    for (const std::vector<int>& walk : r.boundary) {
      Json edges = Json::array();
      for (const int half : walk) edges.push_back(half / 2);
      boundary.push_back(std::move(edges));
    }
    Json j{{"patch", nullptr},
           {"facets", r.facets},
           {measure_name(view), nullptr},
           {"boundary", std::move(boundary)}};
    if (r.patches.size() == 1) j["patch"] = r.patches[0];
    if (r.patches.size() > 1) j["patch"] = r.patches;
    if (r.measure) j[measure_name(view)] = *r.measure;
    list.push_back(std::move(j));
  }
  return list;
}

std::string csv_text(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : escaped_bytes(text))
    quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

}  // namespace

std::string_view name(EyePlace place) {
  static constexpr const char* kNames[] = {"corner", "edge", "facet", "inside", "free"};
  return kNames[static_cast<int>(place)];
}

std::string_view name(MapVertexKind kind) {
  static constexpr const char* kNames[] = {"corner", "t", "touch", "accident"};
  return kNames[static_cast<int>(kind)];
}

std::string_view name(FurtherLine::Kind kind) {
  return kind == FurtherLine::Kind::Seam ? "seam" : "hidden";
}

std::string_view name(MapEdgeKind kind) {
  static constexpr const char* kNames[] = {"silhouette", "crease",   "valley", "boundary",
                                           "contact",    "crossing", "cut"};
  return kNames[static_cast<int>(kind)];
}

std::string_view name(AccidentKind kind) {
  static constexpr const char* kNames[] = {
      "edge_on",     "end_on",     "corner_on_edge", "corner_on_corner",
      "three_edges", "along_edge", "on_scene"};
  return kNames[static_cast<int>(kind)];
}

std::string_view box_side_name(int side) {
  static constexpr const char* kNames[] = {"x0", "y0", "z0", "x1", "y1", "z1"};
  return kNames[side];
}

std::string told(const MapLine& line) {
  if (line.box_side >= 0)
    return fmt::format("facet {} cut by {}", line.facets[0],
                       box_side_name(line.box_side));
  return line.edge >= 0 ? fmt::format("edge {}", line.edge)
                        : fmt::format("facets {} and {}", line.facets[0], line.facets[1]);
}

int count(const PointView& view, MapVertexKind kind) {
  return static_cast<int>(std::ranges::count(view.vertices, kind, &MapVertex::kind));
}

Json asked_json(const BoxQuestion& box) {
  Json json = asked_json(box.box.low, {box.asked[0], box.asked[1], box.asked[2]});
  for (Json& number :
       asked_json(box.box.high, {box.asked[3], box.asked[4], box.asked[5]})) {
    json.push_back(std::move(number));
  }
  return json;
}

Json asked_json(const ExactPosition& at, const std::array<std::string, 3>& asked) {
  Json json = Json::array();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string& text = asked[axis];
    if (at.is_double[axis] && text.find('/') == std::string::npos) {
      json.push_back(at.nearest[static_cast<int>(axis)]);
    } else {
      json.push_back(text);
    }
  }
  return json;
}

Json view_json(const Scene& scene, const ViewQuestion& question, const PointView& view,
               bool with_map) {
  const bool point = view.eye.kind == Viewpoint::Kind::Eye;
  Json j{{point ? "from" : "direction", asked_json(question.eye.at, question.asked)},
         {"eye", name(view.place)},
         {"ids", view.place_ids},
         {"facets", facets_json(scene, view)},
         {"corners", count(view, MapVertexKind::Corner)},
         {"t_vertices", count(view, MapVertexKind::T)},
         {"touches", count(view, MapVertexKind::Touch)},
         {"accident_vertices", count(view, MapVertexKind::Accident)},
         {"edges", view.edges.size()},
         {"regions", view.regions.size()},
         {"components", view.components},
         {"background_pieces", view.background_pieces},
         {"seams", view.seams},
         {"general", view.general},
         {"accidents", accidents_json(scene, view)},
         {"structure", nullptr}};
  if (view.general) j["structure"] = view.structure;
  if (with_map) {
    j["map"] = {{"vertices", vertices_json(scene, view)},
                {"edges", edges_json(view)},
                {"regions", regions_json(view)}};
  }
  return j;
}

std::string viewpoint_text(const Json& view) {
  const char* kind = view.contains("from") ? "from" : "direction";
  std::vector<std::string> asked;
  for (const Json& number : view[kind]) {
    asked.push_back(number.is_string() ? number.get<std::string>()
                                       : fmt::format("{:g}", number.get<double>()));
  }
  return fmt::format("{} {}", kind, fmt::join(asked, ","));
}

std::string view_csv(const Scene& scene, std::size_t number, const PointView& view) {
  const bool point = view.eye.kind == Viewpoint::Kind::Eye;
  std::string rows;
  for (const SeenFacet& seen : view.facets) {
    const std::string& object = scene.objects()[scene.facets()[seen.facet].object].name;
    rows += fmt::format("{},{},{},{},{},{},", number, seen.facet, csv_text(object),
                        fmt::join(polygons_of(scene, seen.facet), " "), seen.front,
                        seen.pieces);
    rows += point ? fmt::format("{},,", seen.measure) : fmt::format(",{},", seen.measure);
    rows += seen.gradient ? fmt::format("{},{},{}\n", seen.gradient->x(),
                                        seen.gradient->y(), seen.gradient->z())
                          : ",,\n";
  }
  return rows;
}

}  // namespace sightline::viewers
