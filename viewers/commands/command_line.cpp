#include "viewers/commands/command_line.h"

#include <fmt/format.h>

#include <utility>

namespace sightline::viewers {

void add_scene_argument(CLI::App& app, CommonOptions& options, bool required) {
  CLI::Option* scene = app.add_option(
      "SCENE", options.scene,
      "mesh file, by extension: .obj .ply .stl .off .glb .gltf; where assimp reads "
      "them .ifc .3ds .ac .dae .dxf .fbx .lwo .x; '-' is standard input, with --format");
  scene->required(required);
  add_format_option(app, options);
}

void add_format_option(CLI::App& app, CommonOptions& options) {
  app.add_option("--format", options.format,
                 "read SCENE in this format, whatever its name ends in: obj, ply, ... "
                 "(default: by extension)")
      ->type_name("EXTENSION")
      ->check(one_of(readable_extensions()));
}

void add_file_argument(CLI::App& app, CommonOptions& options, const std::string& help) {
  app.add_option("FILE", options.scene, help)->required();
}

void add_common_options(CLI::App& app, CommonOptions& options, bool has_vtk) {
  app.add_option("--json", options.json,
                 "write the answer as JSON to FILE; '-' is standard output, and then "
                 "nothing else goes there")
      ->type_name("FILE");
  if (has_vtk) {
    app.add_option(
           "--vtk", options.vtk,
           "write VTK files into the folder DIR; open DIR/sightline.vtm in ParaView")
        ->type_name("DIR");
  }
  app.add_option(
         "--threads", options.threads,
         "number of threads; 0 means one per core (default 0); the answer does not "
         "depend on it")
      ->type_name("N")
      ->check(whole_number(0, 4096));
  app.add_option_function<std::string>(
         "--precision",
         [&options](const std::string& name) {
           options.precision = name == "double" ? Precision::Double : Precision::Exact;
         },
         "exact: every sign is that of exact arithmetic; double: skips the exact stages, "
         "to measure what they cost and save (default exact)")
      ->type_name("exact|double")
      ->check(one_of({"exact", "double"}));
  add_budget_option(app, options.budget);
}

void add_budget_option(CLI::App& app, double& seconds) {
  app.add_option("--budget", seconds,
                 "seconds, from the start of the program on, after which it ends with "
                 "what it has, within a second, reading and writing included; exit "
                 "status 3 (default: no limit)")
      ->type_name("S")
      ->check(number_above_zero());
}

void add_size_budget_option(CLI::App& app, std::size_t& bytes) {
  app.add_option_function<double>(
         "--budget-mb",
         [&bytes](double megabytes) {
           bytes = static_cast<std::size_t>(std::min(megabytes * 1048576, 0x1p62));
         },
         "megabytes (2^20 bytes) of nodes and arcs after which a partial answer is "
         "given, with exit status 3; the process needs two to three times as much "
         "(default: no limit)")
      ->type_name("M")
      ->check(number_above_zero());
}

void add_names_option(CLI::App& app, const std::string& option,
                      std::vector<std::string>& names, const std::string& help) {
  app.add_option(option, names, help)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("GROUP[,GROUP...]");
}

void add_region_option(CLI::App& app, std::vector<double>& region) {
  app.add_option(
         "--region", region,
         "only vertices and edges inside this box: x0,y0,z0,x1,y1,z1 in scene units "
         "(default: everywhere)")
      ->type_name("BOX")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->expected(6)
      ->check(finite_number());
}

std::optional<std::array<Point, 2>> region_box(const std::vector<double>& region,
                                               const char* option) {
  if (region.empty()) return std::nullopt;
  const Point low(region[0], region[1], region[2]), high(region[3], region[4], region[5]);
  if (!low.allFinite() || !high.allFinite()) {
    throw UsageError(fmt::format("{}: not six finite numbers", option));
  }
  if ((low.array() > high.array()).any()) {
    throw UsageError(
        fmt::format("{}: the first corner must not exceed the second", option));
  }
  return std::array<Point, 2>{low, high};
}

MeshFile read_file(Session& session, const std::string& file, const std::string& format) {
  if (file == "-" && format.empty()) {
    throw UsageError("'-' is standard input: name its format, as in --format obj");
  }
  return read_mesh(file, session.with_grace(), format);
}

Scene read_scene(Session& session, const std::string& file, const std::string& format) {
  return Scene(read_file(session, file, format), {}, session.with_grace());
}

std::string counted(std::size_t n, const char* one, const char* many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

Meter::Meter()
    : start_(std::chrono::steady_clock::now()), counts_(thread_stage_counts()) {}

double Meter::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

StageCounts Meter::predicates() const { return thread_stage_counts() - counts_; }

}  // namespace sightline::viewers
