// What all commands share: common options, exit statuses, progress, interruption.

#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "linespace/mesh_io.h"
#include "linespace/request.h"
#include "viewers/answer.h"
#include "viewers/commands/option_checks.h"
#include "viewers/commands/session.h"

namespace sightline::viewers {

/// The command line asks for something that cannot be; what() is one line.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Does a command's work once the command line has been read.  Throws Stopped when the
/// work was stopped before there was an answer.
using Command = std::function<ExitStatus(Session&)>;

struct CommonOptions {
  std::string scene;   ///< or the question's FILE; "-" for standard input
  std::string format;  ///< of the scene, an extension; empty: its own
  std::string json;    ///< file name, "-" for standard output, empty for none
  std::string vtk;     ///< folder, empty for none
  int threads = 0;
  Precision precision = Precision::Exact;
  double budget = std::numeric_limits<double>::infinity();  ///< seconds, for everything

  /// False when standard output belongs to the JSON answer.
  [[nodiscard]] bool may_print() const { return json != "-"; }
};

void add_scene_argument(CLI::App& app, CommonOptions& options, bool required = true);
/// --format, which add_scene_argument adds too.
void add_format_option(CLI::App& app, CommonOptions& options);
/// FILE, for commands that are asked of a JSON file instead of a scene.
void add_file_argument(CLI::App& app, CommonOptions& options, const std::string& help);
/// --json, --vtk unless there are no such files, --threads, --precision, --budget.
void add_common_options(CLI::App& app, CommonOptions& options, bool has_vtk = true);
void add_budget_option(CLI::App& app, double& seconds);
/// --budget-mb, in bytes; stays as it is when not given.
void add_size_budget_option(CLI::App& app, std::size_t& bytes);
/// An option that takes names of groups, separated by commas.
void add_names_option(CLI::App& app, const std::string& option,
                      std::vector<std::string>& names, const std::string& help);
void add_region_option(CLI::App& app, std::vector<double>& region);

/// The six numbers of --region as a box; nullopt when none were given.  Throws UsageError
/// when one is not finite or a lower corner is above its upper one.
[[nodiscard]] std::optional<std::array<Point, 2>> region_box(
    const std::vector<double>& region, const char* option = "--region");

/// The command that runs under the budget among its options.
template <class Options>
Command command_of(std::shared_ptr<Options> options,
                   ExitStatus (*run)(Session&, const Options&)) {
  return [options, run](Session& session) {
    session.set_budget(options->budget);
    return run(session, *options);
  };
}

/// Reads a mesh file, as a stage of the session.  Throws UsageError for "-" without a
/// format.
[[nodiscard]] MeshFile read_file(Session& session, const std::string& file,
                                 const std::string& format = {});

/// Reads a mesh file and makes a scene of it, as stages of the session.  Throws
/// UsageError for "-" without a format.
[[nodiscard]] Scene read_scene(Session& session, const std::string& file,
                               const std::string& format = {});

/// "1 view", "2 views".
[[nodiscard]] std::string counted(std::size_t n, const char* one, const char* many);

/// Seconds since it was made, and predicate calls of this thread since then.
class Meter {
 public:
  Meter();
  [[nodiscard]] double seconds() const;
  [[nodiscard]] StageCounts predicates() const;

 private:
  std::chrono::steady_clock::time_point start_;
  StageCounts counts_;
};

/// Registers the command under its name; the Command is valid after parsing.
Command add_aspects_command(CLI::App& app);
Command add_formfactors_command(CLI::App& app);
Command add_info_command(CLI::App& app);
Command add_look_command(CLI::App& app);
Command add_shadows_command(CLI::App& app);
Command add_skeleton_command(CLI::App& app);
Command add_analyse_command(CLI::App& app);
Command add_stab_command(CLI::App& app);
Command add_transversals_command(CLI::App& app);
Command add_view_command(CLI::App& app);
Command add_viewpoints_command(CLI::App& app);
Command add_visible_command(CLI::App& app);

}  // namespace sightline::viewers
