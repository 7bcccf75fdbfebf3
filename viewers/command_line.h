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

#include "linespace/request.h"
#include "viewers/answer.h"
#include "viewers/option_checks.h"

namespace sightline::viewers {

/// Exit statuses of CONTRACT.md.
enum ExitStatus : int { kAnswered = 0, kOurFailure = 1, kBadInput = 2, kPartial = 3 };

/// The command line asks for something that cannot be; what() is one line.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Does a command's work once the command line has been read.
using Command = std::function<ExitStatus()>;

struct CommonOptions {
  std::string scene;  ///< or the question's FILE
  std::string json;   ///< file name, "-" for standard output, empty for none
  std::string vtk;    ///< folder, empty for none
  int threads = 0;
  Precision precision = Precision::Exact;

  /// False when standard output belongs to the JSON answer.
  [[nodiscard]] bool may_print() const { return json != "-"; }
};

void add_scene_argument(CLI::App& app, CommonOptions& options, bool required = true);
/// FILE, for commands that are asked of a JSON file instead of a scene.
void add_file_argument(CLI::App& app, CommonOptions& options, const std::string& help);
void add_common_options(CLI::App& app, CommonOptions& options);
void add_budget_option(CLI::App& app, double& seconds);
/// --budget-mb, in bytes; stays as it is when not given.
void add_size_budget_option(CLI::App& app, std::size_t& bytes);
void add_region_option(CLI::App& app, std::vector<double>& region);

/// The six numbers of --region as a box; nullopt when none were given.  Throws UsageError
/// when one is not finite or a lower corner is above its upper one.
[[nodiscard]] std::optional<std::array<Point, 2>> region_box(
    const std::vector<double>& region, const char* option = "--region");

/// A line on standard error that shows how far the work is; silent unless standard error
/// is a terminal.
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  [[nodiscard]] std::function<void(std::string_view stage, double share)> callback();

 private:
  struct State;
  std::shared_ptr<State> state_;
};

/// While it lives, a first interrupt (SIGINT or SIGTERM) asks for a stop, a second one
/// ends the program.  Create it before other threads.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;
  [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }

 private:
  std::stop_source stop_;
  std::jthread watcher_;
};

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
Command add_info_command(CLI::App& app);
Command add_skeleton_command(CLI::App& app);
Command add_analyse_command(CLI::App& app);
Command add_stab_command(CLI::App& app);
Command add_transversals_command(CLI::App& app);
Command add_view_command(CLI::App& app);
Command add_visible_command(CLI::App& app);

}  // namespace sightline::viewers
