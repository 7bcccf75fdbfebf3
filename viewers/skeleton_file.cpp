#include "viewers/skeleton_file.h"

#include <fmt/format.h>

#include <fstream>

#include "linespace/stage_internal.h"
#include "viewers/drawing.h"
#include "viewers/eee_surface.h"
#include "viewers/far_ends.h"

namespace sightline::viewers {
namespace {

const char* touch_name(TouchKind kind) {
  switch (kind) {
    case TouchKind::Interior:
      return "face";
    case TouchKind::Edge:
      return "edge";
    case TouchKind::Corner:
      return "vertex";
    case TouchKind::EdgeOn:
      return "edge-on face";
  }
  return "";
}

Json contact_json(const Scene& scene, const Contact& contact) {
  Json touches = Json::array();
  for (const Touch& touch : contact.touches) {
    Json j{{"face", scene.faces()[touch.face].source}, {"at", touch_name(touch.kind)}};
    touches.push_back(std::move(j));
  }
  return {{"kind", contact.blocked ? "end" : "graze"},
          {"from", contact.from},
          {"to", contact.to},
          {"touches", std::move(touches)}};
}

/// What ends a free segment on either side: polygons of the file, or "outside".
Json ends_json(const std::array<std::vector<int>, 2>& ends) {
  Json far = Json::array();
  for (const std::vector<int>& faces : ends) {
    if (faces.empty()) {
      far.push_back("outside");
    } else {
      far.push_back({{"faces", faces}});
    }
  }
  return far;
}

/// "contacts" (positions as parameters: 0 at the first, 1 at the second point of the
/// element's own line) and "free_segment".
void add_far_ends(Json& element, const Scene& scene, const std::optional<FarEnds>& ends) {
  if (!ends) {
    element["free_segment"] = nullptr;
    return;
  }
  Json contacts = Json::array();
  for (const Contact& c : ends->contacts) contacts.push_back(contact_json(scene, c));
  element["contacts"] = std::move(contacts);
  element["free_segment"] = {{"points", points_json(ends->points)},
                             {"ends", ends_json(ends->faces)}};
}

template <typename Arc>
void add_pieces(Json& j, const Scene& scene, const SkeletonLines& lines, const Arc& arc) {
  Json pieces = Json::array();
  for (const SkeletonLines::EndPiece& piece : lines.ends(arc)) {
    pieces.push_back({{"range", piece.range},
                      {"ends", ends_json({source_polygons(scene, piece.faces[0]),
                                          source_polygons(scene, piece.faces[1])})}});
  }
  j["pieces"] = std::move(pieces);
}

/// The line at the middle of the arc's range, and what lies along it.
void add_line(Json& j, const Scene& scene, const SkeletonLines& lines,
              const SkeletonArc& arc) {
  const double middle = 0.5 * (arc.range[0] + arc.range[1]);
  j["line"] = points_json(
      {scene.point(arc.vertex), point_on_edge(scene, scene.edges()[arc.edge], middle)});
  add_far_ends(j, scene, far_ends(scene, lines, arc, middle));
  add_pieces(j, scene, lines, arc);
}

void add_line(Json& j, const Scene& scene, const SkeletonLines& lines,
              const EeeArc& arc) {
  const double middle = 0.5 * (arc.range[0] + arc.range[1]);
  j["line"] = points_json(EeeSurface(scene, arc).line(middle));
  add_far_ends(j, scene, far_ends(scene, lines, arc, middle));
  add_pieces(j, scene, lines, arc);
}

bool is_end(const Json& j) { return j.value("contact", "graze") == "end"; }

Generator generator_from(const Json& j) {
  const std::string type = j.at("type").get<std::string>();
  const auto kind = type == "vertex" ? GeneratorKind::Vertex
                    : type == "edge" ? GeneratorKind::Edge
                                     : GeneratorKind::Face;
  return {kind, j.at("id").get<std::int32_t>()};
}

Point point_from(const Json& j) {
  return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()};
}

NodeKind kind_from(const std::string& name) {
  for (const NodeKind kind : {NodeKind::VV, NodeKind::VEE, NodeKind::EVE, NodeKind::FvE,
                              NodeKind::EEEE, NodeKind::FEE, NodeKind::FF,
                              NodeKind::Saddle, NodeKind::Pierce, NodeKind::Degenerate}) {
    SkeletonNode node{};
    node.kind = kind;
    if (kind_name(node) == name.substr(0, name.find("_self"))) return kind;
  }
  throw InvalidInput("unknown kind of node " + name);
}

/// What arcs of all kinds have.
template <typename Arc>
void read_arc(const Json& j, Arc& arc) {
  arc.self = j.at("kind").get<std::string>().ends_with("_self");
  for (const int i : {0, 1}) {
    arc.range[i] = j.at("range").at(i).get<double>();
    arc.nodes[i] = j.at("nodes").at(i).get<std::uint32_t>();
  }
}

StoredSkeleton skeleton_from(const Json& j) {
  StoredSkeleton stored;
  stored.scene_file = j.at("scene").at("file").get<std::string>();
  Skeleton& skeleton = stored.skeleton;
  skeleton.complete = j.at("complete").get<bool>();
  if (j.contains("options") && j["options"].value("events", "solid") == "polygon") {
    skeleton.events = EventMode::Polygon;
  }
  for (const Json& n : j.at("list").at("nodes")) {
    SkeletonNode node{};
    const std::string name = n.at("kind").get<std::string>();
    node.kind = kind_from(name);
    node.self = name.ends_with("_self");
    node.end = n.value("end", false);
    node.second = n.value("second", false);
    node.first_generator = static_cast<std::uint32_t>(skeleton.generator_pool.size());
    for (const Json& g : n.at("generators")) {
      skeleton.generator_pool.push_back(generator_from(g));
    }
    node.generator_count = static_cast<std::uint32_t>(n.at("generators").size());
    if (!n["generators"].empty()) {
      node.ends = {is_end(n["generators"].front()), is_end(n["generators"].back())};
    }
    node.segment = {point_from(n.at("line").at(0)), point_from(n.at("line").at(1))};
    skeleton.nodes.push_back(node);
  }
  for (const Json& a : j.at("list").at("arcs")) {
    if (a.contains("edges")) {
      EeeArc arc{};
      for (const int i : {0, 1, 2}) {
        arc.edges[i] = a.at("edges").at(i).at("id").get<std::int32_t>();
      }
      arc.ends = {is_end(a.at("edges").at(0)), is_end(a.at("edges").at(2))};
      read_arc(a, arc);
      skeleton.eee_arcs.push_back(arc);
    } else {
      SkeletonArc arc{};
      arc.vertex = a.at("vertex").at("id").get<std::int32_t>();
      arc.edge = a.at("edge").at("id").get<std::int32_t>();
      arc.ends = {is_end(a.at("vertex")), is_end(a.at("edge"))};
      read_arc(a, arc);
      skeleton.arcs.push_back(arc);
    }
  }
  return stored;
}

}  // namespace

