// `sightline analyse`: the main job, one scene into one folder.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "linespace/mesh_io.h"
#include "skeleton/build.h"
#include "viewers/builtin_scene.h"
#include "viewers/commands/command_line.h"
#include "viewers/commands/look_part.h"
#include "viewers/commands/outputs.h"
#include "viewers/commands/skeleton_pictures.h"
#include "viewers/json_text.h"
#include "viewers/page.h"
#include "viewers/report_folder.h"
#include "viewers/skeleton_file.h"
#include "viewers/vtk_export.h"

namespace sightline::viewers {
namespace {

namespace fs = std::filesystem;

struct AnalyseOptions : CommonOptions {
  ViewpointOptions viewpoints;
  std::string folder = "sightline-report";
  std::vector<std::string> only;
  std::string up;
  std::vector<double> region;
};

/// Names what was done and how long it took.
class StageLog {
 public:
  void done(const std::string& name) {
    stages_.push_back({{"name", name},
                       {"seconds", meter_.seconds()},
                       {"peak_memory_bytes", peak_memory_bytes()}});
    meter_ = Meter();
  }
  [[nodiscard]] const Json& stages() const { return stages_; }

 private:
  Meter meter_;
  Json stages_ = Json::array();
};

// ---- which parts ----------------------------------------------------------------------

/// The parts of a report that this version has, in their order.
constexpr std::array<const char*, 3> kParts{"info", "skeleton", "look"};

/// What is done, besides the scene and its defects.
struct Parts {
  bool skeleton = true, look = true;
  [[nodiscard]] int count() const { return int{skeleton} + int{look}; }
};

bool is_asked(const AnalyseOptions& options, std::string_view part) {
  return options.only.empty() || std::ranges::count(options.only, part) > 0;
}

Parts parts_of(const AnalyseOptions& options) {
  for (const std::string& name : options.only) {
    if (std::ranges::count(kParts, name) > 0) continue;
    throw UsageError(
        fmt::format("--only: '{}' is not available in this version; available: {}", name,
                    fmt::join(kParts, ", ")));
  }
  const bool from = !options.viewpoints.empty();
  if (!options.only.empty() && is_asked(options, "look") && !from) {
    throw UsageError("--only look: from where? name --from x,y,z or --direction x,y,z");
  }
  return {is_asked(options, "skeleton"), is_asked(options, "look") && from};
}

/// A word of the shell.
std::string quoted(const std::string& word) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("_-./,+:@%").find(c) != std::string::npos;
  };
  if (!word.empty() && std::ranges::all_of(word, plain)) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

/// [{"part", "why", "command"}] of what could have been done and was not asked for.
Json left_out_json(const AnalyseOptions& options, const Parts& parts,
                   const std::vector<ViewQuestion>& questions, const fs::path& folder) {
  const std::string scene = quoted(
      options.scene.empty() ? (folder / kBuiltinSceneName).string() : options.scene);
  Json left = Json::array();
  const auto add = [&](const char* part, const char* why, const std::string& more) {
    left.push_back({{"part", part},
                    {"why", why},
                    {"command", fmt::format("sightline {} {}{}", part, scene, more)}});
  };
  constexpr const char* kNotAmong = "not among --only";
  if (!parts.skeleton) add("skeleton", kNotAmong, "");
  if (parts.look) return left;
  std::string from;
  for (const ViewQuestion& question : questions) from += " " + question.where;
  add("look", questions.empty() ? "neither --from nor --direction is given" : kNotAmong,
      questions.empty() ? " --from x,y,z" : from);
  return left;
}

Json options_json(const AnalyseOptions& options, const Parts& parts) {
  Json j{{"only", Json::array({"info"})}};
  if (parts.skeleton) j["only"].push_back("skeleton");
  if (parts.look) j["only"].push_back("look");
  j["precision"] = options.precision == Precision::Exact ? "exact" : "double";
  if (std::isfinite(options.budget)) j["budget"] = options.budget;
  if (!options.region.empty()) j["region"] = options.region;
  return j;
}

// ---- what is computed -----------------------------------------------------------------

/// A report before it is written.
struct Analysis {
  std::vector<Defect> defects;
  std::optional<Skeleton> skeleton;
  std::optional<LookPart> look;
  std::string why_no_skeleton, why_no_look;  ///< where the part is not complete
  StageCounts predicates;
  std::size_t memory = 0;  ///< before pictures add theirs

