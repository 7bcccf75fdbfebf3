#include "viewers/queries/path_answer.h"

#include "viewers/queries/view_answer.h"

namespace sightline::viewers {

std::string_view name(PathEventKind kind) {
  static constexpr const char* kNames[] = {"EV", "EEE", "F", "through"};
  return kNames[static_cast<int>(kind)];
}

Json path_event_json(const Scene& scene, const PathEvent& event) {
  Json generators = Json::array();
  for (const Generator& g : event.generators)
    generators.push_back(generator_json(scene, g));
  return {{"kind", name(event.kind)}, {"generators", std::move(generators)}};
}

Json path_events_json(const Scene& scene, const ViewPath& path) {
  Json list = Json::array();
  for (const PathChange& change : path.changes) {
    const MapCounts& d = change.difference;
    const Json changes{
        {"corners", d.corners},      {"t_vertices", d.t_vertices},
        {"touches", d.touches},      {"accident_vertices", d.accident_vertices},
        {"edges", d.edges},          {"regions", d.regions},
        {"components", d.components}};
    for (const PathEvent& event : change.events) {
      Json told = path_event_json(scene, event);
      told.update(Json{{"u", change.u},
                       {"segment", change.segment},
                       {"appears", change.appears},
                       {"vanishes", change.vanishes},
                       {"changes", changes}});
      list.push_back(std::move(told));
    }
  }
  return list;
}

Json path_views_json(const Scene& scene, const ViewPath& path, bool with_map) {
  Json list = Json::array();
  for (const PathStretch& stretch : path.stretches) {
    const PointView& view = stretch.view.value();
    Json j{
        {"segment", stretch.segment}, {"u_from", stretch.u_from}, {"u_to", stretch.u_to}};
    j.update(view_json(scene, {view.eye, view.eye.at.exact, ""}, view, with_map));
    list.push_back(std::move(j));
  }
  return list;
}

}  // namespace sightline::viewers
