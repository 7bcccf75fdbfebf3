#include "viewers/skeleton_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "linespace/checksum.h"
#include "linespace/files/input_file.h"
#include "linespace/work/stage.h"
#include "viewers/drawing.h"
#include "viewers/far_ends.h"
#include "viewers/files/json_parse.h"
#include "viewers/json_text.h"
#include "viewers/kinds.h"

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

void add_pieces(Json& j, const Scene& scene, const SkeletonLines& lines,
                const SkeletonArc& arc) {
  Json pieces = Json::array();
  for (const SkeletonLines::EndPiece& piece : lines.ends(arc)) {
    pieces.push_back({{"range", piece.range},
                      {"ends", ends_json({source_polygons(scene, piece.faces[0]),
                                          source_polygons(scene, piece.faces[1])})}});
  }
  j["pieces"] = std::move(pieces);
}

/// A parameter in the middle half of an arc's range, with as few digits as there is one.
double plain_parameter(const std::array<double, 2>& range) {
  const double quarter = 0.25 * (range[1] - range[0]);
  for (double step = 1; step > 0x1p-60; step /= 2) {
    const double s = std::ceil((range[0] + quarter) / step) * step;
    if (s <= range[1] - quarter) return s;
  }
  return 0.5 * (range[0] + range[1]);
}

Json positions_json(const std::array<ExactPosition, 2>& points) {
  return Json::array({position_json(points[0]), position_json(points[1])});
}

/// "parameter" and "line": a line of the arc, exactly, by the points at positions 0 and
/// 1; and what lies along it.
void add_line(Json& j, const Scene& scene, const SkeletonLines& lines,
              const SkeletonArc& arc) {
  const double s = plain_parameter(arc.range);
  const auto points = lines.points(arc, s);
  j["parameter"] = s;
  j["line"] = points ? positions_json(*points) : Json(nullptr);
  add_far_ends(j, scene, far_ends(scene, lines, arc, s));
  add_pieces(j, scene, lines, arc);
}

/// "exact_line": two points of the line; null where only the rounded one is known.
void add_line(Json& j, const SkeletonLines& lines, const Skeleton& skeleton,
              const SkeletonNode& node) {
  const auto points = lines.points(skeleton, node);
  j["exact_line"] = points ? positions_json(*points) : Json(nullptr);
}

// ---- reading

/// A file says something that no saved skeleton says.
class Malformed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::int32_t id_from(const Json& j) {
  const auto id = j.is_number_integer() ? j.get<std::int64_t>() : -2;
  if (id < -1 || id > std::numeric_limits<std::int32_t>::max()) {
    throw Malformed(fmt::format("{} is no id", j.dump()));
  }
  return static_cast<std::int32_t>(id);
}

bool is_end(const Json& j) { return j.value("contact", "graze") == "end"; }

Generator generator_from(const Json& j) {
  const std::string type = j.at("type").get<std::string>();
  if (type != "vertex" && type != "edge" && type != "face") {
    throw Malformed(fmt::format("unknown kind of generator '{}'", type));
  }
  const auto kind = type == "vertex" ? GeneratorKind::Vertex
                    : type == "edge" ? GeneratorKind::Edge
                                     : GeneratorKind::Face;
  return {kind, id_from(j.at("id"))};
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
  throw Malformed(fmt::format("unknown kind of node '{}'", name));
}

SkeletonArc arc_from(const Json& j) {
  SkeletonArc arc;
  if (j.contains("edges")) {
    const Json& edges = j.at("edges");
    const auto id = [&](int i) { return id_from(edges.at(i).at("id")); };
    arc = SkeletonArc::eee({id(0), id(1), id(2)});
    arc.ends = {is_end(edges.at(0)), is_end(edges.at(2))};
  } else {
    arc =
        SkeletonArc::ev(id_from(j.at("vertex").at("id")), id_from(j.at("edge").at("id")));
    arc.ends = {is_end(j.at("vertex")), is_end(j.at("edge"))};
  }
  arc.self = j.at("kind").get<std::string>().ends_with("_self");
  for (const int i : {0, 1}) {
    arc.range[i] = j.at("range").at(i).get<double>();
    arc.nodes[i] = static_cast<std::uint32_t>(id_from(j.at("nodes").at(i)));
  }
  if (!(0 <= arc.range[0] && arc.range[0] <= arc.range[1] && arc.range[1] <= 1)) {
    throw Malformed(fmt::format("{} is no range", j["range"].dump()));
  }
  return arc;
}

Simplified simplified_from(const Json& j) {
  Simplified simplified;
  simplified.feature_size = j.at("feature_size").get<double>();
  for (const Json& id : j.at("edge_ids")) simplified.edges.push_back(id_from(id));
  for (const Json& id : j.at("vertex_ids")) simplified.vertices.push_back(id_from(id));
  for (const Json& id : j.at("object_ids")) simplified.objects.push_back(id_from(id));
  for (const Json& arc : j.at("arc_list")) {
    simplified.arcs.push_back(
        {id_from(arc.at("vertex")),
         id_from(arc.at("edge")),
         {arc.at("range").at(0).get<double>(), arc.at("range").at(1).get<double>()}});
  }
  return simplified;
}

