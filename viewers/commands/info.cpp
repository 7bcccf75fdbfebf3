// `sightline info`: what a file holds, and what is wrong with it.

#include <fmt/format.h>

#include <iostream>

#include "viewers/commands/outputs.h"
#include "viewers/vtk_export.h"

namespace sightline::viewers {
namespace {

void print_summary(const Scene& scene, const Json& answer) {
  const auto [low, high] = scene.bounds();
  const MeshEdgeCounts& e = scene.mesh_edges();
  std::cout << fmt::format(
      "{}\n"
      "  {}, {}, {}, {} closed and consistently oriented\n"
      "  edges: {} convex, {} reflex, {} flat, {} boundary, {} non-manifold\n"
      "  generators: {} corners, {} edges; {} coplanar facets\n"
      "  bounds: ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g})\n",
      scene.soup().source,
      counted(answer["vertices"].get<std::size_t>(), "vertex", "vertices"),
      counted(answer["faces"].get<std::size_t>(), "face", "faces"),
      counted(scene.objects().size(), "object", "objects"),
      counted(scene.solids(), "component", "components"), e.convex, e.reflex, e.flat,
      e.boundary, e.nonmanifold, scene.corners().size(), scene.edges().size(),
      scene.facets().size(), low.x(), low.y(), low.z(), high.x(), high.y(), high.z());
  if (answer["defects"].empty()) std::cout << "  no defects\n";
  for (const auto& [kind, first] : first_defects(answer)) {
    std::cout << fmt::format("  defect: {}: {}, first: {}\n", kind,
                             answer["defect_counts"][kind].get<int>(), first);
  }
  constexpr std::size_t kShown = 12;
  const Json& groups = answer["groups"];
  for (std::size_t i = 0; i < groups.size() && i < kShown; ++i) {
    std::cout << fmt::format(
        "  group {}: {}\n", groups[i]["name"].get<std::string>(),
        counted(groups[i]["faces"].get<std::size_t>(), "face", "faces"));
  }
  if (groups.size() > kShown) {
    std::cout << fmt::format("  and {} more groups (--json lists them)\n",
                             groups.size() - kShown);
  }
}

ExitStatus run(Session& session, const CommonOptions& options) {
  Outputs outputs(options);
  const Meter meter;
  const PrecisionScope precision(options.precision);
  const Scene scene = read_scene(session, options.scene, options.format);
  const std::vector<Defect> defects = validate(scene, session.with_grace());
  if (!options.vtk.empty()) {
    session.write("VTK files", [&](const Request& request) {
      write_vtk(options.vtk, scene, {}, request);
    });
  }
  Json answer = answer_head("info", scene, session.unwritten().empty(),
                            {session.seconds(), meter.predicates()});
  answer.update(info_json(scene, defects));
  outputs.write_answer(answer);
  if (options.may_print()) print_summary(scene, answer);
  return session.end(true);
}

}  // namespace

Command add_info_command(CLI::App& app) {
  auto options = std::make_shared<CommonOptions>();
  CLI::App* command =
      app.add_subcommand("info", "what a scene holds: counts, groups, bounds, defects");
  add_scene_argument(*command, *options);
  add_common_options(*command, *options);
  return command_of(options, run);
}

}  // namespace sightline::viewers