namespace {

// The elements of the list, one at a time.
class ListWriter {
 public:
  ListWriter(std::ostream& stream, const Scene& scene, const Skeleton& skeleton,
             const SkeletonLines* lines)
      : stream_(stream), scene_(scene), skeleton_(skeleton), lines_(lines) {}

  void nodes(internal::Stage& stage) {
    for (std::size_t i = 0; i < skeleton_.nodes.size(); ++i) {
      tell(stage, i, skeleton_.nodes.size());
      Json node = node_json(scene_, skeleton_, i);
      if (lines_ != nullptr) {
        add_far_ends(node, scene_,
                     far_ends(scene_, *lines_, skeleton_, skeleton_.nodes[i]));
      }
      add(node);
    }
  }
  void arcs(internal::Stage& stage) {
    const std::size_t ev = skeleton_.arcs.size();
    const std::size_t count = ev + skeleton_.eee_arcs.size();
    for (std::size_t i = 0; i < ev; ++i) {
      tell(stage, i, count);
      Json arc = arc_json(scene_, skeleton_, i);
      if (lines_ != nullptr) add_line(arc, scene_, *lines_, skeleton_.arcs[i]);
      add(arc);
    }
    for (std::size_t i = 0; i < skeleton_.eee_arcs.size(); ++i) {
      tell(stage, ev + i, count);
      Json arc = eee_arc_json(scene_, skeleton_, i);
      if (lines_ != nullptr) add_line(arc, scene_, *lines_, skeleton_.eee_arcs[i]);
      add(arc);
    }
  }
  void begin_array() { separator_ = "\n   "; }

