#include "viewers/queries/viewpoint_answer.h"

#include <fmt/format.h>

#include <cmath>

#include "linespace/point_view.h"
#include "viewers/queries/aspect_answer.h"

namespace sightline::viewers {
namespace {

Json finite_or_null(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

Json view_json(const Scene& scene, const ChosenView& view) {
  return {{"at", position_json(view.at.at)}, {"faces", polygons_of(scene, view.facets)}};
}

// A patch, by the polygons of one of its facets.
Json patches_json(const Scene& scene, const std::vector<int>& facets) {
  Json out = Json::array();
  for (const int f : facets) out.push_back(viewers::polygons_of(scene, f));
  return out;
}

}  // namespace

Json best_json(const Scene& scene, const BestViews& best) {
  Json out{{"viewpoints", Json::array()}};
  for (const ChosenView& view : best.views) {
    Json j = view_json(scene, view);
    j["value"] = view.value;
    j["bound"] = finite_or_null(best.bound);
    out["viewpoints"].push_back(std::move(j));
  }
  out["bound"] = finite_or_null(best.bound);
  out["certified"] = best.certified;
  out["views"] = best.taken;
  return out;
}

Json cover_json(const Scene& scene, const ViewCover& cover) {
  Json out{{"viewpoints", Json::array()}};
  for (const ChosenView& view : cover.views)
    out["viewpoints"].push_back(view_json(scene, view));
  out["lower_bound"] = cover.lower_bound;
  out["optimal"] = cover.optimal;
  out["never_seen"] = polygons_of(scene, cover.never_seen);
  out["not_settled"] = polygons_of(scene, cover.unsettled);
  out["short_of"] = patches_json(scene, cover.short_of);
  out["certificate"] = {{"apart", patches_json(scene, cover.apart)},
                        {"patches", cover.patches},
                        {"most_patches", finite_or_null(cover.most_patches)},
                        {"steps", cover.search_steps},
                        {"finished", cover.search_finished}};
  out["certified"] = cover.certified;
  out["views"] = cover.taken;
  return out;
}

std::vector<SavedAspect> saved_aspects(const JsonInput& file, Projection projection) {
  const auto kind = projection == Projection::Orthographic ? Viewpoint::Kind::Direction
                                                           : Viewpoint::Kind::Eye;
  std::vector<SavedAspect> out;
  for (const JsonInput& aspect : file.at("list").items()) {
    const JsonInput at = aspect.at("at");
    try {
      out.push_back({viewpoint(kind, at.coordinates()), aspect.at("structure").text(),
                     aspect.told()});
    } catch (const InvalidInput& refusal) {
      if (std::string(refusal.what()).starts_with(aspect.told())) throw;
      at.refuse(refusal.what());
    }
  }
  if (out.empty()) file.at("list").refuse("expected at least one aspect");
  return out;
}

std::vector<Viewpoint> viewpoints_of(const Scene& scene,
                                     const std::vector<SavedAspect>& graph,
                                     const Request& request) {
  const PointViewIndex index(scene, request);
  std::vector<Viewpoint> out;
  for (const SavedAspect& aspect : graph) {
    if (index.view(aspect.at, request).structure != aspect.structure) {
      throw InvalidInput(fmt::format(
          "{}: another view than SCENE has there: the graph is of another scene, or of "
          "the other projection",
          aspect.where));
    }
    out.push_back(aspect.at);
  }
  return out;
}

}  // namespace sightline::viewers
