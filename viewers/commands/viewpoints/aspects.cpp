// `sightline aspects`: all views of a scene that differ, and how one comes from another.

#include <fmt/format.h>

#include <iostream>

#include "aspect/aspect_graph.h"
#include "viewers/commands/command_line.h"
#include "viewers/commands/outputs.h"
#include "viewers/queries/aspect_answer.h"

namespace sightline::viewers {
namespace {

struct AspectOptions : CommonOptions {
  std::string projection, method = "exact", aspect = "structure", sampling = "regular";
  std::string of;
  int samples = 0;
  std::uint64_t seed = 1;
  int check = 0;
  std::vector<double> bounds;
  bool list = false;
};

constexpr int kSampledViews = 2562;  ///< 10 4^4 + 2 directions

AspectRequest request_of(Session& session, const AspectOptions& options,
                         const Scene& scene) {
  AspectRequest request;
  session.limit(request);
  request.precision = options.precision;
  request.threads = options.threads;
  request.projection = options.projection == "orthographic" ? Projection::Orthographic
                                                            : Projection::Perspective;
  request.method = options.method == "exact"     ? AspectMethod::Exact
                   : options.method == "refined" ? AspectMethod::Refined
                                                 : AspectMethod::Sampled;
  request.label = options.aspect == "faces" ? AspectLabel::Faces : AspectLabel::Structure;
  request.sampling = options.sampling == "random" ? Sampling::Random : Sampling::Regular;
  request.samples = options.samples > 0 ? options.samples : kSampledViews;
  request.seed = options.seed;
  request.check = options.check;
  request.bounds = region_box(options.bounds, "--bounds");
  if (!options.of.empty()) request.of = scene.faces_named(options.of);
  request.list = options.list;
  return request;
}

void print(const AspectOptions& options, const AspectGraph& graph, double seconds) {
  std::cout << fmt::format(
      "{}: {}, {}, {}{}\n", options.scene, counted(graph.aspects, "aspect", "aspects"),
      counted(graph.adjacencies, "pair of neighbours", "pairs of neighbours"),
      graph.certified ? "exact" : name(graph.method),
      graph.complete ? "" : ", INCOMPLETE");
  if (!graph.why.empty()) std::cout << "  not exact: " << graph.why << '\n';
  std::cout << fmt::format("  {} different labels, {} sets of faces, {} shapes\n",
                           graph.distinct, graph.by_visible_faces, graph.by_shape);
  if (graph.unbounded) {
    std::cout << fmt::format("  {} unbounded, {} bounded\n", *graph.unbounded,
                             *graph.bounded);
  }
  if (const auto& e = graph.estimate) {
    std::cout << fmt::format(
        "  not seen yet: {:.4g} of view space ({:.4g} to {:.4g}); at least {:.6g} labels "
        "({:.6g} to {:.6g})\n",
        e->unseen_weight, e->unseen_interval[0], e->unseen_interval[1], e->distinct_total,
        e->distinct_interval[0], e->distinct_interval[1]);
  }
  if (const auto& c = graph.check) {
    std::cout << fmt::format("  {} of {} further views are not in the graph\n",
                             c->not_in_graph, c->views);
  }
  std::cout << fmt::format("  {:.3f} s\n", seconds);
}

ExitStatus run(Session& session, const AspectOptions& options) {
  Outputs outputs(options);
  (void)region_box(options.bounds, "--bounds");
  if (options.projection == "orthographic" && !options.bounds.empty())
    throw UsageError("--bounds: is for --projection perspective");
  const Meter meter;
  const Scene scene = read_scene(session, options.scene, options.format);
  const AspectGraph graph = find_aspects(scene, request_of(session, options, scene));
  Json answer = answer_head("aspects", scene, graph.complete,
                            {session.seconds(), meter.predicates()});
  answer.update(aspects_json(scene, graph, options.list));
  outputs.write_answer(answer);
  if (options.may_print()) print(options, graph, session.seconds());
  return session.end(graph.complete);
}

}  // namespace

Command add_aspects_command(CLI::App& app) {
  auto options = std::make_shared<AspectOptions>();
  CLI::App* command = app.add_subcommand(
      "aspects", "which different views a scene has, and how one comes from another");
  add_scene_argument(*command, *options);
  command
      ->add_option("--projection", options->projection,
                   "orthographic: from all directions; perspective: from all points")
      ->required()
      ->check(one_of({"orthographic", "perspective"}));
  command
      ->add_option(
          "--method", options->method,
          "exact; from samples of view space; or refined by the events between samples")
      ->check(one_of({"sampled", "refined", "exact"}))
      ->capture_default_str();
  command
      ->add_option("--aspect", options->aspect,
                   "what tells two views apart: the faces seen, or the drawing's "
                   "labelled structure")
      ->check(one_of({"faces", "structure"}))
      ->capture_default_str();
  command
      ->add_option("--samples", options->samples,
                   "at least so many views where samples are taken (default 2562)")
      ->type_name("N")
      ->check(whole_number(1, 100'000'000));
  command
      ->add_option("--sampling", options->sampling,
                   "regular: a geodesic sphere, a grid; random: with an estimate of what "
                   "was not seen")
      ->check(one_of({"regular", "random"}))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of random samples (default 1)")
      ->type_name("S")
      ->check(whole_number(0));
  command
      ->add_option("--bounds", options->bounds,
                   "view space is this box: x0,y0,z0,x1,y1,z1 (perspective)")
      ->type_name("x0,y0,z0,x1,y1,z1")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->expected(6)
      ->check(finite_number());
  command->add_option("--of", options->of,
                      "only what is seen of this group counts, all else hides");
  command
      ->add_option("--check", options->check,
                   "compare so many further random views with the graph")
      ->type_name("N")
      ->check(whole_number(0, 100'000'000));
  command->add_flag("--list", options->list,
                    "add \"list\": a viewpoint, weight, faces and neighbours of each");
  add_common_options(*command, *options, false);
  command->footer(
      "An aspect is a connected region of viewpoints with one view.  Graphs of "
      "scenes in\nwhich three edges come into one line of sight are refined so far, and "
      "say so. "
      "Definitions and methods:\ndocs/aspects.md.\n"
      "Examples:\n"
      "  sightline aspects cube.obj --projection orthographic\n"
      "  sightline aspects cube.obj --projection perspective --list --json -\n"
      "  sightline aspects room.obj --projection perspective --method sampled \\\n"
      "      --sampling random --samples 1000 --aspect faces --check 1000");
  return command_of(options, run);
}

}  // namespace sightline::viewers
