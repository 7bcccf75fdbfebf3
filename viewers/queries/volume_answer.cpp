#include "viewers/queries/volume_answer.h"

#include <fmt/format.h>

namespace sightline::viewers {
namespace {

Json volume_json(const ShadowVolume& volume, double its) {
  Json vertices = Json::array(), sides = Json::array();
  for (const ExactPosition& v : volume.vertices) vertices.push_back(position_json(v));
  for (const ShadowVolume::Side& side : volume.sides) {
    sides.push_back({{"kind", name(side.kind)},
                     {"generators", side.generators},
                     {"corners", side.corners}});
  }
  return {{"volume", its}, {"vertices", vertices}, {"sides", sides}};
}

}  // namespace

Json volumes_json(const ShadowVolumes& volumes) {
  return {{"umbra", volume_json(volumes.umbra(), volumes.umbra().volume)},
          {"penumbra", volume_json(volumes.shadow(), volumes.penumbra_volume())},
          {"lit_volume", volumes.lit_volume()},
          {"away_volume", volumes.away_volume()},
          {"solid_volume", volumes.solid_volume()}};
}

std::string told(const ShadowVolumes& volumes) {
  return fmt::format(
      "  volumes: umbra {:.6g} (the solid {:.6g}), penumbra {:.6g}, lit {:.6g}, behind "
      "the source {:.6g}\n",
      volumes.umbra().volume, volumes.solid_volume(), volumes.penumbra_volume(),
      volumes.lit_volume(), volumes.away_volume());
}

std::vector<std::string> LeftOut::names() const {
  std::vector<std::string> all;
  for (const SmallPart& part : parts) {
    for (const int polygon : part.polygons)
      all.push_back(fmt::format("#{0}-{0}", polygon));
  }
  return all;
}

void add_left_out(Json& answer, const Scene& scene, const LeftOut& left_out) {
  answer["feature_size"] = left_out.feature_size;
  Json& parts = answer["left_out"] = Json::array();
  for (const SmallPart& part : left_out.parts) {
    parts.push_back({{"group", scene.objects()[part.object].name},
                     {"polygons", part.polygons},
                     {"diagonal", part.diagonal}});
  }
  answer["form_factor_error_bound"] = left_out.bound;
}

std::string told(const LeftOut& left_out) {
  return fmt::format(
      "  feature size {} left out: {} blockers; form factors grow by at most {:.3g}\n",
      left_out.feature_size, left_out.parts.size(), left_out.bound);
}

}  // namespace sightline::viewers
