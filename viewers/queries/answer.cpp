#include "viewers/answer.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <set>

#include "viewers/drawing.h"
#include "viewers/kinds.h"
#include "viewers/version.h"

namespace sightline::viewers {
namespace {

/// As many as the file has; STL repeats them for every facet, so there the distinct ones.
std::size_t vertex_count(const Scene& scene) {
  const std::string& file = scene.soup().source;
  const bool stl = file.ends_with(".stl") || file.ends_with(".STL");
  return stl ? scene.points().size() : scene.soup().vertices.size();
}

const char* contact_name(bool end) { return end ? "end" : "graze"; }

Json edge_kind(EdgeKind kind) {
  switch (kind) {
    case EdgeKind::Convex:
      return "convex";
    case EdgeKind::Reflex:
      return "reflex";
    case EdgeKind::Flat:
      return "flat";
    case EdgeKind::Boundary:
      return "boundary";
    case EdgeKind::NonManifold:
      return "nonmanifold";
  }
  return nullptr;
}

Json vertex_json(const Scene& scene, int id) {
  std::set<int> objects;
  for (const int f : scene.faces_at(id)) objects.insert(scene.faces()[f].object);
  Json names = Json::array();
  for (const int o : objects) names.push_back(scene.objects()[o].name);
  return {{"type", "vertex"},
          {"id", id},
          {"vertex", scene.vertex_of(id)},
          {"at", point_json(scene.point(id))},
          {"objects", std::move(names)}};
}

Json edge_json(const Scene& scene, int id) {
  if (id < 0) return {{"type", "edge"}, {"id", id}};  // a flat side: no edge of the scene
  const Edge& edge = scene.edges()[id];
  return {
      {"type", "edge"},
      {"id", id},
      {"vertices", {scene.vertex_of(edge.points[0]), scene.vertex_of(edge.points[1])}},
      {"from", point_json(scene.point(edge.points[0]))},
      {"to", point_json(scene.point(edge.points[1]))},
      {"edge", edge_kind(edge.kind)},
      {"objects", Json::array({scene.objects()[edge.object].name})}};
}

Json facet_json(const Scene& scene, int id) {
  const int object = scene.facets()[id].object;
  return {{"type", "face"},
          {"id", id},
          {"faces", polygons_of(scene, id)},
          {"objects", Json::array({scene.objects()[object].name})}};
}

/// "defects", up to kDefectsListed of a kind, and "defect_counts", of all.
void add_defects(Json& info, const std::vector<Defect>& defects) {
  std::map<std::string, int> counts;
  Json list = Json::array();
  for (const Defect& defect : defects) {
    if (++counts[defect.kind] > kDefectsListed) continue;
    Json j{{"kind", defect.kind}};
    if (!defect.faces.empty()) j["faces"] = defect.faces;
    if (!defect.vertices.empty()) j["vertices"] = defect.vertices;
    j["message"] = defect.message;
    list.push_back(std::move(j));
  }
  info["defects"] = std::move(list);
  info["defect_limit"] = kDefectsListed;
  info["defect_counts"] = Json::object();
  for (const auto& [kind, count] : counts) info["defect_counts"][kind] = count;
}

}  // namespace

std::string version() { return SIGHTLINE_VERSION; }

std::size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux counts KiB
}

Json answer_head(const std::string& command, const Scene& scene, bool complete,
                 const Cost& cost) {
  return answer_head(command, scene_counts(scene), complete, cost);
}

Json answer_head(const std::string& command, Json counts, bool complete,
                 const Cost& cost) {
  return {{"command", command},
          {"version", version()},
          {"scene", std::move(counts)},
          {"complete", complete},
          {"seconds", cost.seconds},
          {"peak_memory_bytes", peak_memory_bytes()},
          {"predicates", stage_counts(cost.predicates)}};
}

Json scene_counts(const Scene& scene) {
  const MeshEdgeCounts& e = scene.mesh_edges();
  return {{"file", scene.soup().source},
          {"vertices", vertex_count(scene)},
          {"faces", scene.soup().polygons.size()},
          {"edges", e.convex + e.reflex + e.flat + e.boundary + e.nonmanifold},
          {"objects", scene.objects().size()},
          {"facets", scene.facets().size()},
          {"solids", scene.solids()}};
}

Json stage_counts(const StageCounts& counts) {
  return {{"double", counts.by_double},
          {"interval", counts.by_interval},
          {"exact", counts.by_exact}};
}

Json point_json(const Point& p) { return {p.x(), p.y(), p.z()}; }

Json points_json(const std::array<Point, 2>& points) {
  return {point_json(points[0]), point_json(points[1])};
}

Json position_json(const ExactPosition& p) {
  Json j = Json::array();
  for (int axis = 0; axis < 3; ++axis) {
    if (p.is_double[axis]) {
      j.push_back(p.nearest[axis]);
    } else {
      j.push_back(p.exact[axis]);
    }
  }
  return j;
}

