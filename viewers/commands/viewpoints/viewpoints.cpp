// `sightline viewpoints`: from where to look.

#include "aspect/viewpoints.h"

#include <fmt/format.h>

#include <cmath>
#include <iostream>

#include "viewers/commands/command_line.h"
#include "viewers/commands/outputs.h"
#include "viewers/queries/viewpoint_answer.h"
#include "viewers/questions.h"

namespace sightline::viewers {
namespace {

struct ViewpointsOptions : CommonOptions {
  std::string projection, aspect = "faces", by = "faces", cover, next, of, graph;
  std::vector<double> bounds;
  int best = 0, samples = 0;
  double fraction = 0;  ///< 0: not told
  std::uint64_t seed = 1;

  [[nodiscard]] Projection kind() const {
    return projection == "orthographic" ? Projection::Orthographic
                                        : Projection::Perspective;
  }
};

/// What the command line names besides the scene.
struct ViewpointsQuestion {
  std::vector<Viewpoint> seen;
  std::vector<SavedAspect> graph;
};

constexpr std::array kMeasures{"faces", "area", "solid-angle", "entropy", "structure"};

ViewMeasure measure_named(const std::string& name) {
  const auto at = std::ranges::find(kMeasures, name);
  return static_cast<ViewMeasure>(at - kMeasures.begin());
}

void check(const ViewpointsOptions& options) {
  const int asked = (options.best > 0 ? 1 : 0) + (options.cover.empty() ? 0 : 1) +
                    (options.next.empty() ? 0 : 1);
  if (asked != 1)
    throw UsageError("viewpoints: needs one of --best N, --cover and --next FILE");
  if (options.fraction > 0 && options.cover != "parts")
    throw UsageError("--fraction: is for --cover parts");
  if (options.kind() == Projection::Orthographic && !options.bounds.empty())
    throw UsageError("--bounds: is for --projection perspective");
  if (options.kind() == Projection::Orthographic && options.by == "entropy")
    throw UsageError("--by entropy: is for --projection perspective");
  (void)region_box(options.bounds, "--bounds");
}

ViewpointsQuestion question_of(Session& session, const ViewpointsOptions& options,
                               Outputs& outputs) {
  ViewpointsQuestion out;
  if (!options.next.empty()) {
    outputs.protect(options.next);
    const JsonInput file = session.read([&] { return JsonInput(options.next); });
    for (const ViewQuestion& q : view_questions(file)) out.seen.push_back(q.eye);
  }
  if (!options.graph.empty()) {
    outputs.protect(options.graph);
    const JsonInput file = session.read([&] { return JsonInput(options.graph); });
    out.graph = saved_aspects(file, options.kind());
  }
  return out;
}

ViewpointRequest request_of(Session& session, const ViewpointsOptions& options,
                            const Scene& scene, const ViewpointsQuestion& question) {
  ViewpointRequest request;
  session.limit(request);
  request.precision = options.precision;
  request.threads = options.threads;
  request.projection = options.kind();
  request.label =
      options.aspect == "structure" ? AspectLabel::Structure : AspectLabel::Faces;
  request.bounds = region_box(options.bounds, "--bounds");
  if (!options.of.empty()) request.of = scene.faces_named(options.of);
  if (options.samples > 0) request.samples = options.samples;
  request.seed = options.seed;
  if (!question.graph.empty())
    request.first = viewpoints_of(scene, question.graph, request);
  return request;
}

std::string told(const Json& at) {
  std::vector<std::string> out;
  for (const Json& x : at)
    out.push_back(x.is_string() ? x.get<std::string>()
                                : fmt::format("{:.9g}", x.get<double>()));
  return fmt::format("{}", fmt::join(out, ","));
}

void print(const ViewpointsOptions& options, const Json& answer) {
  constexpr std::size_t kShown = 40;
  const Json& views = answer["viewpoints"];
  std::cout << fmt::format("{}: {}{}\n", options.scene,
                           counted(views.size(), "viewpoint", "viewpoints"),
                           answer["complete"].get<bool>() ? "" : ", INCOMPLETE");
  for (std::size_t i = 0; i < std::min(kShown, views.size()); ++i) {
    const Json& view = views[i];
    std::cout << fmt::format("  {}  sees {}", told(view["at"]),
                             counted(view["faces"].size(), "polygon", "polygons"));
    if (view.contains("value"))
      std::cout << fmt::format("; {:.6g}", view["value"].get<double>());
    std::cout << '\n';
  }
  if (answer.contains("lower_bound")) {
    std::cout << fmt::format("  at least {} are needed{}\n",
                             answer["lower_bound"].get<int>(),
                             answer["optimal"].get<bool>() ? ": proved fewest" : "");
    std::cout << fmt::format(
        "  never seen: {}; not settled: {}\n",
        counted(answer["never_seen"].size(), "polygon", "polygons"),
        counted(answer["not_settled"].size(), "polygon", "polygons"));
    if (!answer["short_of"].empty()) {
      std::cout << fmt::format("  less than asked is seen of {}\n",
                               counted(answer["short_of"].size(), "patch", "patches"));
    }
  } else if (!answer["bound"].is_null()) {
    std::cout << fmt::format("  no view has more than {:.6g}\n",
                             answer["bound"].get<double>());
  }
  std::cout << fmt::format("  {:.3f} s\n", answer["seconds"].get<double>());
}

ExitStatus run(Session& session, const ViewpointsOptions& options) {
  check(options);
  Outputs outputs(options);
  const ViewpointsQuestion question = question_of(session, options, outputs);
  const Meter meter;
  const Scene scene = read_scene(session, options.scene, options.format);
  const ViewpointRequest request = request_of(session, options, scene, question);
  Json found;
  bool complete = true;
  if (!options.cover.empty()) {
    const ViewCover cover = cover_views(
        scene, request, options.cover == "whole" ? CoverGoal::Whole : CoverGoal::Parts,
        options.fraction > 0 ? std::optional(options.fraction) : std::nullopt);
    found = cover_json(scene, cover);
    complete = cover.complete;
  } else {
    const BestViews best =
        options.best > 0
            ? best_views(scene, request, measure_named(options.by), options.best)
            : next_view(scene, request, question.seen);
    found = best_json(scene, best);
    complete = best.complete;
  }
  Json answer =
      answer_head("viewpoints", scene, complete, {session.seconds(), meter.predicates()});
  answer.update(found);
  outputs.write_answer(answer);
  if (options.may_print()) print(options, answer);
  return session.end(complete);
}

void add_question_options(CLI::App& command, ViewpointsOptions& options) {
  command
      .add_option("--best", options.best,
                  "the N best views, the best first, no two of one aspect")
      ->type_name("N")
      ->check(whole_number(1, 100'000));
  command
      .add_option("--by", options.by,
                  "what is good about a view of --best. faces: patches seen; area: "
                  "surface seen, in scene units^2; solid-angle: of all that is seen, in "
                  "steradians (orthographic: the projected area, units^2); entropy: of "
                  "the solid angles, in bits, background included (perspective); "
                  "structure: vertices of the map")
      ->check(one_of({kMeasures.begin(), kMeasures.end()}))
      ->capture_default_str();
  command
      .add_option("--cover", options.cover,
                  "few viewpoints that together see some of every patch (parts), or "
                  "every point (whole), that is seen from anywhere")
      ->check(one_of({"parts", "whole"}));
  command
      .add_option("--fraction", options.fraction,
                  "of --cover parts: together at least this share, above 0 and at most "
                  "1, of what is seen from anywhere of each patch (default: some)")
      ->type_name("E")
      ->check(number_above_zero(1));
  command
      .add_option(
          "--next", options.next,
          R"(JSON: {"views": [{"from": [x,y,z]} | {"direction": [x,y,z]}, ...]}: )"
          "the view that adds most patches to what these see")
      ->type_name("FILE");
}

void add_space_options(CLI::App& command, ViewpointsOptions& options) {
  command
      .add_option("--projection", options.projection,
                  "orthographic: look from any direction; perspective: from any point")
      ->required()
      ->check(one_of({"orthographic", "perspective"}));
  command
      .add_option("--bounds", options.bounds,
                  "the eye stays in this box: x0,y0,z0,x1,y1,z1 (perspective)")
      ->type_name("x0,y0,z0,x1,y1,z1")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->expected(6)
      ->check(finite_number());
  command.add_option("--of", options.of,
                     "where to stand to see this: only what is seen of this group "
                     "counts, all else hides");
  command
      .add_option("--aspect", options.aspect,
                  "what tells two aspects apart: the faces seen, or the drawing's "
                  "labelled structure")
      ->check(one_of({"faces", "structure"}))
      ->capture_default_str();
  command
      .add_option("--from-graph", options.graph,
                  "an aspect graph, as `sightline aspects SCENE --list --json FILE` "
                  "writes it: its viewpoints are tried first; refused if it is of "
                  "another scene")
      ->type_name("FILE");
  command
      .add_option("--samples", options.samples,
                  "at least so many views to begin with (default 642)")
      ->type_name("N")
      ->check(whole_number(1, 100'000'000));
  command
      .add_option("--seed", options.seed, "of the random steps of the search (default 1)")
      ->type_name("S")
      ->check(whole_number(0));
}

}  // namespace

Command add_viewpoints_command(CLI::App& app) {
  auto options = std::make_shared<ViewpointsOptions>();
  CLI::App* command = app.add_subcommand(
      "viewpoints",
      "from where to look: the best views, few that together see all, the next best");
  add_scene_argument(*command, *options);
  add_question_options(*command, *options);
  add_space_options(*command, *options);
  add_common_options(*command, *options, false);
  command->footer(
      "Viewpoints are searched for; each is verified by its exact view. Bounds are "
      "proved: \"bound\",\nwhat no view exceeds; \"lower_bound\", how many viewpoints "
      "are "
      "needed; \"never_seen\", what nobody\ncan see. Methods and limits: "
      "docs/viewpoints.md.\n"
      "Examples:\n"
      "  sightline viewpoints part.obj --projection orthographic --best 3\n"
      "  sightline viewpoints part.obj --projection perspective --best 1 --by entropy\n"
      "  sightline viewpoints room.obj --projection perspective --bounds 0,0,0,6,4,3 \\\n"
      "      --cover whole --json -\n"
      "  sightline viewpoints hall.obj --projection perspective --cover parts --of door\n"
      "  sightline viewpoints part.obj --projection orthographic --next photos.json");
  return command_of(options, run);
}

}  // namespace sightline::viewers
