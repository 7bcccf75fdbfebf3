#include "viewers/queries/aspect_answer.h"

#include <algorithm>
#include <set>

#include "viewers/queries/path_answer.h"

namespace sightline::viewers {
namespace {

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json aspect_json(const Scene& scene, std::size_t id, const Aspect& aspect) {
  Json out{{"id", id},
           {"weight", or_null(aspect.weight)},
           {"at", position_json(aspect.at.at)},
           {"clearance", or_null(aspect.clearance)},
           {"faces", polygons_of(scene, aspect.facets)},
           {"structure", aspect.structure},
           {"neighbours", Json::array()},
           {"events", Json::array()}};
  for (const AspectNeighbour& n : aspect.neighbours) {
    out["neighbours"].push_back(n.aspect);
    Json walls = Json::array();
    for (const AspectWall& wall : n.walls) walls.push_back(path_event_json(scene, wall));
    out["events"].push_back(std::move(walls));
  }
  return out;
}

}  // namespace

std::vector<int> polygons_of(const Scene& scene, const std::vector<int>& facets) {
  std::set<int> out;
  for (const int facet : facets) {
    for (const int f : scene.facets()[facet].faces) out.insert(scene.faces()[f].source);
  }
  return {out.begin(), out.end()};
}

std::string_view name(AspectMethod method) {
  constexpr std::string_view kNames[] = {"sampled", "refined", "exact"};
  return kNames[static_cast<int>(method)];
}

Json aspects_json(const Scene& scene, const AspectGraph& graph, bool list) {
  Json out{{"method", name(graph.method)},
           {"aspects", graph.aspects},
           {"adjacencies", graph.adjacencies},
           {"distinct", graph.distinct},
           {"by_visible_faces", graph.by_visible_faces},
           {"by_shape", graph.by_shape},
           {"certified", graph.certified},
           {"views", graph.views},
           {"estimate", nullptr}};
  if (!graph.why.empty()) out["why"] = graph.why;
  for (const AspectGraph::Round& round : graph.rounds)
    out["rounds"].push_back({{"views", round.views}, {"aspects", round.aspects}});
  if (graph.unbounded) {
    out["unbounded"] = *graph.unbounded;
    out["bounded"] = *graph.bounded;
  }
  if (const auto& e = graph.estimate) {
    out["estimate"] = {{"unseen_weight", e->unseen_weight},
                       {"unseen_interval95", e->unseen_interval},
                       {"distinct_total", e->distinct_total},
                       {"distinct_interval95", e->distinct_interval},
                       {"seen_once", e->seen_once},
                       {"seen_twice", e->seen_twice}};
  }
  if (const auto& c = graph.check) {
    out["check"] = {{"views", c->views},
                    {"not_in_graph", c->not_in_graph},
                    {"interval95", c->interval}};
  }
  if (!list) return out;
  out["list"] = Json::array();
  for (std::size_t i = 0; i < graph.list.size(); ++i)
    out["list"].push_back(aspect_json(scene, i, graph.list[i]));
  return out;
}

}  // namespace sightline::viewers