std::vector<int> polygons_of(const Scene& scene, int facet) {
  std::vector<int> polygons;
  for (const int f : scene.facets()[facet].faces) {
    polygons.push_back(scene.faces()[f].source);
  }
  std::ranges::sort(polygons);
  polygons.erase(std::unique(polygons.begin(), polygons.end()), polygons.end());
  return polygons;
}

Json generator_json(const Scene& scene, const Generator& generator) {
  switch (generator.kind) {
    case GeneratorKind::Vertex:
      return vertex_json(scene, generator.id);
    case GeneratorKind::Edge:
      return edge_json(scene, generator.id);
    case GeneratorKind::Face:
      return facet_json(scene, generator.id);
  }
  return nullptr;
}

Json info_json(const Scene& scene, const std::vector<Defect>& defects) {
  const MeshEdgeCounts& e = scene.mesh_edges();
  Json info{{"vertices", vertex_count(scene)},
            {"faces", scene.soup().polygons.size()},
            {"edges",
             {{"convex", e.convex},
              {"reflex", e.reflex},
              {"flat", e.flat},
              {"boundary", e.boundary},
              {"nonmanifold", e.nonmanifold}}},
            {"solids", scene.solids()}};
  Json groups = Json::array();
  if (scene.soup().groups.empty()) {
    for (const Object& object : scene.objects()) {
      std::vector<int> polygons;
      for (const int f : object.faces) {
        const int source = scene.faces()[f].source;
        if (polygons.empty() || polygons.back() != source) polygons.push_back(source);
      }
      groups.push_back({{"name", object.name}, {"faces", polygons.size()}});
    }
  } else {
    for (const PolygonSoup::Group& group : scene.soup().groups) {
      groups.push_back({{"name", group.name}, {"faces", group.faces.size()}});
      for (const std::string& alias : group.aliases) {
        groups.push_back({{"name", alias}, {"faces", group.faces.size()}});
      }
    }
  }
  info["groups"] = std::move(groups);
  info["bounds"] = points_json(scene.bounds());
  add_defects(info, defects);
  info["objects"] = scene.objects().size();
  int convex = 0, closed = 0;
  for (const Object& object : scene.objects()) {
    closed += object.closed ? 1 : 0;
    convex += object.convex ? 1 : 0;
  }
  info["closed_objects"] = closed;
  info["convex_objects"] = convex;
  info["facets"] = scene.facets().size();
  info["maximal_edges"] = scene.edges().size();
  info["corners"] = scene.corners().size();
  return info;
}

std::map<std::string, std::string> first_defects(const Json& info) {
  std::map<std::string, std::string> first;
  for (const Json& defect : info["defects"]) {
    first.emplace(defect["kind"].get<std::string>(),
                  defect["message"].get<std::string>());
  }
  return first;
}

Json node_counts(const Skeleton& skeleton) {
  Json counts, end;
  for (const char* kind : {"VV", "VEE", "EVE", "EEEE", "FvE", "FEE", "FF"}) {
    counts[kind] = 0;
    end[kind] = 0;
  }
  for (const char* kind : {"VV", "VEE", "EVE", "EEEE", "FvE", "FEE", "FF"}) {
    counts[std::string(kind) + "_self"] = 0;
  }
  counts["degenerate"] = 0;
  for (const SkeletonNode& node : skeleton.nodes) {
    Json& count = (node.end ? end : counts)[kind_name(node)];
    count = count.is_null() ? 1 : count.get<std::int64_t>() + 1;
  }
  counts["end"] = std::move(end);
  return counts;
}

Json arc_counts(const Skeleton& skeleton) {
  const auto counts_of = [&](bool end) {
    const auto count = [&](const auto& arcs, bool self) {
      return std::ranges::count_if(arcs, [&](const auto& arc) {
        return arc.self == self && (arc.ends[0] || arc.ends[1]) == end;
      });
    };
    return Json{{"EV", count(skeleton.ev(), false)},
                {"EEE", count(skeleton.eee(), false)},
                {"EV_self", count(skeleton.ev(), true)},
                {"EEE_self", count(skeleton.eee(), true)}};
  };
  Json counts = counts_of(false);
  if (skeleton.events == EventMode::Polygon) counts["end"] = counts_of(true);
  return counts;
}

std::string stopped_by_name(StoppedBy what) {
  switch (what) {
    case StoppedBy::Seconds:
      return "seconds";
    case StoppedBy::Bytes:
      return "megabytes";
    case StoppedBy::Request:
      return "interruption";
    case StoppedBy::Nothing:
      break;
  }
  return "nothing";
}

StoppedBy stopped_by_from(const std::string& name) {
  for (const StoppedBy what :
       {StoppedBy::Seconds, StoppedBy::Bytes, StoppedBy::Request, StoppedBy::Nothing}) {
    if (stopped_by_name(what) == name) return what;
  }
  throw InvalidInput(fmt::format("nothing is stopped by '{}'", name));
}

