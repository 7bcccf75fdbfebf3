// `sightline view`: results and scenes, in a window or as a picture.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iostream>
#include <utility>

#include "linespace/perturb.h"
#include "viewers/clip.h"
#include "viewers/commands/command_line.h"
#include "viewers/commands/outputs.h"
#include "viewers/drawing.h"
#include "viewers/kinds.h"
#include "viewers/skeleton_file.h"
#include "viewers/vtk_export.h"
#include "viewers/window.h"

namespace sightline::viewers {
namespace {

namespace fs = std::filesystem;

struct ViewCommandOptions {
  std::string what;
  std::string scene;
  std::string png;
  std::string up;
  std::vector<int> size{1400, 980};
  std::vector<double> box, eye, look_at;
  std::vector<std::string> kinds;  // all when empty
  double budget = std::numeric_limits<double>::infinity();
};

/// The file that stands for a folder of results.
fs::path file_of(const fs::path& what) {
  if (!fs::is_directory(what)) return what;
  for (const fs::path& candidate : {what / "vtk/sightline.vtm", what / "sightline.vtm"}) {
    if (fs::is_regular_file(candidate)) return candidate;
  }
  throw UsageError(what.string() + ": holds no sightline.vtm and no vtk/sightline.vtm");
}

/// How many triangles of arcs a picture takes: more cost minutes and show no more.
constexpr std::size_t kDrawnVeils = 60000;

struct Shown {
  std::optional<Scene> scene;  // none in files of lines alone
  std::optional<Skeleton> skeleton;
  std::vector<VeilTriangle> veils;
  std::vector<Stroke> strokes;
};

/// Where the scene of a saved skeleton is: where the file says, or else beside the file.
std::string scene_file_of(const StoredSkeleton& stored) {
  const fs::path beside = fs::path(stored.file).parent_path();
  for (const fs::path& candidate :
       {fs::path(stored.scene_file), beside / stored.scene_file,
        beside / fs::path(stored.scene_file).filename()}) {
    if (fs::is_regular_file(candidate)) return candidate.string();
  }
  throw InvalidInput(fmt::format("{}: its scene {} is not there; name it with --scene",
                                 stored.file, stored.scene_file));
}

Shown read_shown(Session& session, const ViewCommandOptions& options,
                 const fs::path& file, Outputs& outputs) {
  const std::string extension = file.extension();
  if (extension == ".vtm" || extension == ".vtp") {
    VtkPicture picture = read_vtk(file);
    Shown shown{{}, {}, std::move(picture.veils), std::move(picture.strokes)};
    if (!picture.soup.polygons.empty()) {
      shown.scene.emplace(std::move(picture.soup), SceneOptions{}, session.with_grace());
    }
    return shown;
  }
  if (extension == ".json") {
    StoredSkeleton stored =
        session.read([&] { return read_skeleton_json(file.string()); });
    const std::string name =
        options.scene.empty() ? scene_file_of(stored) : options.scene;
    outputs.protect(name);
    Scene scene = read_scene(session, name);
    if (stored.perturb > 0) {
      scene =
          Scene(perturbed(scene, stored.perturb, stored.seed), {}, session.with_grace());
    }
    check_fits(stored, scene);
    return {std::move(scene), std::move(stored.skeleton), {}, {}};
  }
  return {read_scene(session, file.string()), {}, {}, {}};
}

Point point_of(const std::vector<double>& numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

std::array<Point, 2> bounds_of(const Shown& shown) {
  return shown.scene ? shown.scene->bounds() : bounds_of(shown.veils, shown.strokes);
}

/// What the command line says of box and eye; refuses what gives no picture.
ViewOptions view_options_of(const ViewCommandOptions& options, const Shown& shown) {
  ViewOptions view;
  view.width = options.size[0];
  view.height = options.size[1];
  if (!options.up.empty()) view.up_axis = options.up[0] - 'x';
  view.box = region_box(options.box, "--box");
  if (view.box && ((*view.box)[0].array() == (*view.box)[1].array()).any()) {
    throw UsageError("--box: has no extent in x, y or z");
  }
  if (options.eye.empty()) return view;
  const auto [low, high] = view.box ? *view.box : bounds_of(shown);
  const bool told = !options.look_at.empty();
  view.look = {point_of(options.eye),
               told ? point_of(options.look_at) : 0.5 * (low + high)};
  const double distance = (view.look->at - view.look->eye).norm();
  if (!(distance > 0)) {
    throw UsageError(told ? "--eye: is the same point as --look-at"
                          : "--eye: is the middle of what is shown; say where to look "
                            "with --look-at x,y,z");
  }
  if (!std::isfinite(distance)) throw UsageError("--eye: is too far away");
  return view;
}

/// Adds the marks, or what of them is inside the box.
void add_marks(Drawing& drawing, Drawing marks, const ViewOptions& options) {
  if (options.box) marks = clipped(marks, *options.box);
  drawing.veils.insert(drawing.veils.end(), marks.veils.begin(), marks.veils.end());
  drawing.strokes.insert(drawing.strokes.end(), marks.strokes.begin(),
                         marks.strokes.end());
}

/// At most `limit` of the items of these kinds (all if none is named), evenly spread
/// over those that reach into the box.
template <typename Item>
std::vector<int> chosen(std::span<const Item> items, std::size_t limit,
                        const std::vector<std::string>& kinds, const ViewOptions& options,
                        const std::function<void(Drawing&, std::span<const int>)>& draw) {
  std::vector<int> candidates;
  for (int i = 0; i < static_cast<int>(items.size()); ++i) {
    if (!kinds.empty() && std::ranges::find(kinds, kind_name(items[i])) == kinds.end()) {
      continue;
    }
    if (options.box) {
      Drawing one;
      draw(one, {&i, 1});
      if (is_empty(clipped(one, *options.box))) continue;
    }
    candidates.push_back(i);
  }
  std::vector<int> spread = evenly_spread(candidates.size(), limit);
  for (int& i : spread) i = candidates[i];
  return spread;
}

/// Many marks are drawn fainter, so that they stay readable.
float opacity_of(std::size_t veils, double least = 0.004) {
  return static_cast<float>(std::clamp(8 / (static_cast<double>(veils) + 1), least, 0.2));
}

void add_skeleton(Drawing& drawing, const Scene& scene, const Skeleton& skeleton,
                  const std::vector<std::string>& kinds, const ViewOptions& options) {
  Drawing marks;
  const auto draw_ev = [&](Drawing& d, std::span<const int> arcs) {
    add_arcs(d, scene, skeleton, arcs, opacity_of(arcs.size()));
  };
  const auto draw_eee = [&](Drawing& d, std::span<const int> arcs) {
    for (const int i : arcs) {
      add_eee_arc(d, scene, skeleton.eee()[i], opacity_of(arcs.size()));
    }
  };
  const auto draw_nodes = [&](Drawing& d, std::span<const int> nodes) {
    const double crowd = static_cast<double>(nodes.size());
    add_nodes(d, skeleton, nodes,
              static_cast<float>(std::clamp(300 / (crowd + 1), 0.4, 0.9)),
              crowd > 500 ? 1.2F : 1.8F);
  };
  draw_ev(marks, chosen(skeleton.ev(), 1500, kinds, options, draw_ev));
  draw_eee(marks, chosen(skeleton.eee(), 1500, kinds, options, draw_eee));
  draw_nodes(marks, chosen(std::span(skeleton.nodes), 4000, kinds, options, draw_nodes));
  add_marks(drawing, std::move(marks), options);
}

/// Those of a VTK file.
void add_file_marks(Drawing& drawing, const Shown& shown, const ViewOptions& options) {
  Drawing all{{}, shown.veils, shown.strokes, {}};
  if (options.box) all = clipped(all, *options.box);
  const std::vector<int> veils = evenly_spread(all.veils.size(), kDrawnVeils);
  for (const int i : veils) {
    VeilTriangle veil = all.veils[i];
    veil.opacity = opacity_of(veils.size(), 0.002);
    drawing.veils.push_back(veil);
  }
  const double strokes = static_cast<double>(all.strokes.size());
  for (Stroke stroke : all.strokes) {
    stroke.opacity = static_cast<float>(std::clamp(300 / (strokes + 1), 0.05, 0.9));
    stroke.hidden_opacity = 0.12F * stroke.opacity;
    drawing.strokes.push_back(stroke);
  }
}

void check_kinds(const std::vector<std::string>& kinds, const Shown& shown) {
  if (!kinds.empty() && !shown.skeleton) {
    throw UsageError("--kinds: only a saved skeleton (.json) has kinds");
  }
  const std::vector<std::string> names = kind_names();
  for (const std::string& kind : kinds) {
    if (std::ranges::find(names, kind) != names.end()) continue;
    throw UsageError(
        fmt::format("--kinds: '{}' is none of {}", kind, fmt::join(names, ", ")));
  }
}

void write_picture(Session& session, const ViewCommandOptions& options,
                   const Shown& shown, OutputFile& file) {
  check_kinds(options.kinds, shown);
  ViewOptions view_options = view_options_of(options, shown);
  view_options.request = session.with_grace();
  SceneView view = shown.scene ? view_scene(*shown.scene, view_options)
                               : view_marks(shown.veils, shown.strokes, view_options);
  if (shown.skeleton) {
    add_skeleton(view.drawing, *shown.scene, *shown.skeleton, options.kinds,
                 view_options);
  }
  add_file_marks(view.drawing, shown, view_options);
  if (view_options.box && is_empty(view.drawing)) {
    const auto [low, high] = bounds_of(shown);
    throw UsageError(fmt::format(
        "--box: nothing is inside; what there is to show spans {},{},{},{},{},{}",
        low.x(), low.y(), low.z(), high.x(), high.y(), high.z()));
  }
  PictureOptions picture;
  picture.width = options.size[0];
  picture.height = options.size[1];
  picture.request = session.with_grace();
  file.stream() << encode_png(render(view.drawing, view.camera, picture));
  file.commit();
}

/// The window reads VTK files: others are written to a folder of our own first.
void open_window(const fs::path& file, const Shown& shown) {
  if (file.extension() == ".vtm" || file.extension() == ".vtp") {
    show_window(file);
    return;
  }
  std::string pattern = (fs::temp_directory_path() / "sightline-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) {
    throw OutputError(pattern + ": cannot be written: no temporary folder");
  }
  const fs::path folder(pattern);
  write_vtk(folder, *shown.scene, {shown.skeleton ? &*shown.skeleton : nullptr, nullptr});
  show_window(folder / "sightline.vtm");
  fs::remove_all(folder);
}

ExitStatus run(Session& session, const ViewCommandOptions& options) {
  const fs::path file = file_of(options.what);
  if (options.png.empty() && !has_display()) {
    throw UsageError("view: no DISPLAY for a window; use --png FILE");
  }
  Outputs outputs;
  outputs.protect(file.string());
  OutputFile* const png =
      options.png.empty() ? nullptr : &outputs.add("--png", options.png);
  const Shown shown = read_shown(session, options, file, outputs);
  if (png != nullptr) {
    write_picture(session, options, shown, *png);
  } else {
    open_window(file, shown);
  }
  return session.end(true);
}

/// How the picture of --png looks, and what of the scene or the skeleton is in it.
void add_picture_options(CLI::App& command, ViewCommandOptions& options,
                         CLI::Option* png) {
  command
      .add_option("--up", options.up,
                  "the axis that points up in the picture (default: guessed)")
      ->type_name("x|y|z")
      ->check(one_of({"x", "y", "z"}));
  command
      .add_option("--size", options.size,
                  "width,height of the picture in pixels (default 1400,980)")
      ->type_name("W,H")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->expected(2)
      ->check(whole_number(16, 16384));
  command
      .add_option("--box", options.box,
                  "a picture of this box only: x0,y0,z0,x1,y1,z1 in scene units, smaller "
                  "corner first; everything is cut at its faces (solids show a dark "
                  "cut), and the picture frames it; a room without its ceiling is a box "
                  "that ends just below it (default: everything)")
      ->type_name("BOX")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->expected(6)
      ->check(finite_number())
      ->needs(png);
  command
      .add_option("--kinds", options.kinds,
                  "of a saved skeleton, draw only arcs and nodes of these kinds, named "
                  "as `sightline skeleton` counts them: EV,EV_self,EEE,VV,EEEE,... "
                  "(default: all)")
      ->type_name("KIND,...")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->needs(png);
}

/// From where the picture of --png is taken.
void add_eye_options(CLI::App& command, ViewCommandOptions& options, CLI::Option* png) {
  CLI::Option* eye =
      command
          .add_option("--eye", options.eye,
                      "take the picture from this point, x,y,z in scene units, outside "
                      "or inside of the scene; nothing is left away then, and the angle "
                      "is what just holds the box or the scene, 69 degrees at most "
                      "(default: from where most is seen)")
          ->type_name("POINT")
          ->delimiter(',')
          ->allow_extra_args(false)
          ->expected(3)
          ->check(finite_number())
          ->needs(png);
  command
      .add_option("--look-at", options.look_at,
                  "the point x,y,z in the middle of the picture of --eye (default: the "
                  "middle of the box or of the scene)")
      ->type_name("POINT")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->expected(3)
      ->check(finite_number())
      ->needs(eye);
}

}  // namespace

Command add_view_command(CLI::App& app) {
  auto options = std::make_shared<ViewCommandOptions>();
  CLI::App* command = app.add_subcommand(
      "view", "show results or a scene in a window, or as a picture without a display");
  command
      ->add_option("FILE|DIR", options->what,
                   "a folder of analyse or --vtk, a .vtm or .vtp of ours, a saved "
                   "skeleton (.json) or a mesh file")
      ->required();
  command
      ->add_option(
          "--scene", options->scene,
          "the scene of a saved skeleton, where it is neither where that says nor "
          "beside it")
      ->type_name("SCENE");
  CLI::Option* png =
      command
          ->add_option("--png", options->png,
                       "write a picture instead of opening a window; of arcs, at most "
                       "60,000 triangles, evenly chosen")
          ->type_name("FILE");
  add_picture_options(*command, *options, png);
  add_eye_options(*command, *options, png);
  add_budget_option(*command, options->budget);
  return command_of(options, run);
}

}  // namespace sightline::viewers
