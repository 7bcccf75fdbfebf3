#include "viewers/skeleton_queries.h"

#include <algorithm>

#include "viewers/far_ends.h"

namespace sightline::viewers {
namespace {

const std::string kOutsideName = "outside";

// Facets of a group, ascending; kOutside for what is no group.
std::vector<std::int32_t> facets_named(const Scene& scene, const std::string& group) {
  if (group == kOutsideName) return {kOutside};
  std::vector<std::int32_t> facets;
  for (const int f : scene.faces_named(group)) facets.push_back(scene.faces()[f].facet);
  std::sort(facets.begin(), facets.end());
  facets.erase(std::unique(facets.begin(), facets.end()), facets.end());
  return facets;
}

void sort_unique(std::vector<std::uint32_t>& arcs) {
  std::sort(arcs.begin(), arcs.end());
  arcs.erase(std::unique(arcs.begin(), arcs.end()), arcs.end());
}

std::string end_name(const Scene& scene, std::int32_t facet) {
  if (facet == kOutside) return kOutsideName;
  return scene.objects()[scene.facets()[facet].object].name;
}

}  // namespace

std::vector<std::uint32_t> seen_from(const Scene& scene, const EndIndex& ends,
                                     const std::string& group) {
  std::vector<std::uint32_t> arcs;
  for (const std::int32_t facet : facets_named(scene, group)) {
    const auto seen = ends.seen_from(facet);
    arcs.insert(arcs.end(), seen.begin(), seen.end());
  }
  sort_unique(arcs);
  return arcs;
}

std::vector<std::uint32_t> between_ends(const Scene& scene, const EndIndex& ends,
                                        const std::array<std::string, 2>& groups) {
  std::vector<std::uint32_t> arcs;
  const auto others = facets_named(scene, groups[1]);
  for (const std::int32_t a : facets_named(scene, groups[0])) {
    for (const std::int32_t b : others) {
      const auto found = ends.between_facets(a, b);
      arcs.insert(arcs.end(), found.begin(), found.end());
    }
  }
  sort_unique(arcs);
  return arcs;
}

Json arcs_by_ends_json(const Scene& scene, const Skeleton& skeleton, const EndIndex& ends,
                       const std::vector<std::uint32_t>& arcs) {
  Json list = Json::array();
  int ev = 0;
  for (const std::uint32_t arc : arcs) {
    ev += static_cast<int>(skeleton.arcs[arc].is_ev());
    Json j = arc_json(scene, skeleton, arc);
    Json pieces = Json::array();
    const auto all = ends.pieces(arc);
    for (std::size_t k = 0; k < all.size(); ++k) {
      Json names = Json::array();
      for (const std::int32_t facet : all[k].facets) {
        names.push_back(end_name(scene, facet));
      }
      const std::array<double, 2> range{all[k].from, ends.end_of(arc, k)};
      pieces.push_back({{"range", range}, {"ends", std::move(names)}});
    }
    j["pieces"] = std::move(pieces);
    list.push_back(std::move(j));
  }
  return {{"arcs", {{"EV", ev}, {"EEE", static_cast<int>(arcs.size()) - ev}}},
          {"list", std::move(list)}};
}

Json events_json(const Scene& scene, const Skeleton& skeleton,
                 const std::vector<ViewEvent>& events) {
  Json list = Json::array();
  for (const ViewEvent& e : events) {
    Json j{{"u", e.u}, {"point", point_json(e.point)}, {"tie", e.tie}};
    if (e.kind == EventKind::F) {
      j["kind"] = "F";
      j["facet"] = {{"id", e.id},
                    {"faces", source_polygons(scene, scene.facets()[e.id].faces)},
                    {"objects", {scene.objects()[scene.facets()[e.id].object].name}}};
    } else {
      j.update(arc_json(scene, skeleton, e.id));
      j["side"] = e.side;
    }
    list.push_back(std::move(j));
  }
  return list;
}

}  // namespace sightline::viewers
