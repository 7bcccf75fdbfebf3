// The program `sightline`: one subcommand per question.

#include <fmt/format.h>

#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "viewers/commands/command_line.h"
#include "viewers/commands/process.h"
#include "viewers/output_file.h"

namespace {

using namespace sightline::viewers;  // NOLINT(google-build-using-namespace)

ExitStatus complain(ExitStatus status, const std::string& message) {
  tell_error(message);
  return status;
}

/// The system gave no further thread: within bounds on memory or processes, not our
/// fault.  TBB tells it by these words only.
bool is_lack_of_threads(const std::exception& error) {
  const auto* const told = dynamic_cast<const std::system_error*>(&error);
  return (told != nullptr && told->code() == std::errc::resource_unavailable_try_again) ||
         std::string_view(error.what()).starts_with("pthread_create has failed");
}

/// Parses the command line and runs the command; every error becomes a line and a status.
ExitStatus run(Session& session, CLI::App& app,
               const std::vector<std::pair<std::string, Command>>& commands, int argc,
               char** argv) {
  try {
    app.parse(argc, argv);
    for (const auto& [name, run] : commands) {
      if (app.got_subcommand(name)) return run(session);
    }
    return kOurFailure;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      app.exit(error);
      return kAnswered;
    }
    return complain(kBadInput, told(app, error));
  } catch (const sightline::Stopped&) {
    return session.end_without_answer();
  } catch (const UsageError& error) {
    return complain(kBadInput, error.what());
  } catch (const OutputError& error) {
    return complain(kBadInput, error.what());
  } catch (const WriteError& error) {
    return complain(kOurFailure, error.what());
  } catch (const sightline::InvalidInput& error) {
    return complain(kBadInput, error.what());
  } catch (const std::bad_alloc&) {
    return complain(kOurFailure, "out of memory");
  } catch (const std::exception& error) {
    if (is_lack_of_threads(error)) {
      return complain(kOurFailure, "out of memory for threads; --threads takes fewer");
    }
    return complain(kOurFailure, fmt::format("internal error: {}", error.what()));
  }
}

}  // namespace

int main(int argc, char** argv) {
  prepare_process();
  Session session;
  CLI::App app{
      "Exact 3D visibility: which lines touch what, and what that changes.\n"
      "Start with `sightline analyse`, which needs no file, or `sightline info FILE`.",
      "sightline"};
  app.set_version_flag("--version", version());
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 answered; 2 bad usage or bad input, nothing written;\n"
      "3 budget ended or interrupted, partial answer written; 1 our own failure, or an\n"
      "output that could not be written to its end.");
  std::vector<std::pair<std::string, Command>> commands;
  commands.emplace_back("analyse", add_analyse_command(app));
  commands.emplace_back("aspects", add_aspects_command(app));
  commands.emplace_back("info", add_info_command(app));
  commands.emplace_back("look", add_look_command(app));
  commands.emplace_back("formfactors", add_formfactors_command(app));
  commands.emplace_back("shadows", add_shadows_command(app));
  commands.emplace_back("skeleton", add_skeleton_command(app));
  commands.emplace_back("stab", add_stab_command(app));
  commands.emplace_back("transversals", add_transversals_command(app));
  commands.emplace_back("view", add_view_command(app));
  commands.emplace_back("viewpoints", add_viewpoints_command(app));
  commands.emplace_back("visible", add_visible_command(app));
  const ExitStatus status = run(session, app, commands, argc, argv);
  const std::string unwritten = standard_output_error();
  return unwritten.empty() || status == kOurFailure ? status
                                                    : complain(kOurFailure, unwritten);
}
