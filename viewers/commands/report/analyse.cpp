// `sightline analyse`: the main job, one scene into one folder.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <map>
#include <numeric>
#include <span>

#include "linespace/mesh_io.h"
#include "skeleton/build.h"
#include "viewers/builtin_scene.h"
#include "viewers/commands/command_line.h"
#include "viewers/commands/outputs.h"
#include "viewers/commands/report/factor_part.h"
#include "viewers/commands/report/look_part.h"
#include "viewers/commands/report/report_parts.h"
#include "viewers/commands/report/shadow_part.h"
#include "viewers/commands/report/skeleton_pictures.h"
#include "viewers/json_text.h"
#include "viewers/page.h"
#include "viewers/report_folder.h"
#include "viewers/skeleton_file.h"
#include "viewers/vtk_export.h"

namespace sightline::viewers {
namespace {

namespace fs = std::filesystem;

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

// ---- the scene and its light ----------------------------------------------------------

/// What is analysed.
struct Subject {
  Scene scene;
  std::vector<std::string> light;  ///< names of groups or polygons; empty: no light
  std::optional<LightSource> source;
};

/// Ascending numbers of the polygons in the file that these faces are of.
std::vector<int> polygons_of(const Scene& scene, std::span<const int> faces) {
  std::vector<int> polygons;
  for (const int f : faces) polygons.push_back(scene.faces()[f].source);
  std::ranges::sort(polygons);
  polygons.erase(std::ranges::unique(polygons).begin(), polygons.end());
  return polygons;
}

/// These polygons of the file: the names of objects that they are the whole of, and
/// `#i-j` for each run of the rest.  Those without an area are passed over.
std::vector<std::string> names_of(const Scene& scene, const std::vector<int>& given) {
  if (given.empty()) return {};
  std::vector<int> all(scene.faces().size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<int> polygons;
  std::ranges::set_intersection(given, polygons_of(scene, all),
                                std::back_inserter(polygons));
  std::vector<std::string> names;
  for (const Object& object : scene.objects()) {
    const std::vector<int> own = polygons_of(scene, scene.faces_named(object.name));
    if (own.empty() || !std::ranges::includes(polygons, own)) continue;
    names.push_back(object.name);
    std::vector<int> left;
    std::ranges::set_difference(polygons, own, std::back_inserter(left));
    polygons = std::move(left);
  }
  for (std::size_t i = 0; i < polygons.size();) {
    std::size_t end = i + 1;
    while (end < polygons.size() && polygons[end] == polygons[end - 1] + 1) ++end;
    names.push_back(fmt::format("#{}-{}", polygons[i], polygons[end - 1]));
    i = end;
  }
  return names;
}

/// The light is what --light names, else what the file marks as emitting.
Subject load(Session& session, const AnalyseOptions& options, ReportFolder& folder) {
  Subject subject = [&]() -> Subject {
    if (!options.scene.empty()) {
      MeshFile file = read_file(session, options.scene, options.format);
      const std::vector<int> emitting = std::move(file.emitting);
      Scene scene(std::move(file), {}, session.with_grace());
      std::vector<std::string> light = names_of(scene, emitting);
      return {std::move(scene), std::move(light), {}};
    }
    const fs::path file = folder.announce(std::string(kBuiltinSceneName));
    write_whole(file, builtin_scene());
    PolygonSoup soup = read_mesh(file.string());
    soup.source = std::string(kBuiltinSceneName) + " (built in)";
    return {Scene(std::move(soup)), {std::string(kBuiltinSceneLight)}, {}};
  }();
  if (!options.light.empty()) subject.light = options.light;
  if (!subject.light.empty()) {
    subject.source = light_source(subject.scene, subject.light);
  }
  return subject;
}

// ---- what is computed -----------------------------------------------------------------

/// A report before it is written.
struct Analysis {
  std::vector<Defect> defects;
  std::optional<Skeleton> skeleton;
  std::optional<LookPart> look;
  std::optional<ShadowPart> shadows;
  std::optional<FactorPart> factors;
  std::map<std::string, std::string> why_not_all;  ///< by part, where it is not complete
  StageCounts predicates;
  std::size_t memory = 0;  ///< before pictures add theirs

  [[nodiscard]] bool complete() const { return why_not_all.empty(); }
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

Request part_request(Session& session, const AnalyseOptions& options, int shares) {
  Request request;
  request.precision = options.precision;
  request.threads = options.threads;
  session.limit(request, shares);
  return request;
}

/// Each part within an equal share of what is left of the budget.
Analysis analysed(Session& session, const AnalyseOptions& options, const Parts& parts,
                  const std::vector<ViewQuestion>& questions, const Subject& subject,
                  StageLog& log) {
  const Scene& scene = subject.scene;
  const Meter meter;
  Analysis analysis;
  // The search for defects has the grace of writing: without it the report would look
  // like that of a sound scene.
  analysis.defects = validate(scene, session.with_grace());
  log.done("look for defects");
  analysis.predicates = meter.predicates();
  int shares = parts.count();
  const int axis = up_axis_of(options), up_axis = axis < 0 ? guess_up_axis(scene) : axis;
  const auto ended = [&](const char* part, bool complete, const StageCounts& predicates,
                         const char* stage) {
    if (!complete) analysis.why_not_all[part] = why_not_all(session, part);
    analysis.predicates = analysis.predicates + predicates;
    log.done(stage);
  };
  if (parts.skeleton) {
    const Skeleton& skeleton =
        analysis.skeleton.emplace(skeleton_part(session, options, scene, shares--));
    ended("skeleton", skeleton.complete, skeleton.predicates, "visibility skeleton");
  }
  if (parts.look) {
    const LookPart& look =
        analysis.look.emplace(look_part(session, scene, questions, Point::Unit(up_axis),
                                        part_request(session, options, shares--)));
    ended("look", look.complete(), look.predicates, "views");
  }
  if (parts.shadows) {
    const ShadowPart& shadows = analysis.shadows.emplace(shadow_part(
        scene, *subject.source, up_axis, part_request(session, options, shares--)));
    ended("shadows", shadows.complete(), shadows.predicates, "shadows");
  }
  if (parts.factors) {
    const FactorPart& factors = analysis.factors.emplace(
        factor_part(scene, part_request(session, options, shares--)));
    ended("formfactors", factors.factors.complete, factors.predicates, "form factors");
  }
  analysis.memory = peak_memory_bytes();
  return analysis;
}

// ---- what is missing ------------------------------------------------------------------

void add_missing(Json& missing, const std::string& why, std::size_t done,
                 std::size_t asked, const char* what) {
  missing.push_back(fmt::format(
      "{}: {} of {} were not computed ({:.1f} %)", why,
      fmt::format(fmt::runtime(what), asked - done), asked,
      100.0 * static_cast<double>(asked - done) / static_cast<double>(asked)));
}

Json missing_json(const Analysis& analysis, const Session& session) {
  Json missing = Json::array();
  const auto add = [&](const char* part, std::size_t done, std::size_t asked,
                       const char* what) {
    if (done != asked)
      add_missing(missing, analysis.why_not_all.at(part), done, asked, what);
  };
  if (analysis.skeleton) {
    const Skeleton& skeleton = *analysis.skeleton;
    add("skeleton", skeleton.vertices_done, skeleton.vertices_asked, "the EV arcs of {}");
    add("skeleton", skeleton.edges_done, skeleton.edges_asked, "the EEE arcs of {}");
    add("skeleton", skeleton.facets_done, skeleton.facets_asked, "the FF nodes of {}");
    if (!skeleton.complete && missing.empty()) {
      missing.push_back("The skeleton: stopped in its set-up");
    }
  }
  if (analysis.look) {
    add("look", analysis.look->views.size(), analysis.look->asked, "{} views");
  }
  if (const auto& part = analysis.shadows) {
    add("shadows", part->asked - part->shadows.missing.size(), part->asked,
        "the shadows on {} groups");
    if (part->png.empty()) {
      missing.push_back(analysis.why_not_all.at("shadows") +
                        ": the picture under the light was not drawn");
    }
  }
  if (const auto& part = analysis.factors) {
    add("formfactors", part->factors.rows.size(), part->factors.names.size(),
        "the form factors from {} groups");
  }
  for (const std::string& name : session.unwritten()) {
    missing.push_back("Not written: " + name);
  }
  return missing;
}

// ---- what is written ------------------------------------------------------------------

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
  std::vector<PagePicture> skeleton, views, light;
};

const char* incomplete(const Json& part) {
  return part["complete"].get<bool>() ? "" : ", INCOMPLETE";
}

void print_skeleton(const Json& s, const std::string& file) {
  std::cout << fmt::format(
      "{}: {} EV arcs ({} within one object), {} EEE arcs ({}){}\n  nodes:", file,
      s["arcs"]["EV"].get<std::int64_t>() + s["arcs"]["EV_self"].get<std::int64_t>(),
      s["arcs"]["EV_self"].get<std::int64_t>(),
      s["arcs"]["EEE"].get<std::int64_t>() + s["arcs"]["EEE_self"].get<std::int64_t>(),
      s["arcs"]["EEE_self"].get<std::int64_t>(), incomplete(s));
  for (const auto& [kind, count] : s["nodes"].items()) {
    if (count.is_number() && count != 0) {
      std::cout << fmt::format(" {} {}", kind, count.get<std::int64_t>());
    }
  }
  std::cout << "\n";
}

void print_shadows(const Json& shadows, const std::string& file) {
  double lit = 0, penumbra = 0, umbra = 0;
  for (const Json& r : shadows["receivers"]) {
    lit += r["lit_area"].get<double>();
    penumbra += r["penumbra_area"].get<double>();
    umbra += r["umbra_area"].get<double>();
  }
  std::cout << fmt::format(
      "{}: shadows on {}: lit {:.6g}, penumbra {:.6g}, umbra {:.6g}{}\n", file,
      counted(shadows["receivers"].size(), "group", "groups"), lit, penumbra, umbra,
      incomplete(shadows));
}

void print_factors(const Json& factors, const std::string& file) {
  std::cout << fmt::format("{}: form factors between {}, each within {:.1e}{}\n", file,
                           counted(factors["groups"].size(), "group", "groups"),
                           factors["error_bound"].get<double>(), incomplete(factors));
}

void print_summary(const Json& report, const std::vector<ViewQuestion>& questions,
                   const fs::path& folder) {
  const std::string file = report["scene"]["file"].get<std::string>();
  if (report.contains("skeleton")) print_skeleton(report["skeleton"], file);
  if (report.contains("look")) {
    const Json& views = report["look"]["views"];
    std::cout << fmt::format("{}: {}{}\n", file, counted(views.size(), "view", "views"),
                             incomplete(report["look"]));
    print_views(questions, views);
  }
  if (report.contains("shadows")) print_shadows(report["shadows"], file);
  if (report.contains("formfactors")) print_factors(report["formfactors"], file);
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
                    const Skeleton& skeleton, const Shadows* shadows,
                    ReportFolder& folder, Pictures& pictures, StageLog& log) {
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
                   return write_vtk(vtk, scene, {&skeleton, &strips, shadows}, writing);
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
  if (analysis.shadows) {
    Json head = answer_head("shadows", scene, analysis.shadows->complete(),
                            {session.seconds(), analysis.shadows->predicates});
    pictures.light =
        write_shadow_part(session, *analysis.shadows, std::move(head), folder);
    log.done("saved shadows");
  }
  if (analysis.factors) {
    Json head = answer_head("formfactors", scene, analysis.factors->factors.complete,
                            {session.seconds(), analysis.factors->predicates});
    write_factor_part(session, *analysis.factors, std::move(head), folder);
    log.done("saved form factors");
  }
  const Shadows* shadows = analysis.shadows ? &analysis.shadows->shadows : nullptr;
  if (analysis.skeleton) {
    write_skeleton(session, options, scene, *analysis.skeleton, shadows, folder, pictures,
                   log);
  } else {
    write_vtk_part(session, options, folder,
                   [&](const fs::path& vtk, const Request& writing) {
                     return write_vtk(vtk, scene, {.shadows = shadows}, writing);
                   });
    log.done("VTK files");
  }
  return pictures;
}

/// The report, which knows by now what is missing, without its list of files.
Json report_json(const Session& session, const AnalyseOptions& options,
                 const Parts& parts, const std::vector<ViewQuestion>& questions,
                 const Subject& subject, const Analysis& analysis) {
  const Scene& scene = subject.scene;
  const bool complete = analysis.complete() && session.unwritten().empty();
  Json report =
      answer_head("analyse", scene, complete, {session.seconds(), analysis.predicates});
  report["peak_memory_bytes"] = analysis.memory;
  report["peak_memory_bytes_with_pictures"] = peak_memory_bytes();
  report["options"] = options_json(options, parts, subject.light);
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
  if (analysis.shadows) {
    report["shadows"] = shadow_part_json(*analysis.shadows);
    report["shadows"]["light"] = subject.light;
  }
  if (analysis.factors) {
    // Larger matrices stay in their file.
    report["formfactors"] =
        factor_part_json(*analysis.factors, scene.objects().size() <= kMostFactorGroups);
  }
  report["left_out"] =
      left_out_json(options, parts, subject.light, questions, options.folder);
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
  write_whole(page,
              report_page(report, pictures.skeleton, pictures.views, pictures.light));
  return report;
}

ExitStatus run(Session& session, const AnalyseOptions& options) {
  // 1. Outputs first: a folder that cannot be written is refused before the work.  Two
  // kinds of names are ours: those of the report, and in `vtk` those of VTK files.
  check_parts(options);
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
  const Subject subject = load(session, options, folder);
  const Scene& scene = subject.scene;
  const Parts parts = parts_of(options, scene, subject.light);
  log.done("load the scene");
  const Analysis analysis = analysed(session, options, parts, questions, subject, log);

  // 3. Files.  Those of an earlier run go first, so that the folder is of one run only.
  folder.clear();
  if (session.stopped()) {
    // The program may have to end while it still writes what takes long: then there is
    // this report, which says that nothing else is there.
    Json early = report_json(session, options, parts, questions, subject, analysis);
    early["complete"] = false;
    early["missing"].push_back("Not written: any file but this report");
    write_report(std::move(early), {}, folder, log);
  }
  const Pictures pictures = write_parts(session, options, scene, analysis, folder, log);

  // 4. The report.
  const Json report =
      write_report(report_json(session, options, parts, questions, subject, analysis),
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
          "folder for index.html, report.json, a .json file for each part, tables, "
          "pictures and VTK files; of what it holds, only what an earlier run wrote is "
          "removed, "
          "which its files.txt lists (default sightline-report)")
      ->type_name("DIR");
  command
      ->add_option("--only", options->only,
                   "only these parts, separated by commas: info (always done), skeleton, "
                   "look, shadows, formfactors (default: skeleton; look where --from or "
                   "--direction is given; with a light shadows, and formfactors of up to "
                   "100 groups)")
      ->type_name("NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  add_names_option(
      *command, "--light", options->light,
      "the light of shadows: all faces of these groups, or polygons #i-j, by "
      "their fronts (default: what the file marks as emitting, glTF; of the "
      "built-in room its lamp)");
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
