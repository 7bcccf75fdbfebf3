// `sightline look`: the exact view from points and directions.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "linespace/point_view.h"
#include "viewers/commands/command_line.h"
#include "viewers/commands/outputs.h"
#include "viewers/commands/views.h"
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
  ViewpointOptions viewpoints;
  std::string path;
  std::string box;
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

// ---- what is asked --------------------------------------------------------------------

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
  if (questions.size() > kMostDrawnViews) {
    throw UsageError(fmt::format("look: {} views; --svg, --png and --vtk take at most {}",
                                 questions.size(), kMostDrawnViews));
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
  for (std::size_t i = 0; i < views; ++i) {
    files.push_back(&outputs.add(option, name_of_view(file, i, views)));
  }
  return files;
}

// ---- the answer -----------------------------------------------------------------------

/// The files of one run that show something.
struct PictureFiles {
  std::vector<OutputFile*> svg, png;
};

std::string told(const OutputFile& file) {
  return file.target().empty() ? "standard output" : file.target().string();
}

/// Draws views as they come.  Files get their names only in finish(): a refusal of a
/// later view leaves nothing written.
class LookPictures {
 public:
  LookPictures(Session& session, const LookOptions& options, const Scene& scene,
               PictureFiles files)
      : session_(session),
        options_(options),
        scene_(scene),
        wish_(wish_of(options)),
        files_(std::move(files)) {
    if (!options.vtk.empty()) vtk_.emplace(options.vtk, scene);
  }

  /// Throws UsageError.
  void add(const ViewQuestion& question, const SeenView& seen) {
    if (!options_.draws()) return;
    ViewDrawing drawing = drawing_of(scene_, question, seen, wish_);
    if (!files_.svg.empty()) {
      fill(*files_.svg[seen.number],
           [&](const Request&) { return view_svg(scene_, seen.view, drawing); });
    }
    if (!files_.png.empty()) {
      fill(*files_.png[seen.number], [&](const Request& request) {
        return encode_png(view_image(drawing, seen.view, options_.pixels, request));
      });
    }
    if (!vtk_) return;
    const bool written = session_.write("VTK files", [&](const Request& request) {
      vtk_->add(seen.view, drawing, request);
    });
    if (!written) vtk_.reset();
  }

  void finish() {
    for (OutputFile* file : full_) file->commit();
    if (!vtk_) return;
    session_.write("VTK files", [&](const Request& request) { vtk_->finish(request); });
  }

 private:
  void fill(OutputFile& file, const std::function<std::string(const Request&)>& bytes) {
    session_.write(told(file), [&](const Request& request) {
      file.stream() << bytes(request);
      file.close();
      full_.push_back(&file);
    });
  }

  Session& session_;
  const LookOptions& options_;
  const Scene& scene_;
  PictureWish wish_;
  PictureFiles files_;
  std::vector<OutputFile*> full_;
  std::optional<VtkViews> vtk_;
};

struct LookQuestions {
  std::vector<ViewQuestion> views;
  std::optional<BoxQuestion> box;
};

/// What is kept of all views.
struct AllSeen {
  Json views = Json::array();
  std::string rows;
  StageCounts predicates;
};

AllSeen see_all(Session& session, const LookOptions& options, const Scene& scene,
                const LookQuestions& asked, LookPictures& pictures) {
  Request request = session.with_grace();
  request.precision = options.precision;
  request.threads = options.threads;
  const PointViewIndex index = asked.box ? PointViewIndex(scene, asked.box->box, request)
                                         : PointViewIndex(scene, request);
  const std::vector<ViewQuestion>& questions = asked.views;
  session.limit(request);
  session.begin("views");
  const ViewWish wish{.map = options.list,
                      .rows = !options.csv.empty(),
                      .seams = options.draws() && options.seams,
                      .hidden = options.draws() && options.hidden};
  AllSeen all;
  all.predicates = see(scene, index, questions, wish, request, [&](SeenView seen) {
    all.views.push_back(std::move(seen.json));
    all.rows += seen.rows;
    pictures.add(questions[seen.number], seen);
  });
  return all;
}