/// How far the building had come.
void read_progress(const Json& j, Skeleton& skeleton) {
  skeleton.complete = j.at("complete").get<bool>();
  skeleton.stopped_by = stopped_by_from(j.value("stopped_by", "nothing"));
  skeleton.vertices_done = j.at("vertices_done").get<std::size_t>();
  skeleton.vertices_asked = j.at("vertices_asked").get<std::size_t>();
  skeleton.edges_done = j.at("edges_done").get<std::size_t>();
  skeleton.edges_asked = j.at("edges_asked").get<std::size_t>();
  skeleton.facets_done = j.at("facets_done").get<std::size_t>();
  skeleton.facets_asked = j.at("facets_asked").get<std::size_t>();
  skeleton.simplified = simplified_from(j.at("simplified"));
}

StoredSkeleton skeleton_from(const Json& j) {
  StoredSkeleton stored;
  stored.scene_file = unescaped_bytes(j.at("scene").at("file").get<std::string>());
  stored.fingerprint = j.at("scene").at("fingerprint").get<std::string>();
  stored.options = j.at("options");
  stored.perturb = stored.options.value("perturb", 0.0);
  stored.seed = stored.options.value("seed", std::uint64_t{1});
  Skeleton& skeleton = stored.skeleton;
  read_progress(j, skeleton);
  if (stored.options.at("events").get<std::string>() == "polygon") {
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
    skeleton.arcs.push_back(arc_from(a));
  }
  if (!std::ranges::is_partitioned(skeleton.arcs, &SkeletonArc::is_ev)) {
    throw Malformed("an EV arc is listed after an EEE arc");
  }
  return stored;
}

// Before the checksum of all bytes in front of this text; behind it, the file ends.
constexpr std::string_view kChecksumKey = ",\n \"checksum\": \"";
constexpr std::string_view kEnd = "\"\n}\n";

/// Passes text on to a stream and keeps its checksum.
class SummedText {
 public:
  explicit SummedText(std::ostream& stream) : stream_(stream) {}
  SummedText& operator<<(std::string_view text) {
    sum_.add(text);
    stream_ << text;
    return *this;
  }
  [[nodiscard]] std::string sum() const { return sum_.text(); }

 private:
  std::ostream& stream_;
  Checksum sum_;
};

/// Refuses what is not, byte for byte, a file that write_skeleton_json wrote.
void check_whole(const std::string& path, std::string_view text) {
  const auto refuse = [&](std::string_view why) {
    throw InvalidInput(fmt::format("{}: {}", path, why));
  };
  constexpr std::string_view kHead = "\"command\": \"skeleton\"";
  if (text.substr(0, 100).find(kHead) == std::string_view::npos) {
    refuse("not a saved skeleton");
  }
  const std::size_t key = text.rfind(kChecksumKey);
  if (key == std::string_view::npos || !text.ends_with(kEnd)) {
    refuse(
        "has no checksum at its end: it was cut off, or saved by an earlier version; "
        "build it again with sightline skeleton SCENE -o FILE");
  }
  Checksum sum;
  sum.add(text.substr(0, key));
  std::string_view written = text.substr(key + kChecksumKey.size());
  written.remove_suffix(kEnd.size());
  if (written != sum.text()) {
    refuse(
        "was changed since it was saved: its checksum is wrong; build it again with "
        "sightline skeleton SCENE -o FILE");
  }
}

}  // namespace

std::string fingerprint(const Scene& scene) {
  Checksum sum;
  const PolygonSoup& soup = scene.soup();
  sum.add(std::uint64_t{soup.vertices.size()});
  for (const Point& p : soup.vertices) {
    for (const double x : {p.x(), p.y(), p.z()}) sum.add(x);
  }
  const auto add_ids = [&](const std::vector<int>& ids) {
    sum.add(std::uint64_t{ids.size()});
    for (const int id : ids) sum.add(static_cast<std::uint64_t>(id));
  };
  sum.add(std::uint64_t{soup.polygons.size()});
  for (const std::vector<int>& polygon : soup.polygons) add_ids(polygon);
  const auto add_name = [&](const std::string& name) {
    sum.add(std::uint64_t{name.size()});
    sum.add(name);
  };
  for (const PolygonSoup::Group& group : soup.groups) {
    add_name(group.name);
    for (const std::string& alias : group.aliases) add_name(alias);
    add_ids(group.faces);
  }
  return sum.text();
}

namespace {

/// The elements of the list, one at a time.
class ListWriter {
 public:
  ListWriter(SummedText& out, const Scene& scene, const Skeleton& skeleton,
             const SkeletonLines* lines)
      : out_(out), scene_(scene), skeleton_(skeleton), lines_(lines) {}

