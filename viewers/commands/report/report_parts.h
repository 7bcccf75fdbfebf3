// Which parts a report has: what is done, and what is told of the rest.

#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "viewers/commands/command_line.h"
#include "viewers/commands/views.h"

namespace sightline::viewers {

struct AnalyseOptions : CommonOptions {
  ViewpointOptions viewpoints;
  std::string folder = "sightline-report";
  std::vector<std::string> only;
  std::vector<std::string> light;
  std::string up;
  std::vector<double> region;
};

/// The parts of a report that this version has, in their order.
inline constexpr std::array<const char*, 5> kParts{"info", "skeleton", "look", "shadows",
                                                   "formfactors"};

/// Between more groups form factors are found only where --only asks for them.
inline constexpr std::size_t kMostFactorGroups = 100;

/// What is done, besides the scene and its defects.
struct Parts {
  bool skeleton = true, look = true, shadows = true, factors = true;
  [[nodiscard]] int count() const {
    return int{skeleton} + int{look} + int{shadows} + int{factors};
  }
};

/// Refuses what the command line asks for and cannot have, before anything is read.
/// Throws UsageError.
void check_parts(const AnalyseOptions& options);

/// For a scene with these groups as its light, if any.  Throws UsageError where --only
/// asks for shadows and there is no light.
[[nodiscard]] Parts parts_of(const AnalyseOptions& options, const Scene& scene,
                             const std::vector<std::string>& light);

/// [{"part", "why", "command"}] of what could have been done and was not.  `folder`: of
/// the report; the built-in scene lies there.
[[nodiscard]] Json left_out_json(const AnalyseOptions& options, const Parts& parts,
                                 const std::vector<std::string>& light,
                                 const std::vector<ViewQuestion>& questions,
                                 const std::filesystem::path& folder);

/// "options" of report.json.
[[nodiscard]] Json options_json(const AnalyseOptions& options, const Parts& parts,
                                const std::vector<std::string>& light);

}  // namespace sightline::viewers