 private:
  void add(const Json& element) {
    stream_ << separator_ << element.dump();
    separator_ = ",\n   ";
  }
  // With lines an element may take milliseconds.
  void tell(internal::Stage& stage, std::size_t i, std::size_t count) const {
    if (lines_ != nullptr) {
      stage.check(static_cast<double>(i) / static_cast<double>(count));
    } else {
      stage.at(i, count);
    }
  }

  std::ostream& stream_;
  const Scene& scene_;
  const Skeleton& skeleton_;
  const SkeletonLines* lines_;
  const char* separator_ = "";
};

}  // namespace

bool write_skeleton_json(std::ostream& stream, const Json& head, const Scene& scene,
                         const Skeleton& skeleton, const SkeletonLines* lines,
                         const Request& request) {
  // Whether all is complete is known at the end.
  Json keys = head;
  keys.erase("complete");
  std::string text = keys.dump(1);
  text.erase(text.rfind('}'));  // leave the object open
  text.erase(text.find_last_not_of("\n ") + 1);
  stream << text << ",\n \"list\": {\n  \"nodes\": [";
  ListWriter list(stream, scene, skeleton, lines);
  bool whole = true;
  const auto write = [&](const char* name, auto elements) {
    list.begin_array();
    try {
      internal::Stage stage(request, name);
      (list.*elements)(stage);
    } catch (const Stopped&) {
      whole = false;
    }
  };
  write("listing nodes", &ListWriter::nodes);
  stream << "\n  ],\n  \"arcs\": [";
  write("listing arcs", &ListWriter::arcs);
  stream << "\n  ]\n },\n \"complete\": "
         << (whole && head.at("complete").get<bool>() ? "true" : "false") << "\n}\n";
  return whole;
}

StoredSkeleton read_skeleton_json(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InvalidInput(path + ": cannot be read");
  try {
    return skeleton_from(Json::parse(stream));
  } catch (const nlohmann::json::exception& error) {
    throw InvalidInput(fmt::format("{}: not a saved skeleton: {}", path, error.what()));
  }
}

void check_fits(const StoredSkeleton& stored, const Scene& scene) {
  const auto require = [&](bool fits) {
    if (!fits) {
      throw InvalidInput("the saved skeleton does not belong to " + scene.soup().source);
    }
  };
  const auto below = [](std::int64_t id, std::size_t size) {
    return id >= 0 && static_cast<std::size_t>(id) < size;
  };
  for (const Generator& g : stored.skeleton.generator_pool) {
    const std::size_t size = g.kind == GeneratorKind::Vertex ? scene.points().size()
                             : g.kind == GeneratorKind::Edge ? scene.edges().size()
                                                             : scene.facets().size();
    require(below(g.id, size));
  }
  const auto require_nodes = [&](const auto& arc) {
    for (const std::uint32_t n : arc.nodes) {
      require(below(n, stored.skeleton.nodes.size()));
    }
  };
  for (const SkeletonArc& arc : stored.skeleton.arcs) {
    require(below(arc.vertex, scene.points().size()));
    require(below(arc.edge, scene.edges().size()));
    require_nodes(arc);
  }
  for (const EeeArc& arc : stored.skeleton.eee_arcs) {
    for (const int edge : arc.edges) require(below(edge, scene.edges().size()));
    require_nodes(arc);
  }
}

}  // namespace sightline::viewers
