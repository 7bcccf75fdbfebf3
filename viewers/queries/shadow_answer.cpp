#include "viewers/queries/shadow_answer.h"

#include <fmt/format.h>

#include "viewers/queries/view_answer.h"

namespace sightline::viewers {
namespace {

Json vector_json(const Eigen::Vector3d& v) { return Json::array({v[0], v[1], v[2]}); }

}  // namespace

std::string_view name(ShadowClass shadow) {
  switch (shadow) {
    case ShadowClass::Umbra:
      return "umbra";
    case ShadowClass::Penumbra:
      return "penumbra";
    case ShadowClass::Lit:
      break;
  }
  return "lit";
}

std::string told(const SeenSide& side) {
  switch (side.kind) {
    case SeenSide::Kind::Source:
      return fmt::format("source {}", side.id);
    case SeenSide::Kind::Edge:
      return fmt::format("edge {}", side.id);
    case SeenSide::Kind::Cut:
      return fmt::format("cut {}", side.id);
    case SeenSide::Kind::Horizon:
      break;
  }
  return "horizon";
}

Json structure_json(const std::vector<SeenBoundary>& boundaries) {
  Json structure = Json::array();
  for (const SeenBoundary& boundary : boundaries) {
    Json sides = Json::array();
    for (const auto& names : boundary.sides) {
      Json in_line = Json::array();
      for (const SeenSide& side : names) in_line.push_back(told(side));
      sides.push_back(std::move(in_line));
    }
    structure.push_back({{"source_face", boundary.source_face}, {"sides", sides}});
  }
  return structure;
}

Json shadow_json(const ShadowQuestion& question, const Backprojection& seen,
                 const ShadowJsonOptions& options) {
  Json json{{"at", asked_json(question.point.at, question.asked)},
            {"class", name(seen.shadow)},
            {"visible_fraction", seen.visible_fraction},
            {"form_factor", nullptr}};
  if (seen.form_factor) json["form_factor"] = *seen.form_factor;
  if (options.gradient) {
    json["gradient"] = nullptr;
    if (seen.gradient) json["gradient"] = vector_json(*seen.gradient);
  }
  if (options.structure) {
    json["structure"] = structure_json(seen.boundaries);
    Json& corners = json["seen"] = Json::array();
    for (const SeenBoundary& boundary : seen.boundaries) {
      Json points = Json::array();
      for (const Point& p : boundary.corners) points.push_back(point_json(p));
      corners.push_back(std::move(points));
    }
  }
  return json;
}

std::string shadow_csv(std::size_t number, const ShadowQuestion& question,
                       const Backprojection& seen) {
  const Point& p = question.point.at.nearest;
  return fmt::format("{},{},{},{},{},{},{}\n", number, p[0], p[1], p[2],
                     name(seen.shadow), seen.visible_fraction,
                     seen.form_factor ? fmt::format("{}", *seen.form_factor) : "");
}

}  // namespace sightline::viewers