  [[nodiscard]] bool complete() const {
    return (!skeleton || skeleton->complete) && (!look || look->complete());
  }
};

/// Of a part that has just ended.
std::string why_not_all(Session& session, const char* part) {
  if (session.interrupted()) return "Interrupted";
  if (session.stopped()) return "The budget ended first";
  session.share_ended(part);
  return fmt::format("The share of {} in the budget ended first", part);
}

Skeleton skeleton_part(Session& session, const AnalyseOptions& options,
                       const Scene& scene, int shares) {
  SkeletonRequest request;
  request.ff = true;
  request.part.region = region_box(options.region);
  request.precision = options.precision;
  request.threads = options.threads;
  session.limit(request, shares);
  return build_skeleton(scene, request);
}

/// 0 to 2; -1 where it is to be guessed.
int up_axis_of(const AnalyseOptions& options) {
  return options.up.empty() ? -1 : options.up[0] - 'x';
}

LookPart look_part(Session& session, const AnalyseOptions& options, const Scene& scene,
                   const std::vector<ViewQuestion>& questions, int shares) {
  Request request;
  request.precision = options.precision;
  request.threads = options.threads;
  session.limit(request, shares);
  const int axis = up_axis_of(options);
  const Point up = Point::Unit(axis < 0 ? guess_up_axis(scene) : axis);
  return look_part(session, scene, questions, up, request);
}

/// Each part within an equal share of what is left of the budget.
Analysis analysed(Session& session, const AnalyseOptions& options, const Parts& parts,
                  const std::vector<ViewQuestion>& questions, const Scene& scene,
                  StageLog& log) {
  const Meter meter;
  Analysis analysis;
  // The search for defects has the grace of writing: without it the report would look
  // like that of a sound scene.
  analysis.defects = validate(scene, session.with_grace());
  log.done("look for defects");
  analysis.predicates = meter.predicates();
  int shares = parts.count();
  if (parts.skeleton) {
    analysis.skeleton = skeleton_part(session, options, scene, shares--);
    if (!analysis.skeleton->complete) {
      analysis.why_no_skeleton = why_not_all(session, "skeleton");
    }
    analysis.predicates = analysis.predicates + analysis.skeleton->predicates;
    log.done("visibility skeleton");
  }
  if (parts.look) {
    analysis.look = look_part(session, options, scene, questions, shares--);
    if (!analysis.look->complete()) analysis.why_no_look = why_not_all(session, "look");
    analysis.predicates = analysis.predicates + analysis.look->predicates;
    log.done("views");
  }
  analysis.memory = peak_memory_bytes();
  return analysis;
}

// ---- what is missing ------------------------------------------------------------------

void add_missing(Json& missing, const std::string& why, std::size_t done,
                 std::size_t asked, const char* what) {
  if (done == asked) return;
  missing.push_back(fmt::format(
      "{}: {} of {} were not computed ({:.1f} %)", why,
      fmt::format(fmt::runtime(what), asked - done), asked,
      100.0 * static_cast<double>(asked - done) / static_cast<double>(asked)));
}

Json missing_json(const Analysis& analysis, const Session& session) {
  Json missing = Json::array();
  if (analysis.skeleton) {
    const Skeleton& skeleton = *analysis.skeleton;
    const auto add = [&](std::size_t done, std::size_t asked, const char* what) {
      add_missing(missing, analysis.why_no_skeleton, done, asked, what);
    };
    add(skeleton.vertices_done, skeleton.vertices_asked, "the EV arcs of {}");
    add(skeleton.edges_done, skeleton.edges_asked, "the EEE arcs of {}");
    add(skeleton.facets_done, skeleton.facets_asked, "the FF nodes of {}");
    if (!skeleton.complete && missing.empty()) {
      missing.push_back("The skeleton: stopped in its set-up");
    }
  }
  if (analysis.look) {
    add_missing(missing, analysis.why_no_look, analysis.look->views.size(),
                analysis.look->asked, "{} views");
  }
  for (const std::string& name : session.unwritten()) {
    missing.push_back("Not written: " + name);
  }
  return missing;
}

// ---- what is written ------------------------------------------------------------------

Scene load(Session& session, const AnalyseOptions& options, ReportFolder& folder) {
  if (!options.scene.empty()) return read_scene(session, options.scene, options.format);
  const fs::path file = folder.announce(std::string(kBuiltinSceneName));
  write_whole(file, builtin_scene());
  PolygonSoup soup = read_mesh(file.string());
  soup.source = std::string(kBuiltinSceneName) + " (built in)";
  return Scene(std::move(soup));
}

/// skeleton.json, for `view` and `skeleton --saved`.
void save_skeleton(Session& session, const AnalyseOptions& options, const Scene& scene,
                   const Skeleton& skeleton, ReportFolder& folder) {
  Json asked{{"events", "solid"}, {"kinds", Json::array({"EV", "EEE"})}};
  if (!options.region.empty()) asked["region"] = options.region;
  Json answer =
      skeleton_answer(scene, skeleton, asked, options.precision, skeleton.complete,
                      {session.seconds(), skeleton.predicates}, /*with_ids=*/true);
  // The built-in scene lies beside it.
  if (options.scene.empty()) answer["scene"]["file"] = kBuiltinSceneName;
  session.write("skeleton.json", [&](const Request& request) {
    OutputFile file(folder.announce("skeleton.json"));
    save_skeleton_json(file, answer, scene, skeleton, request);
  });
}

/// VTK files where --vtk says, else in the report's own folder.
void write_vtk_part(
    Session& session, const AnalyseOptions& options, ReportFolder& folder,
    const std::function<std::vector<std::string>(const fs::path&, const Request&)>&
        write) {
  session.write("VTK files", [&](const Request& writing) {
    // Only files in the report's own folder are listed on its page.
    const bool here = options.vtk.empty();
    std::vector<std::string> names =
        write(here ? folder.path() / "vtk" : fs::path(options.vtk), writing);
    for (std::string& name : names) name.insert(0, "vtk/");
    if (here) folder.add(names);
  });
}

/// Pictures of the page.
struct Pictures {
  std::vector<PagePicture> skeleton, views;
};

void print_skeleton(const Json& s, const std::string& file) {
  std::cout << fmt::format(
      "{}: {} EV arcs ({} within one object), {} EEE arcs ({}){}\n  nodes:", file,
      s["arcs"]["EV"].get<std::int64_t>() + s["arcs"]["EV_self"].get<std::int64_t>(),
      s["arcs"]["EV_self"].get<std::int64_t>(),
      s["arcs"]["EEE"].get<std::int64_t>() + s["arcs"]["EEE_self"].get<std::int64_t>(),
      s["arcs"]["EEE_self"].get<std::int64_t>(),
      s["complete"].get<bool>() ? "" : ", INCOMPLETE");
  for (const auto& [kind, count] : s["nodes"].items()) {
    if (count.is_number() && count != 0) {
      std::cout << fmt::format(" {} {}", kind, count.get<std::int64_t>());
    }
  }
  std::cout << "\n";
}

void print_summary(const Json& report, const std::vector<ViewQuestion>& questions,
                   const fs::path& folder) {
  const std::string file = report["scene"]["file"].get<std::string>();
  if (report.contains("skeleton")) print_skeleton(report["skeleton"], file);
  if (report.contains("look")) {
    const Json& views = report["look"]["views"];
    std::cout << fmt::format(
        "{}: {}{}\n", file, counted(views.size(), "view", "views"),
        report["look"]["complete"].get<bool>() ? "" : ", INCOMPLETE");
    print_views(questions, views);
  }
  std::cout << fmt::format("{}  {:.2f} s, {:.0f} MiB\n  open {}\n",
                           report["complete"].get<bool>()
                               ? ""
                               : "  INCOMPLETE: the page says what is missing\n",
                           report["seconds"].get<double>(),
                           report["peak_memory_bytes"].get<double>() / 1048576,
                           (folder / "index.html").string());
}

/// skeleton.json, VTK files and pictures, in the order of what they cost.
void write_skeleton(Session& session, const AnalyseOptions& options, const Scene& scene,
                    const Skeleton& skeleton, ReportFolder& folder, Pictures& pictures,
                    StageLog& log) {
  save_skeleton(session, options, scene, skeleton, folder);
  log.done("saved skeleton");
  // `lines` finds free segments: made once, by the first of two steps that gets so far,
  // since either may be stopped.
  std::optional<SkeletonLines> lines;
  const Highlights highlights = find_highlights(scene, skeleton);
  write_vtk_part(session, options, folder,
                 [&](const fs::path& vtk, const Request& writing) {
                   lines.emplace(scene, writing);
                   const std::vector<RuledStrip> strips =
                       strips_of(scene, *lines, skeleton, highlights.vertex);
                   return write_vtk(vtk, scene, {&skeleton, &strips}, writing);
                 });
  log.done("VTK files");
  // All pictures or none: the page shows only those that were drawn to the end.
  session.write("pictures", [&](const Request& writing) {
    if (!lines) lines.emplace(scene, writing);
    auto drawn = draw_pictures(scene, *lines, skeleton, highlights,
                               region_box(options.region), up_axis_of(options), writing);
    for (const PagePicture& picture : drawn) {
      write_whole(folder.announce(picture.file), picture.png);
    }
    pictures.skeleton = std::move(drawn);
  });
  log.done("pictures");
}

Pictures write_parts(Session& session, const AnalyseOptions& options, const Scene& scene,
                     const Analysis& analysis, ReportFolder& folder, StageLog& log) {
  Pictures pictures;
  if (analysis.look) {
    Json head = answer_head("look", scene, analysis.look->complete(),
                            {session.seconds(), analysis.look->predicates});
    pictures.views = write_look(session, *analysis.look, std::move(head), folder);
    log.done("saved views");
  }
  if (analysis.skeleton) {
    write_skeleton(session, options, scene, *analysis.skeleton, folder, pictures, log);
  } else {
    write_vtk_part(session, options, folder,
                   [&](const fs::path& vtk, const Request& writing) {
                     return write_vtk(vtk, scene, {}, writing);
                   });
    log.done("VTK files");
  }
  return pictures;
}

/// The report, which knows by now what is missing, without its list of files.
Json report_json(const Session& session, const AnalyseOptions& options,
                 const Parts& parts, const std::vector<ViewQuestion>& questions,
                 const Scene& scene, const Analysis& analysis) {
  const bool complete = analysis.complete() && session.unwritten().empty();
  Json report =
      answer_head("analyse", scene, complete, {session.seconds(), analysis.predicates});
  report["peak_memory_bytes"] = analysis.memory;
  report["peak_memory_bytes_with_pictures"] = peak_memory_bytes();
  report["options"] = options_json(options, parts);
  report["info"] = info_json(scene, analysis.defects);
  if (analysis.skeleton) {
    report["skeleton"] = skeleton_json(*analysis.skeleton);
    report["skeleton"].update(
        {{"events", "solid"},
         {"kinds", Json::array({"EV", "EEE"})},
         {"complete", analysis.skeleton->complete},
         {"predicates", stage_counts(analysis.skeleton->predicates)}});
  }
  if (analysis.look) report["look"] = look_json(*analysis.look);
  report["left_out"] = left_out_json(options, parts, questions, options.folder);
  report["missing"] = missing_json(analysis, session);
  return report;
}

/// Writes report.json and the page.  The page is made of the report and of the pictures
/// alone, so that both say the same.
Json write_report(Json report, const Pictures& pictures, ReportFolder& folder,
                  const StageLog& log) {
  report["stages"] = log.stages();
  // Announced before the list of files is taken: they are in it themselves.
  const fs::path report_file = folder.announce("report.json");
  const fs::path page = folder.announce("index.html");
  report["files"] = folder.files();
  write_whole(report_file, json_text(report, 1) + "\n");
  write_whole(page, report_page(report, pictures.skeleton, pictures.views));
  return report;
}

ExitStatus run(Session& session, const AnalyseOptions& options) {
  // 1. Outputs first: a folder that cannot be written is refused before the work.  Two
  // kinds of names are ours: those of the report, and in `vtk` those of VTK files.
  const Parts parts = parts_of(options);
  Outputs outputs(options);
  ReportFolder folder(options.folder);
  outputs.add_folder("-o", folder.path(),
                     [&folder](const std::string& name) { return folder.takes(name); });
  outputs.add_folder("-o", folder.path() / "vtk", is_vtk_name);
  const std::vector<ViewQuestion> questions =
      questions_of(session, options.viewpoints, outputs);
  if (questions.size() > kMostDrawnViews) {
    throw UsageError(fmt::format("analyse: {} views; it takes at most {}",
                                 questions.size(), kMostDrawnViews));
  }
  (void)region_box(options.region);  // refuses what is no box

  // 2. The scene and the parts.
  StageLog log;
  const PrecisionScope precision(options.precision);
  const Scene scene = load(session, options, folder);
  log.done("load the scene");
  const Analysis analysis = analysed(session, options, parts, questions, scene, log);

  // 3. Files.  Those of an earlier run go first, so that the folder is of one run only.
  folder.clear();
  if (session.stopped()) {
    // The program may have to end while it still writes what takes long: then there is
    // this report, which says that nothing else is there.
    Json early = report_json(session, options, parts, questions, scene, analysis);
    early["complete"] = false;
    early["missing"].push_back("Not written: any file but this report");
    write_report(std::move(early), {}, folder, log);
  }
  const Pictures pictures = write_parts(session, options, scene, analysis, folder, log);

  // 4. The report.
  const Json report =
      write_report(report_json(session, options, parts, questions, scene, analysis),
                   pictures, folder, log);
  outputs.write_answer(report);
  if (options.may_print()) print_summary(report, questions, folder.path());
  return session.end(report["complete"]);
}

}  // namespace

