// The names of kinds of arcs and nodes, as answers, files and pictures use them.

#pragma once

#include <string>
#include <vector>

#include "skeleton/graph.h"

namespace sightline::viewers {

/// "EV", "EV_self"; "EEE", "EEE_self"; "VV", "VEE", "FvE_self", ...: the names of
/// CONTRACT.md.
[[nodiscard]] std::string kind_name(const SkeletonArc& arc);
[[nodiscard]] std::string kind_name(const SkeletonNode& node);

/// Every name that kind_name() gives, arcs first.
[[nodiscard]] std::vector<std::string> kind_names();

}  // namespace sightline::viewers
