#include "viewers/commands/report/report_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "viewers/builtin_scene.h"

namespace sightline::viewers {
namespace {

namespace fs = std::filesystem;

bool is_asked(const AnalyseOptions& options, std::string_view part) {
  return options.only.empty() || std::ranges::count(options.only, part) > 0;
}

/// By name, not by default.
bool is_named(const AnalyseOptions& options, std::string_view part) {
  return !options.only.empty() && is_asked(options, part);
}

/// A word of the shell.
std::string shell_word(const std::string& word) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("_-./,+:@%").find(c) != std::string::npos;
  };
  if (!word.empty() && std::ranges::all_of(word, plain)) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

constexpr const char* kNotAmong = "not among --only";
constexpr const char* kNoLight = "no light: --light names none, and the file marks none";

std::string why_no_factors(const AnalyseOptions& options,
                           const std::vector<std::string>& light) {
  if (!is_asked(options, "formfactors")) return kNotAmong;
  if (light.empty()) return kNoLight;
  return fmt::format("more than {} groups", kMostFactorGroups);
}

}  // namespace

void check_parts(const AnalyseOptions& options) {
  for (const std::string& name : options.only) {
    if (std::ranges::count(kParts, name) > 0) continue;
    throw UsageError(
        fmt::format("--only: '{}' is not available in this version; available: {}", name,
                    fmt::join(kParts, ", ")));
  }
  if (is_named(options, "look") && options.viewpoints.empty()) {
    throw UsageError("--only look: from where? name --from x,y,z or --direction x,y,z");
  }
}

Parts parts_of(const AnalyseOptions& options, const Scene& scene,
               const std::vector<std::string>& light) {
  const bool lit = !light.empty();
  if (is_named(options, "shadows") && !lit) {
    throw UsageError(
        "--only shadows: of which light? name --light GROUP; the file marks none");
  }
  Parts parts;
  parts.skeleton = is_asked(options, "skeleton");
  parts.look = is_asked(options, "look") && !options.viewpoints.empty();
  parts.shadows = is_asked(options, "shadows") && lit;
  parts.factors =
      is_named(options, "formfactors") ||
      (options.only.empty() && lit && scene.objects().size() <= kMostFactorGroups);
  return parts;
}

Json left_out_json(const AnalyseOptions& options, const Parts& parts,
                   const std::vector<std::string>& light,
                   const std::vector<ViewQuestion>& questions, const fs::path& folder) {
  const std::string scene = shell_word(
      options.scene.empty() ? (folder / kBuiltinSceneName).string() : options.scene);
  Json left = Json::array();
  const auto add = [&](const char* part, const std::string& why,
                       const std::string& more) {
    left.push_back({{"part", part},
                    {"why", why},
                    {"command", fmt::format("sightline {} {}{}", part, scene, more)}});
  };
  if (!parts.skeleton) add("skeleton", kNotAmong, "");
  if (!parts.look) {
    std::string from;
    for (const ViewQuestion& question : questions) from += " " + question.where;
    add("look", questions.empty() ? "neither --from nor --direction is given" : kNotAmong,
        questions.empty() ? " --from x,y,z" : from);
  }
  if (!parts.shadows) {
    const std::string names =
        light.empty() ? "GROUP" : shell_word(fmt::format("{}", fmt::join(light, ",")));
    add("shadows", is_asked(options, "shadows") ? kNoLight : kNotAmong,
        " --light " + names);
  }
  if (!parts.factors) add("formfactors", why_no_factors(options, light), "");
  return left;
}

Json options_json(const AnalyseOptions& options, const Parts& parts,
                  const std::vector<std::string>& light) {
  Json j{{"only", Json::array({"info"})}};
  if (parts.skeleton) j["only"].push_back("skeleton");
  if (parts.look) j["only"].push_back("look");
  if (parts.shadows) j["only"].push_back("shadows");
  if (parts.factors) j["only"].push_back("formfactors");
  j["light"] = light;
  j["precision"] = options.precision == Precision::Exact ? "exact" : "double";
  if (std::isfinite(options.budget)) j["budget"] = options.budget;
  if (!options.region.empty()) j["region"] = options.region;
  return j;
}

}  // namespace sightline::viewers
