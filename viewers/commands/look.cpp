// `sightline look`: the exact view from points and directions.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "linespace/point_view.h"
#include "linespace/work/parallel.h"
#include "viewers/commands/command_line.h"
#include "viewers/commands/outputs.h"
#include "viewers/files/view_svg.h"
#include "viewers/files/view_vtk.h"
#include "viewers/json_text.h"
#include "viewers/pictures/view_drawing.h"
#include "viewers/pictures/view_image.h"
#include "viewers/queries/path_answer.h"
#include "viewers/queries/view_answer.h"
#include "viewers/questions.h"

namespace sightline::viewers {
namespace {

namespace fs = std::filesystem;

struct LookOptions : CommonOptions {
  const CLI::App* command = nullptr;  ///< knows in which order the views were named
  std::vector<std::string> from, direction, at;
  std::string path;
  bool list = false;
  std::vector<double> window, up, towards;
  double fov = 0;  ///< degrees; 0: not told
  std::string svg, png, csv;
  int pixels = 1400;
  bool seams = false, hidden = false;

  [[nodiscard]] bool draws() const {
    return !svg.empty() || !png.empty() || !vtk.empty();
  }
  /// False when standard output belongs to a file.
  [[nodiscard]] bool may_print() const {
    return CommonOptions::may_print() && svg != "-" && png != "-" && csv != "-";
  }
};

/// So many views of one run are drawn: their files are open all the time.
constexpr std::size_t kMostDrawn = 100;

// ---- what is asked --------------------------------------------------------------------

/// In the order of the command line.
std::vector<ViewQuestion> questions_of(Session& session, const LookOptions& options,
                                       Outputs& outputs) {
  std::vector<ViewQuestion> questions;
  std::size_t from = 0, direction = 0, at = 0;
  for (const CLI::Option* option : options.command->parse_order()) {
    const std::string option_name = option->get_name();
    if (option_name == "--from") {
      questions.push_back(
          view_question(Viewpoint::Kind::Eye, option_name, options.from.at(from++)));
    } else if (option_name == "--direction") {
      questions.push_back(view_question(Viewpoint::Kind::Direction, option_name,
                                        options.direction.at(direction++)));
    } else if (option_name == "--at") {
      const std::string& file = options.at.at(at++);
      outputs.protect(file);
      for (ViewQuestion& question :
           session.read([&] { return view_questions(JsonInput(file)); })) {
        questions.push_back(std::move(question));
      }
    }
  }
  if (questions.empty()) {
    throw UsageError(
        "look: from where? name --from x,y,z, --direction x,y,z, --at FILE or --path "
        "FILE");
  }
  return questions;
}

Point point_of(const std::vector<double>& numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

PictureWish wish_of(const LookOptions& options) {
  PictureWish wish;
  if (!options.window.empty()) {
    const std::vector<double>& w = options.window;
    wish.window = PlaneWindow{{w[0], w[1]}, {w[2], w[3]}};
    if (!(wish.window->low.array() < wish.window->high.array()).all()) {
      throw UsageError("--window: x0 must be below x1, and y0 below y1");
    }
  }
  if (options.fov > 0) wish.field_of_view = options.fov * M_PI / 180;
  if (!options.up.empty()) wish.up = point_of(options.up);
  if (!options.towards.empty()) wish.towards = point_of(options.towards);
  return wish;
}

void check_pictures(const LookOptions& options,
                    const std::vector<ViewQuestion>& questions) {
  if (!options.draws()) return;
  if (questions.size() > kMostDrawn) {
    throw UsageError(fmt::format("look: {} views; --svg, --png and --vtk take at most {}",
                                 questions.size(), kMostDrawn));
  }
  const bool eye = std::ranges::any_of(questions, [](const ViewQuestion& q) {
    return q.eye.kind == Viewpoint::Kind::Eye;
  });
  if (!eye && (options.fov > 0 || !options.towards.empty())) {
    throw UsageError(fmt::format("{}: is for eyes, and all views are directions",
                                 options.fov > 0 ? "--fov" : "--towards"));
  }
  if (questions.size() > 1 && (options.svg == "-" || options.png == "-")) {
    throw UsageError(fmt::format("{}: '-' takes one view, and there are {}",
                                 options.svg == "-" ? "--svg" : "--png",
                                 questions.size()));
  }
}

/// A file for each view: the one named, or NAME0.svg, NAME1.svg, ... for several.
std::vector<OutputFile*> files_for(Outputs& outputs, const std::string& option,
                                   const std::string& file, std::size_t views) {
  std::vector<OutputFile*> files;
  if (file.empty()) return files;
  const fs::path path(file);
  for (std::size_t i = 0; i < views; ++i) {
    const fs::path numbered =
        path.parent_path() /
        fmt::format("{}{}{}", path.stem().string(), i, path.extension().string());
    files.push_back(&outputs.add(option, views == 1 ? file : numbered.string()));
  }
  return files;
}

// ---- the answer -----------------------------------------------------------------------

/// What is kept of a view.
struct Seen {
  Json json;
  std::string csv;
  std::optional<PointView> view;  ///< where it is drawn
  std::vector<FurtherLine> further;
};

/// All views, or as many of the first as the budget allowed.
struct AllSeen {
  std::vector<Seen> views;
  StageCounts predicates;
};

PointView view_of(const PointViewIndex& index, const ViewQuestion& question,
                  const Request& request) {
  try {
    return index.view(question.eye, request);
  } catch (const InvalidInput& refusal) {
    throw InvalidInput(fmt::format("{}: {}", question.where, refusal.what()));
  }
}

AllSeen see(Session& session, const LookOptions& options, const Scene& scene,
            const std::vector<ViewQuestion>& questions) {
  Request request = session.with_grace();
  request.precision = options.precision;
  request.threads = options.threads;
  const PointViewIndex index(scene, request);
  session.limit(request);
  session.begin("views");
  // Several views share the threads, and progress counts them; a single one tells its
  // own.
  Request of_one = request;
  if (questions.size() > 1) {
    of_one.progress = nullptr;
    of_one.threads = 1;
  }
  AllSeen all;
  const auto step = [&](int&, std::size_t i) {
    PointView view = view_of(index, questions[i], of_one);
    Seen seen{view_json(scene, questions[i], view, options.list), {}, {}, {}};
    if (options.draws() && (options.seams || options.hidden)) {
      seen.further =
          index.further_lines(questions[i].eye, options.seams, options.hidden, of_one);
    }
    if (!options.csv.empty()) seen.csv = view_csv(scene, i, view);
    if (options.draws()) seen.view = std::move(view);
    return seen;
  };
  // The workers need nothing of their own.
  internal::for_each_parallel(
      questions.size(), request, internal::Deadline(request), "views", all.predicates,
      [] { return std::optional<int>(0); }, step,
      [&](std::size_t, Seen seen) {
        all.views.push_back(std::move(seen));
        return true;
      });
  return all;
}

std::string counted(std::size_t n, const char* one, const char* many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

void print_facets(const Json& view) {
  constexpr std::size_t kShown = 12;
  std::vector<const Json*> facets;
  const char* measure = view.contains("from") ? "solid_angle" : "area";
  for (const Json& facet : view["facets"]) facets.push_back(&facet);
  std::ranges::stable_sort(facets, [&](const Json* a, const Json* b) {
    return (*a)[measure].get<double>() > (*b)[measure].get<double>();
  });
  for (std::size_t i = 0; i < std::min(kShown, facets.size()); ++i) {
    const Json& f = *facets[i];
    std::cout << fmt::format("    facet {} of {}, its {}: {:.6g}{} in {}\n",
                             f["facet"].get<int>(),
                             escaped_bytes(f["object"].get<std::string>()),
                             f["front"].get<bool>() ? "front" : "back",
                             f[measure].get<double>(), view.contains("from") ? " sr" : "",
                             counted(f["pieces"].get<int>(), "piece", "pieces"));
  }
  if (facets.size() > kShown) {
    std::cout << fmt::format("    and {} more that are seen (--json lists them)\n",
                             facets.size() - kShown);
  }
}

void print_view(const ViewQuestion& question, const Json& view) {
  if (view.is_null()) {
    std::cout << fmt::format("  {}: not done\n", question.where);
    return;
  }
  const auto n = [&](const char* key) { return view[key].get<std::size_t>(); };
  const bool from = view.contains("from");
  std::cout << fmt::format(
      "  {} {}{}: {}{}\n    {} seen; map: {} ({} T, {} touch, {} accident), {}, {} ({} "
      "background), {}, {}\n",
      from ? "from" : "direction", fmt::join(question.asked, ","),
      from ? fmt::format(", eye {}", view["eye"].get<std::string>()) : "",
      view["general"].get<bool>() ? "general" : "not general",
      view["accidents"].empty() ? ""
                                : fmt::format(" ({})", counted(view["accidents"].size(),
                                                               "accident", "accidents")),
      counted(view["facets"].size(), "facet", "facets"),
      counted(n("corners") + n("t_vertices") + n("touches") + n("accident_vertices"),
              "vertex", "vertices"),
      n("t_vertices"), n("touches"), n("accident_vertices"),
      counted(n("edges"), "edge", "edges"), counted(n("regions"), "region", "regions"),
      n("background_pieces"), counted(n("components"), "component", "components"),
      counted(n("seams"), "seam", "seams"));
  print_facets(view);
}

void print_summary(const LookOptions& options, const std::vector<ViewQuestion>& questions,
                   const Json& answer) {
  constexpr std::size_t kShown = 20;
  const Json& views = answer["views"];
  std::cout << fmt::format("{}: {}{}\n", options.scene,
                           counted(views.size(), "view", "views"),
                           answer["complete"].get<bool>() ? "" : ", INCOMPLETE");
  for (std::size_t i = 0; i < std::min(kShown, views.size()); ++i) {
    print_view(questions[i], views[i]);
  }
  if (views.size() > kShown) {
    std::cout << fmt::format("  and {} more views (--json lists them)\n",
                             views.size() - kShown);
  }
  std::cout << fmt::format("  {:.3f} s\n", answer["seconds"].get<double>());
}

// ---- files ----------------------------------------------------------------------------

/// The files of one run that show something.
struct PictureFiles {
  std::vector<OutputFile*> svg, png;
  OutputFile* csv = nullptr;
};

std::vector<ViewDrawing> drawings_of(const LookOptions& options, const Scene& scene,
                                     const std::vector<ViewQuestion>& questions,
                                     const AllSeen& all) {
  std::vector<ViewDrawing> drawings;
  if (!options.draws()) return drawings;
  const PictureWish wish = wish_of(options);
  for (std::size_t i = 0; i < all.views.size(); ++i) {
    try {
      drawings.push_back(
          view_drawing(scene, *all.views[i].view, wish, all.views[i].further));
    } catch (const InvalidInput& refusal) {
      throw UsageError(fmt::format("{}: {}", questions[i].where, refusal.what()));
    }
  }
  return drawings;
}

void write_bytes(OutputFile& file, const std::string& bytes) {
  file.stream() << bytes;
  file.commit();
}

std::string told(const OutputFile& file) {
  return file.target().empty() ? "standard output" : file.target().string();
}

void write_pictures(Session& session, const LookOptions& options, const Scene& scene,
                    const AllSeen& all, const std::vector<ViewDrawing>& drawings,
                    const PictureFiles& files) {
  std::vector<ViewAndDrawing> drawn;
  for (std::size_t i = 0; i < drawings.size(); ++i) {
    const PointView& view = *all.views[i].view;
    drawn.push_back({&view, &drawings[i]});
    if (!files.svg.empty()) {
      session.write(told(*files.svg[i]), [&](const Request&) {
        write_bytes(*files.svg[i], view_svg(scene, view, drawings[i]));
      });
    }
    if (!files.png.empty()) {
      session.write(told(*files.png[i]), [&](const Request& request) {
        write_bytes(*files.png[i],
                    encode_png(view_image(drawings[i], view, options.pixels, request)));
      });
    }
  }
  if (!options.vtk.empty()) {
    session.write("VTK files", [&](const Request& request) {
      write_vtk_views(options.vtk, scene, drawn, request);
    });
  }
}

void write_csv(OutputFile& file, const AllSeen& all) {
  file.stream() << kViewCsvHead;
  for (const Seen& seen : all.views) file.stream() << seen.csv;
  file.commit();
}

// ---- along a path ---------------------------------------------------------------------

void check_alone(const LookOptions& options) {
  if (!options.from.empty() || !options.direction.empty() || !options.at.empty()) {
    throw UsageError("--path: takes no --from, --direction or --at beside it");
  }
  if (options.precision != Precision::Exact) {
    throw UsageError("--path: is answered exactly, not with --precision double");
  }
  if (options.draws() || !options.csv.empty()) {
    throw UsageError(
        "--path: answers in JSON only, without --svg, --png, --vtk or --csv");
  }
}

ViewPath walk(Session& session, const LookOptions& options, const Scene& scene,
              const std::vector<Viewpoint>& path) {
  Request request = session.with_grace();
  request.threads = options.threads;
  const PointViewIndex index(scene, request);
  session.limit(request);
  session.begin("path");
  try {
    return view_path(index, path, true, request);
  } catch (const InvalidInput& refusal) {
    throw InvalidInput(fmt::format("{}: {}", options.path, refusal.what()));
  }
}

std::string told(const std::vector<int>& facets, const char* what) {
  if (facets.empty()) return "";
  return fmt::format("; {} {} {}", facets.size() == 1 ? "facet" : "facets",
                     fmt::join(facets, ", "), what);
}

void print_path(const LookOptions& options, const ViewPath& path, const Json& answer) {
  constexpr std::size_t kShown = 40;
  std::cout << fmt::format("{}: {}, {} at {}{}\n", options.scene,
                           counted(path.stretches.size(), "view", "views"),
                           counted(answer["events"].size(), "event", "events"),
                           counted(path.changes.size(), "position", "positions"),
                           path.complete ? "" : ", INCOMPLETE");
  for (std::size_t i = 0; i < std::min(kShown, path.changes.size()); ++i) {
    const PathChange& change = path.changes[i];
    std::vector<std::string> events;
    for (const PathEvent& event : change.events) {
      std::vector<std::string> generators;
      for (const Generator& g : event.generators) {
        constexpr const char* kNames[] = {"corner", "edge", "facet"};
        generators.push_back(
            fmt::format("{} {}", kNames[static_cast<int>(g.kind)], g.id));
      }
      events.push_back(
          fmt::format("{} ({})", name(event.kind), fmt::join(generators, ", ")));
    }
    std::cout << fmt::format("  segment {} at {:.9g}: {}{}{}\n", change.segment, change.u,
                             fmt::join(events, ", "), told(change.appears, "appear"),
                             told(change.vanishes, "vanish"));
  }
  if (path.changes.size() > kShown) {
    std::cout << fmt::format("  and at {} more positions (--json lists them)\n",
                             path.changes.size() - kShown);
  }
  std::cout << fmt::format("  {:.3f} s\n", answer["seconds"].get<double>());
}

ExitStatus run_path(Session& session, const LookOptions& options) {
  check_alone(options);
  Outputs outputs(options);
  outputs.protect(options.path);
  const std::vector<Viewpoint> path =
      session.read([&] { return path_question(JsonInput(options.path)); });
  const Meter meter;
  const Scene scene = read_scene(session, options.scene, options.format);
  const ViewPath found = walk(session, options, scene, path);
  Json answer =
      answer_head("look", scene, found.complete, {session.seconds(), meter.predicates()});
  answer["events"] = path_events_json(scene, found);
  answer["views"] = path_views_json(scene, found, options.list);
  outputs.write_answer(answer);
  if (options.may_print()) print_path(options, found, answer);
  return session.end(found.complete);
}

// ---- the command ----------------------------------------------------------------------

ExitStatus run(Session& session, const LookOptions& options) {
  if (!options.path.empty()) return run_path(session, options);
  // 1. The outputs and the questions, then the scene.
  Outputs outputs(options);
  PictureFiles files;
  if (!options.csv.empty()) files.csv = &outputs.add("--csv", options.csv);
  const std::vector<ViewQuestion> questions = questions_of(session, options, outputs);
  (void)wish_of(options);  // refuses what makes no picture
  check_pictures(options, questions);
  files.svg = files_for(outputs, "--svg", options.svg, questions.size());
  files.png = files_for(outputs, "--png", options.png, questions.size());
  const Meter meter;
  const PrecisionScope precision(options.precision);
  const Scene scene = read_scene(session, options.scene, options.format);

  // 2. The views, and what is drawn of them.
  AllSeen all = see(session, options, scene, questions);
  const std::vector<ViewDrawing> drawings = drawings_of(options, scene, questions, all);
  const bool complete = all.views.size() == questions.size();

  // 3. The files; the answer comes last.
  write_pictures(session, options, scene, all, drawings, files);
  if (files.csv != nullptr) write_csv(*files.csv, all);
  Json answer = answer_head("look", scene, complete && session.unwritten().empty(),
                            {session.seconds(), meter.predicates() + all.predicates});
  Json& views = answer["views"] = Json::array();
  for (Seen& seen : all.views) views.push_back(std::move(seen.json));
  while (views.size() < questions.size()) views.push_back(nullptr);
  outputs.write_answer(answer);
  if (options.may_print()) print_summary(options, questions, answer);
  return session.end(complete);
}

CLI::Option* add_repeated(CLI::App& command, const std::string& name,
                          std::vector<std::string>& values, const char* help) {
  return command.add_option(name, values, help)->allow_extra_args(false);
}

/// From where.
void add_view_options(CLI::App& command, LookOptions& options) {
  add_repeated(command, "--from", options.from,
               "an eye, x,y,z in scene units; numbers or fractions p/q, as in 1/3,0,2; "
               "repeatable, as --direction and --at are, in any mixture; answered in the "
               "order given")
      ->type_name("x,y,z");
  add_repeated(command, "--direction", options.direction,
               "an eye infinitely far away in this direction, so that sight runs against "
               "it: an orthographic view; 0,0,1 is a plan; its length says nothing")
      ->type_name("x,y,z");
  add_repeated(command, "--at", options.at,
               R"(JSON: {"views": [{"from": [x,y,z]} | {"direction": [x,y,z]}, ...]}, )"
               "numbers or strings \"p/q\"")
      ->type_name("FILE");
  command
      .add_option("--path", options.path,
                  R"(JSON: {"points": [[x,y,z], ...]} or {"directions": [...]}: all )"
                  "events that the eye crosses on its way, and the view between each "
                  "two; in JSON only, with neither pictures nor tables")
      ->type_name("FILE");
  command.add_flag("--list", options.list,
                   "add the map to the JSON answer: its vertices, edges with the regions "
                   "beside them, regions with their boundaries");
}

CLI::Option* add_numbers(CLI::App& command, const std::string& name,
                         std::vector<double>& numbers, int count, const char* help) {
  return command.add_option(name, numbers, help)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->expected(count)
      ->check(finite_number());
}

/// What of the view is in the picture.
void add_window_options(CLI::App& command, LookOptions& options) {
  CLI::Option* const window =
      add_numbers(command, "--window", options.window, 4,
                  "the part of the picture's plane that is drawn, x to the right and y "
                  "up: for a direction in scene units, from the origin on; for an eye on "
                  "the plane before it at distance 1 (default: what holds all that is "
                  "seen; 90 degrees where an eye would need 120 or more)")
          ->type_name("x0,y0,x1,y1");
  command
      .add_option("--fov", options.fov,
                  "of an eye: the picture's angle from left to right and from bottom to "
                  "top, in degrees (default 90 with --towards)")
      ->type_name("DEGREES")
      ->check(number_above_zero(179))
      ->excludes(window);
  add_numbers(command, "--up", options.up, 3,
              "the direction that points up in the picture (default 0,0,1, but 0,1,0 "
              "where sight runs along z; scenes of modellers often want 0,1,0)")
      ->type_name("x,y,z");
  add_numbers(command, "--towards", options.towards, 3,
              "of an eye: the point in the picture's middle, in scene units (default: "
              "the middle of what is seen; where that is all around, the horizontal "
              "towards the scene's middle)")
      ->type_name("x,y,z");
}

/// What is written, beside the answer.
void add_file_options(CLI::App& command, LookOptions& options) {
  command
      .add_option("--svg", options.svg,
                  "draw the view: patches (path.patch), edges (line.silhouette, .crease, "
                  ".valley, .boundary, .contact, .crossing) and vertices (circle.corner, "
                  ".t, .touch, .accident), each with its name; see --seams "
                  "and --hidden; of several views NAME0.svg, NAME1.svg, ..., 100 at most")
      ->type_name("FILE");
  command
      .add_option("--png", options.png,
                  "the same as a picture, no display needed; of several views NAME0.png, "
                  "NAME1.png, ...")
      ->type_name("FILE");
  command.add_flag("--seams", options.seams,
                   "draw seams too (line.seam): between two facets of one patch");
  command.add_flag("--hidden", options.hidden,
                   "draw what is hidden of edges too (line.hidden)");
  command
      .add_option("--pixels", options.pixels,
                  "length of the longer side of --png (default 1400)")
      ->type_name("N")
      ->check(whole_number(16, 16384));
  command
      .add_option("--csv", options.csv,
                  "a table with a line for each facet and view: view (from 0), facet, "
                  "object, faces, front, pieces, solid angle (sr) or area, gradient")
      ->type_name("FILE");
}

}  // namespace

Command add_look_command(CLI::App& app) {
  auto options = std::make_shared<LookOptions>();
  CLI::App* command = app.add_subcommand(
      "look",
      "the exact view from points and directions: what is seen of every facet and edge");
  options->command = command;
  add_scene_argument(*command, *options);
  add_view_options(*command, *options);
  add_window_options(*command, *options);
  add_file_options(*command, *options);
  add_common_options(*command, *options);
  command->footer(
      "What counts as seen, an edge, a vertex and a region of the map: "
      "docs/point_view.md.\n"
      "Examples:\n"
      "  sightline look room.obj --from 3,1.5,2 --json -\n"
      "  sightline look room.obj --from 3,1.5,2 --towards 0,1,0 --fov 70 --svg room.svg\n"
      "  sightline look house.ifc --direction 0,0,1 --direction 0,-1,0 --svg house.svg\n"
      "    (a plan, house0.svg, and an elevation from the south, house1.svg)\n"
      "  sightline look city.obj --at eyes.json --csv seen.csv --threads 8\n"
      "  sightline look room.obj --path walk.json --json -");
  return command_of(options, run);
}

}  // namespace sightline::viewers
