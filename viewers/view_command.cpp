// `sightline view`: results and scenes, in a window or as a picture.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "linespace/mesh_io.h"
#include "viewers/command_line.h"
#include "viewers/drawing.h"
#include "viewers/output_file.h"
#include "viewers/skeleton_file.h"
#include "viewers/vtk_export.h"
#include "viewers/window.h"

namespace sightline::viewers {
namespace {

namespace fs = std::filesystem;

struct ViewCommandOptions {
  std::string what;
  std::string png;
  std::string up;
  std::vector<int> size{1400, 980};
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

Shown read_shown(const fs::path& file) {
  const std::string extension = file.extension();
  if (extension == ".vtm" || extension == ".vtp") {
    VtkPicture picture = read_vtk(file);
    Shown shown{{}, {}, std::move(picture.veils), std::move(picture.strokes)};
    if (!picture.soup.polygons.empty()) shown.scene.emplace(std::move(picture.soup));
    return shown;
  }
  if (extension == ".json") {
    StoredSkeleton stored = read_skeleton_json(file.string());
    Scene scene(read_mesh(stored.scene_file));
    check_fits(stored, scene);
    return {std::move(scene), std::move(stored.skeleton), {}, {}};
  }
  return {Scene(read_mesh(file.string())), {}, {}, {}};
}

void write_picture(const ViewCommandOptions& options, const Shown& shown) {
  ViewOptions view_options;
  view_options.width = options.size[0];
  view_options.height = options.size[1];
  if (!options.up.empty()) view_options.up_axis = options.up[0] - 'x';
  SceneView view = shown.scene ? view_scene(*shown.scene, view_options)
                               : view_marks(shown.veils, shown.strokes, view_options);
  if (shown.skeleton) {
    const Skeleton& skeleton = *shown.skeleton;
    const std::vector<int> arcs = evenly_spread(skeleton.arcs.size(), 1500);
    add_arcs(view.drawing, *shown.scene, skeleton, arcs,
             static_cast<float>(std::clamp(8 / (arcs.size() + 1.0), 0.004, 0.2)));
    const std::vector<int> eee = evenly_spread(skeleton.eee_arcs.size(), 1500);
    const auto opacity =
        static_cast<float>(std::clamp(8 / (eee.size() + 1.0), 0.004, 0.2));
    for (const int i : eee) {
      add_eee_arc(view.drawing, *shown.scene, skeleton.eee_arcs[i], opacity);
    }
    add_nodes(view.drawing, skeleton, evenly_spread(skeleton.nodes.size(), 4000), 0.4F,
              1.2F);
  }
  // Many marks are drawn fainter, so that they stay readable, and a part stands for all.
  const std::vector<int> veils = evenly_spread(shown.veils.size(), kDrawnVeils);
  for (const int i : veils) {
    VeilTriangle veil = shown.veils[i];
    veil.opacity = static_cast<float>(
        std::clamp(8 / (static_cast<double>(veils.size()) + 1), 0.002, 0.2));
    view.drawing.veils.push_back(veil);
  }
  const double strokes = static_cast<double>(shown.strokes.size());
  for (Stroke stroke : shown.strokes) {
    stroke.opacity = static_cast<float>(std::clamp(300 / (strokes + 1), 0.05, 0.9));
    stroke.hidden_opacity = 0.12F * stroke.opacity;
    view.drawing.strokes.push_back(stroke);
  }
  PictureOptions picture;
  picture.width = options.size[0];
  picture.height = options.size[1];
  write_whole(options.png, encode_png(render(view.drawing, view.camera, picture)));
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

ExitStatus run(const ViewCommandOptions& options) {
  const fs::path file = file_of(options.what);
  const Shown shown = read_shown(file);
  if (!options.png.empty()) {
    write_picture(options, shown);
  } else if (has_display()) {
    open_window(file, shown);
  } else {
    throw UsageError("view: no DISPLAY for a window; use --png FILE");
  }
  return kAnswered;
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
      ->add_option("--png", options->png,
                   "write a picture instead of opening a window; of arcs, at most "
                   "60,000 triangles, evenly chosen")
      ->type_name("FILE");
  command
      ->add_option("--up", options->up,
                   "the axis that points up in the picture (default: guessed)")
      ->type_name("x|y|z")
      ->check(CLI::IsMember({"x", "y", "z"}));
  command
      ->add_option("--size", options->size,
                   "width,height of the picture in pixels (default 1400,980)")
      ->type_name("W,H")
      ->delimiter(',')
      ->expected(2)
      ->check(CLI::Range(16, 16384));
  return [options] { return run(*options); };
}

}  // namespace sightline::viewers