void print_summary(const LookOptions& options, const std::vector<ViewQuestion>& questions,
                   const Json& answer) {
  const Json& views = answer["views"];
  std::cout << fmt::format("{}: {}{}\n", options.scene,
                           counted(views.size(), "view", "views"),
                           answer["complete"].get<bool>() ? "" : ", INCOMPLETE");
  print_views(questions, views);
  std::cout << fmt::format("  {:.3f} s\n", answer["seconds"].get<double>());
}

// ---- along a path ---------------------------------------------------------------------

void check_alone(const LookOptions& options) {
  if (!options.viewpoints.empty()) {
    throw UsageError("--path: takes no --from, --direction or --at beside it");
  }
  if (options.precision != Precision::Exact) {
    throw UsageError("--path: is answered exactly, not with --precision double");
  }
  if (!options.box.empty())
    throw UsageError("--path: goes through the whole scene, without --box");
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
  OutputFile* const csv =
      options.csv.empty() ? nullptr : &outputs.add("--csv", options.csv);
  const LookQuestions asked{questions_of(session, options.viewpoints, outputs),
                            options.box.empty()
                                ? std::nullopt
                                : std::optional(box_question("--box", options.box))};
  const std::vector<ViewQuestion>& questions = asked.views;
  if (questions.empty()) {
    throw UsageError(
        "look: from where? name --from x,y,z, --direction x,y,z, --at FILE or --path "
        "FILE");
  }
  (void)wish_of(options);  // refuses what makes no picture
  check_pictures(options, questions);
  PictureFiles files{files_for(outputs, "--svg", options.svg, questions.size()),
                     files_for(outputs, "--png", options.png, questions.size())};
  const Meter meter;
  const PrecisionScope precision(options.precision);
  const Scene scene = read_scene(session, options.scene, options.format);

  // 2. The views, drawn as they come.
  LookPictures pictures(session, options, scene, std::move(files));
  AllSeen all = see_all(session, options, scene, asked, pictures);
  const bool complete = all.views.size() == questions.size();

  // 3. The files; the answer comes last.
  pictures.finish();
  if (csv != nullptr) {
    csv->stream() << kViewCsvHead << all.rows;
    csv->commit();
  }
  Json answer = answer_head("look", scene, complete && session.unwritten().empty(),
                            {session.seconds(), meter.predicates() + all.predicates});
  if (asked.box) answer["box"] = asked_json(*asked.box);
  answer["views"] = std::move(all.views);
  while (answer["views"].size() < questions.size()) answer["views"].push_back(nullptr);
  outputs.write_answer(answer);
  if (options.may_print()) print_summary(options, questions, answer);
  return session.end(complete);
}

/// From where.
void add_view_options(CLI::App& command, LookOptions& options) {
  add_viewpoint_options(command, options.viewpoints);
  command
      .add_option(
          "--at", options.viewpoints.at,
          R"(JSON: {"views": [{"from": [x,y,z]} | {"direction": [x,y,z]}, ...]}, )"
          "numbers or strings \"p/q\"; repeatable, beside --from and --direction")
      ->allow_extra_args(false)
      ->type_name("FILE");
  command
      .add_option("--path", options.path,
                  R"(JSON: {"points": [[x,y,z], ...]} or {"directions": [...]}: all )"
                  "events that the eye crosses on its way, and the view between each "
                  "two; in JSON only, with neither pictures nor tables")
      ->type_name("FILE");
  command
      .add_option("--box", options.box,
                  "a section or a crop: what of the scene lies in this box, its sides "
                  "included, is all that is seen and hides; numbers or fractions p/q. "
                  "Lines where it cuts have the kind cut; closed objects that it cuts "
                  "open show their backs there (docs/point_view.md, In a box)")
      ->type_name("x0,y0,z0,x1,y1,z1");
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
      .add_option(
          "--svg", options.svg,
          "draw the view: patches (path.patch), edges (line.silhouette, .crease, "
          ".valley, .boundary, .contact, .crossing, .cut) and vertices (circle.corner, "
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
      "  sightline look house.ifc --direction 0,0,1 --box=-1,-1,0,20,20,1.2 --svg "
      "plan.svg\n"
      "    (the ground floor's plan, cut at 1.2)\n"
      "  sightline look city.obj --at eyes.json --csv seen.csv --threads 8\n"
      "  sightline look room.obj --path walk.json --json -");
  return command_of(options, run);
}

}  // namespace sightline::viewers