Command add_analyse_command(CLI::App& app) {
  auto options = std::make_shared<AnalyseOptions>();
  CLI::App* command = app.add_subcommand(
      "analyse",
      "the main job: all analyses of one scene into a folder with a page to open");
  add_scene_argument(*command, *options, false);
  command->get_option("SCENE")->description(
      command->get_option("SCENE")->get_description() +
      " (default: a built-in room, which is also written into DIR)");
  command
      ->add_option(
          "-o,--output", options->folder,
          "folder for index.html, report.json, skeleton.json, look.json, pictures "
          "and VTK files; of what it holds, only what an earlier run wrote is removed, "
          "which its files.txt lists (default sightline-report)")
      ->type_name("DIR");
  command
      ->add_option("--only", options->only,
                   "only these parts, separated by commas: info (always done), skeleton, "
                   "look (default: skeleton, and look where --from or --direction is "
                   "given)")
      ->type_name("NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  add_viewpoint_options(*command, options->viewpoints);
  command
      ->add_option("--up", options->up,
                   "the axis that points up in the pictures (default: guessed)")
      ->type_name("x|y|z")
      ->check(one_of({"x", "y", "z"}));
  add_region_option(*command, options->region);
  add_common_options(*command, *options);
  return command_of(options, run);
}

}  // namespace sightline::viewers
