// `sightline analyse`: the main job, one scene into one folder.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <set>

#include "linespace/mesh_io.h"
#include "skeleton/build.h"
#include "viewers/builtin_scene.h"
#include "viewers/commands/command_line.h"
#include "viewers/commands/outputs.h"
#include "viewers/drawing.h"
#include "viewers/envelope.h"
#include "viewers/json_text.h"
#include "viewers/kinds.h"
#include "viewers/page.h"
#include "viewers/palette.h"
#include "viewers/report_folder.h"
#include "viewers/skeleton_file.h"
#include "viewers/vtk_export.h"

namespace sightline::viewers {
namespace {

namespace fs = std::filesystem;

struct AnalyseOptions : CommonOptions {
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

/// How many strips and nodes a picture and a strip block take before they tell less.
constexpr std::size_t kDrawnNodes = 2500, kDrawnStrips = 400;

int object_of_vertex(const Scene& scene, int vertex) {
  return scene.edges()[scene.edges_at(vertex)[0]].object;
}

/// The largest set of arcs with one key; arcs without a key do not count.
template <typename Key>
std::vector<int> busiest(const Skeleton& skeleton, const Key& key) {
  std::map<int, std::vector<int>> by_key;
  for (std::size_t i = 0; i < skeleton.arcs.size(); ++i) {
    if (const std::optional<int> k = key(skeleton.arcs[i])) {
      by_key[*k].push_back(static_cast<int>(i));
    }
  }
  std::vector<int> best;
  for (auto& [k, arcs] : by_key) {
    if (arcs.size() > best.size()) best = std::move(arcs);
  }
  return best;
}

/// Of the vertex, the edge, the pair of inner objects that has most arcs.
struct Highlights {
  std::vector<int> vertex, edge, pair;
  /// The EEE arc with the most to see, of inner objects where there is one; those from
  /// one EEEE line to another are favoured.
  std::optional<int> eee;
  /// The EEEE line at whose EEE surfaces there is most to see.
  std::optional<int> eeee;
};

std::optional<int> showiest_eee(const Scene& scene, const Skeleton& skeleton,
                                const std::vector<char>& inner) {
  std::optional<int> best;
  std::pair<bool, double> best_score;
  for (std::size_t i = 0; i < skeleton.eee_arcs.size(); ++i) {
    const EeeArc& arc = skeleton.eee_arcs[i];
    const bool all_inner = std::ranges::all_of(
        arc.edges, [&](int e) { return inner[scene.edges()[e].object] != 0; });
    const bool both_eeee = std::ranges::all_of(arc.nodes, [&](std::uint32_t n) {
      return skeleton.nodes[n].kind == NodeKind::EEEE;
    });
    // A smaller one that shows both its EEEE ends still tells more.
    const std::pair score{all_inner, (both_eeee ? 8 : 1) * spanned_volume(scene, arc)};
    if (best && score <= best_score) continue;
    best_score = score;
    best = static_cast<int>(i);
  }
  return best;
}

std::optional<int> showiest_eeee(const Scene& scene, const Skeleton& skeleton) {
  // Of each node the smallest surface that ends there: all of them are to be seen.
  std::vector<std::optional<double>> smallest(skeleton.nodes.size());
  for (const EeeArc& arc : skeleton.eee_arcs) {
    const double volume = spanned_volume(scene, arc);
    for (const std::uint32_t n : arc.nodes) {
      smallest[n] = std::min(smallest[n].value_or(volume), volume);
    }
  }
  std::optional<int> best;
  for (std::size_t i = 0; i < skeleton.nodes.size(); ++i) {
    if (skeleton.nodes[i].kind != NodeKind::EEEE || !smallest[i]) continue;
    if (best && *smallest[i] <= *smallest[*best]) continue;
    best = static_cast<int>(i);
  }
  return best;
}

Highlights find_highlights(const Scene& scene, const Skeleton& skeleton) {
  std::vector<char> inner = envelope_objects(scene);
  const bool any = std::ranges::count(inner, 0) > 0;
  for (char& i : inner) i = any ? !i : 1;
  const int objects = static_cast<int>(scene.objects().size());
  const auto vertex_object = [&](const SkeletonArc& a) {
    return object_of_vertex(scene, a.vertex);
  };
  const auto edge_object = [&](const SkeletonArc& a) {
    return scene.edges()[a.edge].object;
  };
  using Key = std::optional<int>;
  Highlights found;
  found.vertex = busiest(skeleton, [&](const SkeletonArc& a) {
    return inner[vertex_object(a)] ? Key(a.vertex) : Key();
  });
  found.edge = busiest(skeleton, [&](const SkeletonArc& a) {
    return inner[edge_object(a)] ? Key(a.edge) : Key();
  });
  if (objects < 40000) {  // the pair's number fits an int
    found.pair = busiest(skeleton, [&](const SkeletonArc& a) {
      const int u = vertex_object(a), v = edge_object(a);
      if (u == v || !inner[u] || !inner[v]) return Key();
      return Key(std::min(u, v) * objects + std::max(u, v));
    });
  }
  found.eee = showiest_eee(scene, skeleton, inner);
  found.eeee = showiest_eeee(scene, skeleton);
  return found;
}

std::vector<RuledStrip> strips_of(const Scene& scene, const SkeletonLines& lines,
                                  const Skeleton& skeleton,
                                  const std::vector<int>& arcs) {
  std::vector<RuledStrip> strips;
  for (const int arc : arcs) {
    if (strips.size() == kDrawnStrips) break;
    strips.push_back(ruled_strip(scene, lines, skeleton, arc, 17));
  }
  return strips;
}

PagePicture strips_picture(const SceneView& view, const Canvas& canvas,
                           const Scene& scene, const Skeleton& skeleton,
                           const std::vector<RuledStrip>& strips) {
  SceneView marked = view;
  const double crowd = static_cast<double>(strips.size());
  const auto opacity = static_cast<float>(std::clamp(6 / (crowd + 1), 0.05, 0.3));
  for (const RuledStrip& strip : strips) {
    add_strip(marked, scene, skeleton, strip, opacity);
  }
  return {"", encode_png(canvas.picture(marked.drawing)), "", ""};
}

std::string node_legend(const Json& counts) {
  std::string html = "<span class=legend>";
  for (const auto& [kind, count] : counts.items()) {
    if (!count.is_number() || count == 0) continue;
    html += fmt::format("<span><i class=chip style=\"background:{}\"></i>{}</span>",
                        hex(colour_of_kind(kind)), kind);
  }
  return html + "</span>";
}

std::string drawn_of(std::size_t drawn, std::size_t all, const char* what) {
  return drawn == all ? fmt::format("All {} {}.", all, what)
                      : fmt::format("{} of {} {}, evenly chosen.", drawn, all, what);
}

std::string pair_picture(const SceneView& view, const Canvas& canvas, const Scene& scene,
                         const Skeleton& skeleton, const std::vector<int>& arcs) {
  SceneView marked = view;
  const double crowd = static_cast<double>(arcs.size());
  add_arcs(marked.drawing, scene, skeleton, arcs,
           static_cast<float>(std::clamp(2.5 / (crowd + 1), 0.02, 0.25)));
  std::set<int> ends;
  for (const int a : arcs) {
    for (const std::uint32_t n : skeleton.arcs[a].nodes) ends.insert(static_cast<int>(n));
  }
  add_nodes(marked.drawing, skeleton, std::vector<int>(ends.begin(), ends.end()),
            static_cast<float>(std::clamp(80 / (crowd + 1), 0.2, 0.9)), 1.4F);
  return encode_png(canvas.picture(marked.drawing));
}

std::string object_name(const Scene& scene, int edge) {
  return html_escaped(scene.objects()[scene.edges()[edge].object].name);
}

constexpr Colour kGeneratorEdge{0.95F, 0.35F, 0.05F};

PagePicture eee_picture(const SceneView& view, const Canvas& canvas, const Scene& scene,
                        const Skeleton& skeleton, int id) {
  const EeeArc& arc = skeleton.eee_arcs[id];
  SceneView marked = view;
  add_eee_arc(marked.drawing, scene, arc, 0.45F);
  const Colour colour = colour_of_kind(kind_name(arc));
  const auto swath = swath_of(scene, arc);
  constexpr int kLines = 24;
  for (int i = 1; swath && i < kLines; ++i) {
    const double s =
        arc.range[0] + (arc.range[1] - arc.range[0]) * static_cast<double>(i) / kLines;
    marked.drawing.strokes.push_back({swath->line(s), colour, 1.1F, 0.75F, 0.12F});
  }
  for (const int e : arc.edges) {
    add_edge(marked.drawing, scene, e, kGeneratorEdge, 4.0F, 0.35F);
  }
  const std::vector<int> ends(arc.nodes.begin(), arc.nodes.end());
  add_nodes(marked.drawing, skeleton, ends, 1, 2.6F);
  const auto kind = [&](int end) { return kind_name(skeleton.nodes[arc.nodes[end]]); };
  return {
      "eee.png", encode_png(canvas.picture(marked.drawing)), "An EEE surface",
      fmt::format(
          "All lines that touch three edges (orange) of {}, {} and {}, in this order, "
          "with nothing between: one EEE line set, a piece of a ruled quadric, drawn "
          "between its outer edges. It ends in the lines of kind {} and {}. An eye "
          "that crosses this curved surface beyond the edges sees them part or join.",
          object_name(scene, arc.edges[0]), object_name(scene, arc.edges[1]),
          object_name(scene, arc.edges[2]), kind(0), kind(1))};
}

PagePicture eeee_picture(const SceneView& view, const Canvas& canvas, const Scene& scene,
                         const Skeleton& skeleton, int id) {
  const SkeletonNode& node = skeleton.nodes[id];
  SceneView marked = view;
  std::string names;
  for (const Generator& g : skeleton.generators(node)) {
    if (g.kind != GeneratorKind::Edge || g.id < 0) continue;
    add_edge(marked.drawing, scene, g.id, kGeneratorEdge, 4.0F, 0.35F);
    if (!names.empty()) names += ", ";
    names += object_name(scene, g.id);
  }
  std::size_t arcs = 0;
  for (const EeeArc& arc : skeleton.eee_arcs) {
    if (std::ranges::find(arc.nodes, static_cast<std::uint32_t>(id)) == arc.nodes.end()) {
      continue;
    }
    add_eee_arc(marked.drawing, scene, arc, 0.3F);
    ++arcs;
  }
  marked.drawing.strokes.push_back(
      {node.segment, colour_of_kind(kind_name(node)), 3.2F, 1, 0.5F});
  return {
      "eeee.png", encode_png(canvas.picture(marked.drawing)), "An EEEE line",
      fmt::format("The line that touches four edges (orange) of {}, in this order: no "
                  "small move keeps all four contacts. {} EEE line sets end in it and "
                  "are drawn as surfaces.",
                  names, arcs)};
}

/// `arcs`: all EV arcs of one vertex, in the scene as `view` shows it.
PagePicture vertex_picture(const SceneView& view, const Canvas& canvas,
                           const Scene& scene, const SkeletonLines& lines,
                           const Skeleton& skeleton, const std::vector<int>& arcs) {
  const std::vector<RuledStrip> strips = strips_of(scene, lines, skeleton, arcs);
  PagePicture picture = strips_picture(view, canvas, scene, skeleton, strips);
  picture.file = "vertex.png";
  picture.title = "All events of one vertex";
  const Point& v = scene.point(skeleton.arcs[arcs[0]].vertex);
  picture.caption = fmt::format(
      "{} The vertex at ({:.4g}, {:.4g}, {:.4g}) and the silhouette edges it sees: "
      "each "
      "veil is one EV line set, out to the faces that end it. A light in that vertex "
      "would cast these shadow edges.",
      drawn_of(strips.size(), arcs.size(), "line sets"), v.x(), v.y(), v.z());
  return picture;
}

/// `arcs`: all EV arcs of one edge.
PagePicture edge_picture(const SceneView& view, const Canvas& canvas, const Scene& scene,
                         const SkeletonLines& lines, const Skeleton& skeleton,
                         const std::vector<int>& arcs) {
  const std::vector<RuledStrip> strips = strips_of(scene, lines, skeleton, arcs);
  PagePicture picture = strips_picture(view, canvas, scene, skeleton, strips);
  picture.file = "edge.png";
  picture.title = "All events of one edge";
  picture.caption = drawn_of(strips.size(), arcs.size(), "line sets") +
                    " The edge that most vertices see, out to the faces behind it. An "
                    "EV line set is a fan through its vertex.";
  return picture;
}

/// `arcs`: all EV arcs between two objects.
PagePicture objects_picture(const SceneView& view, const Canvas& canvas,
                            const Scene& scene, const Skeleton& skeleton,
                            const std::vector<int>& arcs) {
  const SkeletonArc& one = skeleton.arcs[arcs[0]];
  return {"pair.png", pair_picture(view, canvas, scene, skeleton, arcs),
          "Between two objects",
          fmt::format(
              "All {} EV arcs between {} and {}, each the triangle between its vertex "
              "and its part of the edge, with the lines at their ends. {}",
              arcs.size(),
              html_escaped(scene.objects()[object_of_vertex(scene, one.vertex)].name),
              html_escaped(scene.objects()[scene.edges()[one.edge].object].name),
              "The same pair: <code>sightline skeleton --between A B</code>.")};
}

/// Nodes of all kinds, fainter the more there are.
PagePicture nodes_picture(const SceneView& view, const Canvas& canvas,
                          const Skeleton& skeleton) {
  SceneView overview = view;
  const std::vector<int> nodes = evenly_spread(skeleton.nodes.size(), kDrawnNodes);
  const double crowd = static_cast<double>(nodes.size());
  add_nodes(overview.drawing, skeleton, nodes,
            static_cast<float>(std::clamp(300 / (crowd + 1), 0.16, 0.9)),
            crowd > 500 ? 1.1F : 1.8F);
  return {"nodes.png", encode_png(canvas.picture(overview.drawing)),
          "Extremal stabbing lines",
          drawn_of(nodes.size(), skeleton.nodes.size(),
                   "lines, each between its outermost contacts") +
              " " + node_legend(node_counts(skeleton))};
}

std::vector<PagePicture> draw_pictures(const Scene& scene, const SkeletonLines& lines,
                                       const Skeleton& skeleton,
                                       const Highlights& highlights,
                                       const std::optional<std::array<Point, 2>>& region,
                                       int up_axis, const Request& request) {
  ViewOptions view_options;
  view_options.request = request;
  view_options.up_axis = up_axis;
  view_options.focus = region;
  SceneView view = view_scene(scene, view_options);
  if (region) add_box(view.drawing, *region, {0.84F, 0.15F, 0.24F});
  const Canvas canvas(view.drawing, view.camera, {.request = request});
  std::vector<PagePicture> pictures;
  if (!highlights.vertex.empty()) {
    pictures.push_back(
        vertex_picture(view, canvas, scene, lines, skeleton, highlights.vertex));
  }
  if (!highlights.edge.empty()) {
    pictures.push_back(
        edge_picture(view, canvas, scene, lines, skeleton, highlights.edge));
  }
  if (!highlights.pair.empty()) {
    pictures.push_back(objects_picture(view, canvas, scene, skeleton, highlights.pair));
  }
  if (highlights.eee) {
    pictures.push_back(eee_picture(view, canvas, scene, skeleton, *highlights.eee));
  }
  if (highlights.eeee) {
    pictures.push_back(eeee_picture(view, canvas, scene, skeleton, *highlights.eeee));
  }
  pictures.push_back(nodes_picture(view, canvas, skeleton));
  return pictures;
}

Json options_json(const AnalyseOptions& options) {
  Json j{{"only", Json::array({"skeleton"})}};
  j["precision"] = options.precision == Precision::Exact ? "exact" : "double";
  if (std::isfinite(options.budget)) j["budget"] = options.budget;
  if (!options.region.empty()) j["region"] = options.region;
  return j;
}

Json missing_json(const Skeleton& skeleton, const Session& session) {
  Json missing = Json::array();
  const auto add = [&](std::size_t done, std::size_t asked, const char* what) {
    if (done == asked) return;
    missing.push_back(fmt::format(
        "{}: {} of {} were not computed ({:.1f} %)",
        session.interrupted() ? "Interrupted" : "The budget ended first",
        fmt::format(fmt::runtime(what), asked - done), asked,
        100.0 * static_cast<double>(asked - done) / static_cast<double>(asked)));
  };
  add(skeleton.vertices_done, skeleton.vertices_asked, "the EV arcs of {}");
  add(skeleton.edges_done, skeleton.edges_asked, "the EEE arcs of {}");
  add(skeleton.facets_done, skeleton.facets_asked, "the FF nodes of {}");
  if (!skeleton.complete && missing.empty()) {
    missing.push_back("The skeleton: stopped in its set-up");
  }
  for (const std::string& name : session.unwritten()) {
    missing.push_back("Not written: " + name);
  }
  return missing;
}

void print_summary(const Json& report, const fs::path& folder) {
  const Json& s = report["skeleton"];
  std::cout << fmt::format(
      "{}: {} EV arcs ({} within one object), {} EEE arcs ({}){}\n  nodes:",
      report["scene"]["file"].get<std::string>(),
      s["arcs"]["EV"].get<std::int64_t>() + s["arcs"]["EV_self"].get<std::int64_t>(),
      s["arcs"]["EV_self"].get<std::int64_t>(),
      s["arcs"]["EEE"].get<std::int64_t>() + s["arcs"]["EEE_self"].get<std::int64_t>(),
      s["arcs"]["EEE_self"].get<std::int64_t>(),
      report["complete"].get<bool>() ? "" : ", INCOMPLETE");
  for (const auto& [kind, count] : s["nodes"].items()) {
    if (count.is_number() && count != 0) {
      std::cout << fmt::format(" {} {}", kind, count.get<std::int64_t>());
    }
  }
  std::cout << fmt::format("\n  {:.2f} s, {:.0f} MiB\n  open {}\n",
                           report["seconds"].get<double>(),
                           report["peak_memory_bytes"].get<double>() / 1048576,
                           (folder / "index.html").string());
}

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

ExitStatus run(Session& session, const AnalyseOptions& options) {
  // The option is there for analyses to come: today it has one value.
  for (const std::string& name : options.only) {
    if (name != "skeleton") {
      throw UsageError(fmt::format(
          "--only: '{}' is not available in this version; available: skeleton", name));
    }
  }
  // Outputs first: a folder that cannot be written is refused before the work.  Two kinds
  // of names are ours: those of the report, and in `vtk` those of VTK files.
  Outputs outputs(options);
  ReportFolder folder(options.folder);
  outputs.add_folder("-o", folder.path(),
                     [&folder](const std::string& name) { return folder.takes(name); });
  outputs.add_folder("-o", folder.path() / "vtk", is_vtk_name);
  // The meter counts predicates of this thread; the skeleton counts its own.
  const Meter meter;
  StageLog log;
  const PrecisionScope precision(options.precision);
  // 1. The scene and what is wrong with it.  The search for defects has the grace of
  // writing: without it the report would look like that of a sound scene.
  SkeletonRequest request;
  request.ff = true;
  request.part.region = region_box(options.region);
  const Scene scene = load(session, options, folder);
  log.done("load the scene");
  const std::vector<Defect> defects = validate(scene, session.with_grace());
  log.done("look for defects");

  // 2. The skeleton, within what is left of the budget.  Its memory is taken here, before
  // pictures add theirs.
  request.precision = options.precision;
  request.threads = options.threads;
  session.limit(request);
  const StageCounts before = meter.predicates();
  const Skeleton skeleton = build_skeleton(scene, request);
  log.done("visibility skeleton");
  const std::size_t analysis_memory = peak_memory_bytes();

  // 3. Files.  Those of an earlier run go first, so that the folder is of one run only.
  // The skeleton comes before what is drawn of it: of all files it cost the most.
  folder.clear();
  save_skeleton(session, options, scene, skeleton, folder);
  log.done("saved skeleton");
  // `lines` finds free segments: made once, by the first of two steps that gets so far,
  // since either may be stopped.
  std::optional<SkeletonLines> lines;
  const Highlights highlights = find_highlights(scene, skeleton);
  session.write("VTK files", [&](const Request& writing) {
    lines.emplace(scene, writing);
    const std::vector<RuledStrip> strips =
        strips_of(scene, *lines, skeleton, highlights.vertex);
    // Only files in the report's own folder are listed on its page.
    const bool here = options.vtk.empty();
    const fs::path vtk = here ? folder.path() / "vtk" : fs::path(options.vtk);
    std::vector<std::string> names = write_vtk(vtk, scene, {&skeleton, &strips}, writing);
    for (std::string& name : names) name.insert(0, "vtk/");
    if (here) folder.add(names);
  });
  log.done("VTK files");
  // All pictures or none: the page shows only those that were drawn to the end.
  std::vector<PagePicture> pictures;
  session.write("pictures", [&](const Request& writing) {
    if (!lines) lines.emplace(scene, writing);
    auto drawn = draw_pictures(scene, *lines, skeleton, highlights, request.part.region,
                               options.up.empty() ? -1 : options.up[0] - 'x', writing);
    for (const PagePicture& picture : drawn) {
      write_whole(folder.announce(picture.file), picture.png);
    }
    pictures = std::move(drawn);
  });
  log.done("pictures");
  const bool complete = skeleton.complete && session.unwritten().empty();

  // 4. The report, which knows by now what is missing.  The page is made of the report
  // and the pictures alone, so that both say the same.
  Json report = answer_head("analyse", scene, complete,
                            {session.seconds(), before + skeleton.predicates});
  report["peak_memory_bytes"] = analysis_memory;
  report["peak_memory_bytes_with_pictures"] = peak_memory_bytes();
  report["options"] = options_json(options);
  report["info"] = info_json(scene, defects);
  report["skeleton"] = skeleton_json(skeleton);
  report["skeleton"].update({{"events", "solid"},
                             {"kinds", Json::array({"EV", "EEE"})},
                             {"complete", skeleton.complete},
                             {"predicates", stage_counts(skeleton.predicates)}});
  report["stages"] = log.stages();
  report["missing"] = missing_json(skeleton, session);
  // Announced before the list of files is taken: they are in it themselves.
  const fs::path report_file = folder.announce("report.json");
  const fs::path page = folder.announce("index.html");
  report["files"] = folder.files();
  write_whole(report_file, json_text(report, 1) + "\n");
  write_whole(page, report_page(report, pictures));
  outputs.write_answer(report);
  if (options.may_print()) print_summary(report, folder.path());
  return session.end(complete);
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
      ->add_option("-o,--output", options->folder,
                   "folder for index.html, report.json, skeleton.json, pictures and VTK "
                   "files; of what it holds, only what an earlier run wrote is removed, "
                   "which its files.txt lists (default sightline-report)")
      ->type_name("DIR");
  command
      ->add_option("--only", options->only,
                   "only these analyses, separated by commas; known: skeleton "
                   "(default: all that apply)")
      ->type_name("NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false);
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
