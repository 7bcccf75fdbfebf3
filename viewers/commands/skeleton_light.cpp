#include "viewers/commands/skeleton_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "skeleton/source_events.h"

namespace sightline::viewers {
namespace {

std::string kind_name(SourceArcKind kind) {
  switch (kind) {
    case SourceArcKind::Face:
      return "face";
    case SourceArcKind::EE:
      return "EE";
    case SourceArcKind::EV:
      return "EV";
    default:
      return "EEE";
  }
}

Json source_generator_json(const Scene& scene, const SourceGenerator& g) {
  switch (g.kind) {
    case SourceGenerator::Kind::Vertex:
      return generator_json(scene, Generator{GeneratorKind::Vertex, g.id});
    case SourceGenerator::Kind::Edge:
      return generator_json(scene, Generator{GeneratorKind::Edge, g.id});
    case SourceGenerator::Kind::SourceCorner:
      return {{"type", "source corner"}, {"id", g.id}};
    case SourceGenerator::Kind::SourceSide:
      return {{"type", "source side"}, {"id", g.id}};
    case SourceGenerator::Kind::Touch:
      return {{"type", "touch"}, {"id", g.id}};
    default:
      return {{"type", "horizon"}, {"id", g.id}};
  }
}

Json cut_json(const SourceCut& cut) {
  Json j{{"at", cut.at}, {"exact", cut.exact}, {"point", point_json(cut.on_receiver)}};
  switch (cut.cause) {
    case SourceCut::Cause::GeneratorEnd:
      j["by"] = "generator end";
      break;
    case SourceCut::Cause::FaceSide:
      j["by"] = "side";
      j["polygon"] = cut.id;
      if (cut.edge >= 0) j["edge"] = cut.edge;
      break;
    case SourceCut::Cause::SourceSide:
      j["by"] = "source side";
      j["id"] = cut.id;
      break;
    case SourceCut::Cause::Pierce:
      j["by"] = "pierced polygon";
      j["polygon"] = cut.id;
      break;
    default:
      j["by"] = "crossing";
  }
  return j;
}

Json arc_json(const Scene& scene, const SourceArc& arc) {
  Json j{{"kind", kind_name(arc.kind)}, {"outline", arc.outline}};
  for (const SourceGenerator& g : arc.generators) {
    j["generators"].push_back(source_generator_json(scene, g));
  }
  if (arc.in_line) {
    for (const SourceGenerator& g : *arc.in_line) {
      j["in_line"].push_back(source_generator_json(scene, g));
    }
  }
  if (arc.facet >= 0) j["facet"] = arc.facet;
  j["curved"] = arc.curved;
  for (const SourceArc::Piece& piece : arc.pieces) {
    j["pieces"].push_back({{"receiver", piece.polygon},
                           {"front", piece.front},
                           {"ends", {cut_json(piece.ends[0]), cut_json(piece.ends[1])}}});
  }
  return j;
}

Json outline_json(const SourceOutline& outline) {
  Json j{{"polygons", outline.polygons}};
  j["sides"] = Json::array();
  for (const SourceOutline::Side& side : outline.sides) {
    Json s{{"ends", {position_json(side.ends[0]), position_json(side.ends[1])}}};
    if (side.foot_of >= 0) s["foot_of"] = side.foot_of;
    j["sides"].push_back(std::move(s));
  }
  j["corners"] = Json::array();
  for (const ExactPosition& c : outline.corners) {
    j["corners"].push_back(position_json(c));
  }
  return j;
}

}  // namespace

ExitStatus run_light(Session& session, const CommonOptions& options,
                     const std::vector<std::string>& groups, bool list,
                     const Scene& scene, const StageCounts& loading, Outputs& outputs) {
  SourceEventsRequest request;
  request.threads = options.threads;
  session.limit(request);
  for (const std::string& group : groups) {
    const std::vector<int> faces = scene.faces_named(group);
    request.source_faces.insert(request.source_faces.end(), faces.begin(), faces.end());
  }
  std::ranges::sort(request.source_faces);
  const auto [end, last] = std::ranges::unique(request.source_faces);
  request.source_faces.erase(end, last);
  const SourceEvents events = source_events(scene, request);
  const SourceEvents::Counts counts = events.counts();
  std::size_t pieces = 0;
  for (const SourceArc& arc : events.arcs) pieces += arc.pieces.size();

  Json answer =
      answer_head("skeleton", scene, events.complete, {session.seconds(), loading});
  answer["options"] = {{"light", groups}};
  answer["arcs"] = {
      {"EV", counts.ev}, {"EEE", counts.eee}, {"EE", counts.ee}, {"face", counts.face}};
  answer["pieces"] = pieces;
  answer["outlines"] = Json::array();
  for (const SourceOutline& outline : events.outlines) {
    answer["outlines"].push_back(outline_json(outline));
  }
  if (list) {
    answer["arc_list"] = Json::array();
    for (const SourceArc& arc : events.arcs) {
      answer["arc_list"].push_back(arc_json(scene, arc));
    }
  }
  outputs.write_answer(answer);
  if (options.may_print()) {
    std::cout << fmt::format(
        "{}: events of a source{}\n  arcs: EV {} EEE {} EE {} face {}\n  {} pieces on "
        "receivers\n  {:.3f} s\n",
        scene.soup().source, events.complete ? "" : ", INCOMPLETE", counts.ev, counts.eee,
        counts.ee, counts.face, pieces, session.seconds());
  }
  return session.end(events.complete);
}

}  // namespace sightline::viewers