Json skeleton_json(const Skeleton& skeleton) {
  Json j{{"nodes", node_counts(skeleton)},
         {"arcs", arc_counts(skeleton)},
         {"vertices_done", skeleton.vertices_done},
         {"vertices_asked", skeleton.vertices_asked},
         {"edges_done", skeleton.edges_done},
         {"edges_asked", skeleton.edges_asked},
         {"facets_done", skeleton.facets_done},
         {"facets_asked", skeleton.facets_asked},
         {"skeleton_bytes", skeleton.bytes()}};
  if (skeleton.stopped_by == StoppedBy::Nothing) return j;
  Json missing = Json::array();
  const auto add = [&](const char* arcs, std::size_t done, std::size_t asked,
                       const char* generators) {
    if (done == asked) return;
    missing.push_back(
        fmt::format("the {} of {} of {} {}", arcs, asked - done, asked, generators));
  };
  add("EV arcs", skeleton.vertices_done, skeleton.vertices_asked, "vertices");
  add("EEE arcs", skeleton.edges_done, skeleton.edges_asked, "first edges");
  add("FF nodes", skeleton.facets_done, skeleton.facets_asked, "first faces");
  j["stopped_by"] = stopped_by_name(skeleton.stopped_by);
  j["missing"] = std::move(missing);
  return j;
}

Json node_json(const Scene& scene, const Skeleton& skeleton, std::size_t id) {
  const SkeletonNode& node = skeleton.nodes[id];
  Json j{{"id", id}, {"kind", kind_name(node)}};
  if (node.end) j["end"] = true;
  if (node.kind == NodeKind::EEEE) j["second"] = node.second;
  Json generators = Json::array();
  for (const Generator& g : skeleton.generators(node)) {
    generators.push_back(generator_json(scene, g));
    if (skeleton.events == EventMode::Polygon) generators.back()["contact"] = "graze";
  }
  const bool told = !generators.empty();
  if (told && node.ends[0]) generators.front()["contact"] = contact_name(true);
  if (told && node.ends[1]) generators.back()["contact"] = contact_name(true);
  j["generators"] = std::move(generators);
  j["line"] = points_json(node.segment);
  return j;
}

Json arc_json(const Scene& scene, const Skeleton& skeleton, std::size_t id) {
  const SkeletonArc& arc = skeleton.arcs[id];
  const bool told = skeleton.events == EventMode::Polygon;
  Json j{{"id", id}, {"kind", kind_name(arc)}};
  if (arc.is_ev()) {
    j["vertex"] = vertex_json(scene, arc.vertex());
    j["edge"] = edge_json(scene, arc.edge());
    if (told) j["vertex"]["contact"] = contact_name(arc.ends[0]);
    if (told) j["edge"]["contact"] = contact_name(arc.ends[1]);
  } else {
    const std::array<bool, 3> ends{arc.ends[0], false, arc.ends[1]};
    for (const int k : {0, 1, 2}) {
      j["edges"].push_back(edge_json(scene, arc.edges()[k]));
      if (told) j["edges"][k]["contact"] = contact_name(ends[k]);
    }
  }
  j["range"] = {arc.range[0], arc.range[1]};
  j["nodes"] = {arc.nodes[0], arc.nodes[1]};
  return j;
}

Json simplified_json(const Scene& scene, const Simplified& simplified, bool with_ids) {
  Json j{{"feature_size", simplified.feature_size}};
  j["edges"] = simplified.edges.size();
  j["vertices"] = simplified.vertices.size();
  j["objects"] = simplified.objects.size();
  j["arcs"] = simplified.arcs.size();
  if (!with_ids) return j;
  Json names = Json::array();
  for (const int o : simplified.objects) names.push_back(scene.objects()[o].name);
  Json arcs = Json::array();
  for (const Simplified::Arc& arc : simplified.arcs) {
    arcs.push_back({{"vertex", arc.vertex}, {"edge", arc.edge}, {"range", arc.range}});
  }
  j["edge_ids"] = simplified.edges;
  j["vertex_ids"] = simplified.vertices;
  j["object_ids"] = simplified.objects;
  j["object_names"] = std::move(names);
  j["arc_list"] = std::move(arcs);
  return j;
}

Json skeleton_answer(const Scene& scene, const Skeleton& skeleton, const Json& options,
                     Precision precision, bool complete, const Cost& cost,
                     bool with_ids) {
  Json answer = answer_head("skeleton", scene, complete, cost);
  answer["options"] = options;
  answer["options"]["precision"] = precision == Precision::Exact ? "exact" : "double";
  answer.update(skeleton_json(skeleton));
  answer["simplified"] = simplified_json(scene, skeleton.simplified, with_ids);
  return answer;
}

StageCounts operator+(const StageCounts& a, const StageCounts& b) {
  return {a.by_double + b.by_double, a.by_interval + b.by_interval,
          a.by_exact + b.by_exact};
}

StageCounts operator-(const StageCounts& a, const StageCounts& b) {
  return {a.by_double - b.by_double, a.by_interval - b.by_interval,
          a.by_exact - b.by_exact};
}

}  // namespace sightline::viewers
