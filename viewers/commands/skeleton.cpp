// `sightline skeleton`: the critical line sets of a scene and where they end.

#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "linespace/perturb.h"
#include "linespace/work/stage.h"
#include "skeleton/build.h"
#include "viewers/commands/command_line.h"
#include "viewers/commands/outputs.h"
#include "viewers/commands/skeleton_light.h"
#include "viewers/skeleton_file.h"
#include "viewers/skeleton_queries.h"
#include "viewers/vtk_export.h"

namespace sightline::viewers {
namespace {

struct SkeletonOptions : CommonOptions {
  std::string events = "solid";
  std::vector<std::string> kinds{"EV", "EEE", "FF"};
  std::vector<std::string> between;
  std::string through;
  std::vector<std::string> light;
  std::size_t budget_bytes = std::numeric_limits<std::size_t>::max();
  std::vector<double> region;
  double perturb = 0;
  std::uint64_t seed = 1;
  std::vector<double> near;
  double radius = 0;
  std::vector<std::vector<double>> between_boxes;
  double feature_size = 0;
  bool list = false;
  bool extend = false;
  std::string output;
  std::string saved;
  std::string seen_from;
  std::vector<std::string> between_ends;
  std::vector<std::string> crossed;

  [[nodiscard]] bool asks() const {
    return !seen_from.empty() || !between_ends.empty() || !crossed.empty();
  }
};

Point point_of(const std::string& text) {
  const std::vector<double> numbers = numbers_of(text);
  if (numbers.size() != 3) {
    throw UsageError(fmt::format("--crossed: '{}' is not a point x,y,z", text));
  }
  if (!std::ranges::all_of(numbers, is_admissible)) {
    throw UsageError(fmt::format(
        "--crossed: '{}': a coordinate is neither 0 nor of magnitude from 2^-140 to "
        "2^140",
        text));
  }
  return {numbers[0], numbers[1], numbers[2]};
}

void check(const SkeletonOptions& options) {
  for (const std::string& kind : options.kinds) {
    if (kind != "EV" && kind != "EEE" && kind != "FF") {
      throw UsageError(fmt::format(
          "--kinds: '{}' is not available in this version; available: EV, EEE, FF",
          kind));
    }
  }
  if (!options.between.empty() && !options.through.empty()) {
    throw UsageError("--between and --through exclude each other");
  }
  if (options.crossed.size() == 2 &&
      point_of(options.crossed[0]) == point_of(options.crossed[1])) {
    throw UsageError("--crossed: its two points are the same");
  }
  if (options.near.empty() != (options.radius == 0)) {
    throw UsageError("--near and --radius belong together");
  }
}

std::vector<double> box_of(const std::string& text) {
  std::vector<double> numbers = numbers_of(text);
  if (numbers.size() != 6) {
    throw UsageError(fmt::format("--between-boxes: '{}' is not six numbers", text));
  }
  return numbers;
}

SkeletonRequest request_of(const SkeletonOptions& options) {
  SkeletonRequest request;
  request.precision = options.precision;
  if (options.events == "polygon") request.events = EventMode::Polygon;
  request.threads = options.threads;
  request.part.region = region_box(options.region);
  request.ev = std::ranges::find(options.kinds, "EV") != options.kinds.end();
  request.eee = std::ranges::find(options.kinds, "EEE") != options.kinds.end();
  request.ff = std::ranges::find(options.kinds, "FF") != options.kinds.end();
  request.budget_bytes = options.budget_bytes;
  request.part.feature_size = options.feature_size;
  if (!options.near.empty()) {
    const Point centre(options.near[0], options.near[1], options.near[2]);
    if (!centre.allFinite()) throw UsageError("--near: three finite numbers");
    request.part.near = {centre, options.radius};
  }
  if (!options.between_boxes.empty()) {
    request.part.between_boxes = {
        *region_box(options.between_boxes[0], "--between-boxes"),
        *region_box(options.between_boxes[1], "--between-boxes")};
  }
  return request;
}

// The arcs between two groups, or those whose lines meet one.
void select(const SkeletonOptions& options, const Scene& scene, SkeletonPart& part) {
  if (options.between.size() == 2) {
    part.between_faces = {scene.faces_named(options.between[0]),
                          scene.faces_named(options.between[1])};
  }
  if (!options.through.empty()) {
    part.through_faces = scene.faces_named(options.through);
    part.through_far_ends = true;
  }
}

Json options_json(const SkeletonOptions& options) {
  Json j{{"events", options.events}, {"kinds", options.kinds}};
  j["precision"] = options.precision == Precision::Exact ? "exact" : "double";
  if (!options.between.empty()) j["between"] = options.between;
  if (!options.through.empty()) j["through"] = options.through;
  if (!options.region.empty()) j["region"] = options.region;
  if (options.perturb > 0) {
    j["perturb"] = options.perturb;
    j["seed"] = options.seed;
  }
  if (!options.near.empty())
    j["near"] = {{"at", options.near}, {"radius", options.radius}};
  if (!options.between_boxes.empty()) j["between_boxes"] = options.between_boxes;
  return j;
}

void print_summary(const Scene& scene, const Skeleton& skeleton, const Json& answer) {
  const bool polygon = skeleton.events == EventMode::Polygon;
  std::cout << fmt::format("{}: visibility skeleton, {} mode{}\n", scene.soup().source,
                           polygon ? "polygon" : "solid",
                           skeleton.complete ? "" : ", INCOMPLETE");
  const auto print_counts = [](const std::string& what, const Json& counts) {
    std::cout << fmt::format("  {}:", what);
    for (const auto& [kind, count] : counts.items()) {
      if (count.is_number() && count != 0) {
        std::cout << fmt::format(" {} {}", kind, count.get<std::int64_t>());
      }
    }
    std::cout << "\n";
  };
  for (const char* what : {"arcs", "nodes"}) {
    print_counts(what, answer[what]);
    if (polygon)
      print_counts(fmt::format("{} with end contacts", what), answer[what]["end"]);
  }
  const Json& p = answer["predicates"];
  std::cout << fmt::format(
      "  vertices done: {} of {}, edges: {} of {}, facets: {} of {}\n  {:.3f} s, {:.0f} "
      "MiB, predicates: "
      "{} "
      "double, {} interval, {} exact\n",
      skeleton.vertices_done, skeleton.vertices_asked, skeleton.edges_done,
      skeleton.edges_asked, skeleton.facets_done, skeleton.facets_asked,
      answer["seconds"].get<double>(),
      answer["peak_memory_bytes"].get<double>() / 1048576,
      p["double"].get<std::uint64_t>(), p["interval"].get<std::uint64_t>(),
      p["exact"].get<std::uint64_t>());
  if (skeleton.stopped_by != StoppedBy::Nothing) {
    std::cout << fmt::format("  stopped by {}; missing:\n",
                             stopped_by_name(skeleton.stopped_by));
    for (const Json& line : answer["missing"]) {
      std::cout << fmt::format("    {}\n", line.get<std::string>());
    }
  }
  const Simplified& s = skeleton.simplified;
  if (s.feature_size > 0) {
    std::cout << fmt::format(
        "  feature size {} left out: {} edges, {} vertices, {} objects, {} short arcs\n",
        s.feature_size, s.edges.size(), s.vertices.size(), s.objects.size(),
        s.arcs.size());
  }
}

void print_arcs(const std::string& what, const Json& arcs) {
  std::cout << fmt::format("  {}: EV {} EEE {}\n", what, arcs["arcs"]["EV"].get<int>(),
                           arcs["arcs"]["EEE"].get<int>());
}

void print_events(const Json& events) {
  for (const Json& e : events) {
    const auto p = e["point"].get<std::array<double, 3>>();
    std::string what;
    const auto add = [&](const char* name, const Json& id) {
      what += fmt::format(" {} {}", name, id.get<std::int64_t>());
    };
    if (e.contains("facet")) {
      add("facet", e["facet"]["id"]);
    } else {
      add("arc", e["id"]);
      what += ":";
      if (e.contains("vertex")) add("vertex", e["vertex"]["id"]);
      if (e.contains("edge")) add("edge", e["edge"]["id"]);
      if (e.contains("edges")) {
        for (const Json& edge : e["edges"]) add("edge", edge["id"]);
      }
    }
    std::cout << fmt::format("  {} u {:.9f} at ({:.6g}, {:.6g}, {:.6g}) {}{}\n",
                             e["tie"].get<bool>() ? "=" : " ", e["u"].get<double>(), p[0],
                             p[1], p[2], e["kind"].get<std::string>(), what);
  }
}

// Adds the answers to what is asked of the finished skeleton; false when the budget ended
// first.
bool answer_queries(const SkeletonOptions& options, const Scene& scene,
                    const Skeleton& skeleton, const Request& request, Json& answer) {
  const EndIndex ends(scene, skeleton, request);
  if (!options.seen_from.empty()) {
    answer["seen_from"] = arcs_by_ends_json(scene, skeleton, ends,
                                            seen_from(scene, ends, options.seen_from));
  }
  if (options.between_ends.size() == 2) {
    answer["between_ends"] = arcs_by_ends_json(
        scene, skeleton, ends,
        between_ends(scene, ends, {options.between_ends[0], options.between_ends[1]}));
  }
  if (options.crossed.size() == 2) {
    const ViewEvents events(scene, skeleton, ends, request);
    const Point a = point_of(options.crossed[0]);
    const Point b = point_of(options.crossed[1]);
    answer["crossed"] = events_json(scene, skeleton, events.crossed(a, b));
    answer["separating"] = events.separating(a, b).size();
  }
  return ends.complete();
}

void print_queries(const Json& answer) {
  if (answer.contains("seen_from")) print_arcs("seen", answer["seen_from"]);
  if (answer.contains("between_ends")) {
    print_arcs("between these ends", answer["between_ends"]);
  }
  if (answer.contains("crossed")) {
    std::cout << fmt::format("  crossed: {} events, {} of which separate the two ends\n",
                             answer["crossed"].size(),
                             answer["separating"].get<std::size_t>());
    print_events(answer["crossed"]);
  }
}

/// A skeleton, built now or read, and what was asked of it when it was built.
struct Made {
  Skeleton skeleton;
  Json options;
};

Made made_skeleton(Session& session, const SkeletonOptions& options, const Scene& scene) {
  if (options.saved.empty()) {
    SkeletonRequest request = request_of(options);
    session.limit(request);
    select(options, scene, request.part);
    return {build_skeleton(scene, request), options_json(options)};
  }
  StoredSkeleton stored = session.read([&] { return read_skeleton_json(options.saved); });
  check_fits(stored, scene);
  stored.options["saved"] = options.saved;
  return {std::move(stored.skeleton), std::move(stored.options)};
}

Scene scene_of(Session& session, const SkeletonOptions& options) {
  Scene scene = read_scene(session, options.scene, options.format);
  if (options.perturb == 0) return scene;
  PolygonSoup moved = perturbed(scene, options.perturb, options.seed);
  moved.source = options.scene;  // the answer's options say how it was moved
  return Scene(std::move(moved), {}, session.with_grace());
}

/// Refuses groups that the scene does not have, before anything is computed.
void check_groups(const SkeletonOptions& options, const Scene& scene) {
  std::vector<std::string> names = options.between;
  if (!options.through.empty()) names.push_back(options.through);
  names.insert(names.end(), options.light.begin(), options.light.end());
  for (const std::string& name : names) (void)scene.faces_named(name);
  std::vector<std::string> ends = options.between_ends;
  if (!options.seen_from.empty()) ends.push_back(options.seen_from);
  for (const std::string& name : ends) {
    if (name != "outside") (void)scene.faces_named(name);
  }
}

Json answer_of(const SkeletonOptions& options, const Scene& scene, const Made& made,
               bool complete, const Cost& cost, bool with_ids) {
  return skeleton_answer(scene, made.skeleton, made.options, options.precision, complete,
                         cost, with_ids);
}

/// The file of -o: the skeleton, without what was asked of it.
void save(Session& session, const Scene& scene, const Skeleton& skeleton,
          const Json& answer, OutputFile& file, const std::string& name) {
  session.write(name, [&](const Request& request) {
    save_skeleton_json(file, answer, scene, skeleton, request);
  });
}

void write_vtk_files(Session& session, const SkeletonOptions& options, const Scene& scene,
                     const Skeleton& skeleton, std::optional<SkeletonLines>& lines) {
  session.write("VTK files", [&](const Request& request) {
    std::vector<RuledStrip> strips;
    if (options.extend) {
      lines.emplace(scene, request);
      internal::Stage stage(request, "extending arcs");
      const std::size_t count = skeleton.ev_count();
      for (std::size_t i = 0; i < count; ++i) {
        stage.check(static_cast<double>(i) / static_cast<double>(count));
        strips.push_back(ruled_strip(scene, *lines, skeleton, static_cast<int>(i), 9));
      }
    }
    write_vtk(options.vtk, scene, {&skeleton, options.extend ? &strips : nullptr},
              request);
  });
}

/// The answer with its list, cut where the time is over.  False when not even its
/// beginning was written.
bool write_list(Session& session, const Scene& scene, const Skeleton& skeleton,
                const Json& answer, OutputFile& file,
                std::optional<SkeletonLines>& lines) {
  bool begun = false;
  session.write("the list", [&](const Request& request) {
    if (!lines) lines.emplace(scene, request);
    begun = true;
    const bool whole =
        write_skeleton_json(file.stream(), answer, scene, skeleton, &*lines, request);
    file.commit();
    if (!whole) throw Stopped("the list", 1);
  });
  return begun;
}

ExitStatus run(Session& session, const SkeletonOptions& options) {
  // 1. The outputs, then the scene.
  check(options);
  Outputs outputs(options);
  OutputFile* const output =
      options.output.empty() ? nullptr : &outputs.add("-o", options.output);
  outputs.protect(options.saved);
  const Meter meter;
  const PrecisionScope precision(options.precision);
  const Scene scene = scene_of(session, options);
  check_groups(options, scene);
  const StageCounts loading = meter.predicates();
  if (!options.light.empty()) {
    return run_light(session, options, options.light, options.list, scene, loading,
                     outputs);
  }

  // 2. The skeleton, and what is asked of it.
  const Made made = made_skeleton(session, options, scene);
  const Skeleton& skeleton = made.skeleton;
  bool complete = skeleton.complete;
  Json queries;
  if (options.asks()) {
    try {
      complete = answer_queries(options, scene, skeleton, session.limited(), queries) &&
                 complete;
    } catch (const Stopped&) {  // what was asked first may be answered
      complete = false;
    }
  }
  const Cost cost{session.seconds(), loading + skeleton.predicates};

  // 3. The files; the answer comes last.
  const auto so_far = [&] { return complete && session.unwritten().empty(); };
  std::optional<SkeletonLines> lines;
  if (output != nullptr) {
    save(session, scene, skeleton,
         answer_of(options, scene, made, skeleton.complete, cost, /*with_ids=*/true),
         *output, options.output);
  }
  if (!options.vtk.empty()) write_vtk_files(session, options, scene, skeleton, lines);
  Json answer = answer_of(options, scene, made, so_far(), cost, options.list);
  if (!queries.is_null()) answer.update(queries);
  const bool listed =
      options.list && outputs.json() != nullptr &&
      write_list(session, scene, skeleton, answer, *outputs.json(), lines);
  if (!listed) {
    answer["complete"] = so_far();
    outputs.write_answer(answer);
  }
  if (options.may_print()) {
    print_summary(scene, skeleton, answer);
    print_queries(answer);
  }
  return session.end(complete);
}

/// Which lines make events.
void add_event_options(CLI::App& command, SkeletonOptions& options) {
  command
      .add_option("--events", options.events,
                  "solid: lines that graze at every contact (default); polygon: "
                  "the two outermost contacts may also be visible creases and corners at "
                  "which the free segment ends, counted under \"end\"")
      ->type_name("solid|polygon")
      ->check(one_of({"solid", "polygon"}));
  command
      .add_option(
          "--kinds", options.kinds,
          "kinds of critical line sets, separated by commas: EV, through a vertex "
          "and an edge, EEE, through three edges; and FF, lines in the planes of two "
          "faces (default EV,EEE,FF)")
      ->type_name("EV,EEE,FF")
      ->delimiter(',')
      ->allow_extra_args(false);
}

/// Parts of the skeleton that groups of faces tell.
void add_group_options(CLI::App& command, SkeletonOptions& options) {
  command
      .add_option(
          "--between", options.between,
          "only EV arcs with the vertex on group A and the edge on group B or the "
          "other way round, and EEE arcs with the outer edges one on each; a "
          "group is a name or #i-j, faces i to j from 0")
      ->type_name("A B")
      ->expected(2)
      ->allow_extra_args(false);
  command
      .add_option(
          "--through", options.through,
          "only lines that meet this group: EV arcs with the vertex or the edge on it "
          "or with lines that end on it, EEE arcs with an edge on it, FF with a "
          "face of it")
      ->type_name("GROUP");
}

/// The option that asks for a source's events instead, and excludes those that it does
/// not obey.
void add_light_option(CLI::App& command, SkeletonOptions& options) {
  CLI::Option* const light =
      command
          .add_option("--light", options.light,
                      "only lines that reach a light, these groups with commas between, "
                      "from its front and end on a face: EV, EEE, and EE, two edges of "
                      "one plane seen along each other, and face, a face seen edge-on; "
                      "the light's own outline makes events too, wherever it lies")
          ->type_name("GROUP,...")
          ->delimiter(',')
          ->allow_extra_args(false);
  for (const char* name :
       {"--events", "--kinds", "--between", "--through", "--region", "--near", "--radius",
        "--between-boxes", "--feature-size", "--budget-mb", "--saved", "--output",
        "--extend", "--vtk", "--seen-from", "--between-ends", "--crossed"}) {
    light->excludes(command.get_option(name));
  }
}

/// The perturbed copy of the scene.
void add_perturb_options(CLI::App& command, SkeletonOptions& options) {
  command
      .add_option("--perturb", options.perturb,
                  "first move every object by its own random map, no point by more than "
                  "this, in scene units: nothing lines up across objects any more "
                  "(default 0: the scene as it is)")
      ->type_name("SIZE")
      ->check(number_from_zero(kLargestCoordinate));
  command.add_option("--seed", options.seed, "of --perturb's random maps (default 1)")
      ->type_name("N")
      ->check(whole_number(0));
}

/// Parts of the skeleton that a place, or two, tell.
void add_place_options(CLI::App& command,
                       const std::shared_ptr<SkeletonOptions>& options) {
  command
      .add_option("--near", options->near,
                  "only vertices and edges no farther than --radius from the point "
                  "x,y,z (an edge with some point of it)")
      ->type_name("x,y,z")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->expected(3)
      ->check(finite_number());
  command.add_option("--radius", options->radius, "of --near, in scene units")
      ->type_name("R")
      ->check(number_above_zero());
  command
      .add_option_function<std::vector<std::string>>(
          "--between-boxes",
          [options](const std::vector<std::string>& boxes) {
            options->between_boxes = {box_of(boxes[0]), box_of(boxes[1])};
          },
          "only arcs between two boxes, each x0,y0,z0,x1,y1,z1: EV arcs with the vertex "
          "in one and the edge in the other, EEE arcs with the outer edges one in each")
      ->type_name("BOX BOX")
      ->expected(2)
      ->allow_extra_args(false);
}

/// The size below which features make no events.
void add_feature_size_option(CLI::App& command, SkeletonOptions& options) {
  command
      .add_option("--feature-size", options.feature_size,
                  "features below this size in scene units make no events but still "
                  "occlude: shorter edges, corners with only such edges, EV arcs on a "
                  "shorter stretch; what is left out is reported (default 0: nothing)")
      ->type_name("L")
      ->check(number_from_zero());
}

/// What is written, beside the answer.
void add_output_options(CLI::App& command, SkeletonOptions& options) {
  command.add_flag(
      "--list", options.list,
      "add every node and arc to the JSON answer: generators, line (of arcs "
      "exactly: numbers or \"p/q\"), contacts, free segment and what ends it");
  command.add_flag("--extend", options.extend,
                   "with --vtk: draw EV arcs out to the ends of their free segments too");
  command
      .add_option("-o,--output", options.output,
                  "save the skeleton as JSON; `sightline view FILE` shows it")
      ->type_name("FILE");
}

/// The option that takes a skeleton from a file, and excludes those that only the
/// building obeys.
void add_saved_option(CLI::App& command, SkeletonOptions& options) {
  CLI::Option* const saved =
      command
          .add_option("--saved", options.saved,
                      "take the skeleton of this scene from a file that -o wrote, "
                      "instead of building it, with the options that it was built "
                      "with; refused when the scene's coordinates, polygons or groups "
                      "have changed since, or the file has")
          ->type_name("FILE");
  for (const char* name :
       {"--events", "--kinds", "--between", "--through", "--region", "--near", "--radius",
        "--between-boxes", "--feature-size", "--budget-mb"}) {
    saved->excludes(command.get_option(name));
  }
}

/// What is asked of the skeleton.
void add_query_options(CLI::App& command, SkeletonOptions& options) {
  command
      .add_option("--seen-from", options.seen_from,
                  "list the arcs with a line that ends on this group: the events that "
                  "it sees; outside: those seen from far away")
      ->type_name("GROUP");
  command
      .add_option("--between-ends", options.between_ends,
                  "list the arcs with a line that runs from one group to the other, or "
                  "to the outside")
      ->type_name("A B")
      ->expected(2)
      ->allow_extra_args(false);
  command
      .add_option("--crossed", options.crossed,
                  "list the events that a viewpoint crosses on its way from one point "
                  "to the other (scene units), in order: u from 0 to 1 along the way, "
                  "the point, the kind (EV, EEE, or F: a face turns), generators; "
                  "events in one point are marked =")
      ->type_name("X,Y,Z X,Y,Z")
      ->expected(2)
      ->allow_extra_args(false);
}

}  // namespace

Command add_skeleton_command(CLI::App& app) {
  auto options = std::make_shared<SkeletonOptions>();
  CLI::App* command = app.add_subcommand(
      "skeleton",
      "the exact visibility skeleton: critical line sets and extremal stabbing lines");
  add_scene_argument(*command, *options);
  add_event_options(*command, *options);
  add_group_options(*command, *options);
  add_region_option(*command, options->region);
  add_perturb_options(*command, *options);
  add_place_options(*command, options);
  add_feature_size_option(*command, *options);
  add_size_budget_option(*command, options->budget_bytes);
  add_output_options(*command, *options);
  add_saved_option(*command, *options);
  add_query_options(*command, *options);
  add_common_options(*command, *options);
  add_light_option(*command, *options);
  return command_of(options, run);
}

}  // namespace sightline::viewers