  void nodes(internal::Stage& stage) {
    for (std::size_t i = 0; i < skeleton_.nodes.size(); ++i) {
      tell(stage, i, skeleton_.nodes.size());
      Json node = node_json(scene_, skeleton_, i);
      if (lines_ != nullptr) {
        add_line(node, *lines_, skeleton_, skeleton_.nodes[i]);
        add_far_ends(node, scene_,
                     far_ends(scene_, *lines_, skeleton_, skeleton_.nodes[i]));
      }
      add(node);
    }
  }
  void arcs(internal::Stage& stage) {
    const std::size_t count = skeleton_.arcs.size();
    for (std::size_t i = 0; i < count; ++i) {
      tell(stage, i, count);
      Json arc = arc_json(scene_, skeleton_, i);
      if (lines_ != nullptr) add_line(arc, scene_, *lines_, skeleton_.arcs[i]);
      add(arc);
    }
  }
  void begin_array() { separator_ = "\n   "; }

 private:
  void add(const Json& element) {
    out_ << separator_ << json_text(element);
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

  SummedText& out_;
  const Scene& scene_;
  const Skeleton& skeleton_;
  const SkeletonLines* lines_;
  const char* separator_ = "";
};

}  // namespace

bool write_skeleton_json(std::ostream& stream, const Json& head, const Scene& scene,
                         const Skeleton& skeleton, const SkeletonLines* lines,
                         const Request& request) {
  Json first = head;
  first["scene"]["fingerprint"] = fingerprint(scene);
  first.erase("complete");  // known at the end
  SummedText out(stream);
  std::string text = json_text(first, 1);
  text.erase(text.rfind('}'));  // leave the object open
  text.erase(text.find_last_not_of("\n ") + 1);
  out << text << ",\n \"list\": {\n  \"nodes\": [";
  ListWriter list(out, scene, skeleton, lines);
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
  out << "\n  ],\n  \"arcs\": [";
  write("listing arcs", &ListWriter::arcs);
  out << "\n  ]\n },\n \"complete\": "
      << (whole && head.at("complete").get<bool>() ? "true" : "false");
  stream << kChecksumKey << out.sum() << kEnd;
  return whole;
}

void save_skeleton_json(OutputFile& file, const Json& head, const Scene& scene,
                        const Skeleton& skeleton, const Request& request) {
  if (!write_skeleton_json(file.stream(), head, scene, skeleton, nullptr, request)) {
    throw Stopped("saving", 1);
  }
  file.commit();
}

StoredSkeleton read_skeleton_json(const std::string& path) {
  const std::string text = internal::read_whole(path);
  check_whole(path, text);
  return parse_skeleton_json(path, text);
}

StoredSkeleton parse_skeleton_json(const std::string& path, std::string_view text) {
  try {
    StoredSkeleton stored = skeleton_from(parse_json<Json>(text));
    stored.file = path;
    return stored;
  } catch (const nlohmann::json::exception& error) {
    throw InvalidInput(fmt::format("{}: not a saved skeleton: {}", path, error.what()));
  } catch (const Malformed& error) {
    throw InvalidInput(fmt::format("{}: not a saved skeleton: {}", path, error.what()));
  }
}

void check_fits(const StoredSkeleton& stored, const Scene& scene) {
  const auto require = [&](bool fits) {
    if (fits) return;
    throw InvalidInput(fmt::format(
        "{}: was saved from another scene than {} (its coordinates, polygons or groups "
        "are others); build it again with sightline skeleton SCENE -o FILE",
        stored.file, scene.soup().source));
  };
  require(stored.fingerprint == fingerprint(scene));
  const auto below = [](std::int64_t id, std::size_t size) {
    return id >= 0 && static_cast<std::size_t>(id) < size;
  };
  for (const Generator& g : stored.skeleton.generator_pool) {
    const std::size_t size = g.kind == GeneratorKind::Vertex ? scene.points().size()
                             : g.kind == GeneratorKind::Edge ? scene.edges().size()
                                                             : scene.facets().size();
    // A flat side is an edge of a node that is no edge of the scene.
    require(below(g.id, size) || (g.kind == GeneratorKind::Edge && g.id == -1));
  }
  for (const SkeletonArc& arc : stored.skeleton.arcs) {
    if (arc.is_ev()) {
      require(below(arc.vertex(), scene.points().size()));
      require(below(arc.edge(), scene.edges().size()));
    } else {
      for (const int edge : arc.edges()) require(below(edge, scene.edges().size()));
    }
    for (const std::uint32_t n : arc.nodes) {
      require(below(n, stored.skeleton.nodes.size()));
    }
  }
  const Simplified& left_out = stored.skeleton.simplified;
  for (const int e : left_out.edges) require(below(e, scene.edges().size()));
  for (const int v : left_out.vertices) require(below(v, scene.points().size()));
  for (const int o : left_out.objects) require(below(o, scene.objects().size()));
}

}  // namespace sightline::viewers
